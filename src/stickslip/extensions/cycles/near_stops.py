"""Cycles that graze a hard stop: whether one turns back next to it, or meets it with next to no slip rate."""

from __future__ import annotations

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.measures import measures_of
from stickslip.problem.bodies import as_on_spring

TOUCHES, SLOWLY = 1e-6, 1e-3
"""A gap of this share (1) of the way of the cycle, and a slip rate of this share of the greatest, are next to nothing."""


def touches_stop(orbit: FoundCycle) -> bool:
    """Return True if a cycle turns back next to a hard stop, or meets one with next to no slip rate."""
    history, last = orbit.closed.history, orbit.closed.piece
    if not history.problem.body.has_stops:
        return False
    body, mode, slip = as_on_spring(history.problem.body), history.store.mode[:last], history.store.slip[1 : last + 1]
    turns = np.flatnonzero((mode != 0) & (mode != history.store.mode[1 : last + 1]))
    rates = np.abs(history.rate(Positions.inside(turns, np.ones(len(turns)))))
    gaps = np.where(mode > 0, body.stop_ahead - slip, slip + body.stop_behind)[turns]
    near = (gaps <= TOUCHES * np.ptp(history.store.slip)) & (rates <= SLOWLY * measures_of(orbit).greatest_rate)
    return bool(near.any())
