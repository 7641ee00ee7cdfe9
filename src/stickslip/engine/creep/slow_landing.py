"""Landing of a leap over slow sliding: the way and the last round trip as pieces of the history, and the engine at its end."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from stickslip.engine.creep.landing import WrittenMotion, continue_after, move, move_over, write_piece
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.slow import BOTH, OFFSETS, PLACES_OF_OFFSETS, RoundTrip, to_powers
from stickslip.engine.creep.slow_leaps import RATE_SHARE, SlowLeap
from stickslip.engine.state.layout import Floats

ROUNDINGS = 64.0
"""Number of roundings of the slip within which a round trip after the landing is compared with the leap."""


@dataclass(frozen=True)
class SlowLanding:
    """A leap over slow sliding, ready to be written."""

    may_rest: ClassVar[bool] = False
    leap: SlowLeap

    @property
    def trips(self) -> int:
        """The number of round trips that are leaped over."""
        return self.leap.trips

    @property
    def errors(self) -> tuple[float, float]:
        """The bound of the error of slip (m), and that as a time (s): at the slip rate there, or the driver's if that is larger."""
        motion = self.leap.motion
        rate = float(motion.at(self.leap.landing).change[BOTH, -1]) / motion.offsets.period
        return self.leap.error, self.leap.error / max(rate, motion.speed)

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end."""
        leap, first = self.leap, run.length + len(self.leap.steps)
        pieces = len(leap.motion.offsets.phase)
        run.reserve(first + pieces)
        begun = int(run.count.trip)
        self._write_way(run)
        self._write_round_trip(run, first, begun + leap.trips)
        end = leap.motion.later(leap.landing, 1)
        states = end[BOTH, leap.motion.size : -1] + leap.motion.at(end).state_begins[BOTH]
        continue_after(run, begun + leap.trips, first, first + pieces, states)

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact round trips after the landing at a slip (m), and how far it may be off.

        What these round trips add may differ by as much as the slip rate may, and by the roundings of all slip so far.
        """
        motion, sign = self.leap.motion, int(run.count.mode)
        landed, end = motion.later(self.leap.landing, 1), motion.later(self.leap.landing, 1 + trips)
        grown = self._slip(end) - self._slip(landed)
        rounded = ROUNDINGS * float(np.spacing(max(abs(slip), self._slip(end))))
        return slip + sign * grown, RATE_SHARE * tolerance * grown + rounded

    def _slip(self, y: Floats) -> float:
        """Return the slip since the leap began (m) where a round trip begins."""
        return float(y[BOTH, -1] + self.leap.motion.at(y).slip_begins[BOTH])

    def _write_way(self, run: LeapingRun) -> None:
        """Write the averaged motion, a piece for each step of the integration, and move the contact to its end."""
        motion, trip = self.leap.motion, int(run.count.trip)
        turn, rows = motion.offsets.period, []
        for step in self.leap.steps:
            moments = [step.between(step.begin + place * (step.end - step.begin))[BOTH] for place in PLACES_OF_OFFSETS]
            rows.append([to_powers(one) for one in motion.means(np.array(moments))])
        ends = np.array([(step.begin, step.end) for step in self.leap.steps]) * turn
        ends[-1, 1] += np.spacing((trip + self.leap.trips) * turn)  # no gap before the next round trip
        grown = np.array([rate @ (1.0 / np.arange(1, OFFSETS + 1)) for _, rate, _ in rows]) * (ends[:, 1] - ends[:, 0])
        stretch = self._slip(self.leap.landing) / grown.sum()  # that slip has no jump where the averaged motion begins or ends
        for k, (load, rate, states) in enumerate(rows):
            n = int(run.count.length) + k
            write_piece(run, n, (trip, *ends[k]), self._motion(run, load, stretch * rate, states))
            move(run, int(run.count.mode) * (stretch * grown[k]))

    def _write_round_trip(self, run: LeapingRun, first: int, trip: int) -> None:
        """Write the round trip on which the leap lands, a piece for each stretch, and move the contact to its end."""
        motion = self.leap.motion
        there = RoundTrip(motion, self.leap.landing, motion.later(self.leap.landing, 1))
        rate, states = there.with_ripple()
        load = motion.friction(rate, states) + run.problem.body.impedance * rate
        for k, ends in enumerate(pairwise(motion.offsets.edges.tolist())):
            n, here = first + k, slice(k * OFFSETS, (k + 1) * OFFSETS)
            own = (to_powers(one) for one in (load[here], rate[here], states[:, here].T))
            write_piece(run, n, (trip, *ends), self._motion(run, *own))
            move_over(run, n)

    def _motion(self, run: LeapingRun, load: Floats, rate: Floats, states: Floats) -> WrittenMotion:
        """Return the motion of polynomials of load (Pa), slip rate (m/s) and states, the first two in the direction of slip."""
        sign, last = int(run.count.mode), int(run.count.previous_to) - 1
        signed = sign * load
        signed[0] -= run.problem.strength
        return WrittenMotion(run.store.mode[last], run.store.law_piece[last], signed, sign * rate, states.T)
