"""Merged strips of creep: before a pulse of a slab the strips at the borders of creep are taken together with their neighbours."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.state.layout import NEVER
from stickslip.problem.run_codes import Stop
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from tests.core.run.long_runs.problems import continued, differences

PULSING = ss.load_scenario("fig5-slab-reconstructed").problem
"""A slab with a pulse every some months, before each of which twenty round trips creep under the crests of its waves."""
LEAPS = 12
"""The comparison begins where so many leaps have landed, under 7 crests before the next pulse."""
TRIPS = 40
"""Round trips (1) from there on that hold the pulse."""
MOST = 2_000


def landed() -> ExactRun:
    """Return a run that stands behind its twelfth leap."""
    run = ExactRun.begin(PULSING, CallOptions(2.0 * ss.YEAR, creep_rtol=1e-5, max_pieces=300_000))
    while run.count.creep_leaps < LEAPS:
        if run.advance(MOST) == Stop.FULL:
            assert run.grow()
    return run


def through_pulse(run: ExactRun) -> ss.Solution:
    """Go on for some round trips, each of them exact."""
    last = run.count.trip + TRIPS
    run.count.pause_at = NEVER
    while run.count.trip < last:
        if run.advance(MOST) == Stop.FULL:
            assert run.grow()
    return run.solution(Stop.FINISHED)


@pytest.fixture(scope="module")
def runs() -> tuple[ss.Solution, ss.Solution, float, float]:
    """The run with strips merged; the same without; the time where they part, s; the stated bound of what is merged after it, m."""
    run = landed()
    begin, start = run.snapshot(), run.time
    before = float(run.state.shifted)
    merged, bound = through_pulse(run), float(run.state.shifted) - before
    run = landed()
    run.restore(begin)
    run.count.creep_leaps = 0  # a run without leaps merges nothing
    return merged, through_pulse(run), start, bound


@pytest.mark.slow
def test_a_pulse_after_merged_strips_is_that_after_all_of_them(runs: tuple[ss.Solution, ss.Solution, float, float]) -> None:
    """Slip at 4000 moments before, in and after a pulse of 0.12 m: within the stated bound, and rounding of 1e-14 m."""
    merged, exact, start, bound = runs
    end = start + (TRIPS - 1) * PULSING.round_trip_time
    times = np.linspace(start, end, 4000)
    grown = exact.slip(times) - exact.slip(start)
    assert float(grown[-1]) > 0.12
    assert 0.0 < bound < 1e-10
    assert np.abs(merged.slip(times) - merged.slip(start) - grown).max() <= bound + 1e-14


def test_merged_strips_take_fewer_pieces(runs: tuple[ss.Solution, ss.Solution, float, float]) -> None:
    """From the landing to behind the pulse, where there are 14 borders; without leaps nothing is merged, and nothing noted."""
    merged, exact, start, _ = runs
    ours, theirs = (int((run.history.start > start).sum()) for run in (merged, exact))
    assert ours < 0.7 * theirs
    assert "strips at the borders of creep were merged" in merged.rounding_note


@pytest.mark.slow
def test_a_run_with_merged_strips_is_resumed_bit_for_bit(tmp_path: Path) -> None:
    """Stopped within the creep before a pulse."""
    whole = ss.simulate(PULSING, 1.1 * ss.YEAR, creep_rtol=1e-5)
    assert whole.rounding_note
    ss.simulate(PULSING, 3.312772e7, creep_rtol=1e-5, checkpoint=tmp_path / "run.nc")
    assert differences(continued(tmp_path / "run.nc", whole.duration), whole) == []


@pytest.mark.slow
def test_a_slab_of_figure_5_goes_on_for_60_years() -> None:
    """Energy balances to 1e-9 of the heat; slip is within what the slab holds, and is off in strips by far less than by leaps."""
    run = ss.simulate(PULSING, "60 years")
    assert run.status.ok
    energy = run.energy(np.array([run.duration]))
    assert abs(float(energy["balance"].values[0])) <= 1e-9 * float(energy["heat"].values[0])
    assert float(run.slip(run.duration)) < 3.0 + PULSING.load / PULSING.body.stiffness
