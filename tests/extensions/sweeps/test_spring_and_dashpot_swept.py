"""The dashpot beside a block's spring is swept as any number is, in a batch under a constant pull and else one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, Sinusoidal
from tests.core.problem.loading.on_dashpot import BLOCK, LAW

SINE = Sinusoidal(0.1, 0.3, 1.7, 0.4)


@pytest.mark.parametrize("pull", [0.1, SINE], ids=["batch", "one by one"])
def test_members_of_a_sweep_over_it_are_single_runs(pull: LoadingHistory | float) -> None:
    problem = ss.Problem(BLOCK, LAW, pull_rate=pull, initial_load=4.0)
    dampings = [0.0, 1.0, 7.0]
    found = ss.sweep(problem, {"body.driver_damping": dampings}, duration=12.0, quantities=["slip", "peak_rate"])
    runs = [ss.simulate(replace(problem, body=replace(BLOCK, driver_damping=c)), 12.0) for c in dampings]
    slips = np.array([float(run.slip(12.0)) for run in runs])
    assert np.ptp(slips) > 1e-3
    assert found["slip"].to_numpy() == pytest.approx(slips, rel=1e-9)
