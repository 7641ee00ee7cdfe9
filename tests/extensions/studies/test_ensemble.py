"""Ensembles against closed forms: growth echo by echo, no growth where there is none, and what is compared with what."""

from __future__ import annotations

import math
import os
import signal
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.studies import kept_runs
from stickslip.extensions.studies.ensemble import Ensemble, ensemble
from stickslip.extensions.studies.separation import disturbed, shared_events, slope
from stickslip.problem.run_codes import UNDER_WAY
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.solution.files.netcdf import save_checkpoint
from tests.core.run.long_runs.problems import differences, killed

SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
TRIP = SLAB.two_way_time
WEAKENING = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
FAST = ss.Problem(SLAB, WEAKENING, pull_rate=0.1, initial_excess=1.0)
SLOW = ss.load_scenario("fig6-slab").problem
CYCLES = ss.load_scenario("cycles-block")
CRITICAL = ss.load_scenario("fig7-slab-critical").problem


@pytest.fixture(scope="module")
def fast() -> Ensemble:
    return ensemble(FAST, 300 * TRIP, members=4)


@pytest.fixture(scope="module")
def cycles() -> Ensemble:
    below = replace(CYCLES.problem, initial_load=None, initial_excess=-1e-3 * CYCLES.problem.strength)  # else some start beyond it
    return ensemble(below, CYCLES.duration, members=4, size=1e-6)


@pytest.fixture(scope="module")
def parted() -> Ensemble:
    return ensemble(replace(FAST, initial_excess=1e6), 700 * TRIP, members=8, size=1e-3)


def later(found: Ensemble) -> np.ndarray:
    """Return how much later (s) each shared event of each member starts than in the undisturbed run, shape (members, events)."""
    own, *members = found.catalogues
    trip = found.reference.history.round_trip_time
    return np.array(
        [trip * (table.start_row - own.start_row) + table.start_offset - own.start_offset for table in members], dtype=float
    )


def test_measured_growth_is_the_predicted_one(fast: Ensemble) -> None:
    """Exponents by the same fit: 5 %; that of `predictability`, from the end only: 15 %. They are near 2.2e-3 1/s."""
    assert fast.exponent == pytest.approx(fast.predicted_exponent, rel=0.05, abs=0.0)
    assert fast.exponent == pytest.approx(ss.studies.predictability(fast.reference).exponent, rel=0.15, abs=0.0)
    assert fast.growth.growth.iloc[-1] > 30.0
    assert fast.growth.small.all()
    assert fast.text == "all 4 members have the same 35 slip events"
    assert math.isinf(fast.horizon)


def test_each_echo_multiplies_by_the_closed_form() -> None:
    """Real pull rate: an event a recurrence time, each multiplies by 2 / (1 - alpha_c / alpha) - 1 = 1.4876: exponent to 3 %."""
    found = ensemble(SLOW, 1e13, members=3, max_events=30)
    q2 = 1.0 / 0.196
    factor = 2.0 / (1.0 - 1.0 / q2) - 1.0
    assert found.exponent == pytest.approx(math.log(factor) / found.table.recurrence.mean(), rel=0.03, abs=0.0)
    assert found.growth.growth.iloc[0] == pytest.approx(factor, rel=1e-3, abs=0.0)


def test_a_block_that_cycles_amplifies_nothing(cycles: Ensemble) -> None:
    """The spring's load stays apart by the push (1e-6 of it), starts by push / (K V) (1e-4): all events alike."""
    body = CYCLES.problem.body
    assert abs(cycles.exponent) * CYCLES.duration < 1e-6
    assert cycles.growth.growth.to_numpy() == pytest.approx(np.ones(40), rel=1e-6, abs=0.0)
    early = cycles.pushes / (body.stiffness * CYCLES.problem.pull_rate)
    assert -later(cycles) == pytest.approx(np.repeat(early[:, None], 7, axis=1), rel=1e-4, abs=0.0)
    own, *members = cycles.catalogues
    assert max(abs(table.slip - own.slip).max() for table in members) < 1e-10 * own.slip.min()
    assert cycles.prediction is None
    assert math.isnan(cycles.predicted_exponent)
    assert "no prediction" in repr(cycles)


