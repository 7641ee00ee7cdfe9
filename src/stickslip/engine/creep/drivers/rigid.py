"""Leaps over steady sliding of a body with waves before a rigid driver: the load where one lands says how much slip there was."""

from __future__ import annotations

import math
from typing import NamedTuple

from typing_extensions import override

from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.steady import BELOW_REST, ROOM, SteadyLeaps, Tried
from stickslip.engine.creep.steady_landing import Deviation, Leap
from stickslip.engine.state.layout import BranchRow
from stickslip.problem.bodies import BodyOnCharacteristics

STILL, LONG = 1e-3, 1000
"""Largest deviation that is dropped, as a share of the slip rate, where its energy is proven never to grow and the leap is this
many times as long as the run so far: the swings of a contact with mass fade ever more slowly. Else the tolerance is that share.
"""
LARGEST_ARGUMENT = 700.0
"""Largest exponent of an exponential."""


class Multiplier(NamedTuple):
    """Hold the factor of a deviation in a round trip, as the logarithm of its size and its sign."""

    size: float
    sign: float

    @classmethod
    def of(cls, impedance: float, reflection: float, slope: float) -> Multiplier:
        """Return r (2 Z / g' - 1) for the slope g' of the resistance (all in Pa s/m)."""
        beyond = 2.0 * (impedance - slope) / slope  # 2 Z / g' - 1 is 1 and this
        if reflection == 0.0 or beyond == -1.0:
            return cls(-math.inf, 1.0)
        size = math.log1p(beyond) if beyond > -1.0 else math.log(-1.0 - beyond)
        return cls(size + math.log(abs(reflection)), math.copysign(1.0, (1.0 + beyond) * reflection))

    def power(self, n: int) -> float:
        """Return the factor of n round trips."""
        return self.sign ** (n % 2) * math.exp(min(n * self.size, LARGEST_ARGUMENT)) if self.size > -math.inf else 0.0


class Multiplied(NamedTuple):
    """A deviation that is multiplied in each round trip, and how far that may be off."""

    each: Multiplier  # at the slope of friction of steady sliding
    factor: float  # of all round trips
    fastest: float  # logarithm of the largest multiplier at the slopes that occur
    least: float  # slope of the resistance, Pa s/m
    spread: float  # of the slopes, Pa s/m
    change: float  # of the multiplier over those slopes
    missed: float  # of the load, Pa
    bent: float  # of the rate where the load is as it should be, m/s


class LeapsInWaves(SteadyLeaps):
    """The echo multiplies a deviation in each round trip; with a contact mass its energy is that of the mass and of the waves."""

    def slip_as_it_multiplies(self, tried: Tried, found: Multiplied) -> tuple[float, float] | None:
        """Return the slip (m) that a deviation adds as it is multiplied, and its error (m); None if that is not known."""
        error = tried.turn * (found.missed / (2.0 * tried.body.impedance) + found.bent)
        return _unloaded(tried, found.factor), error

    def slip_as_it_fades(self, tried: Tried) -> float:
        """Return the slip (m) that a deviation still adds as it fades."""
        return _unloaded(tried, 0.0)

    @override
    def leap(self, tried: Tried) -> Leap | None:
        if not (tried.law.states or tried.body.has_inertia):
            return self._multiplied(tried)
        is_long = tried.trips >= LONG * tried.run.count.trip and not tried.law.states
        return self.faded(tried, STILL if is_long else tried.tolerance)

    @override
    def held(self, body: BodyOnCharacteristics) -> float:
        return body.round_trip_time / (4.0 * body.impedance)

    @override
    def least_slope(self, body: BodyOnCharacteristics) -> float:
        return 0.0

    @override
    def last_slip(self, tried: Tried, energy: float) -> tuple[float, float]:
        return self.slip_as_it_fades(tried), math.sqrt(tried.turn * energy / tried.body.impedance)

    def _multiplied(self, tried: Tried) -> Leap | None:
        """Return a leap of a contact without mass: deviations are multiplied by a number in each round trip."""
        body, deviation, later = tried.body, tried.deviation, tried.trips + 1
        slope, _ = tried.slopes(0.0)
        if not body.damping + slope > 0.0:
            return None
        reach = ROOM * max(deviation.largest_rate, deviation.largest_load / (body.damping + slope))
        low, high = tried.slopes(reach)
        least, spread = body.damping + low, high - low
        if not (least > 0.0 and math.isfinite(spread)):
            return None
        steady, *others = (Multiplier.of(body.impedance, body.reflection, body.damping + one) for one in (slope, low, high))
        fastest = max(one.size for one in (steady, *others))
        growth = math.exp(min(max(later * fastest, 0.0), 1.0))
        if growth * deviation.largest_load > least * reach or not _keeps_branch(tried.run, deviation, growth):
            return None
        factor = steady.power(later)
        change = abs(body.reflection) * 2.0 * body.impedance * spread / least**2
        missed = change * deviation.largest_load * later * math.exp(min((later - 1) * fastest, 1.0))
        bent = 2.0 * spread / least**2 * abs(factor) * deviation.largest_load
        if missed / least + bent > tried.tolerance * tried.rate:
            return None
        multiplied = Multiplied(steady, factor, fastest, least, spread, change, missed, bent)
        slip = self.slip_as_it_multiplies(tried, multiplied)
        return None if slip is None else tried.leap(factor, *slip, growth * deviation.largest_rate)


def _keeps_branch(run: LeapingRun, deviation: Deviation, growth: float) -> bool:
    """Return True if the selection rule keeps the branch at all loads of deviations that have grown by a factor."""
    branch, most = BranchRow(run.setup.branches[run.count.branch]), growth * deviation.largest_load
    there = deviation.load_there
    seen = there if deviation.rate_there > 0.0 else -there - 2.0 * run.problem.strength
    rounding = BELOW_REST * deviation.largest_load
    return bool(branch.keep_from - rounding <= seen - most and seen + most <= branch.keep_to + rounding)


def _unloaded(tried: Tried, factor: float) -> float:
    """Return the slip (m) that takes a deviation of the load to `factor` times itself, less that of its own round trip.

    The sum of rates over the round trips from one to another is the change of the load over 2 Z, whatever the law.
    """
    return (1.0 - factor) * tried.deviation.area / (2.0 * tried.body.impedance) - tried.deviation.slip


ANSWERS = LeapsInWaves()
