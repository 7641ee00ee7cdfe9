"""Creep of a slab under a law of slip, averaged over round trips: in closed form.

Under a rigid driver beta(t) = beta(t-R) - 2 Z v(t-R) + 2 Z V is a sum: at each offset theta of the round trip, n round trips
after one whose load is beta_0(theta),

    tau_n = beta_0 + 2 Z V n - 2 Z C_n,        C_n = sum of v over the round trips before + v_n / 2.

Where it slips tau = S mu(u), where it has not it is below: as slip continues, C_n = max(0, beta_0 + 2 Z V n - S mu(u)) / (2 Z),
whatever echoes are in beta_0, and however v jumps from one round trip to the next (where it slips the contact reflects with a
change of sign: v_n and v_(n+1) add up to twice their mean; a rate above twice the mean is followed by as much rest as makes up
for it). Slip over a round trip then obeys, exactly,

    ubar = u_0 + integral of C_n over theta,    ubar the mean of the slips at the start and the end of round trip n.

With S mu(u) at ubar, which has no error of first order in the slip per round trip, ubar and n are explicit functions of the
*lift* L = 2 Z V n - S mu(ubar):  ubar = u_0 + M(L) / (2 Z),  n = (L + S mu(ubar)) / (2 Z V), where M is the part of beta_0 + L
above zero and A = M' the share of the round trip, in s, in which the contact slips. dn/dL = room / (2 Z V), with
room = 1 + S mu'(ubar) A / (2 Z): no room is left where creep turns dynamic.

Terms of second order come from how slip grows within a round trip, u = ubar + ubar' (phi - 1/2) + A vbar' (phi^2 - phi) / 2 with
phi the share of the slip that has been, ' = d/dn and vbar = V / room the mean rate where it slips:

    2 Z (ubar - u_0) = M + S mu' A^2 vbar' / 12 - S mu'' ubar'^2 A / 24 + [S mu' ubar' (phi - 1/2)]^2 / (2 |dbeta_0/dtheta|),

the last summed over the borders of slip.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace
from typing import Any, Self

import numpy as np

from stickslip.engine.compiled_formula import CompiledFormula, compile_formula
from stickslip.engine.contact_step.certificate import NEGLIGIBLE_FRICTION
from stickslip.engine.creep.pattern import Pattern
from stickslip.engine.input.branch_table import strength_change
from stickslip.engine.state.layout import Ball, Floats
from stickslip.friction.formula import Expression, difference
from stickslip.problem import Problem


@dataclass(frozen=True)
class Sight:
    """A compiled formula, with its constants at a reference slip."""

    formula: CompiledFormula
    constants: Floats

    @classmethod
    def of(cls, tree: Expression, parameters: tuple[str, ...], values: tuple[float, ...], reference: float) -> Self:
        """Return a formula with these values of its parameters; slips count from the reference (m)."""
        formula = compile_formula(tree, parameters, ())
        numbers, constants = np.array(values), np.zeros(formula.size)
        formula.fill(numbers, reference, constants)
        return cls(formula, constants)

    def change(self, slip: float, radius: float) -> float:
        """Return a bound (1) of the change of friction at rest from a slip to slips up to `radius` away (both m).

        The bound is infinite or NaN where nothing is known. Slips count from the reference.
        """
        ball = Ball(np.zeros(Ball.total))
        ball.slip, ball.at_slip = radius, slip
        self.formula.fill_radii(self.constants, ball.numbers)
        return float(ball.friction)


SLIPS_LOOKED_AT = 65
"""Number of slips at which the lowest friction of a stride is looked for, and again around the lowest of them."""
IN_SIGHT = 10.0
"""Largest factor by which friction may be proven to change more than its slopes suggest: the bound of a smooth law is larger by a
few."""
COMPLEX_STEP = 1e-30
"""Imaginary part (m) of the slip in a derivative by a complex step: small enough that the derivative is exact to rounding."""


@dataclass(frozen=True)
class Strength:
    """Friction (Pa) as a function of further slip x >= 0 (m), minus the reference strength."""

    problem: Problem
    law_slip: float  # at x = 0, minus that at the start of the run, m
    sign: float  # change of the law's slip with x
    step: float  # slip over which a second derivative is taken, m: that of a round trip

    def __call__(self, x: float) -> float:
        """Return the static strength (Pa) after slip x (m), minus that at the start of the run."""
        law, slip = self.problem.friction, self.law_slip + self.sign * x
        if law.knot_variable == "slip" and len(law.knots):
            return strength_change(self.problem, slip)
        tree, numbers = self._only
        return self.problem.normal * float(difference(tree, numbers, self.problem.law_slip, slip, 0.0)[0])

    @cached_property
    def _only(self) -> tuple[Expression, dict[str, float]]:
        """The formula of a law without knots, and its numbers."""
        return self.problem.friction.trees()[0], self.problem.friction.numbers()

    @cached_property
    def _formula(self) -> Callable[[Any], Any]:
        """The friction coefficient of this piece of the law as a function of slip, which may be complex."""
        law = self.problem.friction
        formula, numbers, states = law.pieces[self.piece], SimpleNamespace(**law.numbers(self.piece)), law.each_state(0.0)
        return lambda slip: formula(numbers, slip, 0.0, *states)

    @cached_property
    def piece(self) -> int:
        """The piece of the law that holds at x = 0."""
        law = self.problem.friction
        return int(law.piece_at(self.problem.law_slip + self.law_slip)) if law.knot_variable == "slip" else 0

    @cached_property
    def sight(self) -> Sight:
        """The ball arithmetic of the piece of the law that holds at x = 0."""
        law = self.problem.friction
        return Sight.of(law.trees()[self.piece], law.parameters(), law.piece_values(self.piece), self.problem.law_slip)

    def in_sight(self, x: float, end: float) -> bool:
        """Return True if friction is proven to change from x to `end` no more than its slopes at x suggest.

        A part of the law that leaves no trace at x would be missed between the places where a leap evaluates friction.
        """
        way, unit = abs(end - x), self.problem.normal
        expected = abs(self.slope(x)) * way + abs(self.curvature(x)) * way * way
        return unit * self.sight.change(self.law_slip + self.sign * x, way) <= IN_SIGHT * expected + unit * NEGLIGIBLE_FRICTION

    def falls_below_zero(self, x: float, end: float) -> bool:
        """Return True if friction falls below zero between two slips, by more than rounding: it would drive slip there."""
        law = self.problem.friction
        if not law.can_be_negative:
            return False
        slips = self.problem.law_slip + self.law_slip + self.sign * np.linspace(x, end, SLIPS_LOOKED_AT)
        lowest = int(np.argmin(law.piece_coefficient(self.piece, slips, 0.0)))
        near = np.linspace(slips[max(lowest - 1, 0)], slips[min(lowest + 1, SLIPS_LOOKED_AT - 1)], SLIPS_LOOKED_AT)
        return bool(np.min(law.piece_coefficient(self.piece, near, 0.0)) < -NEGLIGIBLE_FRICTION)

    @cached_property
    def room(self) -> float:
        """How far x may grow within the piece of the law, m."""
        knots = (-np.inf, *self.problem.friction.knots, np.inf)
        here = self.problem.law_slip + self.law_slip
        return float(knots[self.piece + 1] - here if self.sign > 0 else here - knots[self.piece])

    def slope(self, x: float) -> float:
        """Return the derivative with respect to x, Pa/m, by a complex step."""
        slip = complex(self.problem.law_slip + self.law_slip + self.sign * x, self.sign * COMPLEX_STEP)
        return self.problem.normal * float(np.imag(self._formula(slip))) / COMPLEX_STEP

    def slopes(self, x: Floats) -> Floats:
        """Return the derivatives at several x, Pa/m."""
        slips = self.problem.law_slip + self.law_slip + self.sign * x + self.sign * COMPLEX_STEP * 1j
        return np.asarray(self.problem.normal * np.imag(self._formula(slips)) / COMPLEX_STEP) + np.zeros(len(slips))

    def curvature(self, x: float) -> float:
        """Return the second derivative with respect to x, Pa/m^2, from the slopes at two nearby slips."""
        return self.slope_and_curvature(x)[1]

    def slope_and_curvature(self, x: float) -> tuple[float, float]:
        """Return the first (Pa/m) and the second derivative with respect to x (Pa/m^2)."""
        before, here, after = self.slopes(np.array([x - self.step, x, x + self.step])).tolist()
        return here, (after - before) / (2.0 * self.step)


@dataclass(frozen=True)
class Creep:
    """The averaged state at one lift. Slip is counted from the start of the round trip whose load is the pattern's."""

    lift: float  # Pa
    trips: float  # n: round trips since the pattern's
    slip: float  # ubar, m
    rate: float  # d ubar / dn, m per round trip
    bend: float  # d2 ubar / dn2, m per round trip squared
    room: float
    length: float  # of the part of the round trip in which the contact slips, s
    widening: float  # change of length in a round trip, s
    mean_rate: float  # m/s, where the contact slips
    mean_bend: float  # change of mean_rate in a round trip, m/s
    error: float  # of ubar, m

    @property
    def seen(self) -> float:
        """The smallest share of an amplitude that the range of slip within two round trips shows.

        Slip oscillates as sin(2 x t / R) where x / tan(x) = 1 - room: twice in four round trips where room is 1, once where it is
        1/5, more slowly where it is less, and then 1 - cos(2 x) is what shows.
        """
        return min(1.0, 5.0 * self.room)


