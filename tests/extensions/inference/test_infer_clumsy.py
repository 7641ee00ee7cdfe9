"""Records as they come from laboratories: one line with the cure, or a note in the answer, and never a number from nonsense."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputWarning
from tests.extensions.inference.laboratory import correlated, load_point
from tests.messages import refused

CLOCK = np.linspace(0.0, 100.0, 401)
MOVED = load_point(CLOCK, [0.0, 50.0], [1e-6, 1e-5])
FRICTION = 0.6 + 1e-3 * np.tanh(CLOCK - 50.0) + 1e-4 * correlated(len(CLOCK), 0.0, 0)
GUESS = ss.Problem(ss.SpringBlock(20.0, 1e8, 5e4), ss.friction.RateAndState(0.6, 0.01, 0.009, 1e-5), pull_rate=1e-6)
SLAB = ss.Problem(
    ss.ElasticSlab(2700, 3000, 1.0, 5e6),
    ss.friction.RateAndState(0.6, 0.01, 0.009, 1e-5),
    **{"pull_rate": 1e-6, "initial_load": 3e6, "initial_state": 10.0},
)
GOOD = {"time (s)": CLOCK, "load point (m)": MOVED, "friction": FRICTION}
Record = ss.studies.Record


def stick_slip(moved: Any) -> dict[str, Any]:
    saw = 0.6 - 0.1 * ((CLOCK / 20.0) % 1.0 < 0.02) + 1e-3 * (CLOCK % 20.0)
    return {"time (s)": CLOCK, "load point (m)": moved, "friction": saw}


REFUSED: list[tuple[Any, dict[str, Any], str]] = [
    ({"load point (m)": MOVED, "friction": FRICTION}, {}, "record: no column 'time'"),
    ({"time (s)": CLOCK, "load point (m)": MOVED}, {}, "record: nothing measured"),
    ({"time (s)": CLOCK, "tau (N)": FRICTION}, {}, "record, column 2: the unit in the heading does not convert to Pa"),
    ({**GOOD, "friction": 100.0 * FRICTION}, {}, "record: friction is 60 in the median: is a stress in N, or friction in percent?"),
    (
        {"time (s)": CLOCK, "tau (Pa)": 3e6 * FRICTION, "load point (m)": MOVED},
        {},
        "record: the loads of a block are in N",
    ),
    ({**GOOD, "slip (m)": MOVED}, {}, "record: load_point and slip are the same numbers"),
    (stick_slip(1e-6 * CLOCK + 1e-4 * np.floor(CLOCK / 20.0)), {}, "record: load_point looks like slip"),
    ({**GOOD, "friction": np.full(len(CLOCK), np.nan)}, {}, "record: friction has no number in any row"),
    ({name: values[:3] for name, values in GOOD.items()}, {"free": ["a", "b", "distance"]}, "infer: 3 samples cannot determine 3 "),
    ({**GOOD, "time (s)": 0.0 * CLOCK}, {}, "record: all rows have one time, 0 s"),
    (GOOD, {"begin": 1000.0}, "record: fewer than two samples in the part that is asked for; the record goes from 0 to 100 s"),
    (GOOD, {"observe": "slip"}, "infer: observe: the record has no 'slip'"),
    (GOOD, {"free": ["frictoin.a"]}, "infer: free: 'frictoin.a' is no number of this problem; did you mean 'friction.a'?"),
    (GOOD, {"free": ["a", "a"]}, "infer: free: friction.a is named twice"),
    (GOOD, {"free": []}, "infer: free must name at least one number"),
    (GOOD, {"bounds": {"a": (0.02, 0.01)}}, "infer: bounds: friction.a: the first must be smaller"),
    (GOOD, {"priors": {"a": "gauss(0.01, 0.1)"}}, 'infer: priors: friction.a must be like "normal(0.6, 0.05)"'),
    (GOOD, {"loss": "l1"}, "infer: loss 'l1' is unknown"),
    (GOOD, {"parts": "rests"}, "record: no drop of friction stands out of its noise"),
    (GOOD, {"sensor": "sprnig"}, "infer: sensor 'sprnig' is unknown; did you mean 'spring'?"),
    (GOOD, {"held_out": 2.0}, "infer: held_out must be a share between 0 and 1"),
    (GOOD, {"start": "stuck"}, "infer: start 'stuck' is unknown"),
    ({**GOOD, "load point (m)": np.full(len(CLOCK), np.nan)}, {}, "record: load_point has no number in any row"),
    ({**GOOD, "friction": np.full(len(CLOCK), 0.6)}, {}, "record: friction is the same number in all rows"),
    ({**GOOD, "time (s)": pd.date_range("2026", periods=len(CLOCK))}, {}, "record: time holds dates: write seconds"),
    ({**GOOD, "friction": FRICTION > 0.6}, {}, "record: friction must be a column of numbers, got truth values"),
    ({}, {}, "record: no column 'time'; there are no headings: is it empty?"),
    ("no.csv", {}, "no.csv: no such file"),
    (3.0, {}, "infer: record must be a CSV file"),
]


@pytest.mark.parametrize(("data", "options", "message"), REFUSED, ids=[message[:50] for _, _, message in REFUSED])
def test_what_cannot_be_used_is_refused_in_one_line_with_the_cure(data: Any, options: dict[str, Any], message: str) -> None:
    options = {"starts": 1} | options
    with refused(begins=message):
        ss.studies.infer(GUESS, data, options.pop("free", ["a"]), **options)


def test_force_on_a_slab_and_its_sensor_are_refused() -> None:
    force = {"time (s)": CLOCK, "shear force (N)": 3e4 * FRICTION, "load point (m)": MOVED}
    with pytest.raises(ss.InputError, match="the loads of a slab are in Pa, and shear_force in N: give normal_force"):
        ss.studies.infer(SLAB, force, ["a"])
    with pytest.raises(ss.InputError, match="the load cell behind the spring of a block: a slab has none"):
        ss.studies.infer(SLAB, GOOD, ["a"], sensor="spring")


def test_rows_in_disorder_repeated_and_without_numbers_are_put_right_and_told() -> None:
    table = pd.DataFrame(GOOD)
    table.loc[7, "friction"] = np.nan
    table.loc[9, "time (s)"] = np.nan
    messy = pd.concat([table.iloc[200:], table.iloc[:201]])
    read = Record.read(messy)
    assert len(read) == 400
    assert (np.diff(read.time) > 0.0).all()
    assert read.notes == (
        "1 row without a time is left out",
        "friction has no number in 1 of 401 rows: left out",
        "the rows were not in the order of time: they were sorted",
        "1 row repeats a time: the mean was taken",
    )


def test_shear_of_the_wrong_sign_is_turned_and_told() -> None:
    read = Record.read({**GOOD, "friction": -FRICTION})
    assert read.measured["friction"] == pytest.approx(FRICTION)
    assert read.notes == ("friction is negative while the machine moves forwards: its sign was turned",)


def test_a_saturated_sensor_is_left_out_and_told() -> None:
    read = Record.read({**GOOD, "friction": np.where((CLOCK > 60.0) & (CLOCK < 65.0), 0.7, FRICTION)})
    assert np.isnan(read.measured["friction"]).sum() == 19
    assert "the sensor was saturated there" in read.notes[0]


def test_marks_of_missing_numbers_are_left_out_and_told() -> None:
    """Programs write -999 where nothing was measured; a slip event, however large, lasts for more samples."""
    read = Record.read({**GOOD, "friction": np.where(np.isin(np.arange(len(CLOCK)), [7, 8, 300]), -999.0, FRICTION)})
    assert np.flatnonzero(np.isnan(read.measured["friction"])).tolist() == [7, 8, 300]
    told = "-999 marks a missing number of friction in 3 rows", f"friction has no number in 3 of {len(CLOCK)} rows: left out"
    assert read.notes == told
    far = Record.read({**GOOD, "friction": np.where(np.isin(np.arange(len(CLOCK)), [7, 8, 300]), -700.0, FRICTION)})
    assert far.notes == ("friction is far beyond the rest in 3 lone samples, as at -700: left out",)
    preload = np.where(np.arange(len(CLOCK)) > 380, FRICTION, 1e-4)
    assert np.isfinite(Record.read({**GOOD, "friction": preload}).measured["friction"]).all()


def test_a_load_point_that_counts_backwards_is_asked_about() -> None:
    (note,) = Record.read({**GOOD, "load point (m)": -MOVED}).notes
    assert note == "load_point falls while friction is positive: does its sensor count backwards, so that its sign must be turned?"
    assert Record.read({**GOOD, "load point (m)": -MOVED, "friction": -FRICTION}).notes == ()


def test_stress_in_newtons_is_asked_about_where_no_run_succeeds() -> None:
    newtons = {"time (s)": CLOCK, "load point (m)": MOVED, "tau (Pa)": 3e4 * FRICTION, "sigma (MPa)": np.full(len(CLOCK), 5.0)}
    with pytest.raises(ss.InputError, match="are the units of shear and normal stress in the headings right"):
        ss.studies.infer(GUESS, newtons, ["a"], starts=1)


def test_a_load_point_that_is_hardly_in_metres_is_warned_about() -> None:
    with pytest.warns(InputWarning, match="load_point, has no unit and is read in m"):
        Record.read({"time (s)": CLOCK, "load_point": 1e6 * MOVED, "friction": FRICTION})


FILES = [
    ("", "no column 'time'; there are no headings: is it empty?"),
    ("time (s),load point (m),mu\n", "at least two rows with a time are needed, got 0"),
    ("time (s);load point (m);mu\n1,100;2,000;1,600\n", "has a decimal comma, or one that groups thousands"),
    ("time (s),load point (m),mu\n0,1,0,0,0,6\n", "6 cells, but the header has 3; decimal commas?"),
    ("time,load point (m),mu\n2026-05-01 12:00:07,0,0.6\n", "times of day are not read, write seconds from the start"),
    ("time,load point,mu\n(s),(g),(-)\n0,0,0.6\n", "line 2, column 2: the unit in the heading does not convert to m"),
    ("time load_point mu\n0 0 0.6 7\n", "columns are separated by commas, semicolons, tabs or blanks"),
    ("time (s),mu\n0,0.6\n1,0.6\nend of test\n2,0.6\n", "time must be a number, got text"),
]


@pytest.mark.parametrize(("text", "message"), FILES, ids=[message[:40] for _, message in FILES])
def test_files_that_cannot_be_read_are_refused_in_one_line(tmp_path: Any, text: str, message: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with refused(message):
        Record.read(path)


def test_a_folder_in_place_of_a_file_is_refused(tmp_path: Any) -> None:
    with pytest.raises(ss.InputError, match="Is a directory"):
        Record.read(tmp_path)


def test_values_in_steps_of_the_digitiser_are_no_saturation() -> None:
    read = Record.read({**GOOD, "friction": np.round(FRICTION, 3)})
    assert read.notes == ()


def test_notes_before_the_headings_synonyms_and_units_are_understood(tmp_path: Any) -> None:
    lines = ["Acquisition 4.2", "operator: A", "", "Time (min);Load point displacement (mm);tau (MPa);sigma n (MPa);v (um/s)"]
    lines += [f"{t / 60};{1e3 * x};{5 * mu};5;1" for t, x, mu in zip(CLOCK, MOVED, FRICTION, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(lines))
    read = Record.read(path)
    assert read.measured["friction"] == pytest.approx(FRICTION, rel=1e-12)
    assert read.load_point == pytest.approx(MOVED, rel=1e-12)
    assert read.measured["slip_rate"] == pytest.approx(1e-6)
    assert read.clock == pytest.approx(CLOCK)


@pytest.mark.slow
def test_given_standard_deviations_weigh_and_are_doubted_if_too_small() -> None:
    options: dict[str, Any] = {"starts": 1}
    data = {**GOOD, "standard deviation": np.full(len(CLOCK), 1e-5)}
    study = ss.studies.infer(GUESS, data, ["reference"], **options)
    assert any("times the standard deviations given" in note for note in study.notes)


def test_a_run_that_cannot_begin_is_told_with_the_reason() -> None:
    hold = {**GOOD, "load point (m)": np.maximum(MOVED - 2e-5, 0.0)}
    with pytest.raises(ss.InputError, match="steadily"):
        ss.studies.infer(GUESS, hold, ["a"], starts=1)


def test_columns_that_are_not_understood_are_told_where_there_is_no_load_point() -> None:
    record = ss.studies.Record.read({"time": [0.0, 1.0, 2.0], "mu": [0.6, 0.61, 0.62], "Displ (um)": [0.0, 1.0, 2.0]})
    (note,) = record.notes
    assert note.startswith("columns that were not understood: 'Displ (um)'; the displacement of the machine is called load_point")


def test_a_few_samples_at_the_end_of_a_range_are_saturated_if_noise_would_move_them() -> None:
    """A short peak is cut off at three samples only, which would nearly double the direct effect that is found."""
    noise = 3e-4 * correlated(len(CLOCK), 0.0, 4)
    peak = 0.6 + 0.01 * np.exp(-0.5 * ((CLOCK - 50.0) / 0.5) ** 2)
    cut = np.minimum(np.round(peak + noise, 5), 0.605)
    read = Record.read({**GOOD, "friction": cut})
    assert np.isnan(read.measured["friction"]).sum() == (cut == 0.605).sum() >= 3
    whole = Record.read({**GOOD, "friction": np.round(peak + noise, 5)})
    assert np.isfinite(whole.measured["friction"]).all()


def test_a_run_of_equal_samples_without_noise_is_not_saturated() -> None:
    rest = np.where(CLOCK < 90.0, 0.6 + 1e-4 * CLOCK, 0.609)
    assert np.isfinite(
        Record.read({**GOOD, "friction": np.where((CLOCK > 90.0) & (CLOCK < 91.2), 0.61, rest)}).measured["friction"]
    ).all()


@pytest.mark.parametrize("steps", [1, 20])
def test_a_record_of_two_levels_without_noise_is_not_saturated(steps: int) -> None:
    """Each level is an end of the range, and less than half of the record; both together are nearly all of it."""
    level = np.where(CLOCK < 49.0, 0.6, 0.61)
    level[np.abs(CLOCK - 49.0) <= 0.125 * steps] = 0.605 + 1e-4 * np.arange((np.abs(CLOCK - 49.0) <= 0.125 * steps).sum())
    assert np.isfinite(Record.read({**GOOD, "friction": level}).measured["friction"]).all()


def test_a_load_point_in_another_unit_is_doubted() -> None:
    record = {name: values[:101] for name, values in {**GOOD, "load point (m)": 1e3 * MOVED}.items()}  # all of it takes long
    study = ss.studies.infer(GUESS, record, ["reference"], starts=1)
    assert study.notes[0].startswith("the load point moves at 1 mm/s, and at 1 um/s in the problem: are the units")


def test_slip_in_place_of_the_load_point_is_doubted_where_it_does_not_jump() -> None:
    slip = 1e-6 * (CLOCK + 20.0 * np.sin(CLOCK / 3.0) * np.exp(-CLOCK / 30.0))
    study = ss.studies.infer(GUESS, {**GOOD, "load point (m)": slip}, ["reference"], starts=1)
    assert any("as slip does and a driven machine hardly" in note for note in study.notes)


def test_a_ramp_is_no_slip() -> None:
    """The load point goes on from 1 to 3 um/s, as a machine may: nothing is doubted."""
    ramp = 1e-6 * (CLOCK + np.maximum(CLOCK - 10.0, 0.0) ** 2 / CLOCK[-1])
    study = ss.studies.infer(GUESS, {**GOOD, "load point (m)": ramp}, ["reference"], starts=1)
    assert not any("machine hardly" in note for note in study.notes)


def test_a_force_that_is_no_friction_under_the_normal_force_is_refused() -> None:
    data = {"time (s)": CLOCK, "load point (m)": MOVED, "shear force (N)": 30.0 * FRICTION}
    message = "record: shear_force is 0.00036 times the problem's normal force of 50 kN, in the median: is its unit"
    with pytest.raises(ss.InputError, match=message):
        ss.studies.infer(GUESS, data, ["reference"], starts=1)
