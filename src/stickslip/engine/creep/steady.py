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
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from stickslip.contact import Sliding, steady_slidings
from stickslip.engine.creep.landing import ROUNDING_OF_NUMBER, SHORTEST_LEAP, LookedFor
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.steady_landing import Deviation, Leap, SteadyLanding
from stickslip.engine.state.layout import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.friction.formula import Enclosure
from stickslip.problem import DRIVER_KINDS, Problem, Resistance
from stickslip.problem.bodies import BodyOnCharacteristics

BELOW_REST = 1e-6
"""Largest share of the slip rate by which a deviation may reach below rest: the contact then rests for a moment of that size."""
ROOM = 1.001
"""Slopes of friction are bounded over a range of slip rates that reaches this much farther than the deviation."""


class Tried(NamedTuple):
    """A leap over so many round trips of steady sliding that is tried; the error of slip may be `tolerance` times the slip."""

    run: LeapingRun
    sliding: Sliding
    deviation: Deviation
    trips: int
    tolerance: float

    @property
    def body(self) -> BodyOnCharacteristics:
        """The body that slides."""
        return self.run.problem.body

    @property
    def law(self) -> FrictionLaw:
        """Its friction."""
        return self.run.problem.friction

    @property
    def rate(self) -> float:
        """The slip rate of steady sliding (m/s), without its sign."""
        return abs(self.sliding.rate)

    @property
    def turn(self) -> float:
        """The time of a round trip of the run, s."""
        return self.run.problem.round_trip_time

    def slopes(self, reach: float) -> tuple[float, float]:
        """Return the least and the greatest slope of friction (Pa s/m or N s/m) at slip rates within `reach` (m/s)."""
        problem, piece = self.run.problem, int(self.run.store.law_piece[self.deviation.rows][0])
        formula = Enclosure((self.law.trees()[piece],), self.law.numbers(piece), problem.law_slip)
        mu = formula.on(np.array([max(self.rate - reach, 0.0)]), np.array([self.rate + reach]))
        return problem.normal * float(mu[0, 1, 0]), problem.normal * float(mu[1, 1, 0])

    def leap(self, factor: float, beyond: float, error: float, slower: float = 0.0) -> Leap:
        """Return the leap: a deviation is multiplied by a factor, and adds slip (m) `beyond` that of steady sliding.

        It may be slower than steady sliding by `slower` (m/s): the contact rests where its rate would be below zero. A factor is 0
        if it leaves less of the deviation than rounding does.
        """
        kept = abs(factor) * self.deviation.largest_rate > ROUNDING_OF_NUMBER * self.rate
        time, sign = self.trips * self.turn, math.copysign(1.0, self.sliding.rate)
        error += time * max(slower - self.rate, 0.0)
        return Leap(self.trips, factor if kept else 0.0, time * self.rate + sign * beyond, error)


class SteadyLeaps(ABC):
    """Where a run slides steadily before one kind of driver, and how far it may leap."""

    def look(self, run: LeapingRun, most: int, tolerance: float) -> LookedFor:
        """Look for a leap over at most so many round trips, as long as the tolerance allows."""
        for sliding in _near(run):
            deviation = Deviation.of(run, sliding.rate, _load(run.problem, sliding), _states(run.problem.friction, sliding))
            if deviation.largest_rate > (1.0 + BELOW_REST) * abs(sliding.rate):
                continue
            trips = most
            while trips >= SHORTEST_LEAP:
                found = self.leap(Tried(run, sliding, deviation, trips, tolerance))
                if found is not None and found.error <= tolerance * (abs(float(run.state.slip_now)) + found.slip):
                    return LookedFor(SteadyLanding(found, deviation), at_end=trips == most)
                trips //= 2
        return LookedFor(None)

    @abstractmethod
    def leap(self, tried: Tried) -> Leap | None:
        """Return the leap that is tried, None if what a deviation does in it is not known."""

    @abstractmethod
    def held(self, body: BodyOnCharacteristics) -> float:
        """Return the energy (J/m^2; block: J) that a body holds for a deviation of the load by 1 Pa (N), at most."""

    @abstractmethod
    def least_slope(self, body: BodyOnCharacteristics) -> float:
        """Return the slope of friction (Pa s/m or N s/m) from which on the energy of a deviation does not grow."""

    @abstractmethod
    def last_slip(self, tried: Tried, energy: float) -> tuple[float, float]:
        """Return the slip (m) that a deviation of an energy (J/m^2; block: J) still adds as it fades, and how far it may be off."""

    def faded(self, tried: Tried, share: float) -> Leap | None:
        """Return a leap after which nothing is left of a deviation within a share of the slip rate, None if it may grow again.

        That is decided by its energy or, with states of friction, by linear stability.
        """
        body, load = tried.body, tried.deviation.largest_load
        if not tried.deviation.is_within(share):
            return None
        energy = load * load * self.held(body) + 0.5 * body.inertia * tried.deviation.largest_rate**2
        if tried.law.states:
            fades = tried.sliding.stable is True
        else:
            fades = tried.slopes(math.sqrt(2.0 * energy / body.inertia))[0] >= self.least_slope(body)
        return tried.leap(0.0, *self.last_slip(tried, energy)) if fades else None


def _near(run: LeapingRun) -> Iterator[Sliding]:
    """Return the steady sliding motions, all in the direction in which the whole last round trip has slipped."""
    store, rows = run.store, slice(int(run.count.previous_from), int(run.count.previous_to))
    modes, pieces, mode = store.mode[rows], store.law_piece[rows], int(run.count.mode)
    turns, changes = (modes == -mode).any(), (pieces != pieces[0]).any()
    if mode == 0 or turns or changes or store.trip[rows][-1] != run.count.trip - 1:
        return
    for sliding in _slidings(run.problem):
        here = int(run.problem.friction.piece_at(run.problem.law_slip, abs(sliding.rate)))
        if sliding.rate * mode > 0.0 and here == pieces[0]:
            yield sliding


def _slidings(problem: Problem) -> tuple[Sliding, ...]:
    with suppress(InputError):  # a law whose friction falls for ever
        return steady_slidings(problem).slidings
    return ()


def _load(problem: Problem, sliding: Sliding) -> float:
    """Return the load of steady sliding minus the reference strength, with its sign."""
    if problem.friction.states:
        return problem.body.total_damping * sliding.rate + sliding.traction - problem.strength
    resistance = Resistance(problem.friction, problem.body.total_damping, problem.normal, problem.law_slip)
    excess = float(resistance.excess(abs(sliding.rate)))
    return excess if math.copysign(1.0, sliding.rate) > 0.0 else -excess - 2.0 * problem.strength


def _states(law: FrictionLaw, sliding: Sliding) -> Floats:
    states = np.array(law.inner_states(sliding.states))
    if sliding.rate < 0.0:
        states[list(law.reverses)] *= -1.0
    return states


def stable_states(problem: Problem) -> Floats | None:
    """Return the states of friction, as the formulas use them, in a steady sliding that is stable; None without one."""
    return next((_states(problem.friction, one) for one in _slidings(problem) if one.stable is True), None)


STEADY_LEAPS: ByKind[SteadyLeaps] = ByKind("stickslip.engine.creep.drivers", DRIVER_KINDS)
"""The leaps by `Problem.driver_kind`: not of a machine or a driver that changes, before which nothing is leaped over."""
