"""Creep leaps and lumping that begin by themselves, and lumping that was asked for."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.engine.creep.schedule import CreepLeaps
from stickslip.engine.input.limits import EXACT_TRIPS, MOST_PIECES
from stickslip.foundation.units import to_si
from stickslip.problem.limits import AUTOMATIC_SHARE, creep_tolerance
from stickslip.problem.run_codes import Stop
from stickslip.problem.run_status import STATUSES
from tests.core.engine.creep_truth import GROWN, ROUND, printed
from tests.core.run.long_runs.problems import differences, stopped_and_continued

SLOW = ss.load_scenario("second-event-perfect-delay").problem
BODY = SLOW.body
assert isinstance(BODY, ss.ElasticSlab)
TRIP = BODY.two_way_time
YEARS = 30_000.0
"""The storm begins after 23 700 of them (`tests/core/engine/truth`)."""


def test_without_lumping_the_run_ends_in_a_storm() -> None:
    run = ss.simulate(SLOW, YEARS * ss.YEAR)
    assert run.status == STATUSES[Stop.STORM]
    assert run.history.end[-1] / ss.YEAR == pytest.approx(23_700.0, abs=20.0)


def test_lumping_changes_nothing_before_the_storm() -> None:
    """The first 40 events, by a tenth of a round trip in row and 1e-6 of slip; lumps make them late by the time to that excess."""
    shortest = 1e-2
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
    events = ss.catalogue(SLOW, 50_000 * ss.YEAR, shortest_event=2e-2, max_pieces=15_000)
    assert events.attrs["status"] == "finished"
    assert len(events) > 15_000
    assert events.slip.sum() == pytest.approx(0.05 * 50_000, abs=23.5)


@pytest.mark.parametrize(
    ("problem", "options", "message"),
    [
        (SLOW, {"shortest_event": -1.0}, "shortest_event must be at least 0 s, got -1"),
        (ss.load_scenario("fig6-block-printed").problem, {"shortest_event": 1e-3}, "only with waves and a rigid driver"),
        (printed(1), {"creep_rtol": -1e-6}, "creep_rtol must be"),
        (replace(printed(1), body=replace(BODY, driver_impedance=1e7)), {"creep_rtol": 1e-6}, "a rigid driver"),
        (replace(printed(1), pull_rate=0.0), {"creep_rtol": 1e-6}, "a pull rate that is not 0"),
    ],
)
def test_runs_that_cannot_be_lumped_or_leap_are_refused(problem: ss.Problem, options: dict[str, float], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.simulate(problem, 1.0, **options)


DAYS = 3 * 86_400.0
PULSE = 234901.286195246
"""Time (s) at which slip of the printed slab has grown by 1 cm: `tests.core.engine.creep_truth 1 64000`."""
WEAKENING = ss.load_scenario("fig6-slab").problem


def weakening(alpha: float, thickness: float = 1e4) -> ss.Problem:
    """The slab of Fig. 6 with another alpha (s/m), below 0.196 regular, and thickness (m)."""
    return replace(WEAKENING, friction=replace(WEAKENING.friction, alpha=alpha), body=replace(WEAKENING.body, thickness=thickness))


@cache
def creeping(pull_rate: float, rtol: float = 1e-10) -> ss.Solution:
    return ss.simulate(replace(printed(1), pull_rate=pull_rate), DAYS, rtol)


def same_pieces(one: ss.Solution, other: ss.Solution, count: int) -> bool:
    """Whether the first pieces of two histories have the same bits."""
    pairs = zip(one.history.store[:4], other.history.store[:4], strict=True)
    return all(np.array_equal(a[:count], b[:count], equal_nan=True) for a, b in pairs)


# ---- creep --------------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("rtol", "error"), [(1e-10, 1e-4), (1e-6, 2e-2)])
def test_a_plain_call_reaches_the_first_pulse(rtol: float, error: float) -> None:
    """2.71878 days of creep, 41 107 round trips, in a second; the error of the pulse's time (s) follows rtol."""
    run = creeping(printed(1).pull_rate, rtol)
    assert run.status.name == "finished"
    found = brentq(lambda t: float(run.slip(t)) - run.problem.initial_slip - GROWN, PULSE - 20, PULSE + 20, xtol=1e-9)
    assert found == pytest.approx(PULSE, rel=0.0, abs=error)
    assert run.events.peak_time.iloc[-1] / 86_400 == pytest.approx(2.71878, rel=0.0, abs=1e-5)
    assert run.events.peak_rate.iloc[-1] > 10.0
    assert run.creep.round_trips.sum() > 40_000
    assert len(run.history) < 50_000


