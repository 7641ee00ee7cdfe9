"""Problems and histories that several test modules use."""

from __future__ import annotations

from stickslip.engine.state.layout import Store


def scaled_rate(store: Store, factor: float) -> Store:
    """Return a copy of a history whose slip rate is wrong by a factor: a test of what reads it must notice."""
    wrong = store._replace(pieces=store.pieces.copy())
    wrong.rate[:] *= factor
    return wrong
