"""Slabs and strings: their cycles start with the wave of a round trip, and waves must fade between one period and the next."""

from __future__ import annotations

import math
from collections.abc import Callable

from stickslip.engine import History
from stickslip.extensions.cycles.asked import CycleKind, not_steady
from stickslip.extensions.cycles.disturbed.growth_of_pair import growth_of_pair
from stickslip.extensions.cycles.exponent import MeasuredGrowth
from stickslip.extensions.cycles.growth_of_echoes import growth_of_echoes, tell_growth
from stickslip.extensions.cycles.waves.near import near_end
from stickslip.extensions.cycles.waves.orbit import WaveOrbit
from stickslip.extensions.cycles.waves.path import WavePath, path_of
from stickslip.problem import Problem, driver_impedance
from stickslip.problem.bodies import as_waves
from stickslip.problem.scenarios import ParameterPath, Scenario

FINITE, WITHOUT_MASS = "a driver of finite impedance", "a driver without driver_inertia"
"""What a driver needs that would send sharp waves back whole."""


def not_repeated(problem: Problem, cure_of_driver: str) -> str:
    """Return why nothing repeats itself, or each moment by itself, in a body with waves; empty if there is no such reason.

    `cure_of_driver` says what a driver needs that sends sharp waves back whole; empty if it does not.
    """
    law = problem.friction
    if why := not_steady(problem):
        return why
    if len(problem.driver_steps) > 1:
        return "the driver changes in time"
    if problem.far_stress_rate != 0.0:
        return "the far stress grows, so that nothing repeats itself"
    if not problem.body.has_inertia and not law.states:
        return (
            f"without a mass at the contact and under {type(law).__name__}, which has no states, each moment of the round trip"
            " moves by itself, and chaotically where r (1 - 2 Z / g') is above 1 in size; with"
            f" {problem.body.mass_field} above 0{cure_of_driver and ' and '}{cure_of_driver} they move together"
        )
    return ""


class CyclesOfUniform(CycleKind):
    """Answers of a uniform body with waves, whose runs may come to more pieces in each round trip."""

    most_pieces = 60_000
    may_be_cut = True

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        body = as_waves(problem.body)
        sends_whole = abs(body.front_reflection) >= 1.0
        has_mass = body.driver_inertia > 0.0 and math.isfinite(body.driver_inertia) and math.isfinite(body.driver_impedance)
        if why := not_repeated(problem, (WITHOUT_MASS if has_mass else FINITE) if sends_whole else ""):
            return why
        if driver_impedance(body).steady == 0.0:
            return "a dead load, or a driver that is one to slow motion, holds the body nowhere"
        if body.has_inertia and sends_whole:
            either = f" or {body.mass_field}" if problem.friction.states else ""
            cure = f"leave driver_inertia{either} out" if has_mass else "give the driver a finite impedance"
            return (
                f"the {'mass of the driver' if has_mass else 'driver'} sends sharp waves back whole, and so does the"
                f" {body.what_is_heavy}: they never fade, and no run comes to a cycle; {cure}"
            )
        return ""

    def near_end(self, history: History, problem: Problem, rtol: float) -> WaveOrbit:
        """Return the cycle near the end of a run. Raises InputError if there is none."""
        return near_end(history, problem, rtol)

    def path(self, orbit: WaveOrbit, scenario: Scenario, parameter: ParameterPath, span: float) -> WavePath:
        """Return the path of a cycle along a number of its scenario, over a span (SI) of it."""
        return path_of(orbit, scenario, parameter, span)

    def growth(self, problem: Problem, rtol: float) -> Callable[..., MeasuredGrowth]:
        """Return how disturbances of a run are followed: by echoes where each multiplies them by a number."""
        return growth_of_echoes if tell_growth(problem, rtol) else growth_of_pair


ANSWERS = CyclesOfUniform()
