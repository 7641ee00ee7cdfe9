"""A driver of finite impedance, which takes up a share of each wave at once."""

from __future__ import annotations

from stickslip.run.check.far_side import GivesWay

ANSWERS = GivesWay()
