"""Leaps over cycles of a block that touches rest in each: under a law of the slip rate alone they are all the same.

Wherever slip begins from rest, the slip rate is zero and the load is at the strength, which does not depend on slip. All that
follows is the same again: under a constant pull rate V each cycle takes the same time P, and its slip is V P. Any number of
cycles is therefore passed over exactly, but for the rounding of P.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple, Self

import numpy as np

from stickslip.engine.creep.landing import SHORTEST_LEAP, WrittenMotion, continue_after, move_over, write_piece
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.slow_landing import ROUNDINGS
from stickslip.engine.series.polynomial import restrict
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.problem import default_event_rate

LOOKED_AT = 400
"""Number of pieces in which cycles are looked for."""
SAME_CYCLE = 1e-6
"""Largest difference between two cycles that count as the same, as a share of their length."""
RECIPROCALS = 1.0 / np.arange(1, TERMS + 1)
"""The integrals of the powers from 0 to 1."""
SHORTEST_PART = 1e-12
"""Shortest part of a piece (as a share of a period) that is written."""


class CyclePart(NamedTuple):
    """A part of a cycle: times since its onset of slip (s), and the motion in between as polynomials on [0, 1]."""

    begin: float
    end: float
    mode: int
    law_piece: int
    load: Floats  # N, minus the reference strength
    rate: Floats  # m/s

    @property
    def slip(self) -> float:
        """The slip in it, m."""
        return (self.end - self.begin) * float(self.rate @ RECIPROCALS)

    def between(self, begin: float, end: float) -> CyclePart:
        """Return what lies between two times (s) in it."""
        low, width = (begin - self.begin) / (self.end - self.begin), (end - begin) / (self.end - self.begin)
        load, rate = np.empty(TERMS), np.empty(TERMS)
        restrict(self.load, low, width, load)
        restrict(self.rate, low, width, rate)
        return self._replace(begin=begin, end=end, load=load, rate=rate)


@dataclass(frozen=True)
class Cycle:
    """The last whole cycle of a run, from one onset of slip to the next."""

    parts: list[CyclePart]
    length: float  # P, s
    since: float  # s: time from its first onset to the moment at hand
    differs: float  # s: by how much the cycle before it was longer or shorter
    peak: float  # m/s: its largest slip rate

    @classmethod
    def of(cls, run: LeapingRun) -> Self | None:
        """Return the last cycle of a run at the beginning of a round trip; None without one."""
        first = max(run.length - LOOKED_AT, 0)
        rows = slice(first, run.length)
        store, turn = run.store, run.problem.round_trip_time
        begin = (store.trip[rows] - int(run.count.trip)) * turn + store.phase_from[rows]
        end, mode = begin + store.phase_to[rows] - store.phase_from[rows], store.mode[rows]
        onsets = np.flatnonzero((mode[1:] != 0) & (mode[:-1] == 0)) + 1
        if len(onsets) < LEAST_ONSETS or (store.bend[rows][onsets[-3] :] != 0.0).any() or len(set(mode[onsets[-3] :])) > 2:
            return None
        before, a, b = onsets[-3:].tolist()
        parts: list[CyclePart] = []
        for k in range(a, b):
            n, (low, high) = first + k, (float(one[k] - begin[a]) for one in (begin, end))
            parts.append(CyclePart(low, high, int(mode[k]), int(store.law_piece[n]), store.load[n].copy(), store.rate[n].copy()))
            if begin[k + 1] - end[k] > SHORTEST_PART * turn:
                parts.append(_rest(parts[-1], float(begin[k + 1] - begin[a]), float(store.load[n + 1][0])))
        rates = store.rate[first + a : first + b]
        peak = float(np.abs(rates).sum(axis=1).max())
        length, differs = float(begin[b] - begin[a]), float(abs((begin[b] - begin[a]) - (begin[a] - begin[before])))
        return cls(parts, length, -float(begin[a]), differs, peak)

    @cached_property
    def slip(self) -> float:
        """The slip in a cycle (m), with its sign."""
        return sum(part.slip for part in self.parts)

    @cached_property
    def mean_load(self) -> float:
        """The mean load (N), minus the reference strength."""
        shares = [(part.end - part.begin) * float(part.load @ RECIPROCALS) for part in self.parts]
        return sum(shares) / self.length

    def between(self, begin: float, end: float) -> list[CyclePart]:
        """Return the motion between two times (s since its first onset, however many cycles later); times begin at 0."""
        found: list[CyclePart] = []
        first, last = math.floor(begin / self.length), math.floor(end / self.length)
        for cycle in range(first, last + 1):
            start = cycle * self.length
            for part in self.parts:
                low, high = max(part.begin, begin - start), min(part.end, end - start)
                if high - low > SHORTEST_PART * self.length:
                    moved = part.between(low, high)
                    found.append(moved._replace(begin=start + low - begin, end=start + high - begin))
        return found


ROUNDED = 4.0
"""Number of roundings of the load by which an onset of slip may be early or late."""
LEAST_ONSETS = 3
"""Two whole cycles are compared."""


def _rest(last: CyclePart, end: float, load: float) -> CyclePart:
    """Return the rest that was leaped over between the end of a part and an onset (s) at a load (N)."""
    straight = np.zeros(TERMS)
    straight[0] = last.load.sum()
    straight[1] = load - straight[0]
    return CyclePart(last.end, end, 0, last.law_piece, straight, np.zeros(TERMS))


@dataclass(frozen=True)
class CycleLanding:
    """A leap over whole periods of a block that goes through the same cycle all the time, ready to be written."""

    may_rest: ClassVar[bool] = True
    cycle: Cycle
    trips: int
    error: float  # bound of the error of slip, m
    period: float  # s: round trip of the run
    speed: float  # of the driver, m/s
    stiffness: float  # N/m

    @property
    def errors(self) -> tuple[float, float]:
        """The bound of the error of the slip (m), and that as a time (s)."""
        return self.error, self.error / self.speed

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end."""
        begin = self.cycle.since + self.trips * self.period
        parts = self.cycle.between(begin, begin + self.period)
        first, begun = run.length + 1, int(run.count.trip)
        run.reserve(first + len(parts))
        self._write_way(run, begun, self._slip(begin) - self._slip(self.cycle.since))
        for k, part in enumerate(parts):
            end = parts[k + 1].begin if k + 1 < len(parts) else self.period
            self._write(run, first + k, (begun + self.trips, part.begin if k else 0.0, end), part)
        run.count.mode, run.count.piece = parts[-1].mode, parts[-1].law_piece
        continue_after(run, begun + self.trips, first, first + len(parts), np.zeros(0))

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact periods after the landing at a slip (m), and how far it may be off."""
        begin = self.cycle.since + (self.trips + 1) * self.period
        grown = self._slip(begin + trips * self.period) - self._slip(begin)
        largest = trips * self.period * self.cycle.peak
        return slip + grown, max(SAME_CYCLE, tolerance) * largest + ROUNDINGS * math.ulp(slip)

    def _slip(self, time: float) -> float:
        """Return the slip (m) from the first onset up to a time (s) after it, with its sign."""
        cycles = math.floor(time / self.cycle.length)
        within = self.cycle.between(0.0, time - cycles * self.cycle.length)
        return cycles * self.cycle.slip + sum(part.slip for part in within)

    def _write_way(self, run: LeapingRun, trip: int, slip: float) -> None:
        """Write the mean motion as one piece with this slip (m)."""
        length = self.trips * self.period
        load, rate = np.zeros(TERMS), np.zeros(TERMS)
        load[0], rate[0] = self.cycle.mean_load, slip / length
        way = CyclePart(0.0, length, int(math.copysign(1.0, slip)), int(run.count.piece), load, rate)
        self._write(run, run.length, (trip, 0.0, length + float(np.spacing((trip + self.trips) * self.period))), way)

    def _write(self, run: LeapingRun, n: int, when: tuple[int, float, float], part: CyclePart) -> None:
        """Write piece n: its round trip and phases (s), and its motion; move the contact to its end."""
        write_piece(run, n, when, WrittenMotion(part.mode, part.law_piece, part.load, part.rate))
        move_over(run, n)


def leap_over_cycles(run: LeapingRun, most: int, tolerance: float) -> CycleLanding | None:
    """Return a leap over at most so many periods of a block under a law of the slip rate alone; None if it finds no cycles."""
    problem, body, law = run.problem, run.problem.body, run.problem.friction
    if law.states or law.depends_on_slip or law.memory != "all" or most < SHORTEST_LEAP:
        return None
    cycle = Cycle.of(run)
    if cycle is None or cycle.differs > SAME_CYCLE * cycle.length or cycle.peak > default_event_rate(problem):
        return None
    turn, speed = problem.round_trip_time, abs(problem.first_pull_rate)
    most -= math.ceil(2.0 * cycle.length / turn)  # that no rest after the landing reaches the end of the run
    if most < SHORTEST_LEAP:
        return None
    cycles = most * turn / cycle.length
    rounds = ROUNDED * math.ulp(max(float(np.abs(part.load).sum()) for part in cycle.parts)) / (body.stiffness * speed)
    apart = rounds + cycle.differs + float(run.setup.params.tolerance) / PER_STEP * cycle.length
    late = cycles * apart + ROUNDINGS * math.ulp(most * turn)
    error, slip = min(cycle.peak * late, speed * cycle.length), abs(float(run.state.slip_now)) + most * turn * speed
    if abs(cycle.slip) < (1.0 - SAME_CYCLE) * speed * cycle.length or error > tolerance * slip:
        return None
    return CycleLanding(cycle, most, error, turn, speed, body.stiffness)


PER_STEP = 0.1
"""Local tolerance of a step as a share of the tolerance of a run."""