@dataclass(frozen=True)
class AveragedCreep:
    """Creep from a round trip with a given load on, driven at `speed` > 0 (m/s), seen in the direction of slip."""

    pattern: Pattern
    strength: Strength
    impedance: float
    speed: float

    @property
    def gain(self) -> float:
        """The load gained in a round trip, Pa."""
        return 2.0 * self.impedance * self.speed

    def at(self, lift: float) -> Creep:
        """Return the state at a lift (Pa), with the size of the terms of second order as its error."""
        above, z2 = self.pattern.above(lift), 2.0 * self.impedance
        length, border = above.length, above.border
        slip = above.area / z2
        slope, curvature = self.strength.slope_and_curvature(slip)
        room = 1.0 + slope * length / z2
        if room <= 0.0:
            return Creep(lift, np.inf, slip, np.inf, np.inf, room, length, np.inf, np.inf, np.inf, np.inf)
        rate, mean_rate = length * self.speed / room, self.speed / room
        closing = (curvature * length * length / z2 + slope * border) / z2 / room * self.gain  # d room / dn
        bend = (border * self.speed * self.gain / room - rate * closing) / room
        mean_bend = -mean_rate * closing / room
        terms = (
            slope * length * length * mean_bend / 12.0,
            -curvature * rate * rate * length / 24.0,
            0.5 * (slope * rate) ** 2 * above.spread,
        )
        resting = z2 * length * max(-mean_bend, 0.0)  # rates that would fall below 0 as the mean falls: the contact rests instead
        slip += sum(terms) / z2 if abs(sum(terms)) < z2 * rate else 0.0  # near an extremum of the load these terms mean nothing
        trips = (lift + self.strength(slip)) / self.gain
        error = (sum(abs(term) for term in terms) + resting) / z2 / room
        return Creep(lift, trips, slip, rate, bend, room, length, border * self.gain / room, mean_rate, mean_bend, error)

    def swing(self, lift: float, creep: Creep, before: Floats) -> float:
        """Return an upper bound of the amplitude of slip (m) around its mean.

        It comes from the range of slip in the first round trip and the one before. `lift` is that of the first round trip, and
        `creep` a creep near there, whose mean rate is the mean. `before` holds, for the round trip before, the offsets (s) of the
        ends of its pieces and the slip (m) since its start.
        """
        areas, lengths = (np.cumsum([0.0, *share]) for share in self.pattern.shares(lift))
        ends = np.append(0.0, self.pattern.parts.phase_from + self.pattern.width)
        first = before[1] - creep.mean_rate * np.interp(before[0], ends, lengths)
        second = first[-1] + areas / self.impedance - creep.mean_rate * lengths
        return float(np.ptp([0.0, *first, *second])) / creep.seen

    def start(self) -> Creep:
        """Return the state at n = 0."""
        low = high = -self.strength(0.0)
        while self.at(low).trips > 0.0:
            low -= self.gain
        while self.at(high).trips < 0.0:
            high += self.gain
        return self.reaching(0.0, low, high, 1e-6 * self.gain)

    def beyond(self, creep: Creep, trips: float) -> tuple[float, float]:
        """Return two lifts between which the creep has continued for the given number of round trips, if it ever does."""
        high = creep.lift + self.gain
        while (state := self.at(high)).room > 0.0 and state.trips < trips:
            high += self.gain
        return creep.lift, high

    def reaching(self, trips: float, low: float, high: float, within: float = 0.0) -> Creep:
        """Return the state after the given number of round trips.

        The state lies between two lifts and is found by bisection, to rounding or to `within` (Pa).
        """
        while high - low > within and low < (middle := 0.5 * (low + high)) < high:
            if self.at(middle).trips < trips:
                low = middle
            else:
                high = middle
        return self.at(0.5 * (low + high))
