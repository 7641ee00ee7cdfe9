"""Compare the load with the static strength while a contact rests, and where slip begins: rest and slip must not be mistaken.

While a contact rests its load, forward or backward, is no larger than the static strength S(t) mu_static. Slip begins when it is as
large. The strength is taken from the law and from the normal load of the problem.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stickslip.engine import History, Positions, values_at
from stickslip.foundation.arrays import Floats
from stickslip.friction.contract import one_argument
from stickslip.problem import PERFECT_DELAY
from stickslip.problem.bodies import as_on_spring
from stickslip.solution.observables.given_on_discs import NormalLoads
from stickslip.solution.observables.proof import POINTS_OF_STEP, Places

RECORDED = 1024
"""Largest number of recorded rests whose load is looked at."""
RESTS = 64
"""Look at the load in at most this many rests that were not recorded, but leaped over."""
PLACES_IN_REST = 32
"""Look at it at this many places in such a rest, and at as many again in its last round trip."""


def exceeded_at_rest(history: History) -> float:
    """Return the most (Pa, N or N m) by which a load exceeds the static strength at rest, or falls short of it where slip begins.

    Where a rule other than perfect delay lets slip begin below the strength, the latter is not looked at.
    """
    if not history.problem.friction.sticks:
        return 0.0
    return max(_in_recorded(history, _recorded(history)), _in_leaped(history), _where_slip_begins(history), 0.0)


def _recorded(history: History) -> Places:
    """Return the recorded rests, without leaps over creep, or an even share of them."""
    store = history.store
    n = np.flatnonzero((store.mode == 0) & ~np.isin(store.trip, history.creep[:, 0]))
    n = n[n >= history.given]
    return n[np.unique(np.linspace(0, len(n) - 1, RECORDED).astype(int))] if len(n) > RECORDED else n


class Strengths(NamedTuple):
    """Static strengths at positions (Pa, N or N m) against forward and against backward slip; the second may be the first."""

    forward: Floats
    backward: Floats


def _strengths(history: History, at: Positions, grown: Floats) -> Strengths:
    """Return the static strengths at positions, under a normal load that has grown by a share (1)."""
    law = history.problem.friction
    forward = _strength(history, law.ways[0], at, grown)
    return Strengths(forward, _strength(history, law.ways[1], at, grown) if law.backward_from else forward)


def _strength(history: History, law: Any, at: Positions, grown: Floats) -> Floats:
    own = len(law.states)
    coefficient = law.coefficient(history.law_slip(at), 0.0, one_argument(history.states(at)[:own]))
    return np.asarray(history.problem.normal * (1.0 + grown) * (coefficient + law.static_excess))


def _over(history: History, at: Positions, strength: Strengths) -> float:
    """Return how far loads exceed strengths at most, in the directions that slip may take."""
    problem, excess = history.problem, history.excess(at)
    forward = excess - (strength.forward - problem.strength)
    backward = -excess - (strength.backward + problem.strength)
    if problem.body.has_stops:
        stops, slip = as_on_spring(problem.body), history.slipped(at)
        forward[slip >= stops.stop_ahead], backward[slip <= -stops.stop_behind] = 0.0, 0.0
    return float(np.max(forward if problem.one_way else np.maximum(forward, backward), initial=0.0))


def _in_recorded(history: History, n: Places) -> float:
    """Return how far the load exceeds the strength at most in recorded rests."""
    if not len(n):
        return 0.0
    at = Positions.inside(np.repeat(n, len(POINTS_OF_STEP)), np.tile(POINTS_OF_STEP, len(n)))
    varies = history.problem.normal_load is not None
    grown = NormalLoads.of(history, n).at(POINTS_OF_STEP)[0].centre.ravel() if varies else np.zeros(len(at.piece))
    return _over(history, at, _strengths(history, at, grown))


def _in_leaped(history: History) -> float:
    """Return the same in rests that were leaped over, at places in all of them and in the last round trip of each."""
    n = np.flatnonzero(history.rests & ~np.isin(history.store.trip, history.creep[:, 0]))
    if not len(n):
        return 0.0
    n = n[np.unique(np.linspace(0, len(n) - 1, RESTS).astype(int))]
    begins, ends = history.end[n], np.append(history.start[1:], history.span[1])[n]
    shares = (np.arange(PLACES_IN_REST) + 0.5) / PLACES_IN_REST
    late = np.maximum(begins, ends - history.round_trip_time)
    times = np.concatenate([low[:, None] + (ends - low)[:, None] * shares for low in (begins, late)], axis=1).ravel()
    at = history.find(np.clip(times, *history.span), "right")
    normal = history.problem.normal_load
    since = times + history.epoch.trip * history.round_trip_time + history.epoch.offset
    grown = np.zeros(len(times)) if normal is None else normal.at(since) / history.problem.normal - 1.0
    stands = Positions.inside(at.last, 1.0)
    resting = history.mode(at) == 0
    held = Strengths(*(one[resting] for one in _strengths(history, stands, grown)))
    return _over(history, history.find(np.clip(times, *history.span)[resting], "right"), held)


def _where_slip_begins(history: History) -> float:
    """Return how far a load falls short of the strength at most where slip begins from rest, whatever the rest was."""
    store, problem = history.store, history.problem
    if problem.rule != PERFECT_DELAY:
        return 0.0
    rests = (store.mode[:-1] == 0) | history.rests[:-1]
    leaps = np.isin(store.trip, history.creep[:, 0])
    n = np.flatnonzero(rests & (store.mode[1:] != 0) & ~(leaps[:-1] | leaps[1:])) + 1
    n = n[n > history.given]
    if not len(n):
        return 0.0
    varies = problem.normal_load is not None
    grown = NormalLoads.of(history, n).at(np.zeros(1))[0].centre[:, 0] if varies else np.zeros(len(n))
    held = _strengths(history, Positions.inside(n - 1, 1.0), grown)
    strength = np.where(store.mode[n] < 0, held.backward, held.forward)
    load = problem.strength + values_at(store.load, n, np.zeros(len(n)))
    return float(np.max(strength - store.mode[n] * load, initial=0.0))