def test_waves_that_leave_take_the_disturbance_along() -> None:
    """Driver of 3 Z: an echo keeps a half of it, with changing sign, where nothing slips: ln 2 a round trip, to 2 %."""
    body = replace(SLAB, driver_impedance=3.0 * SLAB.impedance)
    found = ensemble(ss.Problem(body, WEAKENING, pull_rate=0.0, initial_load=4e7, far_stress=6e7), 20 * TRIP, members=2, size=1e-4)
    assert found.exponent == pytest.approx(-math.log(2.0) / TRIP, rel=0.02, abs=0.0)
    assert found.text == "no slip event"


def test_just_above_critical_one_echo_shifts_all_that_follows() -> None:
    """The first echo makes 2 / (1 - alpha_c / alpha) = 3.92e5 times as much of a push: at 2 Z V a round trip, so many later.

    Some 60 to 100 of them, to 3 %: whole numbers, and what is quadratic in the push.
    """
    found = ensemble(CRITICAL, 100_000.0, members=3, size=1e-13)
    multiplied = 2.0 / (1.0 - 0.196 / CRITICAL.friction.alpha)
    rows = [int(table.start_row.iloc[1] - found.catalogues[0].start_row.iloc[1]) for table in found.catalogues[1:]]
    expected = multiplied * found.pushes / (2.0 * SLAB.impedance * CRITICAL.pull_rate)
    assert (found.pushes > 0.0).all()
    assert rows == pytest.approx(expected.tolist(), rel=0.03, abs=0.0)
    assert found.first_lost == 1
    assert "sequences differ from event 2 of" in found.text


def test_at_the_real_pull_rate_the_storm_is_lost() -> None:
    """50 digits (core/engine/truth) lose the order of events at the 57th: members keep at least 50 events, and not all 64."""
    found = ensemble(SLOW, 1e13, members=3, max_events=65)
    assert found.first_lost is not None
    assert 50 < found.first_lost < 64
    assert (found.table.members.iloc[: found.first_lost] == 3).all()


def test_from_rest_a_disturbance_only_shifts_the_time() -> None:
    """The problem knows no clock: starts are apart by push / (rate of loading), to 1e-3 (rounding of loads), however loads grow."""
    rest = replace(SLOW, initial_excess=-1e6)
    found = ensemble(rest, 1e13, members=3, max_events=20)
    early = found.pushes / (SLAB.stiffness * SLOW.pull_rate)
    assert -later(found) == pytest.approx(np.repeat(early[:, None], 20, axis=1), rel=1e-3, abs=0.0)
    assert found.growth.growth.iloc[-1] > 1e3
    assert found.note.startswith("the run begins at rest")
    assert found.note in repr(found)
    assert ensemble(SLOW, 1.0, members=1).note == ""
    timed = replace(SLOW, pull_rate=ss.loading.Steps([0.0, 0.5], [0.0, 1e-3]), initial_excess=-1.0)  # the steps do not wait
    assert ensemble(timed, 1.0, members=1).note == ""


@pytest.mark.parametrize(
    ("excess", "size", "signs"),
    [(0.0, 1e-12, {1.0}), (-0.0, 1e-12, {1.0}), (1.0, 1e-12, {-1.0, 1.0}), (-1.0, 1e-6, {-1.0, 1.0})],
    ids=["at the strength", "at the strength, minus zero", "beyond the strength", "below the strength"],
)
def test_a_start_beyond_the_strength_is_not_held_back(excess: float, size: float, signs: set) -> None:
    forward = replace(FAST, initial_excess=excess)
    backward = replace(FAST, initial_excess=-excess - 2.0 * FAST.strength)
    for problem in (forward, backward):
        pushes = ensemble(problem, 0.1, members=20, size=size).pushes
        direction = 1.0 if problem is forward else -1.0
        assert set(np.sign(pushes) * direction) == signs


