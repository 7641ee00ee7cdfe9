"""A leap over steady sliding: the deviation from it in the last round trip, and the landing, with the way as one piece."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.engine.creep.landing import WrittenMotion, continue_after, integrals, move, move_over, write_piece
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.pattern import Pattern, monotone_parts
from stickslip.engine.state.layout import Floats


@dataclass(frozen=True)
class Leap:
    """A leap over whole round trips of steady sliding, after which the deviation from it is `factor` times the present one."""

    trips: int
    factor: float
    slip: float  # m, in the direction of slip
    error: float  # bound of the error of slip, m


@dataclass(frozen=True)
class Deviation:
    """The last round trip, less steady sliding; rates and loads have their signs."""

    rate_there: float
    """Slip rate of steady sliding, m/s."""
    load_there: float
    """Load of steady sliding, minus the reference strength, Pa or N."""
    states_there: Floats
    """States of friction, as the formulas use them; with the other sign those that reverse, in backward slip."""
    rows: slice
    rate: Floats  # (pieces, TERMS), m/s
    load: Floats  # (pieces, TERMS), Pa or N
    slip: float  # integral of the rate over the round trip, m
    area: float  # that of the load, Pa s or N s
    end: float  # load at its end, Pa or N
    share: float  # largest deviation of a state, as a share of the state

    @classmethod
    def of(cls, run: LeapingRun, rate: float, load: float, states: Floats) -> Deviation:
        """Return what the last round trip of a run is beyond steady sliding."""
        rows = slice(int(run.count.previous_from), int(run.count.previous_to))
        rates, loads = run.store.rate[rows].copy(), run.store.load[rows].copy()
        rates[:, 0] -= rate
        loads[:, 0] -= load
        speed, bend = run.store.speed[rows], run.store.bend[rows]
        slip, area = (float(integrals(one, speed, bend).sum()) for one in (rates, loads))
        beyond = run.store.state[rows].copy()
        beyond[..., 0] -= states
        scales = np.maximum(np.abs(states), [state.scale for state in run.problem.friction.states])
        share = float(max((_largest(beyond[:, k]) / scale for k, scale in enumerate(scales)), default=0.0))
        return cls(rate, load, states, rows, rates, loads, slip, area, float(loads[-1].sum()), share)

    def is_within(self, share: float) -> bool:
        """Return True if slip rate and states deviate from steady sliding by no more than a share of themselves."""
        return self.largest_rate <= share * abs(self.rate_there) and self.share <= share

    @property
    def largest_rate(self) -> float:
        """The largest deviation of the slip rate, m/s."""
        return _largest(self.rate)

    @property
    def largest_load(self) -> float:
        """The largest deviation of the load, Pa or N."""
        return _largest(self.load)


def _largest(p: Floats) -> float:
    """Return the largest absolute value of polynomials on [0, 1]."""
    still = np.zeros(len(p))
    return float(np.abs(Pattern(monotone_parts(p, still, still + 1.0, still)).ends).max())


@dataclass(frozen=True)
class SteadyLanding:
    """A leap over steady sliding and the deviation from it in the last round trip, ready to be written."""

    may_rest: ClassVar[bool] = False
    leap: Leap
    deviation: Deviation

    @property
    def trips(self) -> int:
        """The number of round trips that are leaped over."""
        return self.leap.trips

    @property
    def errors(self) -> tuple[float, float]:
        """The bound of the error of slip (m), and that as a time (s)."""
        return self.leap.error, self.leap.error / abs(self.deviation.rate_there)

    def write(self, run: LeapingRun) -> None:
        """Write the way as one piece, then the round trip on which the leap lands, and set the engine there."""
        leap, deviation = self.leap, self.deviation
        begun, last = int(run.count.trip), deviation.rows.stop - 1
        rows = range(deviation.rows.start if leap.factor else last, last + 1)
        run.reserve(run.length + 1 + len(rows))
        store, way, landed_on = run.store, run.length, begun + leap.trips
        sign, turn = math.copysign(1.0, deviation.rate_there), run.problem.round_trip_time
        length = leap.trips * turn
        load, states = [deviation.load_there], [[state] for state in deviation.states_there]
        motion = WrittenMotion(store.mode[last], store.law_piece[last], load, [sign * leap.slip / length], states)
        write_piece(run, way, (begun, 0.0, length + np.spacing(landed_on * turn)), motion)  # no gap before the next round trip
        move(run, sign * leap.slip)
        for n, row in enumerate(rows, way + 1):
            phases = (float(store.phase_from[row]), float(store.phase_to[row])) if leap.factor else (0.0, turn)
            motion = WrittenMotion(store.mode[row], store.law_piece[row], load, [deviation.rate_there], states)
            write_piece(run, n, (landed_on, *phases), motion)
            if leap.factor:
                kept = row - deviation.rows.start
                store.load[n] += leap.factor * deviation.load[kept]
                store.rate[n] += leap.factor * deviation.rate[kept]
                store.speed[n], store.bend[n], store.jump[n] = store.speed[row], store.bend[row], store.jump[row]
            move_over(run, n)
        continue_after(run, landed_on, way + 1, way + 1 + len(rows), deviation.states_there)

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact round trips after a landing at `slip`, and how far it may be off."""
        turn = trips * run.problem.round_trip_time
        slip += turn * self.deviation.rate_there
        deviates = turn * abs(self.leap.factor) * self.deviation.largest_rate
        return slip, max(self.leap.error + deviates, tolerance * abs(slip))
