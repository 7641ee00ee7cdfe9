"""The error follows the tolerance; Coulomb friction is the limit of the hyperbolic law."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.reference.slab import PulseTrain
from tests.problems import IMPEDANCE, MODULUS, NORMAL, ROUND, SLAB, THICKNESS, slip_law_block, slip_law_slab

ALPHAS = 10.0 ** np.arange(1, 7)
DROP = 0.5


def test_slip_of_a_slab_tends_to_the_coulomb_limit_with_order_one() -> None:
    """It slides at (muS - muD) S / Z - 1 / alpha for one round trip: of Coulomb's slip the share alpha_c / alpha is missing."""
    slips = []
    for alpha in ALPHAS.tolist():
        problem = ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.8 - DROP, alpha), pull_rate=1e-14, initial_excess=0.0)
        slips.append(float(ss.simulate(problem, 2 * ROUND, rtol=1e-12).slip(2 * ROUND)))
    found = 1.0 - np.array(slips) * MODULUS / (2 * DROP * NORMAL * THICKNESS)
    assert found == pytest.approx(IMPEDANCE / (DROP * NORMAL) / ALPHAS, rel=2e-6, abs=0.0)


CASES = {
    "slab": (slip_law_slab(50.0, 1e-3, extra_load=3430.0, pull=0.0), 9.0),
    "block": (slip_law_block(5.0, MODULUS * 1e3), 3.0),
}


def error(problem: ss.Problem, duration: float, rtol: float, truth: ss.Solution) -> float:
    times = np.linspace(0.0, duration, 400)
    slip = truth.slip(times) - problem.initial_slip
    return float(np.max(np.abs(ss.simulate(problem, duration, rtol=rtol).slip(times) - problem.initial_slip - slip)) / np.ptp(slip))


@pytest.mark.parametrize("name", CASES)
def test_error_follows_tolerance(name: str) -> None:
    problem, duration = CASES[name]
    truth = ss.simulate(problem, duration, rtol=1e-15)
    tolerances = 10.0 ** np.arange(-5, -12, -1)
    errors = np.array([error(problem, duration, rtol, truth) for rtol in tolerances])
    slope = np.polyfit(np.log10(tolerances), np.log10(errors), 1)[0]
    assert 0.8 < slope < 1.3
    # the pulses amplify an error of the start by the ratio of their rates, here about 100
    assert np.all(errors < 100 * tolerances)


def test_pulses_under_constant_load_have_their_closed_form() -> None:
    """tan(theta / 2) moves uniformly under constant load: the slip is closed-form up to the first echo."""
    problem = slip_law_slab(50.0, 1e-3, extra_load=3430.0, pull=0.0)
    body = problem.body
    assert isinstance(body, ss.ElasticSlab)
    exact = PulseTrain(body.impedance, problem.load, 1e8, 1.0, 0.5, 50.0, problem.initial_slip)
    times = np.linspace(0.0, body.two_way_time, 300)
    run = ss.simulate(problem, body.two_way_time, rtol=1e-13)
    assert run.slip(times) == pytest.approx(exact.slip(times), rel=0.0, abs=2e-10 * 0.376)
    assert run.slip_rate(times) == pytest.approx(exact.slip_rate(times), rel=0.0, abs=2e-9 * exact.peak_rate)
