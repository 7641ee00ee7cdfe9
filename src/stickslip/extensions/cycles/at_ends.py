"""Cycles at the end of a branch: whether one grazes a hard stop, grazes its arrest, or rests for ever."""

from __future__ import annotations

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.lag import force_of_slip, is_wound, lags_at
from stickslip.extensions.cycles.measures import measures_of
from stickslip.problem.bodies import as_on_spring

TOUCHES, SLOWLY = 1e-6, 1e-3
"""A gap of this share (1) of the way of the cycle, and a slip rate of this share of the greatest, are next to nothing."""
SLACK, INSTANT, STANDS = 1e-3, 1e-6, 1e-4
"""An arrest is grazed if the force (1, share of the fall of friction) that stops the body is next to nothing, or its rest an
instant (1, share of the period). A rest stands at the set point if its lag is next to nothing (1, share of the way)."""


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


def grazes_arrest(orbit: FoundCycle) -> bool:
    """Return True if the body comes to rest with next to no deceleration, or for an instant."""
    history, last = orbit.closed.history, orbit.closed.piece
    mode = history.store.mode[: last + 2]
    begun = np.flatnonzero((mode[1:] == 0) & (mode[:-1] != 0))
    ended = np.flatnonzero((mode[1:] != 0) & (mode[:-1] == 0))
    if not len(begun):
        return False
    problem, speed = history.problem, history.store.speed[begun]
    slopes = history.store.rate[begun] @ np.arange(history.store.rate.shape[1]) / speed
    slack = np.abs(slopes) * problem.body.inertia <= SLACK * force_of_slip(problem)
    count = min(len(begun), len(ended))
    lasted = history.start[ended[-count:] + 1] - history.start[begun[-count:] + 1] if count else np.zeros(0)
    return bool(slack.any() or (lasted <= INSTANT * orbit.period).any())


def rests_for_ever(orbit: FoundCycle) -> bool:
    """Return True if a position loop rests at its set point, so that its integral hardly changes."""
    history = orbit.closed.history
    if not is_wound(history.problem) or history.problem.first_pull_rate != 0.0:
        return False
    return abs(least_lag(orbit)) <= STANDS * float(np.ptp(history.store.slip))


def least_lag(orbit: FoundCycle) -> float:
    """Return the lag (m) nearest to 0 of a rest of a position loop; inf without a rest."""
    history, last = orbit.closed.history, orbit.closed.piece
    rests = np.flatnonzero(history.store.mode[: last + 1] == 0)
    lags = lags_at(history, Positions.inside(rests, np.zeros(len(rests))))
    return float(lags[np.abs(lags).argmin()]) if len(lags) else np.inf
