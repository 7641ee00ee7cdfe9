"""An event after 900 years is as sharp as one after a second: windows in local time, and the columns of the catalogue.

Slip histories of the same event are compared to 1e-12 of its slip, with no absolute slack.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.solution.observables.event_table import ENERGY_COLUMNS, EVENT_COLUMNS
from tests.problems import ROUND, SLAB, rate_law_slab, slip_law_slab

F = ss.friction
RATE = F.HyperbolicRate(0.8, 0.3, 1.0)
WEAK = F.LinearSlipWeakening(0.8, 0.3, 0.5)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
PULL = 1e-3 / ss.YEAR
LONG = 900 * ss.YEAR
KINDS = {
    "slab, rate law": (SLAB, RATE),
    "slab, slip law": (SLAB, WEAK),
    "slab, slip and rate": (SLAB, F.SlipPlusRate(slip=F.LinearSlipWeakening(0.3, 0.1, 0.5), rate=RATE)),
    "slab, contact mass": (replace(SLAB, contact_mass=1e6), RATE),
    "block, rate law": (BLOCK, RATE),
    "block, slip law": (BLOCK, WEAK),
}


def delayed(kind: str, seconds: float) -> ss.Problem:
    """Pulled at 1 mm/yr, from a load that reaches the strength after so long."""
    body, law = KINDS[kind]
    return ss.Problem(body, law, pull_rate=PULL, initial_excess=-body.stiffness * PULL * seconds)


def same_slip(early: ss.Solution, late: ss.Solution) -> tuple[float, float]:
    """Largest difference of the slip since the event began as a share of it all; in local time, and in seconds of the run."""
    windows = [run.window(0) for run in (early, late)]
    local = np.linspace(-0.5, 1.2 * float(early.events.duration[0]), 1001)
    slips = [window.event_slip(local) for window in windows]
    seconds = late.slip(late.events.start[0] + local) - late.slip(late.events.start[0])
    whole = slips[0].max()
    assert whole > 0.1
    return float(np.abs(slips[1] - slips[0]).max() / whole), float(np.abs(seconds - slips[0]).max() / whole)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", KINDS)
def test_an_event_is_as_sharp_after_900_years_as_after_a_second(kind: str) -> None:
    """The run's seconds, which late in it are 4e-6 apart, do not show it: the tolerance would notice."""
    early, late = (ss.simulate(delayed(kind, t), t + 30.0, rtol=1e-14) for t in (1.0, LONG))
    local, seconds = same_slip(early, late)
    assert local < 1e-12
    assert seconds > 1e-9
    assert late.window(0).epoch.trip > 1e9
    for name in ("duration", "slip", "peak_rate", "traction_drop", "static_drop"):
        assert late.events[name][0] == pytest.approx(early.events[name][0], rel=1e-12, abs=0.0), name


def test_an_event_under_a_lossy_driver_is_as_sharp_after_900_years() -> None:
    """Far stress that grows by 1 kPa a year, after the start has rung down, reflection -0.2; late is 900 years later."""
    slab = replace(SLAB, driver_impedance=1.5 * SLAB.impedance)
    rate, runs = 1e3 / ss.YEAR, []
    for wait in (200.0 * ROUND, LONG):
        problem = ss.Problem(slab, WEAK, initial_excess=-rate * wait, far_stress_rate=rate)
        runs.append(ss.simulate(problem, wait + 60.0, rtol=1e-14))
    windows = [run.window(0) for run in runs]
    local = np.linspace(-5.0, 20.0, 501)
    early, late = (window.event_slip(local) for window in windows)
    assert early.max() > 10.0
    assert np.abs(late - early).max() < 1e-12 * early.max()


def test_other_readings_agree_in_local_time() -> None:
    early, late = (ss.simulate(delayed("slab, rate law", t), t + 30.0) for t in (1.0, LONG))
    local = np.linspace(0.0, 5.0, 101)
    a, b = early.window(0), late.window(0)
    for name in ("slip_rate", "traction", "load"):
        ours, theirs = getattr(b, name)(local), getattr(a, name)(local)
        assert ours == pytest.approx(theirs, rel=1e-13, abs=0.0), name
    end = float(late.events.duration[0])
    assert b.slip_rate(end, side="left") > 4.1
    assert float(b.slip_rate(end)) == 0.0
    assert list(b.shocks.cause) == ["fold", "echo"]
    assert b.shocks.time.to_numpy() == pytest.approx([0.0, ROUND], rel=1e-15, abs=1e-15)


def test_local_time_reaches_over_years_of_rest() -> None:
    """Between two events the load grows by G V / h a second: from either end."""
    run = ss.simulate(rate_law_slab(), 480 * ss.YEAR)
    problem = run.problem
    slope = SLAB.stiffness * problem.pull_rate
    first, second = run.window(0), run.window(1)
    at = 100 * ss.YEAR
    mean = float(first.load(at))
    assert mean == pytest.approx(float(first.load(ROUND)) + slope * (at - ROUND), rel=0.0, abs=1.0)
    recurrence = float(run.events.recurrence[1])
    assert float(second.load(at - recurrence)) == pytest.approx(mean, rel=0.0, abs=1e-6)
    assert float(first.event_slip(at)) == float(first.event_slip(6.0)) == pytest.approx(run.events.slip[0], rel=1e-15)


