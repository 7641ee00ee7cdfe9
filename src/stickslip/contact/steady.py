"""Steady sliding: the possible slip rates of a contact in steady sliding, their stability, and where it changes.

A contact that slides at a constant rate v, at the traction S mu(v) of its steady states, balances a driver of impedance Zd and
far stress s if

    Zd v + S mu(v) = s + Zd V

so it slides at the pull rate V if the driver is rigid, or moves a block's spring, and in general at another rate if the driver
gives way. Drag of layers adds to Zd on the left, not on the right. Without states a disturbance fades if and only if friction falls
with the slip rate less steeply than the body damps, S mu'(v) > -D: D is the damping of a block, 0 under a rigid driver, and
min(Zd, Z^2/Zd) of any other driver under a contact without mass. The critical rates are then the turns of D v + S mu(v). All of
them are found, with proof.

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343; Campillo et al. 1996, eqs (7)-(13), for the slab.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip.contact.crossing import crossing
from stickslip.contact.disturbance import Disturbed, Response
from stickslip.contact.folds import Certificate, certificate
from stickslip.contact.layer_response import SteadyDrive, driven_steadily, response_of, taken_by_layers
from stickslip.contact.roots import sign_change
from stickslip.contact.sliding import RATES, Sliding, StabilityChange, SteadySlidings
from stickslip.contact.steady_proof import proven_changes
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import value_and_slopes
from stickslip.problem import LoadingHistory, Problem, Resistance
from stickslip.problem.bodies import OfLayers

FAR = (0.0, 0.37, 1e3)
"""Steady sliding requires that friction does not change with slip over these distances (m)."""
CANCELLED = 1e-14
"""Rounding of a slope of a state's rate by the slip rate, relative to its terms."""
SURE = 1e-12
"""Stability at a rate counts as known if this relative change of the normal load does not change it."""
PATIENT = 1 << 20
"""Largest number of pieces in which the roots of one motion on layers are counted, a second or two of work."""
BELOW = 1e-4
"""What layers withstand is checked by a count of roots under a fall of friction that is smaller by this share (1)."""
CRAWL, SAME = 1e-300, 1e-9
"""A slip rate (m/s) next to rest; tractions that differ by less than this (relative) are equal."""


@lru_cache(maxsize=64)
def steady_slidings(problem: Problem) -> SteadySlidings:
    """Find the steady sliding of a contact under the loading of a problem (at the start if it varies), and its stability."""
    return _Steady(problem).found()


@lru_cache(maxsize=64)
def proven_slidings(problem: Problem) -> SteadySlidings:
    """Find what `steady_slidings` does, with proof for laws with a state where there is one, in 0.3 s to some seconds."""
    return _Steady(problem, proves=True).found() if problem.friction.states else steady_slidings(problem)


def steady_traction(problem: Problem, rates: Floats) -> Floats:
    """Return the size of the traction (Pa or N) of steady sliding at slip rates (m/s) in the direction of the drive."""
    steady = _Steady(problem)
    return np.array([steady.traction(rate) for rate in rates.tolist()])


def slip_rate_at(problem: Problem, pull_rate: float) -> float | None:
    """Return the fastest slip rate (m/s, without its sign) of steady sliding at another pull rate (m/s); None if there is none."""
    return max(_Steady(replace(problem, pull_rate=pull_rate)).rates(), default=None)