def test_the_predicted_horizon_is_where_the_prediction_saturates(parted: Ensemble) -> None:
    """In the stretch of time in which the predicted separation of the largest push passes a tenth of the range of the load."""
    assert parted.prediction is not None
    growth = parted.growth
    passes = int(np.argmax(growth.predicted * np.abs(parted.pushes).max() > parted.separation.saturation))
    assert growth.time[passes - 1] < parted.prediction.horizon <= growth.time[passes]
    load = parted.reference.load(np.linspace(0.0, parted.until, 50_001))
    assert parted.separation.saturation == pytest.approx(0.1 * float(np.ptp(load)), rel=0.02, abs=0.0)


def test_beyond_the_horizon_no_event_is_shared(parted: Ensemble) -> None:
    assert len(parted.table) > 3500
    assert parted.first_lost is not None
    assert parted.first_lost < 100
    assert parted.table.members.iloc[-1] == 0


def test_the_same_seed_draws_the_same_members() -> None:
    one, same, other = (ensemble(FAST, 20 * TRIP, members=6, seed=seed) for seed in (3, 3, 4))
    pd.testing.assert_frame_equal(one.table, same.table, check_exact=True)
    pd.testing.assert_frame_equal(one.growth, same.growth, check_exact=True)
    assert not np.isin(one.pushes, other.pushes).any()
    share = one.pushes / (1e-12 * 8e7)
    assert (share > 0.0).any()
    assert (share < 0.0).any()
    assert (np.abs(share) >= 0.5).all()
    assert (np.abs(share) <= 1.0).all()


STATE = ss.friction.RateAndState(reference=0.6, rate=1e-6, a=0.01, b=0.015, distance=1e-3)
LOSSY = replace(SLAB, driver_impedance=3e7)


@pytest.mark.parametrize(
    ("problem", "changed"),
    [
        (FAST, {"initial_excess": 3.0}),
        (replace(FAST, initial_excess=None, initial_load=7e7), {"initial_load": None, "initial_excess": -1e7 + 2.0}),
        (ss.Problem(SLAB, STATE, initial_load=6e7, initial_state=10.0), {"initial_load": 6e7 + 2.0}),
        (ss.Problem(LOSSY, WEAKENING, initial_load=7e7), {"initial_load": None, "initial_excess": -1e7 + 2.0, "far_stress": 7e7}),
        (ss.Problem(LOSSY, WEAKENING, initial_excess=1.0, far_stress=6e7), {"initial_excess": 3.0}),
        (ss.Problem(ss.SpringBlock(1.0, 1.0, 10.0), WEAKENING, initial_excess=0.0), {"initial_excess": 2.0}),
    ],
)
def test_only_the_initial_load_is_disturbed(problem: ss.Problem, changed: dict) -> None:
    assert disturbed(problem, 2.0) == replace(problem, **changed)


def events(*starts: float, slip: float = 1.0) -> pd.DataFrame:
    table = pd.DataFrame({"start": starts, "slip": slip, "peak_rate": 2.0, "amplification": 1.0, "end": starts})
    rows = np.floor(table.start / 10.0)
    return table.assign(recurrence=table.start.diff(), start_row=rows.astype(int), start_offset=table.start - 10.0 * rows)


OWN = events(0.0, 100.0, 110.0, 200.0)


