"""Edges of a branch of cycles: folds, doubling, a torus, loss of stick, and the end in steady sliding, each located to rounding."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from stickslip.contact import steady_slidings
from stickslip.extensions.cycles.at_ends import grazes_arrest, least_lag, rests_for_ever, touches_stop
from stickslip.extensions.cycles.found import FoundCycle, kind_of
from stickslip.extensions.cycles.grazing import followed_to_grazing, hardly_holds, no_rest_left
from stickslip.extensions.cycles.lag import is_wound, usual_rate
from stickslip.extensions.cycles.measures import least_rate
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

FOLD, DOUBLING, TORUS = "fold of cycles", "period doubling", "Neimark-Sacker"
HALVING, END_OF_HUNTING = "end of doubling", "end of hunting"
LOSS_OF_STICK, FIRST_STICK, STEADY_END, GRAZING = "loss of stick", "first stick", "steady sliding", "grazing"
CORNER = "corner"
NOT_FOUND = "not followed further"
MEANING = {
    FOLD: "a multiplier is +1: a stable and an unstable cycle meet and vanish",
    DOUBLING: "a multiplier is -1: a cycle of twice the period branches off",
    TORUS: "a pair of multipliers is on the unit circle: a motion with two frequencies branches off, which is not followed",
    HALVING: "both halves of the period become alike: the cycle vanishes in one of half its period",
    LOSS_OF_STICK: "the arrest is grazed: the contact no longer comes to rest",
    FIRST_STICK: "the slip rate touches 0: the contact begins to rest",
    STEADY_END: "the amplitude is 0: the cycle vanishes in steady sliding, which changes its stability there (Hopf)",
    END_OF_HUNTING: "rests last for ever, as the amplitude is 0 or a rest is at the set point: hunting dies out beyond it",
    GRAZING: "rest, slip or a hard stop is touched elsewhere in the period: beyond it another slip, rest or impact begins there",
    CORNER: "an event meets another, or an echo of one: beyond it the branch goes on in another direction",
    NOT_FOUND: "the search finds none beyond: a run and `cycle` there say more",
}
"""The edges by name, and what happens there."""
CLOSE_TO_REST, NEARER, MOST_NEARER = 1e-7, 0.05, 30
"""A branch is followed to this share (1) of the pull rate as least slip rate, each time this much nearer, at most so often."""
SMALLEST_BISECTED = 1e-12
"""Width (1, share of the range) to which a value is bisected beyond which there is no cycle."""
SMALL = 0.05
"""A branch whose amplitude is above this share (1) of the pull rate does not end in steady sliding."""
WIDER, MOST_WIDER = 4.0, 12
"""By what factor, and how often, the surroundings of an end in steady sliding are widened (1)."""

JUMPS = 1e-2
"""Where the sign of a test changes with more than this share (1) of its size at the ends of the step, it is no edge."""


class CycleEdge(NamedTuple):
    """An edge of a branch of cycles: its name, the value (SI) of the parameter there, and the cycle next to it."""

    name: str
    value: float
    orbit: FoundCycle


def _fold(place: PlaceOnBranch) -> float:
    return float(place.way[-1])


def _doubling(place: PlaceOnBranch) -> float:
    return float(np.prod(1.0 + place.orbit.multipliers).real)


def _torus(place: PlaceOnBranch) -> float:
    """Return by how much the pair that is largest is beyond the unit circle; NaN if there is no pair."""
    pairs = [abs(one) for one in place.orbit.multipliers if one.imag != 0.0]
    return max(pairs) - 1.0 if pairs else float("nan")


TESTS: dict[str, Callable[[PlaceOnBranch], float]] = {FOLD: _fold, DOUBLING: _doubling, TORUS: _torus}
"""Functions of a cycle whose sign changes at an edge."""


def edges_between(path: Path, begin: PlaceOnBranch, end: PlaceOnBranch, length: float) -> list[CycleEdge]:
    """Return the edges within a step along a branch, in their order."""
    found = []
    for name, test in TESTS.items():
        if not len(begin.orbit.place) or not test(begin) * test(end) < 0.0:
            continue
        seen = {0.0: begin, length: end}

        def value(at: float, test: Callable[[PlaceOnBranch], float] = test, seen: dict[float, PlaceOnBranch] = seen) -> float:
            if at not in seen:
                seen[at] = path.step(begin, at)
            return test(seen[at])

        try:
            where = float(brentq(value, 0.0, length, xtol=path.same_step * length, rtol=1e-12))
        except NoCycleError:
            continue
        at = seen.get(where) or path.step(begin, where)
        if abs(test(at)) > JUMPS * max(abs(test(begin)), abs(test(end))):  # its sign jumps, and nothing is 0
            continue
        found.append((where, CycleEdge(name, at.value, at.orbit)))
    return [edge for _, edge in sorted(found, key=lambda one: one[0])]


def first_stick(path: Path, last: PlaceOnBranch) -> tuple[CycleEdge, PlaceOnBranch] | None:
    """Return where a branch without rest begins to rest, beyond its last place, and a place next to it; None if it does not.

    The least slip rate is followed towards 0, and the edge is where it gets there: the branch turns no corner before it.
    """
    here, step = last, path.longest_step(last, 1e-3)
    rate = least_rate(here.orbit)
    whole = usual_rate(last.orbit.section.problem)
    before: tuple[float, float] | None = None
    for _ in range(MOST_NEARER):
        try:
            new = path.step(here, step)
        except NoCycleError:
            step *= 0.25
            continue
        after = least_rate(new.orbit)
        if new.orbit.sticks or after <= 0.0 or after >= rate:
            if after >= rate and not new.orbit.sticks:
                return None
            step *= 0.25
            continue
        before, slope = (rate, here.value), (after - rate) / step
        here, rate = new, after
        if rate <= CLOSE_TO_REST * whole:
            gone = here.value + (here.value - before[1]) * rate / (before[0] - rate)
            return CycleEdge(FIRST_STICK, gone, here.orbit), here
        step = (1.0 - NEARER) * rate / -slope
    return None


def loss_of_stick(path: Path, last: PlaceOnBranch, beyond: float) -> tuple[CycleEdge, PlaceOnBranch]:
    """Return where cycles of one kind end, with rest or stops, between a last one and a value (SI) without one, by bisection."""
    before, good, bad, kind, other = last, last, beyond, kind_of(last.orbit), None
    while abs(bad - good.value) > max(SMALLEST_BISECTED * path.range, 4.0 * np.spacing(abs(bad))):
        middle = 0.5 * (good.value + bad)
        try:
            found = path.at_value(middle, good.orbit.place, good.orbit.period, good.way)
        except NoCycleError:
            bad, other = middle, None
            continue
        if kind_of(found.orbit) != kind:
            bad, other = middle, found.orbit
            continue
        before, good = good, found
    value = 0.5 * (good.value + bad)
    if touches_stop(good.orbit):
        return CycleEdge(GRAZING, value, good.orbit), good
    if rests_for_ever(good.orbit):
        if before is not good:  # runs end before it, where a rest lasts too long: on a line to a lag of 0
            now, then = least_lag(good.orbit), least_lag(before.orbit)
            value = good.value + (good.value - before.value) * now / (then - now)
        return CycleEdge(END_OF_HUNTING, value, good.orbit), good
    grazed = followed_to_grazing(path, good)
    if grazed is not None:
        return CycleEdge(LOSS_OF_STICK if grazed.no_rest_left else GRAZING, grazed.value, grazed.orbit), good
    return CycleEdge(_name_of_end(good.orbit, rests_beyond=other is not None and other.sticks), value, good.orbit), good


def _name_of_end(orbit: FoundCycle, *, rests_beyond: bool) -> str:
    """Return what happens next to the end of a branch of cycles of one kind."""
    if hardly_holds(orbit):
        return LOSS_OF_STICK if no_rest_left(orbit) else GRAZING
    if rests_beyond and not len(orbit.place):
        return GRAZING
    return LOSS_OF_STICK if not is_wound(orbit.section.problem) or grazes_arrest(orbit) else NOT_FOUND


def end_in_steady_sliding(path: Path, values: Floats, amplitudes: Floats) -> float | None:
    """Return the value (SI) where steady sliding changes its stability next to the last two cycles of a branch; None: nowhere.

    The square of the amplitude goes to 0 in proportion to the distance from it.
    """
    if len(values) < 2 or not amplitudes[-1] < min(amplitudes[-2], SMALL * usual_rate(path.section(float(values[-1])).problem)):
        return None
    squares = amplitudes[-2:] ** 2
    expected = float(values[-1] - squares[1] * (values[-2] - values[-1]) / (squares[0] - squares[1]))
    width = max(4.0 * abs(values[-1] - expected), 1e-9 * abs(expected))

    def growth(value: float) -> float:
        return steady_slidings(path.section(value).problem).slidings[-1].growth

    for _ in range(MOST_WIDER):
        ends = expected - width, expected + width
        try:
            if growth(ends[0]) * growth(ends[1]) < 0.0:
                return float(brentq(growth, *ends, xtol=1e-14 * abs(expected), rtol=1e-14))
        except (InputError, IndexError):
            return None
        width *= WIDER
    return None