def test_the_first_round_trips_are_all_run() -> None:
    """Bit for bit those of a run without leaps; and a run that ends before is that run."""
    exact, leaping = ss.simulate(printed(1), EXACT_TRIPS * ROUND, creep_rtol=0.0), ss.simulate(printed(1), 1e5)
    assert leaping.creep.start_row.iloc[0] == EXACT_TRIPS
    assert same_pieces(exact, leaping, len(exact.history) - 1)
    short = ss.simulate(printed(1), EXACT_TRIPS * ROUND)
    assert len(short.history) == len(exact.history)
    assert same_pieces(exact, short, len(exact.history))


def test_runs_without_creep_have_no_leaps() -> None:
    """Other laws, no pull, and pulses without rest between them: no pause and no leap."""
    assert creep_tolerance(replace(WEAKENING, pull_rate=0.0), None, 1e-10) == 0.0
    assert creep_tolerance(printed(0), None, 1e-10) == 0.0
    assert len(ss.simulate(ss.load_scenario("fig5-slab-reconstructed").problem, 100 * ROUND).creep) == 0


@pytest.mark.parametrize(("rtol", "tolerance"), [(1e-15, 1e-6), (1e-8, 1e-5), (1e-2, 1e-3)])
def test_the_tolerance_follows_rtol(rtol: float, tolerance: float) -> None:
    assert creep_tolerance(printed(1), None, rtol) == pytest.approx(tolerance, rel=1e-12, abs=0.0)
    assert creep_tolerance(printed(1), 0.0, rtol) == 0.0


# ---- ever shorter events ------------------------------------------------------------------------------------------------------


def test_nothing_is_lumped_before_a_round_trip_is_full() -> None:
    """Bit for bit the run that resolves every event, up to the round trip after the one with too many pieces."""
    exact, lumping = ss.simulate(weakening(0.15), 17 * ROUND, shortest_event=0.0), ss.simulate(weakening(0.15), 17 * ROUND)
    rows = np.bincount(lumping.history.store.trip)
    first = int(np.argmax(rows > MOST_PIECES)) + 1
    assert 10 < first < 17
    assert same_pieces(exact, lumping, rows[:first].sum())
    assert len(lumping.history) < 0.25 * len(exact.history)
    assert f"are lumped from {first * ROUND:.6g} s on" in lumping.lumping_note
    assert exact.lumping_note == ""


@pytest.mark.slow
def test_lumping_keeps_slip_and_energy() -> None:
    """Five round trips later: slip of the run that resolves every event within 4 %, energy to 1e-9 of the heat."""
    end = np.array([17 * ROUND])
    exact, lumped = (ss.simulate(weakening(0.1), float(end[0]), shortest_event=size) for size in (0.0, None))
    assert lumped.lumping_note
    assert float(lumped.slip(end)[0]) == pytest.approx(float(exact.slip(end)[0]), rel=4e-2, abs=0.0)
    energy = lumped.energy(end)
    assert abs(float(energy.balance[0])) < 1e-9 * float(energy.heat[0])


