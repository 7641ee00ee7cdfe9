"""Slabs and strings: their cycles start with the wave of a round trip, and waves must fade between one period and the next."""

from __future__ import annotations

from stickslip.engine import History
from stickslip.extensions.cycles.asked import CycleKind, not_steady
from stickslip.extensions.cycles.waves.near import near_end
from stickslip.extensions.cycles.waves.orbit import WaveOrbit
from stickslip.extensions.cycles.waves.path import WavePath, path_of
from stickslip.problem import Problem
from stickslip.problem.bodies import as_waves
from stickslip.problem.scenarios import ParameterPath, Scenario

OF_DRIVERS = {
    "damper": "cycles of a column that is damped are not found",
    "changing": "the driver changes in time",
}
"""Why no cycle is looked for, by kind of driver."""


def not_repeated(problem: Problem) -> str:
    """Return why nothing repeats itself, or each moment by itself, in a body with waves; empty if there is no such reason."""
    law = problem.friction
    if why := not_steady(problem) or OF_DRIVERS.get(problem.driver_kind, ""):
        return why
    if problem.far_stress_rate != 0.0:
        return "the far stress grows, so that nothing repeats itself"
    if not problem.body.has_inertia and not law.states:
        return (
            f"without a mass at the contact and under {type(law).__name__}, which has no states, each moment of the round trip"
            " moves by itself, and chaotically where r (1 - 2 Z / g') is above 1 in size"
        )
    return ""


class CyclesOfUniform(CycleKind):
    """Answers of a uniform body with waves, whose runs may come to more pieces in each round trip."""

    most_pieces = 60_000
    may_be_cut = True

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        body = as_waves(problem.body)
        if why := not_repeated(problem):
            return why
        if body.front_reflection == 1.0:
            return "a dead load holds the body nowhere"
        if body.has_inertia and abs(body.front_reflection) >= 1.0:
            return (
                f"the driver sends sharp waves back whole, and so does the {body.what_is_heavy}: they never fade, and no run comes"
                " to a cycle; give the driver a finite impedance"
            )
        return ""

    def near_end(self, history: History, problem: Problem, rtol: float) -> WaveOrbit:
        """Return the cycle near the end of a run. Raises InputError if there is none."""
        return near_end(history, problem, rtol)

    def path(self, orbit: WaveOrbit, scenario: Scenario, parameter: ParameterPath, span: float) -> WavePath:
        """Return the path of a cycle along a number of its scenario, over a span (SI) of it."""
        return path_of(orbit, scenario, parameter, span)


ANSWERS = CyclesOfUniform()
