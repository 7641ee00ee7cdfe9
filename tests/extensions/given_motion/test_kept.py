"""Runs along given motions are kept whole, go on bit for bit, and their files are not trusted."""

from __future__ import annotations

import signal
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from stickslip.foundation.netcdf_file import read_tables, write_variables
from tests.extensions.given_motion.running import refused, stickslip

AGEING = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um")
LUGRE = ss.friction.LuGre(static=0.15, dynamic=0.1, rate="1 mm/s", stiffness=2e3, damping=1.5)
TWO = ss.friction.TwoStateRateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um", second_b=0.004, second_distance="50 um")
COUPLED = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um", normal_stress_coupling=0.2)
STEPS = ss.loading.Steps([0.0, "20 s", "35.7 s"], ["1 um/s", "10 um/s", "2 um/s"])
SWING = ss.loading.Sinusoidal(mean=0.0, amplitude=2e-3, period="0.7 s")
PULSING = ss.loading.Sinusoidal(mean="5 MPa", amplitude="1 MPa", period="3.3 s")
SAWTOOTH = ss.loading.PiecewiseLinear([0.0, 1.0, 2.0, 3.0, 4.0], [1e-3, -1e-3, 0.0, 0.0, 2e-3])
RUNS = {
    "steps": (ss.MovedContact(AGEING, STEPS, "5 MPa"), 60.0),
    "two states": (ss.MovedContact(TWO, STEPS, "5 MPa"), 50.0),
    "to and fro": (ss.MovedContact(LUGRE, SWING, "100 N"), 3.0),
    "pulsing load": (ss.MovedContact(COUPLED, STEPS, PULSING), 45.0),
    "steps of load": (ss.MovedContact(COUPLED, "1 um/s", ss.loading.Steps([0.0, 7.0], ["5 MPa", "6 MPa"])), 20.0),
    "with a rest": (ss.MovedContact(LUGRE, SAWTOOTH, "100 N"), 4.5),
    "no change": (ss.MovedContact(AGEING, "1 um/s", "5 MPa", initial_state="1 s"), 30.0),
    "turning": (
        ss.MovedContact(ss.friction.LuGre(static=0.2, dynamic=0.1, rate="1 rad/s", stiffness=1e3), "3 rad/s", "2 N m"),
        1.0,
    ),
    "no state": (ss.MovedContact(ss.friction.Coulomb(static=0.6, dynamic=0.5), SAWTOOTH, "100 N"), 4.0),
}
"""Motions of all kinds, each with a duration."""


def check_same(one: Any, other: Any) -> None:
    """Compare two runs bit for bit."""
    assert (one.duration, one.asked_duration, one.rtol, one.title, one.status) == (
        other.duration,
        other.asked_duration,
        other.rtol,
        other.title,
        other.status,
    )
    assert (one.steps is None) == (other.steps is None)
    for name in [field.name for field in fields(one.steps)] if one.steps is not None else []:
        np.testing.assert_array_equal(getattr(one.steps, name), getattr(other.steps, name), err_msg=name)
    np.testing.assert_array_equal(one.motion.table(), other.motion.table())
    pd.testing.assert_frame_equal(one.at(one.times), other.at(other.times), check_exact=True)


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("name", RUNS)
def test_a_file_gives_the_run_back(name: str, tmp_path: Path) -> None:
    moved, duration = RUNS[name]
    run = ss.simulate(moved, duration, rtol=1e-8, title=name, checkpoint=tmp_path / "run.nc")
    check_same(run, ss.open_solution(tmp_path / "run.nc"))
    check_same(run, ss.simulate(moved, duration, rtol=1e-8, title=name))
    check_same(run, ss.open_solution(run.to_netcdf(tmp_path / "other.nc")))


@pytest.mark.sampled(every=36)
@pytest.mark.parametrize("share", [0.2, 0.55, 0.83, 0.999])
@pytest.mark.parametrize("name", RUNS)
def test_a_resumed_run_is_the_uninterrupted_one_bit_for_bit(name: str, share: float, tmp_path: Path) -> None:
    moved, duration = RUNS[name]
    file = tmp_path / "run.nc"
    ss.simulate(moved, share * duration, checkpoint=file)
    whole = ss.simulate(moved, duration)
    check_same(ss.resume(file, duration), whole)
    check_same(ss.open_solution(file), whole)


