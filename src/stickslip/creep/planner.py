"""How far a leap over creep may go, and the slip on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.creep.averaged import AveragedCreep, Creep
from stickslip.engine.state.layout import Floats

SAFETY = 4.0
"""Bound of the error in sizes of the terms of second order (which are counted in: where all is smooth the error is a hundredth of
them)."""
SETTLED = 3.0
"""Largest slip rate at the start, in mean rates. Up to 2 there is no rest; what has slipped faster rests until the mean has
caught up."""
FIRST_STRIDE, LONGER = 4.0, 1.5
SHORTEST_STRIDE = 0.5
"""Strides in round trips at the rate of rest: nothing is resolved within a round trip."""
SMOOTH = 0.05
INTERPOLATION = 0.1
"""Share of the tolerance that the interpolation between two states may use."""


@dataclass(frozen=True)
class Plan:
    """States from the round trip of the pattern on, the last one a whole number of round trips later; error of slip there (m)."""

    states: list[Creep]
    error: float

    @property
    def trips(self) -> int:
        """Round trips from the pattern's to that of the landing."""
        return round(self.states[-1].trips)


@dataclass
class Planner:
    """Strides along a creep, state by state, as long as the error stays below `tolerance` times the slip since the start.

    One planner makes one plan. `at_end` says afterwards that a longer leap was only refused because of `most`.
    """

    averaged: AveragedCreep
    slipped: float  # before, since the start of the run, m
    tolerance: float
    fastest: float  # slip rate at the start, m/s
    before: Floats  # see AveragedCreep.swing
    most: int  # round trips that there may be
    at_end: bool = False
    largest: float = 0.0  # of the terms of second order so far, m
    swing: float = 0.0  # range of slip that goes up and down from one round trip to the next so far, m

    def plan(self) -> Plan | None:
        """A leap, None if there is none."""
        start = self.averaged.start()  # its own error says little: rates next to 0 look like borders of slip for a round trip
        near = start, self.averaged.at(start.lift + self.averaged.gain)
        if min(state.room for state in near) <= 0.0 or self.fastest > SETTLED * start.mean_rate:
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
            states.append(state)
            stride, growth = stride * growth, min(growth + 0.1, LONGER)
        whole = math.floor(states[-1].trips)
        while len(states) > 1 and states[-1].trips > whole:
            last = states.pop()
        if states[-1].trips < whole:
            states.append(self.averaged.reaching(whole, states[-1].lift, last.lift))
        if len(states) == 1:
            return None
        return Plan(states, self.error(states[-1], 0.0))

    def error(self, state: Creep, swing: float) -> float:
        """Bound of the error of slip so far (m), the amplitude of slip from one round trip to the next given."""
        return SAFETY * max(self.largest, state.error) + max(self.swing, swing)

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
        """The state one stride on, if it can be trusted and the way there interpolated."""
        middle, end = self.averaged.at(begin.lift + 0.5 * stride), self.averaged.at(begin.lift + stride)
        if not self.averaged.strength.in_sight(begin.slip, (middle.slip, end.slip)):
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
    """Range of slip (m), twice its amplitude, that new slip leaves behind, which begins anywhere between 0 and twice the mean rate.

    What begins to slip within one round trip does so together. If the length that slips grows smoothly that is its growth in a
    round trip; growth that this does not explain may come all at once.
    """
    trips, growth = end.trips - begin.trips, max(end.length - begin.length, 0.0)
    widening = begin.widening, middle.widening, end.widening
    if trips > 1.0 and max(widening) < np.inf:
        smooth = trips * (widening[0] + 4.0 * widening[1] + widening[2]) / 6.0
        growth = min(growth, max(widening) + abs(growth - smooth))
    return 2.0 * end.mean_rate * growth / end.seen


def hermite(length: float, rise: float, first: float, last: float) -> Floats:
    """Coefficients in xi on [0, 1] of the cubic that starts at 0, rises by `rise` over `length`, with slopes first and last."""
    a, b = first * length, last * length
    return np.array([0.0, a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise])


def between(begin: Creep, end: Creep, trips: float) -> float:
    """Slip (m) after so many round trips, interpolated between two states."""
    length = end.trips - begin.trips
    xi = (trips - begin.trips) / length
    return begin.slip + float(hermite(length, end.slip - begin.slip, begin.rate, end.rate) @ xi ** np.arange(4))