def test_runs_below_the_critical_value_finish() -> None:
    """105 round trips of doubling: within a million pieces; what is lumped is a share of the round trip."""
    run = ss.simulate(weakening(0.1959, thickness=1e3), 60.0)
    assert run.status.name == "finished"
    assert f"shorter than {AUTOMATIC_SHARE * 0.1 * ROUND:.3g} s" in run.lumping_note
    assert np.bincount(run.history.store.trip).max() < 3 * MOST_PIECES


@pytest.mark.slow
def test_lumped_runs_can_be_resumed_and_streamed(tmp_path: Path) -> None:
    problem, end = weakening(0.15, thickness=1e3), 9.0
    whole = ss.simulate(problem, end)
    for stop in (7.0, 8.9):
        resumed = stopped_and_continued(ss.simulate(problem, stop), end, tmp_path)
        assert differences(resumed, whole) == []
        assert resumed.lumping_note == whole.lumping_note
    table = ss.catalogue(problem, end)
    pd.testing.assert_frame_equal(table, whole.catalogue(), check_exact=True)
    assert table.attrs["lumping"] == whole.lumping_note


def test_laws_of_slip_lump_nothing() -> None:
    """Creep has many pieces too, up to 2470 in a round trip of a slab pulled a hundred times faster, which stay as they are."""
    run, exact = ss.simulate(printed(100), 190 * ROUND), ss.simulate(printed(100), 190 * ROUND, creep_rtol=0.0, shortest_event=0.0)
    assert run.lumping_note == ""
    assert len(run.history) == len(exact.history)
    assert same_pieces(run, exact, len(exact.history))


