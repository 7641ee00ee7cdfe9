"""What the engine is told of a uniform body with waves: what slip sends out comes back once, from the driver."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine.input.asked import InputOfBody, Shaken
from stickslip.engine.input.first_pieces import pieces_of
from stickslip.engine.state import layout as at
from stickslip.problem import Problem, driver_of, steady_inflow, wave_before


class InputOfUniform(InputOfBody):
    """Answers of a uniform body with waves."""

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the smallest jump of the slip rate (m/s), and when the inflow is heard first: at once on ground that moves."""
        jump, heard = smallest_jump(problem), problem.body.inflow_delay if problem.ground is None else 0.0
        return {"smallest_jump": jump, "inflow_from": heard}

    def steady_numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the inflow, its growth, and that of the load at rest in a round trip."""
        return steady_numbers(problem)

    def first_load(self, problem: Problem) -> at.Floats:
        """Return one straight piece under a rigid driver; behind another, what it sends back of the start is heard from h/c on."""
        body, excess = problem.body, problem.excess
        slope = body.impedance * problem.initial_shear / (0.5 * body.round_trip_time)  # G (V - v0) / h
        if body.is_driven_rigidly:
            return pieces_of([0.0, body.round_trip_time], [excess], [slope])
        r, half = body.reflection, 0.5 * body.round_trip_time
        steady, rate = steady_inflow(problem)
        # for h/c <= t < R the waves of the initial state come back: w(t - R) = G (V - v0) (R - t) / h - (load - 2 Z v0)
        reflected = steady + rate * half + r * (slope * half - wave_before(problem))
        before = excess + slope * half
        jump = jumps(problem, reflected, before)
        return pieces_of(
            [0.0, half, 2.0 * half], [excess, np.where(jump, reflected, before)], [slope, rate - r * slope], [0.0, jump]
        )

    def first_load_varying(self, problem: Problem) -> at.Floats:
        """Return the load until the driver is heard, and then what it sends back of the start, perhaps changing meanwhile.

        Whether the load jumps when it is first heard depends on what it sends, too; other jumps are those of the loading.
        """
        body, driver, trip = problem.body, driver_of(problem), problem.round_trip_time
        half = 0.5 * trip
        slope = body.impedance * problem.initial_shear / half
        phases = driver.first_phases(problem, half)
        share = driver.first_share(problem, phases)
        back = share * (slope * (trip - phases) - wave_before(problem))
        jump = jumps(problem, back[0] + driver.first_sent(problem, half), problem.excess + slope * half)
        sudden = [0.0, float(jump), *np.zeros(len(phases) - 1)]
        return pieces_of([0.0, *phases, trip], [problem.excess, *back], [slope, *(-share * slope)], sudden)

    def on_ground(self, problem: Problem) -> Shaken:
        """Return the inflow of driver and ground together."""
        from stickslip.engine.input.shaking import Shaking  # here, because few runs move the ground

        return Shaking.of(problem)


def jumps(problem: Problem, after: Any, before: Any) -> Any:
    """Return True if a load (Pa) before some moment and after it differ by more than rounding."""
    return abs(after - before) > 1e-12 * np.maximum(abs(problem.strength), abs(before))


def smallest_jump(problem: Problem) -> Any:
    """Return the smallest jump of the slip rate (m/s) of a body with waves that is none of rounding."""
    return 1e-14 * problem.normal / problem.body.impedance


def steady_numbers(problem: Problem) -> dict[str, Any]:
    """Return the numbers of a loading of a body with waves that does not vary."""
    inflow, growth = steady_inflow(problem)
    return {"inflow": inflow, "inflow_rate": growth, "ramp": driver_of(problem).ramp(problem)}


ANSWERS = InputOfUniform()
