"""Bodies of layers: their cycles are not found."""

from __future__ import annotations

from stickslip.extensions.cycles.asked import CycleKind


class CyclesOfLayers(CycleKind):
    """Answers of a body of layers."""

    what = "body of layers"


ANSWERS = CyclesOfLayers()
