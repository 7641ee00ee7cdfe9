"""Where the waves of a body are found that decide what follows, by its kind."""

from __future__ import annotations

from stickslip.engine import History
from stickslip.extensions.cycles.waves.layers import LayerSource
from stickslip.extensions.cycles.waves.mesh import WaveSource

SOURCES: dict[str, type[WaveSource]] = {"uniform": WaveSource, "layered": LayerSource}
"""That of each kind of body (`Body.structure`)."""


def source_of(history: History, end: float) -> WaveSource:
    """Return the waves of the round trip in a history that ends at a time (s)."""
    return SOURCES[history.problem.body.structure](history, end)
