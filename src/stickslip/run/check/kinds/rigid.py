"""What `check` says of rigid bodies on a spring."""

from __future__ import annotations

import cmath
import math

from stickslip.contact import Uniqueness
from stickslip.foundation.names import si_unit
from stickslip.foundation.quantities import quantities_of
from stickslip.foundation.show import brief
from stickslip.friction import RateAndState
from stickslip.problem import Problem, driver_of, loading_rate
from stickslip.problem.bodies import BodyOnCharacteristics, as_on_spring
from stickslip.problem.scenarios import Scenario
from stickslip.run.check.asked import CHECK_DRIVERS, CheckOfKind, Fact
from stickslip.run.reference.rate_and_state import SteadySliding


class CheckOfRigid(CheckOfKind):
    """The answers of rigid bodies."""

    def numbers(self, problem: Problem) -> list[Fact]:
        """Return period, impedance and rate of loading, as far as there is a spring, and the largest force."""
        body, first = (
            problem.body,
            ", at first" if problem.loading_varies else ", outside the play" if problem.body.has_play else "",
        )
        size = math.sqrt(body.stiffness) * math.sqrt(body.inertia)
        loads = "K V + c dV/dt" if problem.loading_varies and as_on_spring(body).driver_damping else "K V"
        rate, unit = loading_rate(problem), problem.unit_of("load_rate")
        of_driver = [*CHECK_DRIVERS[problem.driver_kind].facts(problem, ""), *_force(problem)]
        if body.is_free:
            return of_driver
        return [
            Fact("period", body.round_trip_time, "s", "period 2 pi sqrt(m/K) of free oscillation"),
            Fact("sqrt(K m)", size, problem.unit_of("impedance"), f"impedance of the {body.noun}, in place of Z"),
            Fact(loads, rate, unit, f"rate of loading while stuck{first}"),
            *of_driver,
            *_play(problem),
            *_inertia(problem),
        ]

    def mass_on_ground(self, body: BodyOnCharacteristics) -> float:
        """Return the mass: its spring hangs on the ground, and is not stretched before it slips."""
        return body.inertia

    def stability(self, problem: Problem, by_slip: float, by_rate: float) -> str:
        """Return whether spring and friction hold a small swing, and whether damping and friction end it."""
        body = problem.body
        spring, dash = body.stiffness + body.normal_load * by_slip, body.total_damping + body.normal_load * by_rate
        swings = cmath.sqrt(dash * dash - 4 * body.inertia * spring)
        fastest = max((-dash + sign * swings for sign in (1, -1)), key=lambda root: root.real)
        growth = fastest / (2 * body.inertia)
        stiffness, impedance = si_unit("stiffness", body.load_unit), si_unit("impedance", body.load_unit)
        damping = "damping + driver_damping" if as_on_spring(body).driver_damping else "damping"
        values = f"K + S mu'(u) = {spring:.6g} {stiffness}, {damping} + S mu'(v) = {dash:.6g} {impedance}"
        if body.is_free and spring == 0.0:
            return f"no spring holds it, and friction does not change with slip: {damping} + S mu'(v) = {dash:.6g} {impedance}"
        if spring < 0 or (growth.real > 0 and growth.imag == 0):
            return f"unstable: {values}; a small disturbance grows at {growth.real:.6g} /s"
        if growth.real > 0:
            return f"oscillates with growing amplitude: {values}; growth {growth.real:.6g} /s"
        loose = "; in the play no spring holds it" if body.has_play else ""
        return f"statically stable: {values}{loose}"

    def warnings(self, scenario: Scenario, contact: Uniqueness) -> list[str]:
        """Return a warning of a steady pull, or of a force, that does not make the body slip, where nothing else can."""
        problem = scenario.problem
        if first_slip(problem) > scenario.duration:
            return ["the run ends before the play is taken up and the load reaches the static strength: nothing will slip"]
        rests = problem.friction.sticks and not problem.has_initial_rate and problem.ground is None
        if problem.force_in_time is None or not rests or problem.normal_varies or problem.pull_rate != 0.0:
            return []
        most = problem.load + problem.force_in_time.highest
        least = problem.load + problem.force_in_time.lowest
        if most > problem.strength or (least < -problem.strength and not problem.one_way):
            return []
        return ["the force never reaches the static strength: nothing will slip"]

    def critical_stiffness(self, body: BodyOnCharacteristics, sliding: SteadySliding) -> tuple[str, float] | None:
        """Return the stiffness of the spring beside the one that mass and damping ask for."""
        return "stiffness K", sliding.critical_stiffness(body.inertia, body.total_damping)


def first_slip(problem: Problem) -> float:
    """Return when (s) a steady pull has taken up the play and the static strength; 0 without a play, or where more than it acts."""
    body, rate = as_on_spring(problem.body), problem.first_pull_rate
    alone = not (problem.loading_varies or problem.ground or problem.force) and problem.friction.sticks
    if not (problem.body.has_play and alone and rate) or problem.has_initial_rate:
        return 0.0
    strength = problem.strength if rate > 0.0 else problem.backward_strength
    stretch = (strength - body.driver_damping * abs(rate)) / problem.body.stiffness + 0.5 * body.backlash
    return max(stretch / abs(rate) - float(driver_of(problem).numbers(problem)["first_lag"]) / rate, 0.0)


def _play(problem: Problem) -> list[Fact]:
    """Return how far the pulled end moves in vain where the pull turns, and when slip begins under a steady pull."""
    body, wait = problem.body, first_slip(problem)
    if not body.has_play:
        return []
    lost = as_on_spring(body).backlash + (problem.strength + problem.backward_strength) / body.stiffness
    meaning = "way of the pulled end from slip one way to slip the other: the backlash, and the stretch that friction holds"
    begins = Fact("first slip", wait, "s", "when the play is taken up and the load reaches the static strength")
    return [Fact("lost motion", lost, problem.unit_of("slip"), meaning), *([begins] if wait else [])]


LITTLE = 1e-9
"""A share (1) of inertia that nobody measures: a block with so little moves as a spring without mass does."""


def _inertia(problem: Problem) -> list[Fact]:
    """Return what the mass does to slow sliding under rate-and-state friction, and a mass that is as good as none."""
    body, law, rate = problem.body, problem.friction, abs(problem.first_pull_rate)
    if not isinstance(law, RateAndState) or rate == 0.0:
        return []
    share = SteadySliding(problem.normal, law.a, law.b, law.distance, rate).inertia_of(body.inertia, body.total_damping)
    small = brief(body.inertia * LITTLE / share, quantities_of(type(body))[body.mass_field].unit, 3)
    none = f"{small} would by {LITTLE:g}, as a spring without mass does"
    return [Fact("inertia", share, "1", f"share that the mass adds to the critical stiffness of slow sliding; {none}")]


def _force(problem: Problem) -> list[Fact]:
    """Return the largest and the least force on the body, if it varies."""
    force, unit = problem.force_in_time, problem.load_unit
    if force is None or force.lowest == force.highest:
        return []
    return [
        Fact("largest force", force.highest, unit, "of the straight parts, with the amplitude of the sinusoid"),
        Fact("least force", force.lowest, unit, "of the straight parts, less that amplitude"),
    ]


ANSWERS = CheckOfRigid()
