"""Marks of missing numbers in runs of any length, columns that the user names, and columns without a unit."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extensions.schemes.series import read_series
from stickslip.foundation.errors import InputWarning
from stickslip.foundation.marks import MARKS, marked
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_text
from stickslip.friction import FromTable, Points
from tests.extensions.inference.laboratory import correlated

Floats = NDArray[np.float64]
Record = ss.studies.Record
COUNT = 400
CLOCK = np.linspace(0.0, 100.0, COUNT)


def channel(rng: np.random.Generator) -> Floats:
    """Return a channel as rigs record them, away from marks: steady with noise, a ramp, stick-slip, or in a digitiser's steps."""
    size = 10.0 ** rng.uniform(-6.0, 2.0)
    noise = rng.choice([0.0, 1e-3, 0.1]) * rng.standard_normal(COUNT)
    kinds: list[Floats] = [
        5.0 + noise,
        np.linspace(0.0, 9.0, COUNT) + noise,
        8.0 + (0.05 * np.arange(COUNT)) % 2.0 + noise,
        np.round(6.0 + noise, 2),
        np.where(np.arange(COUNT) < COUNT // 2, 1.0, 7.0) + noise,
        np.full(COUNT, 3.0),
    ]
    return size * kinds[rng.integers(len(kinds))]


@pytest.mark.slow
def test_marks_in_runs_of_any_length_are_found_and_nothing_else() -> None:
    rng = np.random.default_rng(1)
    for _ in range(400):
        values, missing = channel(rng), np.zeros(COUNT, bool)
        for _ in range(int(rng.integers(1, 6))):
            begin, length = int(rng.integers(COUNT)), int(rng.choice([1, 2, 3, 5, 8, 40, 150]))
            values[begin : begin + length] = rng.choice([*MARKS, 1e30, -1e30, 1.7e38])
            missing[begin : begin + length] = True
        assert marked(values).tolist() == missing.tolist()


def passing(rng: np.random.Generator, mark: float) -> Floats:
    """Return a channel that takes the value of a mark itself, in whole numbers: as a ramp, a turn, noise, or a rest there."""
    size, number = abs(mark), np.arange(COUNT)
    step = size * 10.0 ** rng.uniform(-3.0, -1.0)
    kinds: list[Floats] = [
        mark + step * (number - rng.integers(2, COUNT - 2)),
        mark + 0.02 * size * (1.0 - np.cos(0.03 * (number - rng.integers(COUNT)))),
        mark + step * rng.standard_normal(COUNT),
        mark + 0.5 * step * np.abs(np.cumsum(rng.standard_normal(COUNT))),
        np.where(number < COUNT // 2, mark + step * (COUNT // 2 - number), mark),
    ]
    return np.asarray(mark + np.round(kinds[rng.integers(len(kinds))] - mark))


def test_a_channel_that_passes_through_a_mark_is_not_harmed() -> None:
    rng, met = np.random.default_rng(2), 0
    for _ in range(400):
        mark = float(rng.choice(MARKS))
        values = passing(rng, mark)
        met += int((values == mark).sum())
        assert not marked(values).any()
    assert met > 400


def test_marks_that_stand_beside_a_passage_are_told_from_it() -> None:
    """A load cell in N from -2000 to 0: one of its samples is -999, and a logger wrote -999 for none elsewhere."""
    values = -2000.0 + 7.0 * np.arange(280)
    assert values[143] == -999.0
    values[[20, 21, 22, 23, 24, 25, 200]] = -999.0
    assert np.flatnonzero(marked(values)).tolist() == [20, 21, 22, 23, 24, 25, 200]


def test_each_way_to_tell_data_from_a_mark_has_its_limit() -> None:
    """A drop that one sample meets on its way; noise far from a mark; a strong motion in a record that is quiet elsewhere."""
    drop = np.where(np.arange(60) < 30, -10.0, -3000.0)
    drop[30] = -999.0
    assert not marked(drop).any()
    drop[31:34] = -999.0
    assert np.flatnonzero(marked(drop)).tolist() == [30, 31, 32, 33]  # four equal samples are no way down
    rng = np.random.default_rng(3)
    noise = -700.0 + 10.0 * rng.standard_normal(COUNT)
    noise[[50, 90, 91]] = -999.0
    assert np.flatnonzero(marked(noise)).tolist() == [50, 90, 91]
    strong = np.round(1.5 * rng.standard_normal(COUNT))
    strong[100:160] = np.round(700.0 * rng.standard_normal(60))
    strong[[130, 300]] = -999.0
    strong[[129, 131]] = -350.0, 120.0
    assert np.flatnonzero(marked(strong)).tolist() == [300]


def test_a_column_of_marks_only_has_no_number() -> None:
    assert marked(np.full(9, -999.25)).all()
    with pytest.raises(ss.InputError, match="record: friction has no number in any row"):
        Record.read({"time (s)": CLOCK, "mu": np.full(COUNT, -999.25)})


FRICTION = 0.6 + 1e-3 * np.tanh(CLOCK - 50.0) + 1e-4 * correlated(COUNT, 0.0, 0)


@pytest.mark.parametrize(("mark", "length"), [(-999.25, 1), (-999.25, 5), (-9999.0, 60), (1e30, 7), (-9999.25, 300)])
def test_a_record_says_how_many_marks_it_had_in_a_file_and_in_memory(tmp_path: Path, mark: float, length: int) -> None:
    """In the file friction is in a column of a stress in MPa: a mark is a number of the file, not of SI."""
    tau = 5.0 * FRICTION
    tau[40 : 40 + length] = mark
    rows = "".join(f"{t:.9g},{one:.9g}\n" for t, one in zip(CLOCK, tau, strict=True))
    (tmp_path / "a.csv").write_text(f"time (s),tau (MPa)\n{rows}")
    told = f"{mark:.7g} marks a missing number of shear_stress in {length} row{'s' * (length > 1)}"
    for record in (Record.read(tmp_path / "a.csv"), Record.read({"time (s)": CLOCK, "tau (MPa)": tau})):
        assert np.flatnonzero(np.isnan(record.measured["shear_stress"])).tolist() == list(range(40, 40 + length))
        assert record.notes[0] == told
        assert record.notes[1] == f"shear_stress has no number in {length} of {COUNT} rows: left out"


def test_rows_whose_time_is_a_mark_are_left_out() -> None:
    time = CLOCK.copy()
    time[7:19] = -999.25
    assert len(Record.read({"time (s)": time, "mu": FRICTION})) == COUNT - 12


LAW = "v (m/s),mu\n0.1,0.7\n0.2,-999.25\n0.3,-999.25\n0.4,0.6\n"
HISTORY = "time (s),ground_acceleration (g)\n0,0\n0.5,-999.25\n1,0.1\n"
SCENARIO = (
    '[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 1.0\nnormal_force = 1.0\n[friction]\nkind = "coulomb"\nstatic = 0.6\n'
    'dynamic = 0.5\n[loading.ground_acceleration]\nkind = "piecewise-linear"\nfile = "a.csv"\n{more}[initial]\nload = 0.0\n'
    "[run]\nduration = 1.0\n"
)


def shaking(folder: Path, text: str, more: str = "") -> Any:
    """Return the history of ground acceleration in a file beside a scenario."""
    (folder / "a.csv").write_text(text, encoding="utf-8")
    (folder / "s.toml").write_text(SCENARIO.format(more=more), encoding="utf-8")
    return ss.load_scenario(folder / "s.toml").problem.ground_acceleration


def test_marks_are_left_out_of_points_and_refused_in_a_loading_history(tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text(LAW)
    with pytest.warns(InputWarning, match=r"points\.csv: -999\.25 marks a missing number of friction in 2 rows: left out") as said:
        points = Points.read(tmp_path / "points.csv")
    assert len(said) == 1
    assert points.friction.tolist() == [0.7, 0.6]
    with pytest.raises(ss.InputError, match=r"'a\.csv', line 3: ground_acceleration is -999\.25, which marks a missing number"):
        shaking(tmp_path, HISTORY)


# ---- columns without a unit ------------------------------------------------------------------------------------------------


def read_record(folder: Path, text: str) -> object:
    (folder / "a.csv").write_text(text)
    return Record.read(folder / "a.csv")


def read_points(folder: Path, text: str) -> object:
    (folder / "a.csv").write_text(text)
    return Points.read(folder / "a.csv")


def read_law(folder: Path, text: str) -> object:
    (folder / "a.csv").write_text(text)
    return FromTable(folder / "a.csv")


def read_other(folder: Path, text: str) -> object:
    (folder / "a.csv").write_text(text)
    return read_series(folder / "a.csv")


Reader = Callable[[Path, str], object]
BARE: list[tuple[Reader, str, str]] = [
    (read_record, "time,mu\n0,0.6\n1,0.6\n", "column 1, time, has no unit and is read in s"),
    (read_record, "timestamps,mu\n0,0.6\n1,0.6\n", "column 1, time, has no unit and is read in s"),
    (read_record, "t (s),mu,LPD\n0,0.6,0\n1,0.6,1\n", "column 3, load_point, has no unit and is read in m"),
    (read_points, "v,mu\n0,0.6\n1,0.6\n", "column 1, slip_rate, has no unit and is read in m/s"),
    (read_law, "slip,mu\n0,0.6\n1,0.6\n", "column 1, slip, has no unit and is read in m"),
    (shaking, "time (s),ground_acceleration\n0,0\n1,0.1\n", "column 2, ground_acceleration, has no unit and is read in m/s^2"),
    (shaking, "time,acc (g)\n0,0\n1,0.1\n", "column 1, time, has no unit and is read in s"),
    (
        read_other,
        "time,slip,slip_rate,traction\n0,0,0,1\n1,0,0,1\n2,0,0,1\n",
        "column 1, time, has no unit and is read in s, and column 2, slip, in m, and column 3, slip_rate, in m/s, and column 4, "
        "shear_stress, in Pa; if they are in others, write them into the headings, as in time (ms), or name",
    ),
]


@pytest.mark.parametrize(("reader", "text", "message"), BARE)
def test_a_file_whose_heading_has_no_unit_is_warned_about_once_with_the_cure(
    tmp_path: Path, reader: Reader, text: str, message: str
) -> None:
    with pytest.warns(InputWarning, match=f"a.csv.*, line 1: {re.escape(message)}.*--column, columns") as said:
        reader(tmp_path, text)
    assert len(said) == 1


def test_the_cure_that_the_warning_names_is_read(tmp_path: Path) -> None:
    with pytest.warns(InputWarning) as said:
        read_record(tmp_path, "time,mu\n0,0.6\n1000,0.6\n")
    cure = re.search(r'(\w+)="([^"]*)"$', str(said[0].message))
    assert cure is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        record = Record.read(tmp_path / "a.csv", columns={cure[1]: cure[2]})
    assert record.time.tolist() == [0.0, 1.0]


def test_arrays_and_the_layout_of_the_benchmarks_need_no_unit(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Record.read({"time": CLOCK, "mu": FRICTION})
        read_other(tmp_path, "t h-slip h-slip-rate h-shear-stress\n0 0 0 1\n1 0 0 1\n2 0 0 1\n")
        read_points(tmp_path, "v (m/s),tau,sigma\n0,6,10\n1,6,10\n")


# ---- columns that the user names -------------------------------------------------------------------------------------------

RIG = "Zeit (ms),Vert_disp (micron),Kanal 3,Ram_mm,Kanal 3b\n0,1,0.60,4,7\n100,2,0.61,5,8\n200,4,0.62,6,9\n"
NAMED: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"time": "Zeit (ms)", "load_point": "Vert_disp (micron)", "friction": "Kanal 3"}, {}),
    ({"time": "Zeit", "load_point": "Vert_disp", "mu": "kanal 3"}, {}),
    ({"time": 1, "lp disp": 2, "friction": "3"}, {}),
    ({"time": "1 (ms)", "load_point": "vert disp (micron)", "friction": "Kanal 3 (-)"}, {}),
    ({"time": "Zeit", "load_point": "Ram_mm", "friction": 3}, {"load_point": [4e-3, 5e-3, 6e-3]}),
    ({"time": "Zeit", "load_point": "4 (um)", "friction": 3}, {"load_point": [4e-6, 5e-6, 6e-6]}),
]


@pytest.mark.parametrize(("columns", "other"), NAMED)
def test_columns_are_named_by_heading_with_or_without_unit_or_by_number(
    tmp_path: Path, columns: dict[str, Any], other: dict[str, Any]
) -> None:
    (tmp_path / "a.csv").write_text(RIG)
    record = Record.read(tmp_path / "a.csv", columns=columns)
    assert record.time == pytest.approx([0.0, 0.1, 0.2])
    assert record.load_point == pytest.approx(other.get("load_point", [1e-6, 2e-6, 4e-6]))
    assert record.measured["friction"].tolist() == [0.6, 0.61, 0.62]


def test_a_unit_that_is_given_counts_before_that_of_the_file_and_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(RIG)
    with pytest.warns(InputWarning, match=r"line 1, column 2: read in the unit that columns gives, where the heading of the file"):
        record = Record.read(tmp_path / "a.csv", columns={"time": 1, "load_point": "Vert_disp (mm)", "mu": 3})
    assert record.load_point == pytest.approx([1e-3, 2e-3, 4e-3])


def test_a_column_that_is_named_wins_over_one_that_is_understood() -> None:
    data = {"time (s)": CLOCK, "LPD (um)": 1e3 * CLOCK, "load_point (mm)": CLOCK, "B": 2.0 * CLOCK, "mu": FRICTION}
    assert Record.read(data, columns={"load_point": "B (um)"}).load_point == pytest.approx(2e-6 * CLOCK)
    assert Record.read(data, columns={"load_point": "LPD"}).load_point == pytest.approx(1e-3 * CLOCK)


def test_units_in_a_row_below_are_those_of_columns_that_are_named(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("rig 3\nZeit;Weg;Reibung\nms;um;-\n0;1;0.6\n100;2;0.61\n")
    record = Record.read(tmp_path / "a.csv", columns={"time": "Zeit", "load_point": "Weg", "friction": "Reibung"})
    assert record.time.tolist() == [0.0, 0.1]
    assert record.load_point == pytest.approx([1e-6, 2e-6])


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"time": "Zeit", "mu": "Kanl 3"}, r"no column 'Kanl 3' for mu; did you mean 'Kanal 3'\? it has 'Zeit \(ms\)', 'Vert_disp"),
    ({"time": "Zeit", "load_point": "disp"}, r"no column 'disp' for load_point; did you mean 'Vert_disp \(micron\)'\? it has"),
    ({"time": "Zeit", "mu": 6}, r"no column '6' for mu; it has 'Zeit \(ms\)'"),
    ({"time": "Zeit", "mu": 0}, r"no column '0' for mu; it has 'Zeit \(ms\)'"),
    ({"time": "Zeit", "mu": "Zeit"}, r"time and mu are both column 1"),
    ({"tim": "Zeit", "mu": 3}, r"columns: 'tim' is no column that is looked for; did you mean 'time'\?"),
    ({"time": "Zeit", "load_point": "Vert_disp (kg)", "mu": 3}, r"line 1, column 2: the unit in the heading does not convert to m"),
    ({"time": "Zeit", "mu": 3.5}, r"columns: 'mu' must be a heading or the number of a column, got 3\.5"),
    ({"time": "Zeit", "mu": True}, r"columns: 'mu' must be a heading or the number of a column, got True"),
]


