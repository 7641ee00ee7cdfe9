"""Slip events too short to be resolved, lumped: nothing changes before them, and slip goes on as it must behind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.engine.state.layout import Stop
from stickslip.trajectory.status import STATUSES
from tests.long_runs.problems import differences

SLOW = ss.load_scenario("second-event-perfect-delay").problem
BODY = SLOW.body
assert isinstance(BODY, ss.ElasticSlab)
TRIP = BODY.two_way_time
YEARS = 30_000.0
"""The storm begins after 23 700 of them (`tests/truth`)."""


def test_without_lumping_the_run_ends_in_a_storm() -> None:
    run = ss.simulate(SLOW, YEARS * ss.YEAR)
    assert run.status == STATUSES[Stop.STORM]
    assert run.history.end[-1] / ss.YEAR == pytest.approx(23_700.0, abs=20.0)


@pytest.mark.parametrize("shortest", [1e-4, 1e-2])
def test_lumping_changes_nothing_before_the_storm(shortest: float) -> None:
    """The first 40 events, by a tenth of a round trip in row and 1e-6 of slip; lumps make them late by the time to that excess."""
    exact, lumped = (ss.simulate(SLOW, 19_000.0 * ss.YEAR, shortest_event=size).catalogue() for size in (0.0, shortest))
    assert len(exact) == len(lumped) == 41
    np.testing.assert_allclose(lumped.slip, exact.slip, rtol=max(1e-6, 0.3 * shortest / TRIP), atol=0.0)
    np.testing.assert_allclose(lumped.start, exact.start, rtol=shortest / TRIP, atol=TRIP)


def test_after_the_storm_slip_keeps_up_with_the_driver() -> None:
    """Slip of V t, but for one event of up to 23.4 m under way; and the energy that lumps lose is below 1e-6 of the heat."""
    run = ss.simulate(SLOW, 30_000 * ss.YEAR, shortest_event=1e-2)
    events = run.catalogue()
    assert run.status.name == "finished"
    assert len(events) > 5_000
    assert events[events.start > 24_000 * ss.YEAR].duration.median() < 1e-2
    assert events.slip.sum() == pytest.approx(0.05 * 30_000, abs=23.5)
    energy = run.energy(np.array([29_990 * ss.YEAR]))
    assert 1e-10 < abs(float(energy.balance[0] / energy.heat[0])) < 1e-6


def test_a_long_lumped_catalogue_fits_in_bounded_memory() -> None:
    events = ss.catalogue(SLOW, 100_000 * ss.YEAR, shortest_event=2e-2, max_pieces=60_000)
    assert events.attrs["status"] == "finished"
    assert len(events) > 60_000
    assert events.slip.sum() == pytest.approx(0.05 * 100_000, abs=23.5)


def test_pieces_in_a_round_trip_are_bounded() -> None:
    """At most a few for each shortest event that fits into it."""
    run = ss.simulate(SLOW, 25_000 * ss.YEAR, shortest_event=2e-2)
    standing, _, _ = run.history.standing(int(run.history.store.trip[-1]))
    assert run.status.ok
    assert len(standing) < 4 * TRIP / 2e-2


def test_a_resumed_run_continues_as_if_it_had_not_stopped(tmp_path: Path) -> None:
    """Bit for bit, in the middle of the storm; and a catalogue that forgets is the table of the whole run."""
    file, years = tmp_path / "run.nc", 24_500 * ss.YEAR
    whole = ss.simulate(SLOW, years, shortest_event=1e-2)
    ss.simulate(SLOW, 0.98 * years, shortest_event=1e-2).to_netcdf(file)
    assert differences(ss.resume(file, years), whole) == []
    pd.testing.assert_frame_equal(ss.catalogue(SLOW, years, shortest_event=1e-2), whole.catalogue(), check_exact=True)


@pytest.mark.parametrize(
    ("problem", "shortest", "message"),
    [
        (SLOW, -1.0, "shortest_event must be at least 0 s, got -1"),
        (SLOW, 1.0, r"shortest_event must be 0 or at most 0\.0571429 s \(1 % of the two-way travel time\), got 1 s"),
        (SLOW, float("nan"), "shortest_event must be finite, got nan"),
        (ss.load_scenario("fig6-block-printed").problem, 1e-3, "only under a slab with a rigid driver"),
    ],
)
def test_runs_that_cannot_be_lumped_are_refused(problem: ss.Problem, shortest: float, message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.simulate(problem, 1.0, shortest_event=shortest)
