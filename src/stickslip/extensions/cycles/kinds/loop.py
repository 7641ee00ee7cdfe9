"""Bodies in a position loop: their cycles are not found."""

from __future__ import annotations

from stickslip.extensions.cycles.asked import CycleKind


class CyclesOfLoops(CycleKind):
    """Answers of a body in a position loop."""

    what = "body in a position loop"


ANSWERS = CyclesOfLoops()