def test_slip_in_an_event_keeps_its_digits_after_much_slip() -> None:
    """A slab that has slipped 1e9 m before, where two numbers are 1.2e-7 m apart."""
    run = ss.simulate(replace(rate_law_slab(), pull_rate=0.05), 30.0)
    store = run.history.store._replace(pieces=run.history.store.pieces.copy())
    store.slip[:] += 1e9
    moved = replace(run, history=replace(run.history, store=store))
    local = np.linspace(0.0, 5.0, 101)
    assert moved.events.equals(run.events)
    assert np.array_equal(moved.window(0).event_slip(local), run.window(0).event_slip(local))
    assert np.abs((moved.slip(local) - 1e9) - run.slip(local)).max() > 1e-9


# ---- the catalogue ------------------------------------------------------------------------------------------------------------


def test_block_and_slab_catalogues_have_the_same_columns() -> None:
    for kind in ("slab, rate law", "block, rate law"):
        run = ss.simulate(delayed(kind, 1.0), 30.0)
        assert list(run.events) == list(EVENT_COLUMNS)
        assert list(run.catalogue(0.0, energy=True)) == [*EVENT_COLUMNS, *ENERGY_COLUMNS]
        may_lack = ["recurrence", "amplification"] if kind.startswith("block") else ["recurrence"]
        assert not run.catalogue(0.0, energy=True).drop(columns=may_lack).isna().any(axis=None)


def test_a_run_without_events_has_the_columns_too() -> None:
    still = ss.simulate(ss.Problem(SLAB, RATE, initial_load=1e6), 10.0)
    table = still.catalogue(energy=True)
    assert list(table) == [*EVENT_COLUMNS, *ENERGY_COLUMNS]
    assert len(table) == 0


def test_unfinished_event_has_neither_end_nor_duration() -> None:
    event = ss.simulate(rate_law_slab(), 3.0).events.iloc[0]
    assert np.isnan(event.end)
    assert np.isnan(event.duration)
    window = ss.simulate(rate_law_slab(), 3.0).window(0)
    assert window.shown == (0.0, 3.0)


# ---- files, figures, mistakes ------------------------------------------------------------------------------------------------


def test_epochs_and_windows_survive_a_file(tmp_path: Path) -> None:
    run = ss.simulate(rate_law_slab(), 480 * ss.YEAR)
    back = ss.open_solution(run.to_netcdf(tmp_path / "run.nc"))
    local = np.linspace(-1.0, 6.0, 201)
    assert back.window(1).epoch == run.window(1).epoch
    assert np.array_equal(back.window(1).event_slip(local), run.window(1).event_slip(local))
    assert back.events.start_row[1] == 2_589_011_266


def test_a_window_becomes_a_dataset_with_its_epoch() -> None:
    window = ss.simulate(rate_law_slab(), 480 * ss.YEAR).window(1)
    dataset = window.to_dataset([0.0, 1.0])
    assert (dataset.epoch_trip, dataset.epoch_offset, dataset.round_trip_time) == (2_589_011_266, 0.0, ROUND)
    assert dataset.event_slip.attrs["units"] == "m"
    assert float(dataset.event_slip[1]) == pytest.approx(4.10204082, rel=1e-8, abs=0.0)


def test_a_window_shows_its_span_within_the_run() -> None:
    run = ss.simulate(slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0)
    window = run.window(0, before=3.0, after=4.0)
    assert window.shown == (0.0, 4.0)  # nothing lies before the start of the run
    time, slip = window.curve("event_slip")
    assert (time[0], time[-1], slip[0]) == (0.0, 4.0, 0.0)
    assert "of an event" in repr(window)
    assert run.window(run.catalogue(1.0).iloc[2]).history.epoch.offset > 4.0


@pytest.mark.parametrize("event", [1, -2])
def test_events_that_do_not_exist_are_refused(event: int) -> None:
    run = ss.simulate(rate_law_slab(), 12.0)
    with pytest.raises(ss.InputError, match=rf"window: no event {event}: the run has 1, 0 to 0"):
        run.window(event)


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        (-1.0, None, "before must be at least 0 s, got -1"),
        (None, 0.0, "after must be greater than 0 s, got 0"),
        (None, np.nan, "after must be finite, got nan"),
        (np.inf, None, "before must be finite, got inf"),
    ],
)
def test_bad_spans_are_refused(before: float | None, after: float | None, message: str) -> None:
    run = ss.simulate(rate_law_slab(), 12.0)
    with pytest.raises(ss.InputError, match=f"window: {message}"):
        run.window(0, before, after)


def test_local_times_outside_the_run_are_refused() -> None:
    window = ss.simulate(rate_law_slab(), 480 * ss.YEAR).window(1)
    with pytest.raises(ss.InputError, match=r"times must lie between -1\.479"):
        window.slip(-469 * ss.YEAR)