class Stops:
    """A solver's steps, a few at a time, with Ctrl-C after some of them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, calls: int) -> None:
        from stickslip.extensions.given_motion.solve import StatesUnderWay

        self.left, advance = calls, StatesUnderWay.advance

        def slowly(run: StatesUnderWay, most: int) -> None:
            advance(run, 7)
            self.left -= 1
            if self.left == 0:
                signal.raise_signal(signal.SIGINT)

        monkeypatch.setattr(StatesUnderWay, "advance", slowly)


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize("calls", [1, 3, 6])
@pytest.mark.parametrize("name", ["steps", "to and fro", "pulsing load", "with a rest"])
def test_ctrl_c_leaves_a_file_that_goes_on(name: str, calls: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    moved, duration = RUNS[name]
    file = tmp_path / "run.nc"
    with monkeypatch.context() as patch:
        Stops(patch, calls)
        stopped = ss.simulate(moved, duration, checkpoint=file)
    assert stopped.status.name == "interrupted"
    assert 0.0 < stopped.duration < duration == stopped.asked_duration
    assert len(stopped.steps.length) == 7 * calls
    assert "interrupted: stopped by the user" in str(stopped)
    check_same(stopped, ss.open_solution(file))
    assert float(stopped.times[-1]) == stopped.duration
    check_same(ss.resume(file), ss.simulate(moved, duration))


def test_a_checkpoint_of_a_killed_run_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    moved, duration = RUNS["to and fro"]
    file = tmp_path / "run.nc"

    def killed(text: str) -> None:
        if file.exists():
            raise MemoryError

    with monkeypatch.context() as patch:
        Stops(patch, -1)
        with pytest.raises(MemoryError):
            ss.simulate(moved, duration, checkpoint=file, checkpoint_every=0, progress=killed)
    left = ss.open_solution(file)
    assert left.status.name == "under way"
    assert 0.0 < left.duration < duration
    check_same(ss.resume(file), ss.simulate(moved, duration))


def test_progress_is_told_as_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    moved, duration = RUNS["to and fro"]
    Stops(monkeypatch, -1)
    said: list[str] = []
    ss.simulate(moved, duration, progress=said.append)
    assert said[0].startswith("0.")
    assert said[0].split(",")[0].endswith(" of 3 s")
    assert said[-1].startswith("3 of 3 s")


def test_a_file_says_where_it_comes_from_and_opens_in_xarray(tmp_path: Path) -> None:
    moved, duration = RUNS["steps"]
    run = ss.simulate(moved, duration, checkpoint=tmp_path / "run.nc", title="A test")
    with xr.open_dataset(tmp_path / "run.nc") as found:
        assert found.attrs["source"] == f"stickslip {ss.__version__}"
        assert found.attrs["status"] == "finished"
        assert "[motion]" in found.attrs["scenario"]
        assert "[body]" not in found.attrs["scenario"]
        assert found.traction.attrs["units"] == "Pa"
        np.testing.assert_array_equal(found.traction, run.traction(run.times))


def test_the_command_line_keeps_shows_exports_and_resumes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenario, file, csv, curves = (tmp_path / name for name in ("steps.toml", "run.nc", "run.csv", "curves.nc"))
    run = ss.simulate(*RUNS["steps"], title="A test", checkpoint=tmp_path / "python.nc")
    with xr.open_dataset(tmp_path / "python.nc") as found:
        scenario.write_text(found.attrs["scenario"], encoding="utf-8")
    stickslip("run", scenario, "--out", file, "--duration", "31 s")
    said = capsys.readouterr().out
    assert "along a given motion of 31 s" in said
    assert str(file) in "".join(said.split("\n"))
    stickslip("run", "--resume", file, "--duration", "60 s")
    capsys.readouterr()
    check_same(ss.open_solution(file), run)
    stickslip("run", scenario, "--resume", file)
    stickslip("show", file, "--figure", tmp_path / "run.png")
    said = capsys.readouterr().out
    assert "along a given motion of 60 s, in 4 intervals" in said
    assert f"made by stickslip {ss.__version__}" in said
    stickslip("show", file, "--scenario")
    assert capsys.readouterr().out.strip() == scenario.read_text(encoding="utf-8").strip()
    stickslip("export", file, csv)
    stickslip("export", file, curves)
    table = pd.read_csv(csv)
    assert list(table["traction (Pa)"]) == list(run.traction(run.times))
    with xr.open_dataset(curves) as found:
        np.testing.assert_array_equal(found.state, run.state(run.times))
    for words, why in (
        (("run", scenario, "--out", tmp_path / "run.zarr"), "--out"),
        (("run", scenario, "--max-events", "3"), "--max-events"),
        (("run", scenario, "--animation", tmp_path / "x.gif"), "--animation"),
        (("run", "--resume", file, "--duration", "10 s"), "the run has already reached 60 s"),
        (("run", "--resume", file, "--max-pieces", "10000"), "--max-pieces"),
        (("run", "block", "--resume", file), "is a run of another problem than block: its [friction] differs"),
        (("export", file, csv, "--points", "10"), "written at its own times: leave out --points"),
        (("compare", file, file), ""),
        (("explore", file), ""),
    ):
        refused(*words)
        said = capsys.readouterr().err
        assert why in said
        assert len(said.strip().splitlines()) == 1, said


def test_tolerance_is_an_option_and_is_kept(tmp_path: Path) -> None:
    moved, duration = RUNS["steps"]
    file = tmp_path / "run.nc"
    loose = ss.simulate(moved, duration, rtol=1e-5, checkpoint=file)
    assert len(loose.steps.length) < len(ss.simulate(moved, duration).steps.length)
    check_same(ss.resume(file), loose)


class Own(ss.friction.Coulomb):
    """A law of a user's own, which files do not know."""


