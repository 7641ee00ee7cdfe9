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
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip.contact.asked import CONTACT_KINDS, ContactOfKind, SteadyDrive, Withstood
from stickslip.contact.disturbance import Modes
from stickslip.contact.folds import Certificate, certificate
from stickslip.contact.roots import sign_change
from stickslip.contact.sliding import RATES, Sliding, StabilityChange, SteadySlidings
from stickslip.contact.steady_friction import SteadyFriction
from stickslip.contact.steady_proof import ChangeBetween, proven_changes
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import LoadingHistory, Problem, Resistance, driver_of
from stickslip.problem.bodies import BodyOnCharacteristics

CRAWL, SAME = 1e-300, 1e-9
"""A slip rate (m/s) next to rest; tractions that differ by less than this (relative) are equal."""


@lru_cache(maxsize=64)
def steady_slidings(problem: Problem) -> SteadySlidings:
    """Find the steady sliding of a contact under the loading of a problem (at the start if it varies), and its stability."""
    return replace(_Steady(_driven(problem)).found(), problem=problem)


def _driven(problem: Problem) -> Problem:
    """Return the problem with the law of slip in the direction of the drive, if friction differs by direction."""
    return problem.facing(-1 if problem.friction.backward_from and _Steady(problem).drive < 0.0 else 1)


@lru_cache(maxsize=64)
def proven_slidings(problem: Problem) -> SteadySlidings:
    """Find what `steady_slidings` does, with proof for laws with a state where there is one, in 0.3 s to some seconds."""
    return _Steady(problem, proves=True).found() if problem.friction.states else steady_slidings(problem)


def steady_traction(problem: Problem, rates: Floats) -> Floats:
    """Return the size of the traction (Pa or N) of steady sliding at slip rates (m/s) in the direction of the drive."""
    steady = _Steady(_driven(problem))
    return np.array([steady.traction(rate) for rate in rates.tolist()])


def slip_rate_at(problem: Problem, pull_rate: float) -> float | None:
    """Return the fastest slip rate (m/s, without its sign) of steady sliding at another pull rate (m/s); None if there is none."""
    return max(_Steady(_driven(replace(problem, pull_rate=pull_rate))).rates(), default=None)


