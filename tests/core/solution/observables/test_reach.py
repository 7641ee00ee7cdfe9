"""The last number: slip at the end, the largest displacement and the signs of events, against closed forms."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.history.reach import Reach, reach_of
from stickslip.run.catalogue import catalogue_of
from stickslip.run.options import CallOptions
from stickslip.run.resume import PausedCatalogue

F = ss.friction
SWINGING = ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), F.Coulomb(0.11, 0.1), initial_load=6.0)
"""A block under 6 N, against 1 N of friction, swings out by 0.2 m, back by 0.12 m and out by 0.04 m: 2 (load - 1)/50."""


def test_the_largest_displacement_is_that_of_the_swing_in_closed_form() -> None:
    run = ss.simulate(SWINGING, 5.0, rtol=1e-12)
    assert run.catalogue(0.0).slip.to_numpy() == pytest.approx([0.2, -0.12, 0.04], rel=1e-10, abs=0.0)
    assert run.reach.end == pytest.approx(0.12, rel=1e-10, abs=0.0)
    assert run.reach.largest == pytest.approx(0.2, rel=1e-10, abs=0.0)
    assert run.reach.time == pytest.approx(np.pi * np.sqrt(2.0 / 50.0), rel=1e-10, abs=0.0)  # half a period
    assert run.reach_note == "slip at the end 0.12 m; largest displacement 0.2 m, at 0.628319 s"


def test_a_run_back_has_a_negative_largest_displacement() -> None:
    run = ss.simulate(replace(SWINGING, initial_load=-6.0, initial_slip=1.0), 5.0, rtol=1e-12)
    assert run.catalogue(0.0).slip.to_numpy() == pytest.approx([-0.2, 0.12, -0.04], rel=1e-10, abs=0.0)
    assert run.catalogue(0.0).static_drop.to_numpy() == pytest.approx([-10.0, 6.0, -2.0], rel=1e-10, abs=0.0)
    assert run.reach_note.startswith("slip at the end 0.88 m, -0.12 m from the start; largest displacement -0.2 m, at ")
    assert "; largest displacement -0.2 m, at " in repr(run)


@pytest.mark.parametrize(
    ("scenario", "duration"),
    [("reversing-axis", 0.25), ("bowed-string-tenth", 0.03), ("drill-string", 15.0), ("sliding-block-shaken", 20.0)],
)
def test_no_moment_is_farther_than_the_largest_displacement(scenario: str, duration: float) -> None:
    run = ss.simulate(scenario, duration)
    slip = run.slip(np.linspace(0.0, run.duration, 20_001)) - run.problem.initial_slip
    assert np.abs(slip).max() <= abs(run.reach.largest) * (1.0 + 1e-12)
    assert float(run.slip(run.reach.time)) - run.problem.initial_slip == pytest.approx(run.reach.largest, rel=1e-9, abs=1e-15)


def test_a_contact_that_rests_is_said_to_rest() -> None:
    rests = ss.simulate(replace(SWINGING, initial_load=0.5), 1.0)
    assert rests.reach == Reach(0.0, 0.0, 0.0)
    assert rests.reach_note == "slip at the end 0 m, largest displacement 0 m: nothing slips"


def test_what_turns_has_an_angle_in_turns() -> None:
    run = ss.simulate("drill-string", 20.0)
    angle = float(run.slip())
    assert run.reach_note == f"angle at the end {angle:.8g} rad ({angle / (2 * np.pi):.6g} turns), which is the largest rotation"


def test_values_without_a_time_are_the_last_ones() -> None:
    run = ss.simulate("reversing-axis", 0.15)
    end = run.duration
    for name in ("slip", "slip_rate", "traction", "load", "state", "normal_load"):
        assert getattr(run, name)().shape == ()
        assert float(getattr(run, name)()) == float(getattr(run, name)(end))
    window = run.window(0)
    assert float(window.event_slip()) == float(window.event_slip(window.shown[1]))
    assert float(window.slip()) == float(run.slip(float(run.events.start[0]) + window.shown[1]))


def test_a_catalogue_remembers_how_far_the_history_went_that_it_discards(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The farthest point lies in the first tenth of the run, which is long forgotten at its end; a resumed run still knows it."""
    monkeypatch.setattr("stickslip.run.catalogue.CAPACITY", 256)
    scenario = ss.load_scenario("reversing-axis")
    whole = ss.simulate(scenario, 3.0)
    problem = scenario.problem
    options = CallOptions.of(replace(scenario, duration=2.0))
    first = catalogue_of(problem, options, tmp_path / "a.csv")
    farthest = ss.simulate(scenario, 2.0).reach.largest
    assert first.account.notes["reach"].startswith("slip at the end ")
    paused = PausedCatalogue.read(tmp_path / "a.checkpoint.nc")
    assert len(paused.stopped.history) < len(ss.simulate(scenario, 2.0).history)
    assert abs(reach_of(paused.stopped.history).largest) < abs(farthest)
    again = paused.resume(CallOptions.to_continue(paused.stopped, 3.0))
    kept = PausedCatalogue.read(tmp_path / "a.checkpoint.nc")
    assert (kept.about["displaced"], kept.about["displaced_at"]) == (whole.reach.largest, whole.reach.time)
    assert reach_of(kept.stopped.history).end == pytest.approx(whole.reach.end, rel=1e-9, abs=0.0)
    assert again.account.notes["reach"] == whole.reach_note


def test_mirrored_runs_have_mirrored_pulses() -> None:
    forward, back = (ss.simulate(replace(SWINGING, initial_load=sign * 6.0), 5.0).pulses(0.0) for sign in (1.0, -1.0))
    assert back.slip.to_numpy() == pytest.approx(-forward.slip.to_numpy(), rel=1e-12, abs=0.0)
