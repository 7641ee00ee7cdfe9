"""What a planar slab does not follow is refused by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from tests.core.problem.bodies.dashpot import SLAB as DAMPED

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e3, 1e8)
LAW = ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1)
STILL = ss.Problem(SLAB, LAW, pull_rate=0.03, initial_load=5e7)
MACHINE = replace(SLAB, driver_impedance=5e6, driver_inertia=1e6, driver_integral_gain=1e6)
PRESSED = replace(STILL, normal_load=ss.loading.Steps([0.0, 1.0], [1e8, 9e7]))
SHAKEN = replace(STILL, ground_velocity=ss.loading.Sinusoidal(mean=0.0, amplitude=0.1, period=1.0))
FREED = replace(STILL, far_stress=0.0, driver_reflection=ss.loading.Steps([0.0, SLAB.two_way_time], [-1.0, 1.0]))
WAYS = replace(STILL, friction=ss.friction.BothWays(forward=LAW, backward=ss.friction.LinearSlipWeakening(0.4, 0.3, 0.1)))
ROUGH = ss.Problem(SLAB, ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3), initial_load=3e7, initial_state=1e3)


@pytest.mark.parametrize(
    ("problem", "message"),
    [
        (replace(STILL, body=MACHINE), r".*mass or an integral gain is followed in 1D only"),
        (replace(STILL, body=DAMPED), r"PlanarSlab: a dashpot at the contact is followed in 1D only: set contact_damping to 0$"),
        (
            ss.load_scenario("drill-string").problem,
            r"PlanarSlab: body must be .*: a string is a line, and the top of a column is free$",
        ),
        (FREED, r"PlanarSlab: a driver that changes is followed in 1D only: leave driver_reflection"),
        (SHAKEN, r"PlanarSlab: ground that moves is followed at one place only: leave it out$"),
        (WAYS, r"PlanarSlab: friction of BothWays differs with the direction of slip, which planar slabs do not follow$"),
        (PRESSED, r"PlanarSlab: .*normal_load"),
        *(
            (ss.load_scenario(name).problem, r"PlanarSlab: ")
            for name in ("low-velocity-zone", "steel-on-granite", "pipe-and-collar")
        ),
    ],
)
def test_a_problem_that_is_of_one_place_alone_is_refused_in_one_line(problem: ss.Problem, message: str) -> None:
    with pytest.raises(ss.InputError, match=f"^{message}") as refused:
        ss.PlanarSlab(problem, nodes=16, length=9e3)
    assert "\n" not in str(refused.value)


def test_the_problem_that_these_differ_from_is_taken() -> None:
    assert ss.PlanarSlab(STILL, nodes=16, length=9e3).nodes == 16


def test_a_fault_whose_a_crosses_the_limit_is_refused_by_name() -> None:
    with pytest.raises(ss.InputError, match="the formula of friction would differ from node to node"):
        ss.PlanarSlab(ROUGH, nodes=8, length=1e4, along={"friction.a": np.full(8, 1e-4)})


def test_a_rate_law_with_folds_is_refused_with_the_cure_and_taken_with_it() -> None:
    ill = ss.load_scenario("fig6-slab").problem
    with pytest.raises(
        ss.InputError, match=r"HyperbolicRate is irregular.*with a lag \(the law 'lagged', see docs/rate-law-on-a-fault"
    ) as refused:
        ss.PlanarSlab(ill, nodes=16, length=9e3)
    assert "\n" not in str(refused.value)
    lagged = ss.Problem(ill.body, ss.friction.LaggedFriction(ill.friction, time=0.1), initial_load=7e7)
    assert ss.PlanarSlab(lagged, nodes=16, length=9e3).nodes == 16
