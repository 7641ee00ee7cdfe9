"""How disturbances of a slab grow under a law of slip rate: each echo multiplies them, at each phase of the round trip by itself.

A disturbance of the load returns multiplied by r (1 - 2 Z / g'(v)) from a contact that slips, and by r from one that rests. r is
the reflection coefficient of the driver. The exponent is the mean of the logarithm of this factor over phases and round trips,
divided by the time of a round trip. See `stickslip.solution.observables.predictability` for the factor.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.exponent import ERROR_BATCHES, MeasuredGrowth, along, law_in, whole_run
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.friction.contract import one_argument
from stickslip.problem import Problem
from stickslip.run import TextProgress, uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution.observables.predictability import predictability

GAUSS_PLACES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(12)
MOST_INTERVALS = 4096
"""The largest number of intervals (1) into which a run is divided."""
TRIP_ENDS_ALL = (
    "nothing comes back from the driver, or from the contact: a round trip ends all disturbances (exponent minus infinity)"
)


def tell_growth(problem: Problem, rtol: float) -> bool:
    """Return True if the echoes of a slab or string tell how disturbances grow."""
    if problem.normal_load is not None:
        return False
    return bool(uninterrupted(simulate(problem, problem.round_trip_time, rtol)).horizon_note)  # which says what is known


def growth_of_echoes(problem: Problem, skip: float, duration: float, rtol: float, tell: TextProgress) -> MeasuredGrowth:
    """Return how disturbances grow along a run of a slab or string from `skip` to `duration` (s). Raises InputError."""
    trip = problem.body.round_trip_time
    if not duration - skip > 2.0 * trip:
        raise InputError(f"lyapunov: duration must be longer than skip by two round trips of {brief(trip, 's')} or more")
    run = whole_run(problem, duration, rtol, "a shorter duration, or several such runs from other initial loads, and their mean")
    tell(f"run of {brief(duration, 's')}")
    history, back = run.history, abs(problem.body.reflection)
    edges = np.linspace(skip, duration, 1 + min(MOST_INTERVALS, int((duration - skip) / trip)))
    each = growth_on_pieces(history)
    middle = middle_of_pieces(history)
    grown, _ = np.histogram(middle, edges, weights=each)
    at_driver = math.log(back) if back > 0.0 else -math.inf
    if not np.isfinite(grown).all() or not back > 0.0:
        return MeasuredGrowth(np.zeros(1), np.zeros(1), -math.inf, 0.0, duration - skip, TRIP_ENDS_ALL)
    growth = np.append(0.0, np.cumsum(grown + at_driver * np.diff(edges) / trip))
    start = run.events["start"].to_numpy(float)
    each_trip = brief(math.exp(float(growth[-1]) * trip / (duration - skip)), "", 4)
    trips = brief((duration - skip) / trip, "", 6)
    how = f"the mean over phases and {trips} round trips (rtol {rtol:g}); each multiplies a disturbance by {each_trip}"
    if not (history.store.mode[middle > skip] != 0).any():
        how += f"; nothing slips from {brief(skip, 's')} on, and a contact at rest sends disturbances back as they are"
    sizes = ranges_of_rate(history, skip, duration)
    return along(edges, growth, sizes, how, events=int((start >= skip).sum()), known=predictability(run).error)


def middle_of_pieces(history: History) -> Floats:
    """Return the times (s) halfway between the ends of each piece."""
    return np.asarray(history.start + 0.5 * (history.store.speed + history.store.bend))


def ranges_of_rate(history: History, begin: float, end: float) -> Floats:
    """Return how far the slip rate goes (m/s) in each of ERROR_BATCHES equal parts of a run, without those where it is steady."""
    count = len(history)
    rates = history.rate(Positions.inside(np.repeat(np.arange(count), 3), np.tile([0.0, 0.5, 1.0], count))).reshape(count, 3)
    part = np.floor((middle_of_pieces(history) - begin) / (end - begin) * ERROR_BATCHES).astype(np.int64)
    found = np.array([np.ptp(rates[part == n]) if (part == n).any() else 0.0 for n in range(ERROR_BATCHES)])
    return found[found > 0.0]


def growth_on_pieces(history: History) -> Floats:
    """Return the integral of ln|1 - 2 Z / g'| over each piece of slip, divided by the time of a round trip; 0 where it rests."""
    store, problem, body = history.store, history.problem, history.problem.body
    slips = np.flatnonzero(store.mode != 0)
    found = np.zeros(len(history))
    if not len(slips):
        return found
    if np.isnan(store.gain[slips]).any():
        raise InputError("lyapunov: the run leaps over creep, where the growth of disturbances is not followed")
    at = Positions.inside(np.repeat(slips, len(GAUSS_PLACES)), np.tile(0.5 * (GAUSS_PLACES + 1.0), len(slips)))
    rates, slopes = np.abs(history.rate(at)), np.empty(len(at.piece))
    for direction in (1, -1):
        here = store.mode[at.piece] == direction
        law = law_in(problem, direction)
        if here.any():
            slopes[here] = law.slopes(0.0, rates[here], one_argument(()))[1]
    with np.errstate(divide="ignore"):
        logs = np.log(np.abs(1.0 - 2.0 * body.impedance / (body.total_damping + problem.normal * slopes)))
    lasts = (store.speed[at.piece] + 2.0 * store.bend[at.piece] * at.xi) * np.tile(0.5 * GAUSS_WEIGHTS, len(slips))
    found[slips] = (logs * lasts).reshape(len(slips), -1).sum(axis=1) / body.round_trip_time
    return found
