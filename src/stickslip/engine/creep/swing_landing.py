"""Landing of a leap over swinging creep: the way and the last period as pieces of the history, and the engine at its end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np

from stickslip.engine.creep.landing import WrittenMotion, continue_after, move_over, seen, write_piece
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.planner import hermite
from stickslip.engine.creep.slow import PLACES_OF_OFFSETS, to_powers
from stickslip.engine.creep.slow_landing import ROUNDINGS
from stickslip.engine.creep.swing_leaps import LastPeriods, SwingLeap, nodes_of, stretches
from stickslip.engine.state.layout import TERMS, Floats

CONTINUES = 1e-6
"""Share of the slip of a period by which the period after the landing may differ from what the leap predicts."""


@dataclass(frozen=True)
class SwingLanding:
    """A leap over swinging creep, ready to be written."""

    may_rest: ClassVar[bool] = False
    leap: SwingLeap

    @property
    def trips(self) -> int:
        """The number of periods that are leaped over."""
        return self.leap.trips

    @property
    def errors(self) -> tuple[float, float]:
        """The estimate of the error of the slip (m), and that as a time (s)."""
        landing = self.leap.at((self.trips + 1) * self.leap.period)
        error = self.leap.error(landing)
        return error, error / landing.swing.place.rate

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end."""
        nodes, parts = nodes_of(self.leap), stretches(self.leap)
        first, length = run.length + len(nodes) - 1, run.length + len(nodes) + len(parts) - 2
        run.reserve(length)
        begun = int(run.count.trip)
        for k, (begin, end) in enumerate(pairwise(nodes)):
            self._write_way(run, run.length + k, begun, begin, end, last=k == len(nodes) - 2)
        for k, part in enumerate(pairwise(parts.tolist())):
            self._write_swing(run, first + k, begun + self.trips, part)
        run.count.mode = self.leap.direction
        continue_after(run, begun + self.trips, first, length, np.zeros(0))

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact periods after the landing at a slip (m), and how far it may be off."""
        leap = self.leap
        (landed, end), _ = self._last.at(np.array([1.0, 1.0 + trips]))
        share = max(CONTINUES, tolerance) + leap.block.quickness(leap.marks[-1].swing.place)
        return slip + leap.direction * (end - landed), share * (end - landed) + ROUNDINGS * float(np.spacing(abs(slip) + end))

    @cached_property
    def _last(self) -> LastPeriods:
        return LastPeriods(self.leap)

    def _write_way(
        self, run: LeapingRun, n: int, trip: int, begin: tuple[float, float, float], end: tuple[float, float, float], *, last: bool
    ) -> None:
        """Write the averaged slip from one node (s, m, m/s) to the next as a cubic, and move the contact to its end."""
        (t0, x0, v0), (t1, x1, v1) = begin, end
        grown = hermite(t1 - t0, x1 - x0, v0, v1)
        rate = np.zeros(TERMS)
        rate[:3] = grown[1:] * np.arange(1, 4) / (t1 - t0)
        gap = float(np.spacing((trip + self.trips) * self.leap.period)) if last else 0.0  # none before the next period
        self._write(run, n, (trip, t0, t1 + gap), t0, rate)

    def _write_swing(self, run: LeapingRun, n: int, trip: int, part: tuple[float, float]) -> None:
        """Write a part of the period (as shares of it) on which the leap lands, and move the contact to its end."""
        begin, end = part
        rate, period = np.zeros(TERMS), self.leap.period
        _, rates = self._last.at(begin + (end - begin) * PLACES_OF_OFFSETS)
        rate[: len(PLACES_OF_OFFSETS)] = to_powers(rates)
        self._write(run, n, (trip, begin * period, end * period), (self.trips + begin) * period, rate)

    def _write(self, run: LeapingRun, n: int, when: tuple[int, float, float], since: float, rate: Floats) -> None:
        """Write piece n: its round trip and phases (s), the time since the leap began (s), and the slip rate, seen forwards."""
        block, way = self.leap.block, self.leap.direction
        length = when[2] - when[1]
        load = np.zeros(TERMS)
        load[1:] = -block.spring * length * rate[:-1] / np.arange(1, TERMS)
        load[0] = self._load(run, since)
        load[1] += block.spring * block.speed * length
        motion = WrittenMotion(way, run.count.piece, seen(load, run.problem.strength, way), way * rate)
        write_piece(run, n, when, motion)
        move_over(run, n)

    def _load(self, run: LeapingRun, since: float) -> float:
        """Return the load (N) at a time (s) since the leap began, for the present slip, seen in the direction of slip."""
        block, way = self.leap.block, self.leap.direction
        slipped = way * float(run.state.slip_now) - self.leap.slip
        return block.load + block.spring * (block.speed * since - slipped)