@pytest.mark.parametrize(
    ("member", "shared"),
    [
        (events(0.0, 100.0, 110.0, 200.0), 4),
        (events(1.0, 100.9, 110.9, 208.9), 4),
        (events(1.0, 101.1, 110.0, 200.0), 1),
        (events(0.0, 100.0, 105.0, 110.0, 200.0), 2),
        (events(0.0, 110.0, 200.0), 1),
        (events(0.0, 100.0), 2),
        (events(), 0),
    ],
)
def test_events_are_shared_within_a_tenth_of_the_nearer_interval(member: pd.DataFrame, shared: int) -> None:
    """A tenth of the time to the nearer neighbour: 10, 1, 1 and 9 s; once lost is lost."""
    table, has = shared_events(OWN, [member, OWN], 10.0, until=300.0)
    assert has.sum(axis=1).tolist() == [shared, 4]
    assert table.members.tolist() == [2] * shared + [1] * (4 - shared)


def test_events_that_the_end_cuts_off_are_not_called_lost() -> None:
    lacking = events(0.0, 100.0, 110.0)
    assert len(shared_events(OWN, [lacking], 10.0, until=205.0)[0]) == 3
    assert len(shared_events(OWN, [OWN], 10.0, until=205.0)[0]) == 4
    assert len(shared_events(OWN, [lacking], 10.0, until=209.0)[0]) == 4


def test_slope_is_that_of_the_exponential() -> None:
    time = np.array([1.0, 2.0, 4.0, 8.0])
    assert slope(time, 5.0 * np.exp(0.25 * time)) == pytest.approx(0.25, rel=1e-13, abs=0.0)
    assert slope(time, np.full(4, 0.3)) == 0.0
    assert math.isnan(slope(time[:2], time[:2]))


def test_runs_that_end_early_are_compared_up_to_there() -> None:
    found = ensemble(FAST, 700 * TRIP, members=3, size=1e-4, max_pieces=3000)
    assert found.until < 700 * TRIP
    assert found.stopped.startswith(f"compared up to {found.until:.6g} s only, where the first run ended (too many pieces)")
    assert found.stopped in repr(found)
    assert all((table.start <= found.until).all() for table in found.catalogues)
    assert not found.ok


def test_ctrl_c_keeps_what_is_finished(fast: Ensemble) -> None:
    def at(name: str, text: str) -> None:
        if text.startswith(name):
            raise KeyboardInterrupt

    found = ensemble(FAST, 300 * TRIP, members=4, progress=partial(at, "member 3"))
    assert len(found.runs) == 2
    assert found.pushes.tolist() == fast.pushes[:2].tolist()
    assert found.stopped == "interrupted: 2 of 4 members"
    assert found.table.members.max() == 2
    for name in ("undisturbed", "member 1"):
        with pytest.raises(KeyboardInterrupt):
            ensemble(FAST, TRIP, members=4, progress=partial(at, name))


def test_an_interrupted_run_is_no_member(monkeypatch: pytest.MonkeyPatch) -> None:
    """simulate itself keeps what it has after Ctrl-C."""
    original, done = ss.simulate, []

    def stops(*arguments: object, **options: object) -> ss.Solution:
        found = original(*arguments, **options)
        done.append(found)
        return found if len(done) < 3 else replace(found, status=replace(found.status, name="interrupted", ok=False))

    monkeypatch.setattr(import_module("stickslip.extensions.studies.kept_runs"), "simulate", stops)
    found = ensemble(FAST, 20 * TRIP, members=4)
    assert len(found.runs) == 1
    assert found.stopped == "interrupted: 1 of 4 members"


def test_the_table_is_a_file(fast: Ensemble, tmp_path: Path) -> None:
    path = fast.to_csv(tmp_path / "a.csv")
    assert path.read_text().startswith("# written by stickslip\nstart,")
    table = pd.read_csv(path, comment="#")
    assert table.start.tolist() == fast.table.start.tolist()


