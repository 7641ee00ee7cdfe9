"""Members of a batch leap over creep and lump events as single runs do."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.sweeps.batch import run_members
from stickslip.problem.run_status import STATUSES
from tests.core.engine.creep_truth import printed

DAYS = 3 * 86_400.0


@cache
def creeping(pull_rate: float, rtol: float = 1e-10) -> ss.Solution:
    return ss.simulate(replace(printed(1), pull_rate=pull_rate), DAYS, rtol)


@pytest.mark.slow
def test_a_member_of_a_batch_leaps_as_a_single_run() -> None:
    """Members that creep for long are run alone, the others are not changed by that."""
    scenario = replace(ss.load_scenario("fig5-slab-printed"), duration=DAYS)
    pulls = np.array([0.0, 1.0]) * scenario.problem.pull_rate
    found = run_members(scenario, {"loading.pull_rate": pulls}, ("events", "slip", "peak_time"))
    for n, pull in enumerate(pulls):
        run = creeping(float(pull))
        assert STATUSES[int(found.status[n])] == run.status
        assert found.results["events"][n] == len(run.events)
        peak = run.events.peak_time[run.events.peak_rate.idxmax()]
        assert found.results["peak_time"][n] == pytest.approx(peak, rel=1e-14, abs=0.0)
        slip = float(run.slip(run.duration)) - run.problem.initial_slip
        assert found.results["slip"][n] == pytest.approx(slip, rel=2e-14, abs=1e-14)


WEAKENING = ss.load_scenario("fig6-slab").problem


def weakening(alpha: float, thickness: float = 1e4) -> ss.Problem:
    """The slab of Fig. 6 with another alpha (s/m), below 0.196 regular, and thickness (m)."""
    return replace(WEAKENING, friction=replace(WEAKENING.friction, alpha=alpha), body=replace(WEAKENING.body, thickness=thickness))


def test_a_member_of_a_batch_lumps_as_a_single_run() -> None:
    problem, end = weakening(0.15, thickness=1e3), 9.0
    whole = ss.simulate(problem, end)
    scenario = replace(ss.load_scenario("fig6-slab"), problem=problem, duration=end)
    found = run_members(scenario, {"friction.alpha": np.array([1.0, 0.15])}, ("events", "slip"))
    slip = float(whole.slip(end)) - problem.initial_slip
    assert found.results["slip"][1] == pytest.approx(slip, rel=1e-12, abs=0.0)
    assert found.results["events"][1] == len(whole.events)