# ---- histories that are full --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{}, pytest.param({"max_pieces": 2000}, marks=pytest.mark.slow)], ids=["default", "asked for"])
def test_a_full_history_is_written_and_goes_on_with_more_pieces(
    options: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, short = tmp_path / "run.nc", 0.5 * EXACT_TRIPS * ROUND
    monkeypatch.setattr("stickslip.problem.run_options.MAX_PIECES", 1000)
    full = ss.simulate(printed(1), short, checkpoint=file, **options)
    kept = ss.open_solution(file)
    assert full.status.name == "too many pieces"
    assert kept.status == full.status
    assert same_pieces(kept, full, len(full.history))
    again = ss.resume(file)
    assert again.status.name == "too many pieces"
    assert len(again.history) == len(full.history)
    more = ss.resume(file, max_pieces=20_000)
    whole = ss.simulate(printed(1), short, max_pieces=20_000)
    assert more.status.name == "finished"
    assert ss.open_solution(file).status.name == "finished"
    assert len(more.history) == len(whole.history)
    assert same_pieces(more, whole, len(whole.history))


@pytest.mark.slow
def test_a_long_run_that_was_stopped_goes_on_without_a_number_of_pieces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It had more than the default allows, because it was allowed more; it is not full."""
    file, short = tmp_path / "run.nc", 0.5 * EXACT_TRIPS * ROUND

    def stop(report: Any) -> None:
        if report.pieces > 3000:
            raise KeyboardInterrupt

    stopped = ss.simulate(printed(1), short, checkpoint=file, max_pieces=20_000, progress=stop)
    monkeypatch.setattr("stickslip.problem.run_options.MAX_PIECES", 1000)
    assert stopped.status.name == "interrupted"
    more = ss.resume(file)
    assert len(more.history) > 1.25 * len(stopped.history)


@pytest.mark.slow
def test_a_history_takes_a_share_of_the_memory_that_is_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """12 MB are counted on, of which a history may take 2: some 4 000 pieces."""
    file, short = tmp_path / "run.nc", 0.5 * EXACT_TRIPS * ROUND
    monkeypatch.setenv("STICKSLIP_MEMORY", "12 MB")
    full = ss.simulate(printed(1), short, checkpoint=file, max_pieces=100_000_000)
    assert full.status.name == "too many pieces"
    assert full.status.message.startswith("memory is short: the history takes 0.002 GB with ")
    assert 3000 < len(full.history) < 5000
    assert "max_pieces" not in full.status.message
    assert same_pieces(ss.open_solution(file), full, len(full.history))
    monkeypatch.delenv("STICKSLIP_MEMORY")
    assert ss.resume(file).status.name == "finished"


CROWDS: dict[str, tuple[ss.Problem, float, dict[str, Any], set[str]]] = {
    "cycles of a block": (
        ss.load_scenario("cycles-block").problem,
        100 * ss.YEAR,
        {"max_pieces": 250},
        {"catalogue", "max_pieces", "duration"},
    ),
    "creep": (printed(1), 300 * ROUND, {"max_pieces": 60_000, "creep_rtol": 0.0}, {"leaps", "duration"}),
    "ever shorter events": (weakening(0.15), 17 * ROUND, {"max_pieces": 60_000, "shortest_event": 0.0}, {"lumping", "duration"}),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", CROWDS)
def test_each_cure_that_a_full_history_names_lets_the_run_finish(name: str) -> None:
    problem, duration, options, expected = CROWDS[name]
    full = ss.simulate(problem, duration, **options)
    assert full.status.name == "too many pieces"
    cures = re.split(", or ", full.status.message.partition("what helps: ")[2].replace(", which keeps events only", ""))
    tried = set()
    for cure in cures:
        word = next(word for word in cure.split() if word in ("catalogue", "leaps", "lumping", "max_pieces", "duration"))
        tried.add(word)
        if word == "catalogue":
            assert ss.catalogue(problem, duration, **options).attrs["status"] == "finished", cure
            continue
        left = {key: value for key, value in options.items() if f"leave out {key} = 0" not in cure}
        if word == "max_pieces":
            left["max_pieces"] = int(cure.rpartition(" ")[2])
        number, _, unit = cure.rpartition("up to ")[2].partition(" ")
        shorter = to_si(float(number), unit, "s") if word == "duration" else duration
        assert ss.simulate(problem, shorter, **left).status.name == "finished", cure
    assert tried == expected


@pytest.mark.parametrize(
    ("problem", "trips", "option"),
    [(printed(1), 150, "creep_rtol"), (weakening(0.15), 11, "shortest_event")],
    ids=["leaps", "lumping"],
)
def test_a_full_history_names_nothing_that_would_begin_later(problem: ss.Problem, trips: int, option: str) -> None:
    """Leaps begin after 200 round trips with slip, and lumping after one with 4 096 pieces: without the option it is as full."""
    options: dict[str, Any] = {"max_pieces": 2000}
    full, without = ss.simulate(problem, trips * ROUND, **options, **{option: 0.0}), ss.simulate(problem, trips * ROUND, **options)
    assert full.status == without.status
    assert full.status.name == "too many pieces"
    assert option not in full.status.message


@pytest.mark.slow
def test_a_file_has_the_size_that_is_documented(tmp_path: Path) -> None:
    """0.42 GB a million pieces, to a tenth."""
    run = ss.simulate(printed(1), 150 * ROUND)
    size = run.to_netcdf(tmp_path / "run.nc").stat().st_size
    assert size / len(run.history) == pytest.approx(420.0, rel=0.1, abs=0.0)


def test_a_run_that_slides_for_ever_is_rarely_examined_for_creep(monkeypatch: pytest.MonkeyPatch) -> None:
    """3000 round trips under a fast pull, without a leap: the same run, with twelve looks at most."""
    looks, look = [], CreepLeaps.at_row_end
    monkeypatch.setattr(CreepLeaps, "at_row_end", lambda *a: looks.append(0) or look(*a))
    slab = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
    sliding = ss.Problem(slab, ss.friction.SinusoidalSlip(0.6, 0.001, 5.0), pull_rate=0.1, initial_excess=0.0)
    exact, run = ss.simulate(sliding, 3000 * ROUND, creep_rtol=0.0), ss.simulate(sliding, 3000 * ROUND)
    assert len(run.creep) == 0
    assert 0 < len(looks) <= 12
    assert len(run.history) == len(exact.history)
    assert same_pieces(run, exact, len(exact.history))
