"""Random problems against scipy, one round trip at a time: another algorithm, another author."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference.method_of_steps import method_of_steps
from tests.engine import problems
from tests.engine.problems import KINDS
from tests.engine.shocks import away_from_jumps


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", KINDS)
def test_slip_and_rate_of_random_problems_agree_with_scipy(kind: str, seed: int) -> None:
    rng = np.random.default_rng([seed, *kind.encode()])
    body, law = KINDS[kind](rng)
    problem = problems.problem(rng, body, law)
    duration = problems.duration(body, 2.3)
    ours, theirs = ss.simulate(problem, duration), method_of_steps(problem, duration, rtol=1e-10)
    times = np.linspace(0.0, duration, 241)
    slipped = theirs.slip(times) - problem.initial_slip
    assert np.ptp(slipped) > 0.0
    assert ours.status.ok
    difference = np.abs(ours.slip(times) - problem.initial_slip - slipped)
    assert difference.max() <= 2e-7 * np.ptp(slipped)
    away = away_from_jumps(ours, times)
    rates = theirs.slip_rate(times)
    assert np.abs(ours.slip_rate(times) - rates)[away].max() <= 2e-6 * np.abs(rates).max()
