"""Bodies in a position loop: their cycles are not found."""

from __future__ import annotations

from stickslip.extensions.cycles.asked import WithoutCycles

ANSWERS = WithoutCycles("body in a position loop")