BAD = [
    ({"members": 0}, "members must be a whole number from 1 to 1000, got 0"),
    ({"members": 2.5}, "members must be a whole number"),
    ({"size": 0.0}, "size must lie between 1e-15 and 0.01, got 0.0"),
    ({"size": math.nan}, "size must lie between"),
    ({"seed": -1}, "seed must be a whole number, 0 or more, got -1"),
    ({"duration": 0.0}, "duration must be greater than 0 s, got 0"),
    ({"rtol": 1.0}, "rtol must be at most 0.01 (a pure number), got 1"),
    ({"max_events": 0}, "max_events must be a whole number above 0"),
    ({"event_rate": -1.0}, "event_rate must be at least 0 m/s, got -1"),
    ({"problem": ss.Problem(SLAB, STATE, initial_load=0.0, initial_state=1.0)}, "neither a strength nor an initial load"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD)
def test_what_makes_no_sense_is_refused_in_one_line(arguments: dict, message: str) -> None:
    with pytest.raises(ss.InputError, match=r"^ensemble: [^\n]*$") as refused:
        ensemble(**({"problem": FAST, "duration": 1.0} | arguments))
    assert message in str(refused.value)


def _same(found: Ensemble, other: Ensemble) -> None:
    assert np.array_equal(found.pushes, other.pushes)
    for one, two in zip((found.reference, *found.runs), (other.reference, *other.runs), strict=True):
        assert differences(one, two) == []


@pytest.mark.slow
def test_an_ensemble_that_was_stopped_goes_on_with_the_runs_that_it_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It stops after the first member, and in the middle of the second, as a checkpoint of a killed run leaves it."""
    folder, whole = tmp_path / "kept", ensemble(FAST, 300 * TRIP, members=3)

    def stop(text: str) -> None:
        if text == "member 2 of 3":
            raise KeyboardInterrupt

    begun = ensemble(FAST, 300 * TRIP, members=3, checkpoint=folder, progress=stop)
    assert len(begun.runs) == 1
    assert sorted(path.name for path in folder.iterdir()) == ["member-1.nc", "undisturbed.nc"]
    half = ExactRun.begin(whole.runs[1].problem, CallOptions(300 * TRIP, creep_rtol=0.0, shortest_event=0.0))
    half.advance(50)
    assert 0 < half.length < len(whole.runs[1].history)
    save_checkpoint(half.solution(UNDER_WAY), folder / "member-2.nc")
    begun_anew = list[ss.Problem]()
    real = kept_runs.simulate

    def noted(scenario: ss.Scenario, *rest: Any, **more: Any) -> Any:
        begun_anew.append(scenario.problem)
        return real(scenario, *rest, **more)

    monkeypatch.setattr(kept_runs, "simulate", noted)
    _same(ensemble(FAST, 300 * TRIP, members=3, checkpoint=folder), whole)
    assert begun_anew == [whole.runs[2].problem]
    _same(ensemble(FAST, 300 * TRIP, members=3, checkpoint=folder), whole)
    assert len(begun_anew) == 1
    for other in ({"seed": 1}, {"rtol": 1e-9}, {"size": 1e-9}, {"max_events": 7}):
        with pytest.raises(ss.InputError, match="is a run of another ensemble: choose another folder, or remove this one"):
            ensemble(FAST, 300 * TRIP, members=3, checkpoint=folder, **other)
    (tmp_path / "link").symlink_to(folder)
    with pytest.raises(ss.InputError, match="link: is no folder"):
        ensemble(FAST, 300 * TRIP, members=3, checkpoint=tmp_path / "link")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
def test_an_ensemble_that_was_killed_goes_on(tmp_path: Path) -> None:
    code = """
ss.studies.ensemble("cycles-block", "10000 years", members=3, size=1e-6, checkpoint="kept")
"""
    ended = killed(code, tmp_path, "kept/member-2.nc", signal.SIGKILL, times=0)
    assert ended.returncode == -signal.SIGKILL
    assert not (tmp_path / "kept" / "member-3.nc").exists()
    asked = ("cycles-block", "10000 years", 3, 1e-6)
    _same(ensemble(*asked, checkpoint=tmp_path / "kept"), ensemble(*asked))
