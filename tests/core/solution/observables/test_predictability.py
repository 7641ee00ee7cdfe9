"""The growth of disturbances along a run, against runs that were really disturbed, and against the closed form of one echo."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.solution.observables.predictability import predictability, predictability_of_events

SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
TRIP = SLAB.two_way_time
WEAKENING = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)


def run_of(excess: float, trips: float, driver: float = math.inf) -> ss.Solution:
    body, far = replace(SLAB, driver_impedance=driver), {} if math.isinf(driver) else {"far_stress": 8e7}
    return ss.simulate(ss.Problem(body, WEAKENING, pull_rate=0.1, initial_excess=excess, **far), trips * TRIP, rtol=1e-12)


def amplification_at(solution: ss.Solution, time: float) -> float:
    found = predictability(solution)
    return float(found.amplification[np.searchsorted(found.time, time, side="right") - 1])


def test_one_echo_amplifies_by_the_closed_form() -> None:
    """|1 - 2 Z / g'(v_B)| with g'(v_B) = Z (1 - 1/q^2) at the jump up, q^2 = alpha / alpha_c: 1.4876; relative 1e-9."""
    run = ss.simulate(ss.Problem(SLAB, WEAKENING, initial_excess=1e-6), 1.5 * TRIP)
    q2 = 1.0 / 0.196
    assert amplification_at(run, 1.2 * TRIP) == pytest.approx(2.0 / (1.0 - 1.0 / q2) - 1.0, rel=1e-6)
    assert amplification_at(run, 0.5 * TRIP) == 1.0


@pytest.mark.parametrize("driver", [math.inf, 3e8, 1e6])
def test_the_amplification_is_that_of_a_disturbed_run(driver: float) -> None:
    """Loads of two runs that start 1e-4 Pa apart, after 3 to 60 round trips with several events: 1 % of their difference."""
    push, trips = 1e-4, (0.4, 1.4, 3.4, 20.4, 50.4)
    run, pushed = (run_of(excess, 60.0, driver) for excess in (1.0, 1.0 + push))
    for trip in trips:
        apart = abs(float(pushed.load(trip * TRIP) - run.load(trip * TRIP))) / push
        if apart > 1e-3:  # else a rigid start only fades
            assert amplification_at(run, trip * TRIP) == pytest.approx(apart, rel=1e-2)
    assert predictability(run_of(1.0, 60.0)).largest > 2.0


def test_the_horizon_is_where_50_digits_lose_the_sequence() -> None:
    """Where 50 digits (`tests/core/engine/truth`) say that the sequence is lost, at the default tolerance.

    Just above alpha_c an echo multiplies by 4e5: the second generation of micro-events, from row 24 645 on, is the first whose
    loads have been amplified twice. At alpha = 1 the round trips of events are lost from the 39th on, their order at the 57th.
    """
    critical = ss.load_scenario("fig7-slab-critical").problem
    found = predictability(ss.simulate(critical, 24_700 * TRIP))
    assert found.largest > 1e10
    assert found.horizon / TRIP == pytest.approx(24_645, abs=1.0)
    assert "only statistics" in found.text
    slow = ss.simulate(replace(critical, friction=WEAKENING), 1e12, max_events=58).catalogue(0.0)
    of_events = predictability_of_events(slow, 1e-10)
    streamed = ss.catalogue(replace(critical, friction=WEAKENING), 1e12, max_events=58, event_rate=0.0)
    assert streamed.attrs["predictability"] == of_events.text
    assert slow.start[39] <= of_events.horizon <= slow.start[57]
    assert slow.amplification[1:30].to_numpy() == pytest.approx(slow.amplification[1] ** np.arange(1, 30), rel=1e-3)
    calm = predictability(run_of(1.0, 5.0))
    assert math.isinf(calm.horizon)
    assert "throughout" in calm.text
    assert 0.0 < calm.exponent < 1.0


def test_other_problems_are_refused_in_one_line() -> None:
    for body, law in (
        (SLAB, ss.friction.SinusoidalSlip(1.0, 0.1, 5.0)),
        (ss.SpringBlock(1.0, 1.0, 1.0), WEAKENING),
        (replace(SLAB, contact_mass=1.0), WEAKENING),
    ):
        run = ss.simulate(ss.Problem(body, law, initial_excess=0.0), 1.0)
        with pytest.raises(ss.InputError, match=r"^predictability: needs a slab[^\n]*$"):
            predictability(run)


def test_files_hold_the_predictability(tmp_path: Path) -> None:
    run = run_of(1.0, 60.0)
    run.to_netcdf(tmp_path / "run.nc")
    ss.catalogue(run.problem, run.duration, tmp_path / "events.nc", rtol=1e-12)
    of_events = predictability_of_events(run.catalogue(), 1e-12)
    for name, found in (("run.nc", predictability(run)), ("events.nc", of_events)):
        with xr.open_dataset(tmp_path / name, engine="h5netcdf", decode_times=False) as file:
            assert file.attrs["predictability"] == found.text
            assert file.attrs["horizon"] == math.inf
            assert file.attrs["lyapunov_exponent"] == found.exponent > 0.0


def test_a_run_that_ends_before_its_horizon_says_about_where_that_is() -> None:
    """By the formula to 1e-12, and beside a run that reaches its horizon to a factor of 2."""
    critical = ss.load_scenario("fig7-slab-critical").problem
    early, late = (predictability(ss.simulate(critical, trips * TRIP)) for trips in (20_000, 24_700))
    assert math.isinf(early.horizon)
    assert early.expected_horizon == pytest.approx(
        early.time[-1] * math.log(0.1 / early.error) / math.log(early.largest), rel=1e-12
    )
    assert 0.5 < early.expected_horizon / late.horizon < 2.0
    assert early.text.endswith("up to about 2.06e+05 s if errors go on to grow as in this run")
    assert late.expected_horizon == late.horizon
    alone = predictability(ss.simulate("fig6-slab"))
    assert alone.expected_horizon == math.inf, "a single event tells no rate"
    assert alone.text.endswith("single events are predictable throughout")
