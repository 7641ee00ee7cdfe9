"""Cycles of slabs and strings: runs come to them at the pace that the multipliers say, and their energies balance."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.section import onsets


def string(share: float, pull: float) -> ss.Problem:
    """Return the bundled drill string behind a drive whose impedance is so many times its own, at a pull rate (rad/s)."""
    problem = ss.load_scenario("drill-string").problem
    body = replace(problem.body, driver_impedance=share * problem.body.impedance)
    return replace(problem, body=body, pull_rate=pull)


@cache
def found(share: float, pull: float) -> LimitCycle:
    return ss.studies.cycle(string(share, pull), near=70.0)


@pytest.mark.parametrize(("share", "pull"), [(10.0, 2.0 * np.pi), (4.0, 9.0)])
def test_a_plain_run_of_the_problem_comes_to_the_cycle(share: float, pull: float) -> None:
    """To 1e-8 of the period and of the greatest slip rate, or as near as its slowest disturbance lets it in 900 s."""
    run = ss.simulate(string(share, pull), 900.0, 1e-12)
    times, cycle = onsets(run.history).time, found(share, pull)
    fades = abs(cycle.multipliers[0]) ** (len(times) - 4)
    assert np.diff(times)[-3:] == pytest.approx(np.full(3, cycle.period), rel=1e-8 + fades)
    at = np.linspace(0.1, 0.6, 11) * cycle.period
    own = cycle.run.slip_rate(cycle.begin + at)
    assert run.slip_rate(times[-3] + at) == pytest.approx(own, abs=(1e-8 + 10.0 * fades) * cycle.greatest_rate)
