"""Cycles that graze: an arrest with next to no deceleration, an onset with next to no loading, or a rest that hardly holds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History
from stickslip.extensions.cycles.exponent import law_in
from stickslip.extensions.cycles.found import FoundCycle, kind_of
from stickslip.extensions.cycles.lag import force_of_slip
from stickslip.extensions.cycles.measures import measures_of
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.foundation.arrays import Floats

NEAR_GRAZING, AT_GRAZING, GRAZES = 0.1, 1e-6, 1e-3
"""A grazing is looked for where its margin (1) is below the first, as near as the second, and found if it comes below the third."""
NEARER, MOST_NEARER = 0.05, 40
"""Each step leads to this share (1) of the margin; the largest number of steps."""
HOLDS, SOFT_ARREST = 1e-6, 1e-2
"""A rest hardly holds, or slip hardly goes on, where no more than this share (1) of strength, or of the greatest rate, is left.
An arrest has next to no deceleration if that times the mass is below the second share of the fall of friction."""

OF_DISTANCE = 2
"""So many margins, the last ones, are in proportion to the distance from the edge (1)."""


class Grazing(NamedTuple):
    """Where a branch grazes: the value (SI), the cycle next to it, and whether all its arrests do."""

    value: float
    orbit: FoundCycle
    no_rest_left: bool


def rising(series: Floats) -> Floats:
    """Return the derivatives (1) of polynomials, each in a row, at their end."""
    return np.asarray(series @ np.arange(series.shape[1]))


def strength(history: History, loads: Floats) -> Floats:
    """Return the static strength (N) in the direction of each load."""
    problem = history.problem
    ways = [float(problem.normal * law_in(problem, way).static_coefficient(0.0)) for way in (1, -1)]
    return np.where(loads >= 0.0, *ways)


def begun_and_ended(orbit: FoundCycle) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the pieces of a cycle after which rest begins, and those with which it ends."""
    mode = orbit.closed.history.store.mode[: orbit.closed.piece + 1]
    after = np.append(mode[1:], 1)
    return np.flatnonzero((mode != 0) & (after == 0)), np.flatnonzero((mode == 0) & (after != 0))


def margins_of(orbit: FoundCycle) -> Floats:
    """Return the decelerations at arrests, then the rates of loading at onsets, as shares (1) of the fall of friction and strength.

    They go to 0 as roots of the distance to the value where the branch grazes. The last two are in proportion to it: what is
    left of the strength where the load turns in a rest, or as slip ends, and the slip rate where that turns, over the greatest.
    """
    history, last = orbit.closed.history, orbit.closed.piece
    problem, store, mode = history.problem, history.store, history.store.mode[: orbit.closed.piece + 1]
    begun, ended = begun_and_ended(orbit)
    paces = store.speed + 2.0 * store.bend
    slack = np.abs(rising(store.rate[begun]) / paces[begun]) * problem.body.inertia / force_of_slip(problem)
    loads = store.load[ended].sum(axis=1) + problem.strength
    loading = np.abs(rising(store.load[ended]) / paces[ended]) * orbit.period / strength(history, loads)
    turns = np.append(begun, np.flatnonzero(mode[:-1] * mode[1:] == -1))
    held = np.array([*_turning(store.load[: last + 1][mode == 0]), *store.load[turns].sum(axis=1)]) + problem.strength
    slow = np.abs(_turning(store.rate[: last + 1][mode != 0])) / measures_of(orbit).greatest_rate
    left = np.min(np.abs(np.abs(held) / strength(history, held) - 1.0), initial=np.inf)
    return np.array([*slack, *loading, left, np.min(slow, initial=np.inf)])


def followed_to_grazing(path: Path, last: PlaceOnBranch) -> Grazing | None:
    """Return where a branch grazes an arrest or an onset next to its last place; None if it does not.

    There the branch turns across the parameter, so that it is followed along itself: a margin goes straight to 0, and the distance
    of the parameter from the edge with its square; where rest hardly holds, as the margin.
    """
    if not len(last.orbit.place):
        return None
    here, margins = last, margins_of(last.orbit)
    n = int(margins.argmin())
    if not margins[n] <= NEAR_GRAZING:
        return None
    step, before = path.longest_step(last, 1e-3 * float(margins[n])), (np.inf, last.value)
    for _ in range(MOST_NEARER):
        left = float(margins_of(here.orbit)[n])
        if left <= AT_GRAZING:
            break
        new = _of_same_kind(path, here, step)
        after = left if new is None else float(margins_of(new.orbit)[n])
        if new is None or after >= left:
            step *= 0.25
            continue
        before, here = (left, here.value), new
        step *= (1.0 - NEARER) * after / (left - after)
    left = float(margins_of(here.orbit)[n])
    if left > GRAZES or not np.isfinite(before[0]):
        return None
    power = 1 if n >= len(margins) - OF_DISTANCE else 2
    gone = here.value + (here.value - before[1]) * left**power / (before[0] ** power - left**power)
    return Grazing(gone, here.orbit, no_rest_left(here.orbit))


def no_rest_left(orbit: FoundCycle) -> bool:
    """Return True if each arrest of a cycle is grazed: with next to no deceleration, or under a load next to the strength."""
    history = orbit.closed.history
    begun, _ = begun_and_ended(orbit)
    loads = history.store.load[begun].sum(axis=1) + history.problem.strength
    held = np.abs(np.abs(loads) / strength(history, loads) - 1.0) <= HOLDS
    return bool((held | (margins_of(orbit)[: len(begun)] <= SOFT_ARREST)).all())


def _of_same_kind(path: Path, here: PlaceOnBranch, step: float) -> PlaceOnBranch | None:
    """Return the cycle a step further along the branch if it is of the same kind."""
    try:
        new = path.step(here, step)
    except NoCycleError:
        return None
    return new if kind_of(new.orbit) == kind_of(here.orbit) else None


def hardly_holds(orbit: FoundCycle) -> bool:
    """Return True if the load reaches the strength within a rest or as slip turns back, or if slip nearly stops on its way."""
    return bool(margins_of(orbit)[-OF_DISTANCE:].min() <= HOLDS)


def _turning(series: Floats) -> list[float]:
    """Return the values of polynomials, each in a row, where they turn between 0 and 1."""
    found = []
    for one in series:
        places = np.polynomial.polynomial.polyroots(np.polynomial.polynomial.polyder(np.trim_zeros(one, "b")))
        inside = places.real[(np.abs(places.imag) == 0.0) & (places.real > 0.0) & (places.real < 1.0)]
        found += np.polynomial.polynomial.polyval(inside, one).tolist()
    return found
