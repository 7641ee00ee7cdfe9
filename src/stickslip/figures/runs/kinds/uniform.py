"""How uniform bodies with waves are drawn."""

from __future__ import annotations

from stickslip.figures.runs.asked import DrawnKind

ANSWERS = DrawnKind()
