"""Every step carries a bound of what it lacks: the bound holds, and the law is met where coefficients of a series vanish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import stickslip as ss
from stickslip.engine.input.prepare import SHARE_OF_TOLERANCE, first_disc
from stickslip.engine.state.layout import Counts
from tests.core.engine.certified_runs import RUNS, coefficient, duration, shortfall

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
Floats = NDArray[np.float64]

# ---- the bound ------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("make", RUNS)
def test_no_step_lacks_more_than_its_bound(make: Callable[[int], ss.Problem]) -> None:
    """Less the rounding of terms; a bound a million times smaller would be exceeded somewhere."""
    shares = []
    for seed, rtol in ((0, 1e-4), (1, 1e-4), (2, 1e-4), (0, 1e-6), (1, 1e-6), (2, 1e-8)):
        problem = make(seed)
        run = ss.simulate(problem, duration(problem), rtol)
        assert run.status.ok
        real, bound = shortfall(run.history, coefficient(problem))
        known = np.isfinite(bound)
        assert np.count_nonzero(~known) == run.proven.unproven
        assert (real <= bound)[known].all(), f"seed {seed}, rtol {rtol}: pieces {np.flatnonzero(real > bound)}"
        shares.append(np.max((real / np.maximum(bound, 1e-300))[known], initial=0.0))
    assert max(shares) > 1e-6


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("make", RUNS)
def test_a_step_that_is_bent_by_a_thousandth_exceeds_its_bound(make: Callable[[int], ss.Problem]) -> None:
    """The test above would notice it: in more than half of the pieces in which slip is faster than its rounding."""
    problem = make(1)
    run = ss.simulate(problem, duration(problem), 1e-7)
    wrong = run.history.store._replace(pieces=run.history.store.pieces.copy())
    size = np.abs(wrong.rate).sum(axis=1)
    wrong.rate[:, 1] += 1e-3 * size
    wrong.rate[:, 2] -= 1e-3 * size
    real, bound = shortfall(replace(run.history, store=wrong), coefficient(problem))
    slips = (size > 1e-6 * size.max())[wrong.mode != 0]
    assert (real > bound)[slips].mean() > 0.5


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_first_disc_is_the_one_that_serves_the_run(rtol: float) -> None:
    """It is within one of the disc on which the last step of the transit of Fig. 5 was proven."""
    scenario = ss.load_scenario("fig5-slab-reconstructed")
    run = ss.simulate(scenario.problem, scenario.problem.round_trip_time, rtol)
    assert run.checkpoint is not None
    assert abs(Counts(run.checkpoint.count).disc - int(first_disc(rtol * SHARE_OF_TOLERANCE))) <= 1


# ---- what follows from it -------------------------------------------------------------------------------------------------


def off_the_law(solution: ss.Solution, times: Floats) -> float:
    """Largest |traction / normal stress - mu(u, v)| at times of slip."""
    law, rate = solution.problem.friction, solution.slip_rate(times)
    miss = np.abs(np.abs(solution.traction(times)) / 1e8 - law.coefficient(solution.slip(times), np.abs(rate)))
    return float(np.max(np.where(rate != 0.0, miss, 0.0)))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("power", [4, 8, 20])
@pytest.mark.parametrize("start", [0.0, 1e-6, 1e-3])
def test_the_contact_equation_is_met_where_the_last_coefficients_are_next_to_nothing(power: int, start: float) -> None:
    """Under u^n the last two coefficients vanish, or are tiny from a small slip on, and those before are not: a step far too long.

    Law met to 1e-10; by the last coefficients alone it is missed by up to 6e-2, and slip grows beyond all measure for n = 8.
    """
    law = F.FromExpression(f"0.6 + 0.05*u**{power}")
    solution = ss.simulate(ss.Problem(SLAB, law, initial_slip=start, initial_excess=1e7), 2.0)
    assert solution.status.ok
    assert off_the_law(solution, np.linspace(0.0, 2.0, 2001)) < 1e-10


@pytest.mark.slow
def test_bounds_hold_for_a_long_formula() -> None:
    """Seven wide bumps beside a narrow one: `radii` works out the values at the centre itself. The narrow one was jumped over."""
    wide = "".join(f"+0.001*exp(-((u-{centre})/0.5)**2)" for centre in range(3, 10))
    problem = ss.Problem(SLAB, F.FromExpression(f"0.6+0.05*exp(-((u-1)/1e-3)**2){wide}"), initial_excess=1.2e7)
    real, bound = shortfall(ss.simulate(problem, 3.0).history, coefficient(problem))
    assert (real <= bound).all()


def test_the_residual_bounds_the_error_of_slip() -> None:
    """Under friction of the slip rate alone |e'| <= |g| / q, where q is the smallest Z + S dmu/dv on the way: 1.7e-13 m (10 %)."""
    scenario = ss.load_scenario("fig6-slab")
    problem, run = scenario.problem, ss.simulate(scenario.problem, scenario.duration)
    event = run.events.iloc[0]
    rates = run.slip_rate(np.linspace(0.0, event.end, 1001)[:-1])
    slopes = [problem.friction.slopes(0.0, rate)[1] for rate in np.unique(rates)]
    q = problem.body.impedance + problem.normal * min(slopes)
    assert q == pytest.approx(0.804 * problem.body.impedance, rel=0.01, abs=0.0)
    assert run.proven.residual * event.duration / q == pytest.approx(1.7e-13, rel=0.1, abs=0.0)
    assert event.slip == pytest.approx(23.44, rel=1e-3, abs=0.0)
