"""What a user asks of a solution: limits at shocks, tables, bad questions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.progress import Report
from tests.problems import (
    IMPEDANCE,
    NORMAL,
    RATE_LAW,
    ROUND,
    SLAB,
    rate_law_slab,
    slip_law_slab,
)

F = ss.friction


def test_a_shock_has_two_limits() -> None:
    run = ss.simulate(rate_law_slab(), 12.0)
    time = run.shocks.time.iloc[1]
    assert float(run.slip_rate(time, side="left")) == pytest.approx(4.1020408203, rel=1e-9, abs=0.0)
    assert float(run.slip_rate(time)) == 0.0
    assert float(run.traction(time, side="left")) > 0 > float(run.traction(time))
    assert float(run.load(0.0, side="left")) == 8e7
    assert float(run.traction(0.0, side="left")) == 8e7


def test_readings_have_the_shape_of_their_times() -> None:
    run = ss.simulate(rate_law_slab(), 6.0)
    assert run.slip(1.0).shape == ()
    assert run.slip([1.0, 2.0]).shape == (2,)
    assert run.slip_rate(np.zeros((2, 3))).shape == (2, 3)


def test_slip_is_absolute() -> None:
    run = ss.simulate(slip_law_slab(5.0, 1e-3), 1.0)
    assert float(run.slip(0.0)) == run.problem.initial_slip


@pytest.mark.parametrize("time", [-1.0, 7.0, np.nan])
def test_times_outside_the_run_are_refused(time: float) -> None:
    run = ss.simulate(rate_law_slab(), 6.0)
    with pytest.raises(ss.InputError, match="between 0 and the end"):
        run.slip(time)


def test_unknown_sides_and_curves_are_refused() -> None:
    run = ss.simulate(rate_law_slab(), 6.0)
    with pytest.raises(ss.InputError, match="side must be"):
        run.slip_rate(1.0, side="middle")  # type: ignore[arg-type]
    with pytest.raises(ss.InputError, match="did you mean 'slip_rate'"):
        run.curve("sliprate")  # type: ignore[arg-type]


def test_curve_has_both_limits() -> None:
    time, rate = ss.simulate(rate_law_slab(), 12.0).curve("slip_rate")
    assert np.all(np.diff(time) >= 0)
    at_arrest = rate[time == ROUND]
    assert at_arrest.max() > 4.1
    assert at_arrest.min() == 0.0


def test_excess_zero_without_pull_stays_stuck() -> None:
    run = ss.simulate(replace(rate_law_slab(), pull_rate=0.0), 100.0)
    assert run.status.name == "locked for ever"
    assert run.status.ok
    assert len(run.events) == 0
    assert float(run.slip(100.0)) == 0.0


@pytest.mark.parametrize(("static", "dynamic"), [(0.6, 0.3), (0.7, 0.3), (0.9, 0.2), (0.35, 0.1)])
@pytest.mark.parametrize("pull", [0.0, -1e-9])
def test_coulomb_at_its_strength_is_not_pushed_over_it_by_rounding(static: float, dynamic: float, pull: float) -> None:
    for load in ({"initial_excess": 0.0}, {"initial_load": static * NORMAL}, {"initial_load": -static * NORMAL}):
        if pull < 0 and "initial_load" in load and load["initial_load"] < 0:
            continue  # there the pull takes it over
        run = ss.simulate(ss.Problem(SLAB, F.Coulomb(static, dynamic), pull_rate=pull, **load), 20.0)
        assert float(np.ptp(run.slip(np.linspace(0, 20, 50)))) == 0.0
        assert len(run.events) == 0


def test_constant_slip_rate_has_an_event() -> None:
    run = ss.simulate(ss.Problem(SLAB, F.Coulomb(0.8, 0.3), initial_load=-8.1e7), 20.0)
    assert len(run.events) == 1


def test_a_load_within_rounding_of_the_strength_is_excess_zero() -> None:
    load = np.nextafter(np.nextafter(8e7, np.inf), np.inf)
    assert replace(rate_law_slab(), initial_excess=None, initial_load=float(load)).excess == 0.0
    assert replace(rate_law_slab(), initial_excess=None, initial_load=8e7 + 1e-6).excess > 0.0


def test_block_swings_back_and_forth_under_weak_friction() -> None:
    """Coulomb, V = 0: each half swing loses 2 mu S / K of amplitude; direction reverses until friction holds."""
    block = ss.SpringBlock(2.0, 50.0, 10.0)
    law = F.Coulomb(0.3, 0.3)
    run = ss.simulate(ss.Problem(block, law, initial_load=20.0), 10.0)
    # spring force 20 N against 3 N of friction: amplitude (20 - 3)/K, then (20 - 9)/K, (20 - 15)/K, and 2 N is held
    half = np.pi * np.sqrt(2.0 / 50.0)
    turns = [0.0, half, 2 * half, 3 * half]
    slips = [0.0, 2 * 17 / 50, 2 * 17 / 50 - 2 * 11 / 50, 2 * 17 / 50 - 2 * 11 / 50 + 2 * 5 / 50]
    assert run.slip(turns) == pytest.approx(slips, rel=0, abs=1e-11)
    assert float(run.slip(10.0)) == pytest.approx(slips[-1], rel=0, abs=1e-11)
    assert float(run.load(10.0)) == pytest.approx(20 - 50 * slips[-1], rel=0, abs=1e-10)
    assert len(run.catalogue(0.0)) == 3


def test_far_stress_rate_reloads_a_lossy_slab() -> None:
    """At rest the load ends up following the far stress, a constant time late; slip starts when it meets the strength."""
    lossy = replace(SLAB, driver_impedance=3e6)
    problem = ss.Problem(lossy, RATE_LAW, pull_rate=0.0, initial_excess=-1e6, far_stress_rate=1.0)
    run = ss.simulate(problem, 1.2e6)
    # beta = s(t) - s' (h/c) Zd / Z solves beta(t) = -r beta(t - R) + (1 + r) s(t - h/c): far stress meets the strength at 1e6 s
    lag = ROUND / 2 * 3e6 / IMPEDANCE
    assert run.shocks.time.iloc[0] == pytest.approx(1e6 + lag, rel=1e-9, abs=0.0)


def test_repr_names_body_law_status_and_rule() -> None:
    run = ss.simulate(rate_law_slab(), 12.0)
    for word in ("ElasticSlab", "HyperbolicRate", "finished", "depends on the rule", "rtol"):
        assert word in repr(run)
        assert word in run._repr_html_()


def test_progress_is_reported() -> None:
    seen: list[Report] = []
    ss.simulate(rate_law_slab(), 12.0, progress=seen.append)
    assert seen
    assert seen[-1].time <= 12.0
    assert (seen[-1].events, seen[-1].doing) == (1, "stuck")