@dataclass(frozen=True)
class _Steady:
    """The search for steady sliding of one problem; slip rates in it are magnitudes, in the direction of the drive."""

    problem: Problem
    proves: bool = False
    """True if a proof is wanted under a law with a state, too."""

    @cached_property
    def kind(self) -> ContactOfKind[Any, Any]:
        """What the kind of body answers."""
        return CONTACT_KINDS[self.problem.body.structure]

    @property
    def pressed(self) -> tuple[BodyOnCharacteristics, float]:
        """The body and the normal load on its contact (Pa, N or N m)."""
        return self.problem.body, self.problem.normal

    @cached_property
    def driver(self) -> SteadyDrive:
        """What driver, far stress and drag do to a contact at a steady rate."""
        return self.kind.steady_drive(self.problem.body)

    @property
    def is_soft(self) -> bool:
        """True if the driver gives way in the long run."""
        return math.isfinite(self.driver.resists)

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
        held = self.problem.body.held_at_start(self.problem.rate, self.problem.initial_shear)
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
        rests = self.far_stress is not None and bool(abs(self.drive) <= strength)
        damped = not slidings or bool(problem.friction.states) or self.withstood.fall > 0.0 or problem.body.total_damping > 0.0
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
        swings = problem.body.inertia or problem.body.has_machine or problem.body.is_damped
        if self.varies or (problem.friction.states and not self._starts_steadily) or (swings and changes):
            return False
        if self.kind.overshoots(problem.body) and not self._starts_steadily:
            return False
        if problem.friction.sticks and not math.isclose(problem.strength, abs(self.traction(CRAWL)), rel_tol=SAME):
            return False
        return self._starts_steadily or abs(problem.load) <= max(abs(sliding.traction), problem.strength) * (1.0 + SAME)

    def why_none(self) -> str:
        """Return why nothing slides steadily, "" if something may."""
        problem, law = self.problem, self.problem.friction
        first = " at first" if problem.loading_varies else ""
        if problem.far_stress_rate and "far_stress_rate" not in driver_of(problem).unfelt:
            return "the far stress keeps changing"
        if not_sought := self.kind.not_sought(problem.body):
            return not_sought
        if self.drive == 0.0:
            return f"nothing pulls{first}"
        if law.states and law.steady_state(1.0) is None:
            return f"{type(law).__name__} does not say in which state it slides steadily"
        return "friction keeps changing with slip" if self.friction.changes_with_slip else ""

    @property
    def _lost(self) -> float:
        """The stress over velocity (Pa s/m) that drag takes while a driver that gives way moves at the pull rate."""
        return self.driver.resists - self.driver.by_pull if self.is_soft else 0.0

    def _at_pull_rate(self) -> float:
        pull = self.problem.first_pull_rate
        return math.copysign(self.traction(abs(pull)), pull) + self._lost * pull if pull else math.nan

    @cached_property
    def friction(self) -> SteadyFriction:
        """What the law does after a long way."""
        return SteadyFriction(self.problem, self.drive)

    def traction(self, rate: float) -> float:
        """Return the traction (Pa, N or N m) of steady sliding at a slip rate (m/s)."""
        return self.friction.traction(rate)

    def modes(self, rate: float, *, patient: bool = False) -> Modes:
        """Return the disturbances of steady sliding at a slip rate (m/s)."""
        found: Modes = self.kind.modes(*self.pressed, self.friction.response(rate), patient=patient)
        return found

    def sliding(self, rate: float) -> Sliding:
        """Return steady sliding at a slip rate (m/s), with its stability."""
        modes, sign = self.modes(rate, patient=True), math.copysign(1.0, self.drive)
        growth = modes.growth()
        period = 2.0 * math.pi / growth.frequency if growth.frequency else math.inf
        stable, unit = modes.verdict, self.problem.load_unit
        if (stable is True and growth.rate > 0.0) or (stable is False and growth.rate <= 0.0):
            stable, growth, period = None, growth._replace(rate=math.nan), math.inf  # they contradict each other: not decided
        return Sliding(sign * rate, sign * self.traction(rate), self.friction.states(rate)[0], stable, growth.rate, period, unit)

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
        return Resistance(self.problem.friction, damping, self.problem.normal, self.friction.slip, self.problem.load_unit)

    def changes(self) -> tuple[tuple[StabilityChange, ...], bool]:
        """Return where stability changes along the slip rate, and whether it is proven that it changes nowhere else."""
        law = self.problem.friction
        if law.states:
            return self._changes_under_states()
        fall, is_known = self.withstood
        if not law.depends_on_rate or not math.isfinite(fall):
            return (), True
        proof, g = self.turns(fall), self.resistance(fall)
        if proof is None:
            return (), False
        found, rates = [], proof.rates
        for k, rate in enumerate(rates):
            beyond = 0.5 * (rate + rates[k + 1]) if k + 1 < len(rates) else 2.0 * rate
            found.append(self._change(rate, bool(g.slope(beyond) > 0.0), proof.enclosure(rate)))
        return tuple(found), proof.verdict == "proven" and is_known

    @cached_property
    def withstood(self) -> Withstood:
        """How steeply friction may fall with the slip rate without making sliding unstable."""
        return self.kind.withstood(*self.pressed)

    def _changes_under_states(self) -> tuple[tuple[StabilityChange, ...], bool]:
        law, ends = self.problem.friction, (float(RATES[0]), float(RATES[-1]))
        judge = self.kind.judge(*self.pressed, len(law.states)) if self.proves else None
        proven = proven_changes(judge, law, self.friction.slip, ends) if judge else None
        found = self._searched() if proven is None else proven
        enclosures = [one[:2] if proven else None for one in found]
        edges = [(self.kind.edge(self.modes, *one), one.stable_above) for one in found]
        return tuple(self._change(*edge, within) for edge, within in zip(edges, enclosures, strict=True)), proven is not None

    def _searched(self) -> list[ChangeBetween]:
        """Return the slip rates (m/s) between which stability changes under a law with states."""
        verdicts = ((rate, self.kind.is_surely_stable(*self.pressed, self.friction.response(rate))) for rate in RATES.tolist())
        known = [(rate, stable) for rate, stable in verdicts if stable is not None]
        return [ChangeBetween(low, high, after) for (low, before), (high, after) in pairwise(known) if before != after]

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
