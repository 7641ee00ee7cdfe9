"""Planner of leaps over creep: how far a leap may go, and the slip along it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.engine.creep.averaged import AveragedCreep, Creep
from stickslip.engine.state.layout import Floats

SAFETY_OF_SECOND_ORDER = 4.0
"""Bound of the error as a multiple of the terms of second order. The terms themselves are included in the slip; where all is
smooth, the true error is a hundredth of them.
"""
SETTLED_RATE = 3.0
"""Largest slip rate at the start, as a multiple of the mean rate. Up to 2 the contact does not rest; where it has slipped faster,
it rests until the mean has caught up.
"""
FIRST_STRIDE, LONGER = 4.0, 1.5
"""First stride, and the factor by which strides grow. A stride of 1 is the lift that a contact at rest gains in one round trip."""
SHORTEST_STRIDE = 0.5
"""Shortest stride, in the same unit: averaged creep resolves nothing within a round trip."""
LEAST_ADVANCE = 0.25
"""A leap ends where a stride passes over less of a round trip: creep is about to turn dynamic, and such strides lead nowhere."""
SMOOTH = 0.05
"""Largest relative difference between the round trips of a stride and Simpson's rule for them: a larger one means that the creep
is not smooth there.
"""
INTERPOLATION = 0.1
"""Share of the tolerance that the interpolation between two states may use."""


@dataclass(frozen=True)
class CreepPlan:
    """States of a creep from the round trip of the pattern on, and the error of slip at the last of them (m).

    The last state lies a whole number of round trips after the pattern's.
    """

    states: list[Creep]
    error: float

    @property
    def trips(self) -> int:
        """The number of round trips from the pattern's to that of the landing."""
        return round(self.states[-1].trips)


@dataclass
class Planner:
    """Stride along a creep while the error stays below `tolerance` times the slip since the start of the run.

    One planner makes one plan, state by state. Afterwards `at_end` is true if a longer leap was refused only because of `most`.
    """

    averaged: AveragedCreep
    slipped: float  # slip before the leap, since the start of the run, m
    tolerance: float
    fastest: float  # slip rate at the start, m/s
    before: Floats  # see AveragedCreep.swing
    most: int  # largest number of round trips
    at_end: bool = False
    largest: float = 0.0  # largest error of a state so far, m
    swing: float = 0.0  # largest range so far of the oscillation of slip from one round trip to the next, m

    def plan(self) -> CreepPlan | None:
        """Return a plan for a leap, or None if no leap is possible."""
        # the start's own error is not used: for one round trip, slip rates near 0 look like borders of slip
        start = self.averaged.start()
        near = start, self.averaged.at(start.lift + self.averaged.gain)
        if min(state.room for state in near) <= 0.0 or self.fastest > SETTLED_RATE * start.mean_rate:
            return None
        self.swing = max(self.averaged.swing(start.lift, state, self.before) for state in near)
        if self.swing > self._allowed(start):
            return None
        states, stride, growth = [start], FIRST_STRIDE * self.averaged.gain, LONGER
        while stride >= SHORTEST_STRIDE * self.averaged.gain:
            state = self._stride(states[-1], stride)
            if state is None:
                stride, growth = 0.5 * stride, 1.0
                continue
            advance = state.trips - states[-1].trips
            states.append(state)
            if advance < LEAST_ADVANCE:
                break
            stride, growth = stride * growth, min(growth + 0.1, LONGER)
        whole = math.floor(states[-1].trips)
        while len(states) > 1 and states[-1].trips > whole:
            last = states.pop()
        if states[-1].trips < whole:
            states.append(self.averaged.reaching(whole, states[-1].lift, last.lift))
        if len(states) == 1:
            return None
        return CreepPlan(states, self.error(states[-1], 0.0))

    def error(self, state: Creep, swing: float) -> float:
        """Return a bound of the error of slip so far (m), given the amplitude of slip from one round trip to the next."""
        return SAFETY_OF_SECOND_ORDER * max(self.largest, state.error) + max(self.swing, swing)

    def _allowed(self, state: Creep) -> float:
        return self.tolerance * (self.slipped + state.slip)

    def _fits(self, state: Creep, swing: float) -> bool:
        if (
            state.room <= 0.0
            or state.rate <= 0.0
            or state.slip >= self.averaged.strength.room
            or self.error(state, swing) > self._allowed(state)
        ):
            return False
        self.at_end |= state.trips > self.most
        return state.trips <= self.most

    def _stride(self, begin: Creep, stride: float) -> Creep | None:
        """Return the state one stride later, or None if it cannot be trusted or the slip up to it cannot be interpolated."""
        middle, end = self.averaged.at(begin.lift + 0.5 * stride), self.averaged.at(begin.lift + stride)
        strength = self.averaged.strength
        if not strength.in_sight(begin.slip, end.slip) or strength.falls_below_zero(begin.slip, end.slip):
            return None
        swing = swing_of(begin, middle, end)
        if not (self._fits(middle, swing) and self._fits(end, swing)):
            return None
        if stride <= self.averaged.gain:
            return self._noted(end, swing) if end.trips > begin.trips else None
        expected = stride * (begin.room + 4.0 * middle.room + end.room) / 6.0 / self.averaged.gain
        if abs(end.trips - begin.trips - expected) > SMOOTH * expected:
            return None
        error = abs(between(begin, end, middle.trips) - middle.slip)
        return self._noted(end, swing) if error <= INTERPOLATION * self._allowed(end) else None

    def _noted(self, state: Creep, swing: float) -> Creep:
        self.largest, self.swing = max(self.largest, state.error), max(self.swing, swing)
        return state


def swing_of(begin: Creep, middle: Creep, end: Creep) -> float:
    """Return the range (m, twice the amplitude) by which slip oscillates after new parts of the round trip have begun to slip.

    New parts begin to slip at any rate between 0 and twice the mean, and those that begin within one round trip oscillate
    together. If the length that slips grows smoothly, that is its growth in a round trip; growth that this does not explain may
    come all at once.
    """
    trips, growth = end.trips - begin.trips, max(end.length - begin.length, 0.0)
    widening = begin.widening, middle.widening, end.widening
    if trips > 1.0 and max(widening) < np.inf:
        smooth = trips * (widening[0] + 4.0 * widening[1] + widening[2]) / 6.0
        growth = min(growth, max(widening) + abs(growth - smooth))
    return 2.0 * end.mean_rate * growth / end.seen


def hermite(length: float, rise: float, first: float, last: float) -> Floats:
    """Return the coefficients in xi on [0, 1] of a cubic.

    The cubic starts at 0 and rises by `rise` over `length`, with slopes `first` and `last` at its ends.
    """
    a, b = first * length, last * length
    return np.array([0.0, a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise])


def between(begin: Creep, end: Creep, trips: float) -> float:
    """Return the slip (m) after the given number of round trips, interpolated between two states."""
    length = end.trips - begin.trips
    xi = (trips - begin.trips) / length
    return begin.slip + float(hermite(length, end.slip - begin.slip, begin.rate, end.rate) @ xi ** np.arange(4))
