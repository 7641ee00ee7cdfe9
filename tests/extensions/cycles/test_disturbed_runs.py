"""How disturbances grow by two runs that differ a little: beside multipliers of cycles, shifts in time, and other ways."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.disturbed.growth_of_pair import growth_of_pair
from stickslip.extensions.cycles.disturbed.pair import Measure, Pair
from stickslip.extensions.cycles.exponent import MeasuredGrowth
from tests.extensions.cycles.problems import rate_and_state

TRIP = 2.0 * 1770.0 / math.sqrt(61e9 / 7850.0)


def string(**changes: Any) -> ss.Problem:
    """Return the bundled drill string with other numbers, by their paths with two underscores."""
    problem = ss.load_scenario("drill-string").problem
    for name, value in changes.items():
        problem = problem.parameters[name.replace("__", ".")].put(value)
    return problem


def grown(problem: ss.Problem, skip: float, duration: float) -> MeasuredGrowth:
    """Return the growth in a pair of runs."""
    return growth_of_pair(problem, skip, duration, 1e-10, lambda text: None)


def test_the_exponent_of_a_string_on_a_cycle_is_its_multiplier_over_its_period() -> None:
    """The multiplier is that of `test_cycles_of_waves`, by Arnoldi's iteration: to 1e-3."""
    found = ss.studies.lyapunov(string(body__driver_impedance=2000.0, loading__pull_rate=8.95), 400.0, skip=60.0)
    assert found.exponent == pytest.approx(math.log(0.9101) / 5.336266, rel=1e-3)
    assert "measured on two runs that differ by 1e-06" in found.text


def test_a_pair_of_runs_of_a_rigid_body_tells_what_the_equation_of_disturbances_does() -> None:
    """To the standard error."""
    cycle = ss.studies.cycle(rate_and_state())
    found = grown(cycle.problem, 0.0, 60.0 * cycle.period)
    wanted = math.log(abs(cycle.multipliers[0])) / cycle.period
    assert abs(found.exponent - wanted) < found.error
    assert found.exponent == pytest.approx(wanted, rel=0.02)


MACHINE = {"body__driver_impedance": 2000.0, "body__driver_inertia": 800.0, "body__driver_integral_gain": 300.0}


@pytest.mark.parametrize(
    "problem",
    [string(), string(**MACHINE), ss.load_scenario("pipe-and-collar").problem, rate_and_state()],
    ids=["rigid drive", "machine", "layers", "rigid body"],
)
def test_a_shift_in_time_is_no_disturbance(problem: ss.Problem) -> None:
    """A run that is 1e-6 of a trip ahead stays so, and all but 1e-4 of that is taken away; the machine's motion is differenced."""
    pair = Pair.begin(problem, 60.0 * min(problem.round_trip_time, 100.0), 1e-11, shifts=True)
    for _ in range(12):
        pair.differ_by(pair.apart(pair.stand, Measure.of(pair.run))[0].times(0.0))
        pair.lead()
    measure = Measure.of(pair.run)
    measure.see(pair.stand)
    ahead = pair.flow(measure).times(1e-6 * pair.interval)
    whole = np.linalg.norm(measure.scaled(ahead, pair.stand))
    pair.differ_by(ahead)
    for _ in range(6):
        pair.lead()
    assert pair.apart(pair.stand, measure)[1] < 1e-4 * whole