def test_a_law_that_a_file_cannot_name_is_refused_before_the_run(tmp_path: Path) -> None:
    moved = ss.MovedContact(Own(static=0.6, dynamic=0.5), "1 mm/s", "100 N")
    assert ss.simulate(moved, 1.0).duration == 1.0
    with pytest.raises(ss.InputError, match=r"save: .*friction.* kind 'Own' is unknown"):
        ss.simulate(moved, 1.0, checkpoint=tmp_path / "run.nc")
    assert not (tmp_path / "run.nc").exists()


def damaged(file: Path, change: Any) -> Path:
    """Write the content of a file anew with a change, and a checksum that is right."""
    tables = read_tables(file)
    change(tables.variables, tables.attrs)
    return write_variables(tables.variables, tables.attrs, file)


def put(name: str, index: Any, value: float) -> Any:
    """Return what puts a number into an array."""

    def change(variables: Any, attrs: Any) -> None:
        array = np.array(variables[name].values)
        array[index] = value
        variables[name] = variables[name]._replace(values=array)

    return change


WRONG = {
    "no steps": (lambda v, a: v.pop("step_values"), "is missing or wrong"),
    "other shape": (
        lambda v, a: v.update(step_length=v["step_length"]._replace(dims=("x",), values=np.ones(3))),
        "step_interval is",
    ),
    "no number": (put("step_values", (5, 0, 2), np.nan), "step_values must be finite"),
    "endless": (put("step_length", 3, np.inf), "step_length must be finite"),
    "backwards": (put("step_length", 3, -1.0), "lengths of steps must be above 0"),
    "gap": (put("step_since", 3, 1.0), "its steps leave gaps in time, or overlap"),
    "far interval": (put("step_interval", -1, 9), "not in the intervals of its motion"),
    "negative interval": (put("step_interval", 0, -1), "not in the intervals of its motion"),
    "jump": (put("step_values", (5, 0, 0), 0.3), "its states jump inside an interval"),
    "other start": (put("step_values", (0, 0, 0), 3.0), "its states jump where the motion does not"),
    "negative error": (put("step_errors", (2, 0), -1.0), "step_errors are bounds"),
    "other format": (lambda v, a: a.update(stickslip_motion_format=7), "format 1 expected, found 7"),
    "no scenario": (lambda v, a: a.pop("scenario"), "'scenario' is missing or wrong"),
    "scenario of a block": (
        lambda v, a: a.update(scenario=ss.scenarios["fig6-block-printed"].to_toml()),
        "its scenario has no [motion]",
    ),
    "endless scenario": (lambda v, a: a.update(scenario=a["scenario"].replace("duration = 60.0", "duration = inf")), "duration"),
    "other duration": (
        lambda v, a: a.update(scenario=a["scenario"].replace("duration = 60.0", "duration = 90.0")),
        "its status is",
    ),
    "no text": (lambda v, a: a.update(scenario=5), "not TOML"),
}


@pytest.mark.sampled(every=17)
@pytest.mark.parametrize("name", WRONG)
def test_a_file_that_no_run_wrote_is_refused_in_one_line(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    change, why = WRONG[name]
    file = tmp_path / "run.nc"
    ss.simulate(*RUNS["steps"], checkpoint=file)
    damaged(file, change)
    for opening in (ss.open_solution, ss.resume):
        with pytest.raises(ss.InputError) as error:
            opening(file)
        assert str(error.value).startswith(str(file))
        assert why in str(error.value)
        assert "\n" not in str(error.value)
    refused("show", file)
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


def test_a_file_that_is_cut_off_or_changed_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "run.nc"
    ss.simulate(*RUNS["steps"], checkpoint=file)
    content = file.read_bytes()
    for broken in (content[:-200], content[: len(content) // 2], content[:5000] + b"x" + content[5001:], b""):
        file.write_bytes(broken)
        with pytest.raises(ss.InputError, match=r"run\.nc"):
            ss.open_solution(file)


def test_other_code_does_not_go_on(tmp_path: Path) -> None:
    file = tmp_path / "run.nc"
    ss.simulate(*RUNS["steps"], checkpoint=file)
    damaged(file, lambda v, a: a.update(engine="0123456789abcdef"))
    assert ss.open_solution(file).duration == 60.0
    with pytest.raises(ss.InputError, match="cannot be resumed: another version of stickslip's code made it"):
        ss.resume(file, 70.0)


REFUSED = [
    ({"checkpoint": "run.csv"}, "is kept in a file NAME.nc, got 'run.csv'"),
    ({"checkpoint": "run.nc", "max_events": 3}, "a MovedContact has no max_events: leave it out"),
]


@pytest.mark.parametrize(("given", "said"), REFUSED)
def test_options_that_a_given_motion_does_not_have(given: dict[str, Any], said: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ss.simulate(*RUNS["steps"], **given)
    assert said in str(error.value)
