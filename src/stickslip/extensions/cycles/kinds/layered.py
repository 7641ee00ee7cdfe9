"""Bodies of layers: their cycles start with the waves in all cells, and waves must fade between one period and the next."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from stickslip.extensions.cycles.disturbed.growth_of_pair import growth_of_pair
from stickslip.extensions.cycles.exponent import MeasuredGrowth
from stickslip.extensions.cycles.kinds.uniform import FINITE, CyclesOfUniform, not_repeated
from stickslip.extensions.cycles.waves.orbit import WaveOrbit
from stickslip.extensions.cycles.waves.path import WavePath
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.bodies import OfLayers
from stickslip.problem.scenarios import ParameterPath, Scenario

OF_DRIVERS = {"machine": "cycles behind layers and a machine with a motion of its own are not found"}
"""Why no cycle is looked for, by kind of driver."""
TRIED_SHARE = 1e-6
"""A number is changed by this share (1) to see whether travel times change beside each other."""


class CyclesOfLayered(CyclesOfUniform):
    """Answers of a body of layers."""

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        body = cast(OfLayers, problem.body)
        sends_whole = any(abs(one.reflection) == 1.0 for one in body.stacks)
        if why := not_repeated(problem, FINITE if sends_whole else "") or OF_DRIVERS.get(problem.driver_kind, ""):
            return why
        if all(one.reflection == 1.0 for one in body.stacks):
            return "a dead load holds the body nowhere"
        if problem.body.has_inertia and sends_whole:
            where = "the driver sends" if len(body.stacks) == 1 else "a driver sends"
            drags = "; drag is lumped between cells, and leaves waves that rest there" if body.has_drag else ""
            return (
                f"{where} sharp waves back whole, and so does the {body.what_is_heavy}: they never fade, and no run comes"
                f" to a cycle{drags}; give the driver a finite impedance"
            )
        return ""

    def path(self, orbit: WaveOrbit, scenario: Scenario, parameter: ParameterPath, span: float) -> WavePath:
        """Return the path of a cycle along a number of its scenario, over a span (SI) of it.

        Raises InputError if the number changes how travel times compare: the cells that layers are cut into then change in steps.
        """
        number = scenario.problem.parameters[parameter.name]
        before, after = (
            cast(OfLayers, one.body).cells for one in (scenario.problem, number.put(number.value * (1.0 + TRIED_SHARE)))
        )
        if before.counts != after.counts or abs(after.error - before.error) > 1e-3 * TRIED_SHARE:
            raise InputError(
                f"follow: {parameter.name} changes how the travel times compare, and so, in steps, the cells that the layers are"
                " cut into: follow a number that leaves them, such as an impedance or the pull rate, or find the cycles one by one"
            )
        return super().path(orbit, scenario, parameter, span)

    def growth(self, problem: Problem, rtol: float) -> Callable[..., MeasuredGrowth]:
        """Return how disturbances of a run are followed: by two runs."""
        return growth_of_pair


ANSWERS = CyclesOfLayered()