@pytest.mark.parametrize(("columns", "message"), WRONG)
@pytest.mark.filterwarnings("ignore::stickslip.foundation.errors.InputWarning")
def test_a_column_that_is_not_there_is_refused_with_those_that_are(tmp_path: Path, columns: dict[str, Any], message: str) -> None:
    (tmp_path / "a.csv").write_text(RIG)
    with pytest.raises(ss.InputError, match=message):
        Record.read(tmp_path / "a.csv", columns=columns)


def test_two_columns_of_one_name_are_told_apart_by_their_numbers() -> None:
    text = "t (s),F (kN),F (kN)\n0,1,2\n1,1,2\n"
    with pytest.raises(ss.InputError, match=r"columns 2 and 3 are both called 'F': give the number, as shear_force=\"2\""):
        read_text(text, ("time", "shear_force"), "a", 9, named=NamedColumns({"shear_force": "F"}))
    found = read_text(text, ("time", "shear_force"), "a", 9, named=NamedColumns({"shear_force": "3"}))
    assert found.columns["shear_force"].tolist() == [2000.0, 2000.0]


def test_of_two_files_each_may_have_some_of_the_columns(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("Zeit (s),Reibung\n0,0.6\n1,0.61\n2,0.62\n")
    (tmp_path / "b.csv").write_text("Zeit (s),Weg (um)\n0,1\n2,3\n")
    columns = {"time": "Zeit", "friction": "Reibung", "load_point": "Weg"}
    record = Record.read(f"{tmp_path / 'a.csv'}+{tmp_path / 'b.csv'}", columns=columns)
    assert record.load_point == pytest.approx([1e-6, 2e-6, 3e-6])
    with pytest.raises(ss.InputError, match=r"columns: neither has a column 'Kraft' for shear_force"):
        Record.read(tmp_path / "a.csv", beside=tmp_path / "b.csv", columns={**columns, "shear_force": "Kraft"})


def test_columns_are_named_wherever_a_table_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("A (mm/s);B\n1;0.6\n2;0.5\n")
    points = Points.read(tmp_path / "a.csv", columns={"slip_rate": "A", "friction": "B"})
    assert points.slip_rate == pytest.approx([1e-3, 2e-3])
    found = shaking(tmp_path, "Zeit (ms);Kanal 3\n0;0\n500;0.1\n", 'columns = { time = "Zeit", ground_acceleration = "2 (g)" }\n')
    assert (list(found.times), list(found.values)) == ([0.0, 0.5], pytest.approx([0.0, 0.980665]))
    (tmp_path / "b.csv").write_text("Zeit (s),D (mm),V (mm/s),S (MPa)\n0,0,0,1\n1,2,3,1\n2,2,3,1\n")
    series = read_series(tmp_path / "b.csv", columns={"time": 1, "slip": "D", "slip_rate": "V", "shear_stress": "S"})
    assert (series.slip[1], series.rate[1], series.traction[1]) == (2e-3, 3e-3, 1e6)
    with pytest.raises(
        ss.InputError, match=r"'a\.csv', line 1: columns: there is no column 'Zeiit' for time among the 2"
    ) as caught:
        shaking(tmp_path, "Zeit (ms);secret\n0;0\n", 'columns = { time = "Zeiit", ground_acceleration = 2 }\n')
    assert "secret" not in str(caught.value)
    with pytest.raises(ss.InputError, match="columns must map columns to headings"):
        shaking(tmp_path, "Zeit (ms);secret\n0;0\n", "columns = 3\n")
