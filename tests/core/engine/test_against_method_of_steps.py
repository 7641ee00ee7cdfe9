"""Every law under every body, and random problems, against scipy one round trip at a time, and by the balance of energy."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.friction import LAWS
from tests.core.engine import problems
from tests.core.engine.drawn import BODIES, SLAB, example_problem
from tests.core.engine.problems import KINDS, away_from_jumps
from tests.core.run.reference.method_of_steps import method_of_steps


@pytest.mark.sampled(every=78)
@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("body", BODIES)
def test_every_law_under_every_body_balances_energy_and_agrees_with_scipy(kind: str, body: str) -> None:
    problem = example_problem(kind, body)
    law = problem.friction
    duration = 2.2 * (problem.body.period if isinstance(problem.body, ss.SpringBlock) else SLAB.two_way_time)
    run = ss.simulate(problem, duration, rtol=1e-11)
    assert run.status.ok
    energy = run.energy(np.linspace(0, duration, 23))
    assert float(np.abs(energy.balance).max() / np.abs(energy.heat[-1])) < 1e-8
    massless = body == "slab" and law.depends_on_rate and kind not in ("coulomb", "hyperbolic-rate")
    if massless or law.state or kind == "velocity-strengthening" or (law.knots and law.knot_variable == "rate"):
        return  # beyond the slow method; the balance has spoken, and other tests look at each of these
    times = np.linspace(0.0, duration, 101)
    theirs = method_of_steps(problem, duration, rtol=1e-10).slip(times)
    assert np.ptp(theirs) > 0
    assert run.slip(times) == pytest.approx(theirs, rel=0.0, abs=1e-6 * np.ptp(theirs))


@pytest.mark.sampled(every=32)
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
