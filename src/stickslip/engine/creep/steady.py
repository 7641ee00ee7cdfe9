"""Leaps over steady sliding: how a deviation from it goes on from round trip to round trip, and what is proven of that.

Let v be the slip rate of steady sliding and d(t) the deviation from it, b(t) that of the load. One round trip later

    b' = r (2 Z d - b)         slab, at each phase by itself (r = -1 with a rigid driver)

and where the contact has no mass and friction F depends on the slip rate alone, b = Z d + F(v + d) - F(v): the deviation at each
phase is multiplied by r (Z - F') / (Z + F'), with F' somewhere between its bounds on the slip rates that occur. Interval arithmetic
bounds F'; so a deviation n round trips on is q^n times the present one, q the multiplier of steady sliding, within a proven bound,
whether deviations fade (F' > 0), keep their size and swing (F' = 0, q = -1) or slowly grow. A block without damping under friction
that hardly varies with the slip rate swings with its own period, from one period to the next the same (q = 1).

In any other contact that slides the deviation must have faded first: then it is dropped (q^n = 0). That no deviation grows again
is proven for friction of the slip rate alone that does not fall with it: the energy of the deviation,

    m d^2 / 2 + K x^2 / 2   (block; x is the deviation of the slip)        m_c d^2 / 2 + integral of b^2 / (4 Z)   (slab)

never grows. With states of friction it is not proven: linear stability decides, and the deviation is within the tolerance.

Under a rigid driver b' = b - 2 Z d, so that the slip passed over is known from the load where the leap lands: the sum of d over
the round trips from one to another is the change of b over 2 Z, whatever the law. For a block it is that change over K.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stickslip.contact import Sliding, steady_slidings
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.pattern import Pattern, monotone_parts
from stickslip.engine.state.layout import TERMS, BranchRow, Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.formula import Enclosure
from stickslip.problem import Problem, Resistance

SHORTEST_LEAP = 16
"""Fewest round trips of a leap that is worth its cost."""
BELOW_REST = 1e-6
"""Largest share of the slip rate by which a deviation may reach below rest: the contact then rests for a moment of that size."""
STILL, LONG = 1e-3, 1000
"""Largest deviation that is dropped, as a share of the slip rate, where its energy is proven never to grow and the leap is this
many times as long as the run so far: the swings of a contact with mass fade ever more slowly. Else the tolerance is that share.
"""
ROOM = 1.001
"""Slopes of friction are bounded over a range of slip rates that reaches this much farther than the deviation."""
ROUNDING = 4e-16
"""Rounding of a number, as a share of it."""
MOST = 700.0
"""Largest exponent of an exponential."""


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


def integrals(p: Floats, speed: Floats, bend: Floats) -> Floats:
    """Return the integrals of polynomials in xi over time: d theta = (speed + 2 bend xi) d xi."""
    powers = np.arange(1, TERMS + 1)
    return np.asarray(speed * (p / powers).sum(axis=1) + 2.0 * bend * (p / (powers + 1)).sum(axis=1))


@dataclass(frozen=True)
class SteadyLeaps:
    """Where a run slides steadily, and how far it may leap: the error of slip is at most `tolerance` times the slip."""

    problem: Problem
    tolerance: float

    @property
    def stable_states(self) -> Floats | None:
        """The states of friction, as the formulas use them, in a steady sliding that is stable; None without one."""
        return next((self._states(sliding) for sliding in self._slidings if sliding.stable is True), None)

    def leap(self, run: LeapingRun, most: int) -> tuple[Leap, Deviation] | None:
        """Return a leap over at most so many round trips, as long as the tolerance allows; None if none is worth its cost."""
        for sliding in self._near(run):
            deviation = Deviation.of(run, sliding.rate, self._load(sliding), self._states(sliding))
            if deviation.largest_rate > (1.0 + BELOW_REST) * abs(sliding.rate):
                continue
            trips = most
            while trips >= SHORTEST_LEAP:
                found = self._of_length(run, sliding, deviation, trips)
                if found is not None and found.error <= self.tolerance * (abs(float(run.state.slip_now)) + found.slip):
                    return found, deviation
                trips //= 2
        return None

    def _near(self, run: LeapingRun) -> Iterator[Sliding]:
        """Return the steady sliding motions, all in the direction in which the whole last round trip has slipped."""
        store, rows = run.store, slice(int(run.count.previous_from), int(run.count.previous_to))
        modes, pieces, mode = store.mode[rows], store.law_piece[rows], int(run.count.mode)
        turns, changes = (modes == -mode).any(), (pieces != pieces[0]).any()
        if mode == 0 or turns or changes or store.trip[rows][-1] != run.count.trip - 1:
            return
        law = self.problem.friction
        for sliding in self._slidings:
            here = int(law.piece_at(self.problem.law_slip, abs(sliding.rate)))
            if sliding.rate * mode > 0.0 and here == pieces[0]:
                yield sliding

    @property
    def _slidings(self) -> tuple[Sliding, ...]:
        with suppress(InputError):  # a law whose friction falls for ever
            return steady_slidings(self.problem).slidings
        return ()

    def _load(self, sliding: Sliding) -> float:
        """Return the load of steady sliding minus the reference strength, with its sign."""
        problem, sign = self.problem, math.copysign(1.0, sliding.rate)
        if problem.friction.states:
            return problem.body.damping * sliding.rate + sliding.traction - problem.strength
        excess = float(self._resistance.excess(abs(sliding.rate)))
        return excess if sign > 0.0 else -excess - 2.0 * problem.strength

    def _states(self, sliding: Sliding) -> Floats:
        law = self.problem.friction
        states = np.array(law.inner_states(sliding.states))
        if sliding.rate < 0.0:
            states[list(law.reverses)] *= -1.0
        return states

    @property
    def _resistance(self) -> Resistance:
        problem = self.problem
        return Resistance(problem.friction, problem.body.damping, problem.normal, problem.law_slip)

    def _slopes(self, low: float, high: float, piece: int) -> tuple[float, float]:
        """Return the least and the greatest slope of friction between two slip rates (m/s), Pa s/m or N s/m."""
        law, slip, normal = self.problem.friction, self.problem.law_slip, self.problem.normal
        mu = Enclosure((law.trees()[piece],), law.numbers(piece), slip).on(np.array([max(low, 0.0)]), np.array([high]))
        return normal * float(mu[0, 1, 0]), normal * float(mu[1, 1, 0])

    def _of_length(self, run: LeapingRun, sliding: Sliding, deviation: Deviation, trips: int) -> Leap | None:
        """Return the leap over so many round trips, None if what a deviation does in them is not known."""
        body, law = self.problem.body, self.problem.friction
        piece = int(run.store.law_piece[deviation.rows][0])
        if not (law.states or body.has_inertia):
            return self._multiplied(run, sliding, deviation, trips, piece)
        if not (law.states or body.has_waves) and (found := self._repeated(run, sliding, deviation, trips, piece)):
            return found
        is_long = trips >= LONG * run.count.trip and body.has_waves and not law.states
        if deviation.is_within(STILL if is_long else self.tolerance) and self._fades(sliding, deviation, piece):
            return self._dropped(sliding, deviation, trips)
        return None

    def _multiplied(self, run: LeapingRun, sliding: Sliding, deviation: Deviation, trips: int, piece: int) -> Leap | None:
        """Return a leap of a contact without mass: deviations are multiplied by a number in each round trip."""
        body, rate, later = self.problem.body, abs(sliding.rate), trips + 1
        slope, _ = self._slopes(rate, rate, piece)
        if not body.damping + slope > 0.0:
            return None
        reach = ROOM * max(deviation.largest_rate, deviation.largest_load / (body.damping + slope))
        low, high = self._slopes(rate - reach, rate + reach, piece)
        least, spread = body.damping + low, high - low
        if not (least > 0.0 and math.isfinite(spread)):
            return None
        steady, *others = (Multiplier.of(body.impedance, body.reflection, body.damping + one) for one in (slope, low, high))
        fastest = max(one.size for one in (steady, *others))  # logarithm of the largest multiplier
        growth = math.exp(min(max(later * fastest, 0.0), 1.0))
        if growth * deviation.largest_load > least * reach or not self._keeps_branch(run, deviation, growth):
            return None
        factor = steady.power(later)
        change = abs(body.reflection) * 2.0 * body.impedance * spread / least**2  # of the multiplier, over those slopes
        missed = change * deviation.largest_load * later * math.exp(min((later - 1) * fastest, 1.0))
        bent = 2.0 * spread / least**2 * abs(factor) * deviation.largest_load  # of the rate, where the load is as it should be
        if missed / least + bent > self.tolerance * rate:
            return None
        turn, sign = self.problem.round_trip_time, math.copysign(1.0, sliding.rate)
        if body.is_driven_rigidly:
            beyond = (1.0 - factor) * deviation.area / (2.0 * body.impedance) - deviation.slip
            error = turn * (missed / (2.0 * body.impedance) + bent)
        elif fastest < 0.0:
            gone = -math.expm1(fastest)
            beyond = (steady.power(1) - factor) / (1.0 - steady.power(1)) * deviation.slip
            error = turn * deviation.largest_load / (least * gone) * (change / gone + 2.0 * spread / least)
        else:
            return None
        error += trips * turn * max(growth * deviation.largest_rate - rate, 0.0)  # it rests where the rate would be below zero
        return Leap(trips, self._kept(factor, deviation), trips * turn * rate + sign * beyond, error)

    def _keeps_branch(self, run: LeapingRun, deviation: Deviation, growth: float) -> bool:
        """Return True if the selection rule keeps the branch at all loads of deviations that have grown by a factor."""
        branch, most = BranchRow(run.setup.branches[run.count.branch]), growth * deviation.largest_load
        there = deviation.load_there
        seen = there if deviation.rate_there > 0.0 else -there - 2.0 * self.problem.strength
        rounding = BELOW_REST * deviation.largest_load
        return bool(branch.keep_from - rounding <= seen - most and seen + most <= branch.keep_to + rounding)

    def _repeated(self, run: LeapingRun, sliding: Sliding, deviation: Deviation, trips: int, piece: int) -> Leap | None:
        """Return a leap of a block that swings with its own period, as if friction did not vary with the slip rate."""
        body, rate, turn = self.problem.body, abs(sliding.rate), self.problem.round_trip_time
        if body.damping or turn != body.round_trip_time:
            return None
        end = float(deviation.rate[-1].sum())
        swing = math.hypot(end, deviation.end / math.sqrt(body.inertia * body.stiffness))  # of the slip rate
        if swing > (1.0 + BELOW_REST) * rate or (swing >= rate and self.problem.friction.static_excess):
            return None
        low, high = self._slopes(rate - ROOM * swing, rate + ROOM * swing, piece)
        varies = 2.0 * swing * max(-low, high)  # range of friction
        missed = (trips + 1) * (turn * varies / body.inertia + ROUNDING * swing)
        if not missed <= self.tolerance * rate:
            return None
        error = missed * math.sqrt(body.inertia / body.stiffness) + trips * turn * max(swing + missed - rate, 0.0)
        return Leap(trips, self._kept(1.0, deviation), trips * turn * rate, error)

    def _fades(self, sliding: Sliding, deviation: Deviation, piece: int) -> bool:
        """Return True if a small deviation does not grow: by its energy or, with states of friction, by linear stability."""
        if self.problem.friction.states:
            return sliding.stable is True
        reach = math.sqrt(2.0 * self._energy(deviation) / self.problem.body.inertia)
        low, _ = self._slopes(abs(sliding.rate) - reach, abs(sliding.rate) + reach, piece)
        return low >= (0.0 if self.problem.body.has_waves else -self.problem.body.damping)

    def _energy(self, deviation: Deviation) -> float:
        """Return a bound of the energy of a deviation: motion and spring, or motion and waves, J/m^2 (block: J)."""
        body, load = self.problem.body, deviation.largest_load
        held = load * load * (body.round_trip_time / (4.0 * body.impedance) if body.has_waves else 0.5 / body.stiffness)
        return held + 0.5 * body.inertia * deviation.largest_rate**2

    def _dropped(self, sliding: Sliding, deviation: Deviation, trips: int) -> Leap:
        """Return a leap after which nothing is left of a deviation that is small already."""
        body, turn, sign = self.problem.body, self.problem.round_trip_time, math.copysign(1.0, sliding.rate)
        energy = self._energy(deviation)
        if not body.has_waves:
            beyond, error = deviation.end / body.stiffness, math.sqrt(2.0 * energy / body.stiffness)
        else:
            error = math.sqrt(turn * energy / body.impedance)
            beyond = deviation.area / (2.0 * body.impedance) - deviation.slip if body.is_driven_rigidly else 0.0
        return Leap(trips, 0.0, trips * turn * abs(sliding.rate) + sign * beyond, error)

    @staticmethod
    def _kept(factor: float, deviation: Deviation) -> float:
        """Return a factor, or 0 if it leaves less of a deviation than rounding does."""
        return factor if abs(factor) * deviation.largest_rate > ROUNDING * abs(deviation.rate_there) else 0.0


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
        return self.sign ** (n % 2) * math.exp(min(n * self.size, MOST)) if self.size > -math.inf else 0.0
