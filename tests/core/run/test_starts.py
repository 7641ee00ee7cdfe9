"""What `check` says about starts that are chosen for a user is what the run then does."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.run.check.examine import examine
from stickslip.run.check.starts import chosen_starts

COULOMB = ss.friction.Coulomb(0.6, 0.4)
SLAB = ss.ElasticSlab(2800.0, 3500.0, 100.0, 1e6)
SOFT = replace(SLAB, driver_impedance=0.5 * SLAB.impedance)
GAIN = replace(SOFT, driver_integral_gain=1e6)
HEAVY = replace(GAIN, driver_inertia=1e5)
LAYERS = ss.LayeredSlab([30.0, 70.0], [2000.0, 2800.0], [1500.0, 3500.0], 1e6, driver_impedance=2e6, drag=[1e3, 2e3])
JOINED = ss.TwoSlabs([30.0], [2000.0], [1500.0], [70.0], [2800.0], [3500.0], 1e6, driver_impedance=2e6, sides="joined")
APART = replace(JOINED, sides="apart")
HISTORY = ss.loading.Steps([0.0, 1.0], [0.01, 0.02])
ROCK = ss.friction.RateAndState(0.6, 0.010, 0.008, "1 um")
SHEARED = (
    "the slab is being sheared evenly, from 0 m/s at the contact to 10 mm/s at the driver, as if it had been pulled so for long"
)


def problem(body: Any = SLAB, law: Any = COULOMB, **fields: Any) -> ss.Problem:
    return ss.Problem(body, law, **({"pull_rate": 0.01, "initial_load": 5.9e5} | fields))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("made", "said"),
    [
        (problem(), SHEARED),
        (problem(pull_rate=HISTORY), "before the start the pull rate has its value of 0 s"),
        (problem(SOFT), "the far stress is not given: it holds the stress in the slab at the start, 590 kPa"),
        (problem(LAYERS), "it holds the stress in the slab at the start, 590 kPa, and what drag takes"),
        (problem(LAYERS), "the stress grows from the contact to the driver by what drag takes, 1.35078 kPa"),
        (problem(SOFT, far_stress=6.2e5), "the far stress is 620 kPa at first, beside 590 kPa in the slab: the difference"),
        (problem(GAIN, far_stress=6.2e5), "beside 590 kPa in the slab: the difference comes to the contact as a jump"),
        (problem(HEAVY, far_stress=6.2e5), "beside 590 kPa in the slab: the difference accelerates the driver"),
        (problem(HEAVY), "the driver begins at 10 mm/s, the pull rate, and its integral gain has nothing to make up for yet"),
        (problem(GAIN, far_stress=6.2e5), "the driver begins at 12.0408 mm/s, at which the forces on it balance, and"),
        (problem(replace(SOFT, driver_inertia=math.inf)), "the driver is rigid, because its mass is infinite: its impedance"),
        (problem(JOINED), "the two sides share the load and the far stress in proportion to their stiffness: 0.234375 to 0.765625"),
        (problem(APART), "mm/s at the driver and from 2.34375 mm/s at the contact to 0 m/s at the driver, as if they had"),
        (problem(ground_acceleration=ss.loading.PiecewiseLinear([0, 1, 2], [0, 1, 0])), "before the start the ground is at rest"),
        (problem(law=ROCK, initial_load=None, initial_rate="steady"), "the load and the states are those of steady sliding: "),
        (problem(law=ROCK, initial_load=None, initial_rate="steady"), "the whole slab moves at 10 mm/s, as the contact does"),
        (
            problem(far_stress=1.0, driver_reflection=ss.loading.Steps([0, 1], [-1, -1])),
            "the far stress is not felt, because the driver is rigid all along",
        ),
        (
            problem(law=ss.friction.LinearSlipWeakening(0.6, 0.5, 1.0, memory="since-arrest"), initial_slip=0.3),
            "the start counts as an arrest, since which friction remembers no slip",
        ),
    ],
)  # fmt: skip
def test_each_start_that_is_chosen_is_said_in_one_line(made: ss.Problem, said: str) -> None:
    lines = examine(Scenario(made, 1.0)).chosen
    assert len([line for line in lines if said in line]) == 1
    assert all("\n" not in line for line in lines)


@pytest.mark.parametrize("body", [SOFT, GAIN, JOINED, replace(LAYERS, drag=None)])
def test_the_far_stress_that_is_said_to_be_chosen_makes_the_same_run(body: Any) -> None:
    left_out = problem(body)
    given = replace(left_out, far_stress=5.9e5)
    assert not [line for line in chosen_starts(given) if "far stress is" in line]
    runs = [ss.simulate(one, 2.0) for one in (left_out, given)]
    assert runs[0].slip(2.0) > 1e-3
    np.testing.assert_allclose(*(run.slip(np.linspace(0.0, 2.0, 21)) for run in runs), rtol=1e-9, atol=1e-12)
    other = ss.simulate(replace(left_out, far_stress=9e5), 2.0)
    assert abs(other.slip(2.0) - runs[0].slip(2.0)) > 1e-5


def test_joined_sides_bear_the_shares_of_load_and_far_stress_that_are_printed() -> None:
    first, other = (float(word) for word in chosen_starts(problem(JOINED))[1].split(": ")[1].split(" to "))
    both = replace(JOINED, other_driver_impedance=2e6)
    run = ss.simulate(problem(both, pull_rate=0.0, initial_load=4e5, far_stress=5e5), 40.0)
    start = run.field(np.array([15.0, -35.0]), 1e-4).stress
    np.testing.assert_allclose(start, np.array([first, other]) * 4e5, rtol=1e-5)
    settled = run.field(np.array([15.0, -35.0]), 39.0).stress  # what drivers do has come to rest
    np.testing.assert_allclose(settled, np.array([first, other]) * 5e5, rtol=1e-5)
    np.testing.assert_allclose(first / other, (2000 * 1500**2 / 30) / (2800 * 3500**2 / 70), rtol=1e-5)


def test_the_velocity_and_the_driver_that_are_said_are_those_of_the_run() -> None:
    run = ss.simulate(problem(GAIN, far_stress=6.2e5), 1.0)
    places = np.array([0.0, 25.0, 75.0])
    np.testing.assert_allclose(run.field(places, 0.0).velocity, 1e-4 * places, rtol=1e-9, atol=1e-15)
    assert float(run.field(100.0, 1e-9).velocity) == pytest.approx(12.0408e-3, rel=1e-5)
    apart = ss.simulate(problem(APART), 1.0).field(np.array([15.0, -35.0, -69.999]), 1e-9).velocity
    np.testing.assert_allclose(apart, [1e-3 * (2.34375 + 10.0) / 2, 1e-3 * 2.34375 / 2, 0.0], rtol=1e-6, atol=1e-7)