@dataclass(frozen=True)
class _Steady:
    """The search for steady sliding of one problem; slip rates in it are magnitudes, in the direction of the drive."""

    problem: Problem
    proves: bool = False
    """True if a proof is wanted under a law with a state, too."""

    @cached_property
    def is_soft(self) -> bool:
        """True if the driver gives way in the long run: an integral gain does not."""
        body = self.problem.body
        return math.isfinite(self.driver.resists) and not body.is_driven_rigidly and body.driver_integral_gain == 0.0

    @cached_property
    def driver(self) -> SteadyDrive:
        """What driver, far stress and drag do to a contact at a steady rate."""
        body = self.problem.body
        if isinstance(body, OfLayers):
            return driven_steadily(body)
        return SteadyDrive(body.driver_impedance + body.damping - body.impedance, body.driver_impedance)

    @property
    def varies(self) -> bool:
        """True if what pulls or presses the contact varies in time."""
        return self.problem.loading_varies or self.problem.normal_varies

    @cached_property
    def far_stress(self) -> float | None:
        """The stress far beyond the driver (Pa); None if the driver is rigid, or if the contact starts in steady sliding.

        Unless it is given it holds the load of the start, and what drag takes then.
        """
        far, problem = self.problem.far_stress, self.problem
        if not self.is_soft or (far is None and self._starts_steadily):
            return None
        if far is None:
            return problem.stress + self._held_at_start
        return far.first if isinstance(far, LoadingHistory) else far

    @property
    def _held_at_start(self) -> float:
        """The stress (Pa) that drag takes between the contact and the far stresses at the start."""
        problem, body = self.problem, self.problem.body
        if not isinstance(body, OfLayers):
            return 0.0
        rates = body.rates_at_start(problem.rate, problem.initial_shear)
        held = [float(one.held(*both)[-1]) for one, both in zip(body.stacks, rates, strict=True)]
        return sum(share * one for share, one in zip(self.driver.shares, held, strict=True))

    @property
    def _starts_steadily(self) -> bool:
        return self.problem.initial_load is None and self.problem.initial_excess is None

    @cached_property
    def drive(self) -> float:
        """The load that steady sliding balances, with its sign: s + Zd V (Pa), or V (m/s) if the contact slides at that rate."""
        pull = self.problem.first_pull_rate
        return pull if self.far_stress is None else self.far_stress + self.driver.by_pull * pull

    def found(self) -> SteadySlidings:
        problem, why = self.problem, self.why_none()
        rates = [] if why else self.rates()
        if not (why or rates):
            why = "the driver does not pull hard enough to keep the contact sliding"
        slidings = tuple(self.sliding(rate) for rate in rates)
        changes, proven = ((), False) if why else self.changes()
        far = self.far_stress
        if self.is_soft and far is None and slidings:
            far = slidings[0].traction + self._lost * slidings[0].rate
        strength = problem.strength if problem.friction.sticks else 0.0
        rests = self.far_stress is not None and abs(self.drive) <= strength
        damped = bool(problem.friction.states) or self.taken_away > 0.0
        return SteadySlidings(
            pull_rate=problem.first_pull_rate,
            far_stress=far,
            slidings=slidings,
            changes=changes,
            can_rest=rests and not why,
            proven=proven,
            sticks=problem.friction.sticks,
            varies=problem.loading_varies,
            is_damped=damped,
            traction_at_pull_rate=self._at_pull_rate() if slidings else math.nan,
            why_none=why,
            unit=problem.load_unit,
            is_calm=bool(slidings) and self.is_calm(slidings[0], changes),
            problem=problem,
        )

    def is_calm(self, sliding: Sliding, changes: tuple[StabilityChange, ...]) -> bool:
        """Return True if a contact that starts like this one comes to the steady sliding at no more than its rate.

        Friction at rest is that of very slow sliding, the load is no larger than that of steady sliding, and the states are those
        of it. A contact with mass may overshoot: then no rate may be unstable.
        """
        problem = self.problem
        swings = problem.body.inertia or problem.body.has_machine
        if self.varies or (problem.friction.states and not self._starts_steadily) or (swings and changes):
            return False
        if problem.friction.sticks and not math.isclose(problem.strength, abs(self.traction(CRAWL)), rel_tol=SAME):
            return False
        return self._starts_steadily or abs(problem.load) <= max(abs(sliding.traction), problem.strength) * (1.0 + SAME)

    def why_none(self) -> str:
        """Return why nothing slides steadily, "" if something may."""
        problem, law = self.problem, self.problem.friction
        first = " at first" if problem.loading_varies else ""
        if problem.far_stress_rate and not problem.is_driven_rigidly:
            return "the far stress keeps changing"
        if problem.body.has_machine and not problem.body.is_uniform:
            return "not sought for layers behind a driver with a mass or an integral gain"
        if self.drive == 0.0:
            return f"nothing pulls{first}"
        if law.states and law.steady_state(1.0) is None:
            return f"{type(law).__name__} does not say in which state it slides steadily"
        return "friction keeps changing with slip" if self._changes_with_slip() else ""

    def _changes_with_slip(self) -> bool:
        law, states = self.problem.friction, self.states(1.0)[1]
        slips = self.slip + math.copysign(1.0, self.drive) * np.array(FAR)
        formulas = [(law.trees()[i], law.numbers(i)) for i in self.pieces]
        formulas += [(tree, law.numbers(self.pieces[0])) for tree in law.state_trees()]
        return any(value_and_slopes(tree, numbers, slips, 1.0, *states)[1][0].any() for tree, numbers in formulas)

    @property
    def _lost(self) -> float:
        """The stress over velocity (Pa s/m) that drag takes while a driver that gives way moves at the pull rate."""
        return self.driver.resists - self.driver.by_pull if self.is_soft else 0.0

    def _at_pull_rate(self) -> float:
        pull = self.problem.first_pull_rate
        return math.copysign(self.traction(abs(pull)), pull) + self._lost * pull if pull else math.nan

    # ---- the law --------------------------------------------------------------------------------------------------------------

    @cached_property
    def pieces(self) -> tuple[int, ...]:
        """The pieces of the law that steady sliding may be on: after a long way, a law of slip is on its last one."""
        law = self.problem.friction
        if law.knot_variable == "rate" or not law.knots:
            return tuple(range(len(law.pieces)))
        return (0,) if self.drive < 0.0 and law.counts == "net" else (len(law.pieces) - 1,)

    @cached_property
    def slip(self) -> float:
        """A slip (m) of the law in the piece of steady sliding."""
        law = self.problem.friction
        if law.knot_variable == "rate" or not law.knots:
            return self.problem.law_slip
        return law.knots[-1] if self.pieces[0] else float(np.nextafter(law.knots[0], -math.inf))

    def states(self, rate: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the states of steady sliding at a slip rate (m/s): as users see them, and as formulas use them."""
        law = self.problem.friction
        found = law.steady_state(rate) if law.states else None
        seen = () if found is None else tuple(np.ravel(found).tolist())
        return seen, law.inner_states(seen)

    def traction(self, rate: float) -> float:
        """Return the traction (Pa, N or N m) of steady sliding at a slip rate (m/s)."""
        mu = self.problem.friction.coefficient(self.slip, rate, one_argument(self.states(rate)[1]))
        return self.problem.normal * float(mu)

    def response(self, rate: float) -> Response:
        """Return how friction responds to a disturbance of steady sliding at a slip rate (m/s).

        With w' = f(v, w) it is Phi = mu_v + mu_w (s - f_w)^-1 f_v.
        """
        law, states = self.problem.friction, self.states(rate)[1]
        piece = int(law.piece_at(self.slip, rate))
        numbers, at, many = law.numbers(piece), (self.slip, rate, *states), len(states)
        slopes = value_and_slopes(law.trees()[piece], numbers, *at)[1]
        if not many:
            return Response(slopes[1:2], np.ones(1))
        evolve = np.array([value_and_slopes(tree, numbers, *at)[1] for tree in law.state_trees()])
        matrix, forced, felt = evolve[:, 2:], evolve[:, 1], slopes[2:]
        # a difference of nearly equal terms is rounding, as for friction that is the same at any rate
        forced = np.where(np.abs(forced) * rate > CANCELLED * np.abs(np.diag(matrix) * states), forced, 0.0)
        below = np.real(np.poly(matrix))[::-1]
        above = np.zeros(many)
        above[-1] = felt @ forced
        if many == 2:  # the adjugate of s - f_w is s + f_w - trace
            above[0] = felt @ (matrix - np.trace(matrix) * np.eye(2)) @ forced
        return Response(np.append(above, 0.0) + slopes[1] * below, below)

    def disturbed(self, rate: float) -> Disturbed:
        return Disturbed(self.problem.body, self.problem.normal, self.response(rate))

    def sliding(self, rate: float) -> Sliding:
        """Return steady sliding at a slip rate (m/s), with its stability."""
        disturbed, sign = replace(self.disturbed(rate), pieces=PATIENT), math.copysign(1.0, self.drive)
        growth = disturbed.growth()
        period = 2.0 * math.pi / growth.frequency if growth.frequency else math.inf
        stable, unit = disturbed.is_stable(), self.problem.load_unit
        if (stable is True and growth.rate > 0.0) or (stable is False and growth.rate <= 0.0):
            stable, growth, period = None, growth._replace(rate=math.nan), math.inf  # they contradict each other: not decided
        return Sliding(sign * rate, sign * self.traction(rate), self.states(rate)[0], stable, growth.rate, period, unit)

    # ---- the rates ------------------------------------------------------------------------------------------------------------

    def rates(self) -> list[float]:
        """Return the slip rates (m/s) of steady sliding, ascending."""
        if self.far_stress is None:
            return [abs(self.drive)]
        load, slope = abs(self.drive), self.driver.resists
        fastest = min(2.0 * load / slope, RATES[-1]) if slope > 0.0 else RATES[-1]
        proof = None if self.problem.friction.states else self.turns(slope)
        turns = RATES.tolist() if proof is None else proof.rates
        places = [RATES[0] * 1e-6, *(rate for rate in turns if rate < fastest), fastest]

        def miss(rate: float) -> float:
            return slope * rate + self.traction(rate) - load

        misses = [miss(place) for place in places]
        ends = zip(places[:-1], places[1:], misses[:-1], misses[1:], strict=True)
        return [sign_change(miss, low, high) for low, high, one, other in ends if (one < 0.0) != (other < 0.0)]

    # ---- stability ------------------------------------------------------------------------------------------------------------

    def turns(self, damping: float) -> Certificate | None:
        """Return where `damping` v + S mu(v) turns, for a law without states; None if it turns too often to be followed."""
        try:
            return certificate(self.resistance(damping))
        except InputError:
            return None

    def resistance(self, damping: float) -> Resistance:
        return Resistance(self.problem.friction, damping, self.problem.normal, self.slip, self.problem.load_unit)

    def changes(self) -> tuple[tuple[StabilityChange, ...], bool]:
        """Return where stability changes along the slip rate, and whether it is proven that it changes nowhere else."""
        law = self.problem.friction
        if law.states:
            return self._changes_under_states()
        taken = self.taken_away
        if not law.depends_on_rate or not math.isfinite(taken):
            return (), True
        proof, g = self.turns(taken), self.resistance(taken)
        if proof is None:
            return (), False
        found, rates = [], proof.rates
        for k, rate in enumerate(rates):
            beyond = 0.5 * (rate + rates[k + 1]) if k + 1 < len(rates) else 2.0 * rate
            found.append(self._change(rate, bool(g.slope(beyond) > 0.0), proof.enclosure(rate)))
        return tuple(found), proof.verdict == "proven" and not self._is_searched

    @property
    def _is_searched(self) -> bool:
        """True if what the waves take away is not known in closed form."""
        body = self.problem.body
        return body.has_machine or not (body.is_uniform or body.is_driven_rigidly)

    def _changes_under_states(self) -> tuple[tuple[StabilityChange, ...], bool]:
        problem = self.problem
        ends = (float(RATES[0]), float(RATES[-1]))
        proves = self.proves and problem.body.is_uniform and not problem.body.has_machine
        found = proven_changes(problem.body, problem.normal, problem.friction, self.slip, ends) if proves else None
        if found is None:
            return tuple(self._change(rate, above, None) for rate, above in self._searched()), False
        return tuple(self._change(self._edge(*one), one.stable_above, (one.low, one.high)) for one in found), True

    @cached_property
    def taken_away(self) -> float:
        """The steepest fall of friction with the slip rate (Pa s/m, N s/m or N m s) under which steady sliding is stable."""
        body = self.problem.body
        if not body.has_waves:
            return body.damping
        if body.driver_inertia > 0.0 and not body.has_inertia:
            return body.damping - body.impedance  # a mass sends sharp fronts back whole
        if body.has_machine:
            return _largest(lambda fall: self._withstands(fall), self._surely_falls())
        dragged = isinstance(body, OfLayers) and body.has_drag
        if not dragged and (body.is_driven_rigidly or not (self.is_soft or isinstance(body, OfLayers))):
            return body.damping - body.impedance
        if isinstance(body, OfLayers):
            heavy = body.inertia > 0.0
            return _largest(self._withstands, self._surely_falls_on_layers(body)) if heavy else self._taken_by_layers(body)
        driver, own = body.driver_impedance, body.impedance
        if not body.has_inertia:
            return body.damping - own + min(driver, own * own / driver if driver else 0.0)
        return _largest(lambda fall: self._withstands(fall), driver + body.damping - own)

    def _taken_by_layers(self, body: OfLayers) -> float:
        """Return the same for layers without a mass at the contact: found by sampling, and checked by a count of roots.

        A count decides nothing where a root is as good as on the axis, so it is made a little below.
        """
        found = taken_by_layers(body)
        return found if found == 0.0 or self._withstands(found * (1.0 - BELOW)) else _largest(self._withstands, found)

    def _surely_falls(self) -> float:
        """Return a fall of friction with the slip rate (Pa s/m) that a slab under a machine does not withstand.

        A disturbance exp(t/R) grows under it: friction gives what body, waves and machine take at s = 1/R.
        """
        body, s = self.problem.body, 1.0 / self.problem.round_trip_time
        machine = body.driver_inertia * s + body.driver_impedance + body.driver_integral_gain / s
        echo = math.exp(-1.0) * (body.impedance - machine) / (body.impedance + machine)
        return body.impedance * (1.0 - echo) / (1.0 + echo) + body.inertia * s + body.damping - body.impedance

    def _surely_falls_on_layers(self, body: OfLayers) -> float:
        """Return the same for layers and a mass at the contact."""
        s = 1.0 / body.two_way_time
        above, below = response_of(body, np.array([s], complex))
        return float((above[0] / below[0]).real) + body.inertia * s

    def _withstands(self, fall: float) -> bool:
        """Return True if sliding is stable where friction falls with the slip rate by `fall` (Pa s/m)."""
        response = Response(np.array([-fall / self.problem.normal]), np.ones(1))
        return Disturbed(self.problem.body, self.problem.normal, response).is_stable() is True

    def _searched(self) -> list[tuple[float, bool]]:
        """Return the slip rates (m/s) where stability changes under a law with states, and whether sliding is stable above each."""
        known = [(rate, stable) for rate in RATES.tolist() if (stable := self._surely_stable(rate)) is not None]
        return [(self._edge(low, high, after), after) for (low, before), (high, after) in pairwise(known) if before != after]

    def _surely_stable(self, rate: float) -> bool | None:
        """Return whether sliding is stable; None if rounding decides: a little more or less normal load changes the answer."""
        body, response = self.problem.body, self.response(rate)
        if isinstance(body, OfLayers):
            return Disturbed(body, self.problem.normal, response).is_stable()
        more, less = (
            Disturbed(body, self.problem.normal * share, response).is_stable() is True for share in (1.0 + SURE, 1.0 - SURE)
        )
        return more if more == less else None

    def _edge(self, low: float, high: float, stable_above: bool) -> float:
        """Return the slip rate (m/s) between two others where stability changes."""
        if isinstance(self.problem.body, OfLayers):
            return crossing(self.disturbed, low, high, stable_above)
        return sign_change(lambda rate: 1.0 if (self.disturbed(rate).is_stable() is True) == stable_above else -1.0, low, high)

    def _change(self, rate: float, stable_above: bool, enclosure: Any) -> StabilityChange:
        return StabilityChange(rate, self._pull_rate(rate), stable_above, enclosure, self.problem.load_unit)

    def _pull_rate(self, rate: float) -> float | None:
        """Return the pull rate (m/s) that makes the contact slide steadily at a slip rate, None if there is none."""
        if self.far_stress is None:
            return rate
        driver = self.driver
        if driver.by_pull == 0.0:
            return None
        sign = math.copysign(1.0, self.drive)
        return (sign * (driver.resists * rate + self.traction(rate)) - self.far_stress) / driver.by_pull


def _largest(holds: Callable[[float], bool], high: float) -> float:
    """Return the largest number between 0 and `high` that satisfies a condition, by bisection; all smaller ones satisfy it."""
    low = 0.0
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return low
        low, high = (middle, high) if holds(middle) else (low, middle)
