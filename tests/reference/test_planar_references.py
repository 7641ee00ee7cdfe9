"""The two reference methods of the planar slab against each other, the engine in 1D, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.reference.planar import (
    LawAtNodes,
    PlanarCase,
    PlanarSeries,
    SlipWeakeningAtNodes,
    Volume,
    convolution,
    volume,
)
from stickslip.reference.planar.closed_forms import (
    CRITICAL_PATCH,
    SteadyFront,
    growth_rate_on_half_space,
    growth_rate_on_slab,
    linear_fracture_energy,
)
from stickslip.reference.slab.growth_rate import growth_rate
from tests.reference.planar_cases import slip_difference, weakening_patch, weakening_plane

METHODS = (volume, convolution)
Method = Callable[[PlanarCase, float, int], PlanarSeries]


def test_uniform_slip_is_that_of_the_engine_in_1d() -> None:
    """The paper's slab, reconstructed: slip 0.376105283 m, arrest at R. Both methods are of order 2, and equal to rounding."""
    problem = replace(ss.load_scenario("fig5-slab-reconstructed").problem, pull_rate=0.0)
    body, R = problem.body, problem.body.two_way_time
    run = ss.simulate(problem, 1.1 * R)
    friction = LawAtNodes(problem.friction, np.full(2, body.normal_stress), problem.initial_slip)
    load = np.full(2, float(run.load(0.0)))
    case = PlanarCase(body.density, body.wave_speed, body.thickness, (1e4,), load, friction)
    errors = []
    for steps in (1600, 3200):
        found = volume(case, 1.1 * R, steps)
        exact = run.slip(found.times[[steps // 2, steps]]) - problem.initial_slip
        errors.append(np.abs(found.slip[[steps // 2, steps], 0] - exact).max())
        assert not found.slip_rate[steps + 1 :].any()
        assert found.slip[-1] == pytest.approx(np.full(2, 0.376105283), rel=2e-5)
    assert errors[1] < 1e-6
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert convolution(case, 1.1 * R, 1600).slip == pytest.approx(volume(case, 1.1 * R, 1600).slip, rel=1e-11, abs=1e-13)


@pytest.mark.parametrize("method", METHODS)
def test_uniform_slip_under_a_pull_and_under_other_drivers_is_that_of_the_engine(method: Method) -> None:
    """Rate strengthening over three round trips, against `simulate`: rel 1e-4 of the largest slip."""
    law = ss.friction.FromExpression("0.5 + 0.2*v/(0.1 + v)")
    for impedance, pull in ((math.inf, 0.05), (0.0, 0.0), (3e6, 0.0)):
        body = ss.ElasticSlab(2800.0, 3500.0, 1e4, normal_stress=1e8, driver_impedance=impedance)
        run = ss.simulate(ss.Problem(body, law, initial_load=5.6e7, pull_rate=pull), 17.0)
        friction = LawAtNodes(law, np.full(2, 1e8))
        case = PlanarCase(2800.0, 3500.0, 1e4, (1e4,), np.full(2, 5.6e7), friction, impedance, pull_rate=pull)
        found = method(case, 17.0, 200)
        exact = run.slip(found.times)
        assert found.slip[:, 1] == pytest.approx(exact, abs=1e-4 * exact.max())
        smooth = np.abs(found.times % (0.5 * body.two_way_time)) > 0.05
        assert found.slip_rate[smooth, 1] == pytest.approx(run.slip_rate(found.times[smooth]), abs=2e-3 * run.slip_rate(0.0))


@pytest.mark.parametrize("driver_impedance", [math.inf, 0.3, 0.0])
def test_methods_agree_and_the_difference_falls_by_order_two(driver_impedance: float) -> None:
    """Weakening, echoes and arrest: the difference is 7e-4 of the largest slip at 128 steps in R, and falls with an order above 1."""
    case = weakening_patch(32, driver_impedance)
    coarse, fine = (slip_difference(volume(case, 6.0, n), convolution(case, 6.0, n)) for n in (64, 128))
    assert fine < 1e-3
    assert coarse / fine > 2.0
