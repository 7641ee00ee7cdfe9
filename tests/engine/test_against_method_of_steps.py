"""Random problems against scipy, one round trip at a time: another algorithm, another author."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.reference.method_of_steps import method_of_steps
from tests.engine import problems

KINDS = {
    "slab, slip law": lambda rng: (body := problems.slab(rng), problems.slip_law(rng, body)),
    "slab, rate law": lambda rng: (body := problems.slab(rng), problems.rate_law(rng, body)),
    "lossy slab, slip law": lambda rng: (
        body := problems.slab(rng, driver_impedance=float(10 ** rng.uniform(5, 8))),
        problems.slip_law(rng, body),
    ),
    "dead load, rate law": lambda rng: (body := problems.slab(rng, driver_impedance=0.0), problems.rate_law(rng, body)),
    "slab with mass, slip law": lambda rng: (body := problems.slab(rng, contact_mass=1e6), problems.slip_law(rng, body)),
    "slab with mass, rate law": lambda rng: (body := problems.slab(rng, contact_mass=1e6), problems.rate_law(rng, body)),
    "block, slip law": lambda rng: (body := problems.block(rng), problems.slip_law(rng, body)),
    "block, rate law": lambda rng: (body := problems.block(rng), problems.rate_law(rng, body)),
}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", KINDS)
def test_random_problem(kind: str, seed: int) -> None:
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


def away_from_jumps(run: ss.Solution, times: np.ndarray) -> np.ndarray:
    """Times that are not within a hair of a shock, where the two may stand on different sides."""
    shocks = run.shocks.time.to_numpy()
    if len(shocks) == 0:
        return np.ones(len(times), bool)
    return np.abs(times[:, None] - shocks).min(axis=1) > 1e-6 * run.duration
