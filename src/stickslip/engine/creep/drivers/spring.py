"""Leaps over steady sliding of a rigid body on a spring, which swings with its own period."""

from __future__ import annotations

import math

from typing_extensions import override

from stickslip.engine.creep.cycles import leap_over_cycles
from stickslip.engine.creep.landing import ROUNDING_OF_NUMBER, LookedFor
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.steady import BELOW_REST, ROOM, SteadyLeaps, Tried
from stickslip.engine.creep.steady_landing import Leap
from stickslip.problem.bodies import BodyOnCharacteristics


class LeapsOnSpring(SteadyLeaps):
    """The energy of a deviation is that of motion and spring; cycles that touch rest may be all the same, too."""

    @override
    def look(self, run: LeapingRun, most: int, tolerance: float) -> LookedFor:
        found = super().look(run, most, tolerance)
        if found.landing is not None:
            return found
        cycles = leap_over_cycles(run, most, tolerance)
        return LookedFor(cycles, at_end=cycles is not None)

    @override
    def leap(self, tried: Tried) -> Leap | None:
        repeated = None if tried.law.states else _repeated(tried)
        return repeated or self.faded(tried, tried.tolerance)

    @override
    def held(self, body: BodyOnCharacteristics) -> float:
        return math.inf if body.is_free else 0.5 / body.stiffness

    @override
    def least_slope(self, body: BodyOnCharacteristics) -> float:
        return -body.total_damping

    @override
    def last_slip(self, tried: Tried, energy: float) -> tuple[float, float]:
        return tried.deviation.end / tried.body.stiffness, math.sqrt(2.0 * energy / tried.body.stiffness)


def _repeated(tried: Tried) -> Leap | None:
    """Return a leap of a block that swings with its own period, as if friction did not vary with the slip rate."""
    body, rate, turn, deviation = tried.body, tried.rate, tried.turn, tried.deviation
    if body.total_damping or turn != body.round_trip_time:
        return None
    end = float(deviation.rate[-1].sum())
    swing = math.hypot(end, deviation.end / math.sqrt(body.inertia * body.stiffness))  # of the slip rate
    if swing > (1.0 + BELOW_REST) * rate or (swing >= rate and tried.law.static_excess):
        return None
    low, high = tried.slopes(ROOM * swing)
    varies = 2.0 * swing * max(-low, high)  # range of friction
    missed = (tried.trips + 1) * (turn * varies / body.inertia + ROUNDING_OF_NUMBER * swing)
    if not missed <= tried.tolerance * rate:
        return None
    return tried.leap(1.0, 0.0, missed * math.sqrt(body.inertia / body.stiffness), swing + missed)


ANSWERS = LeapsOnSpring()
