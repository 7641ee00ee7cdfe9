"""Files as laboratories write them: headings, xlook's text, two clocks, rotary rigs, columns that contradict, and large texts."""

from __future__ import annotations

import re
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.headings import KNOWN_COLUMNS, find
from stickslip.foundation.text_columns import read_text
from tests.extensions.inference.laboratory import correlated

Record = ss.studies.Record
CLOCK = np.linspace(0.0, 100.0, 401)
MOVED = 1e-6 * CLOCK
FRICTION = 0.6 + 1e-3 * np.tanh(CLOCK - 50.0) + 1e-4 * correlated(len(CLOCK), 0.0, 0)

HEADINGS = [
    ("SigmaN (MPa)", "normal_stress", 1e6),
    ("σ_n (MPa)", "normal_stress", 1e6),
    ("Nor_stress (MPa)", "normal_stress", 1e6),
    ("effns_mpa", None, 1.0),
    ("effns_MPa", "normal_stress", 1e6),
    ("LP disp (micron)", "load_point", 1e-6),
    ("LPD (um)", "load_point", 1e-6),
    ("LoadPointDisplacement_um", "load_point", 1e-6),
    ("ram displacement, mm", "load_point", 1e-3),
    ("VLP (um/s)", "load_rate", 1e-6),
    ("pull_rate_m_per_s", "load_rate", 1.0),
    ("mu_app", "friction", 1.0),
    ("AppFriction", "friction", 1.0),
    ("µ (-)", "friction", 1.0),
    ("μ (.)", "friction", 1.0),
    ("τ (MPa)", "shear_stress", 1e6),
    ("ShearStress", "shear_stress", 1.0),
    ("slip_rate_m_per_s", "slip_rate", 1.0),
    ("Time, s", "time", 1.0),
    ("t min", "time", 60.0),
    ("Rotation (rpm)", "rotation_rate", 2.0 * np.pi / 60.0),
    ("Rotation (turn)", "rotation", 2.0 * np.pi),
    ("sign", None, 1.0),
    ("mu s", None, 1.0),
    ("time constant", None, 1.0),
    ("Shear displacement (mm)", None, 1.0),
]


@pytest.mark.parametrize(("heading", "column", "factor"), HEADINGS)
def test_headings_of_laboratories_are_understood_with_their_units(heading: str, column: str | None, factor: float) -> None:
    wanted = tuple(name for name in KNOWN_COLUMNS if name not in ("pull_rate", "far_stress"))
    found = find([heading], wanted, "a.csv")
    assert list(found) == ([] if column is None else [column])
    if column is not None:
        assert float(found[column].factor) == pytest.approx(factor, rel=1e-15)


def xlook(names: list[str], units: list[str], rows: Any, junk: list[str]) -> str:
    """Return text as xlook writes it: numbers of columns, names, units and counts, each twelve characters wide, and rows."""
    heads = [[f"col {k}" for k in range(1, len(names) + 1)], names, units, [f"{len(rows):7d} recs" for _ in names]]
    lines = [f"number of records = {len(rows)}", *("     " + "".join(f"{cell:>12}" for cell in cells) for cells in heads)]
    lines += [f" {i:4d} " + "".join(f"  {value:10.6g}" for value in row) + f"  {junk[i % len(junk)]}" for i, row in enumerate(rows)]
    return "\n".join(lines) + "\n"


def test_text_from_xlook_is_read_at_once_with_names_that_touch_and_junk_in_columns_that_are_not_used(tmp_path: Path) -> None:
    rows = np.column_stack([1e6 * MOVED, 5.0 * FRICTION, 0.0 * CLOCK, np.full(len(CLOCK), 5.0), CLOCK])
    names = ["LP_disp", "Shear_stress", "layer_thick.", "Nor_stress", "Time", "no_val"]
    units = ["micron", "MPa", "micron", "MPa", "sec", "."]
    path = tmp_path / "p446.txt"
    path.write_text(xlook(names, units, rows, ["-nan", "1.#QNAN", "********"]))
    assert "LP_dispShear_stress" in path.read_text()
    read = Record.read(path)
    assert read.load_point == pytest.approx(MOVED, abs=1e-12, rel=1e-5)
    assert read.measured["friction"] == pytest.approx(FRICTION, rel=1e-5)
    assert read.clock == pytest.approx(CLOCK)
    assert read.notes == ("columns that were not understood: 'layer_thick. (micron)', 'no_val'",)


def test_the_later_form_of_xlook_with_a_row_of_units_is_read_too(tmp_path: Path) -> None:
    head = f"{'RecNum':>7}" + "".join(f"{name:>15}" for name in ("LP_disp", "mu", "Time"))
    units = "     ." + "".join(f"{unit:>15}" for unit in ("micron", ".", "sec"))
    rows = (f"{i:5d}  {1e6 * x:.10f}  {mu:.10f}  {t:.10f}" for i, (t, x, mu) in enumerate(zip(CLOCK, MOVED, FRICTION, strict=True)))
    path = tmp_path / "p4347.txt"
    path.write_text("\n".join([head, units, *rows]))
    read = Record.read(path)
    assert read.load_point == pytest.approx(MOVED, abs=1e-16)
    assert read.measured["friction"] == pytest.approx(FRICTION, abs=1e-10)


BLANKS = [
    "time (s) load_point (um)  mu\n",
    "# from the rig\n# time (s) load_point (um)  mu\n",
    "Time (s)   Load point displacement (um)   Coefficient of friction\n",
    "rig 2, test 17\ntime load_point mu\ns um -\n",
]


@pytest.mark.parametrize("head", BLANKS)
def test_columns_may_stand_apart_by_blanks_and_their_headings_behind_a_hash(tmp_path: Path, head: str) -> None:
    path = tmp_path / "a.txt"
    path.write_text(head + "0 0 0.6\n1 2 0.61\n 2  4\t0.62\n" if "\t" in head else head + "0 0 0.6\n1 2 0.61\n 2  4  0.62\n")
    read = Record.read(path)
    assert read.load_point == pytest.approx([0.0, 2e-6, 4e-6])
    assert read.measured["friction"].tolist() == [0.6, 0.61, 0.62]


def write(path: Path, heading: str, *columns: Any, encoding: str = "utf-8") -> Path:
    rows = "".join(",".join(f"{cell:.9g}" for cell in row) + "\n" for row in zip(*columns, strict=True))
    path.write_text(f"{heading}\n{rows}", encoding=encoding)
    return path


def test_two_files_with_two_clocks_and_a_mark_of_the_encoding_make_one_record(tmp_path: Path) -> None:
    """The load point is sampled each 0.7 s from a clock that starts 20 s after that of the shear stress."""
    slow = np.arange(-15.0, 110.0, 0.7)
    shear = write(tmp_path / "shear.csv", "time (s),τ (MPa)", CLOCK, 5.0 * FRICTION, encoding="utf-8-sig")
    load = write(
        tmp_path / "load.csv", "time (ms),LPD (um),SigmaN (MPa)", 1e3 * (slow - 20.0), slow, 5.0 + 0.0 * slow, encoding="utf-16"
    )
    first, typed = Record.read(shear, beside=load, later=20.0), Record.read(f"{shear}+{load}@20")
    for read in (first, typed):
        assert read.load_point == pytest.approx(MOVED, abs=1e-14)
        assert read.measured["friction"] == pytest.approx(FRICTION, rel=1e-8)
        assert read.notes == (f"load_point, normal_stress of {load} are taken at the times of {shear}",)
    other = Record.read(load, beside=shear, later=-20.0)  # the same record on the clock of the load point
    assert other.time == pytest.approx(CLOCK - 20.0)
    assert other.measured["friction"] == pytest.approx(FRICTION, rel=1e-8)


def test_two_clocks_without_a_common_time_and_columns_in_both_files_are_refused_with_the_cure(tmp_path: Path) -> None:
    shear = write(tmp_path / "shear.csv", "time (s),mu", CLOCK, FRICTION)
    load = write(tmp_path / "load.csv", "time (s),LPD (um)", 1.7e9 + CLOCK, CLOCK)
    with pytest.raises(ss.InputError, match=r"no time in common, 0 to 100 s and 1\.7e\+09 .* give how much later .*@SECONDS"):
        Record.read(f"{shear}+{load}")
    with pytest.raises(ss.InputError, match="both have friction: remove one"):
        Record.read(shear, beside={"time": CLOCK, "mu": FRICTION})
    with pytest.raises(ss.InputError, match=r"columns 1 and 3 both are the time: of two clocks, write each .* file of its own"):
        Record.read({"time (s)": CLOCK, "mu": FRICTION, "Time (ms)": CLOCK, "LPD (um)": CLOCK})


def test_a_rotation_needs_the_radius_of_the_contact() -> None:
    data = {"time (s)": CLOCK, "mu": FRICTION, "Rotation (rpm)": np.full(len(CLOCK), 30.0)}
    turning = Record.read(data)
    assert (turning.slips_in, turning.load_rate) == ("rad", pytest.approx(np.pi))
    assert turning.of_motion("rad", "RotatingBlock") is turning
    sliding = turning.of_motion("m", "SpringBlock")
    assert (sliding.load_rate, sliding.slips_in) == (None, "")
    note = "the rotation is passed over: a column radius (mm), the mean radius of the contact, makes it the load point"
    assert sliding.notes == (note,)
    passed = Record.read({**data, "slip (mm)": MOVED}).notes
    assert any(one.startswith("rotation_rate is passed over: a column radius (mm)") for one in passed)
    read = Record.read({**data, "mean radius (mm)": np.full(len(CLOCK), 20.0)})
    assert read.load_rate == pytest.approx(np.pi * 0.02)
    turned = Record.read({"time (s)": CLOCK, "mu": FRICTION, "Rotation (turn)": CLOCK, "radius (m)": np.full(len(CLOCK), 0.5)})
    assert turned.load_point == pytest.approx(np.pi * CLOCK)


def data_with(**columns: Any) -> dict[str, Any]:
    return {"time (s)": CLOCK, "load point (m)": MOVED, "friction": FRICTION, **columns}


def test_slip_beside_shear_is_told() -> None:
    (note,) = Record.read(data_with(**{"slip (m)": 0.99 * MOVED, "v (m/s)": 1e-6 + 0.0 * CLOCK})).notes
    assert note == "friction is what is fitted, unless observe names slip or slip_rate, which the record has too"


CONTRARY = [
    (
        {"v (m/s)": 7.0 + 0.0 * CLOCK},
        r"by 100 s slip_rate makes 700 m of slip, where the load point moves 100 um: are its",
    ),
    ({"v (um/s)": 1e-6 + 0.0 * CLOCK}, r"slip_rate makes .* where the load point moves"),
    ({"slip (mm)": 1e6 * MOVED}, r"slip makes 100 mm of slip, where the load point moves 100 um: .* as slip \(um\), right\?"),
    ({"slip (m)": -MOVED}, r"slip makes -.* of slip, where the load point moves"),
]


@pytest.mark.parametrize(("columns", "message"), CONTRARY)
def test_slip_that_contradicts_the_load_point_is_asked_about(columns: dict[str, Any], message: str) -> None:
    _, note = Record.read(data_with(**columns)).notes
    assert re.search(message, note), note


def test_slip_that_shear_explains_is_not_asked_about() -> None:
    """A load that never slips, and a stored one that is released at once while the machine rests."""
    rising = {"time (s)": CLOCK, "load point (m)": MOVED, "friction": 0.1 + 0.004 * CLOCK, "slip (m)": 1e-9 * CLOCK}
    fallen = np.where(CLOCK < 50.0, 0.6, 0.4)
    falling = {"time (s)": CLOCK, "load point (m)": 1e-3 * MOVED, "friction": fallen, "slip (m)": 1e-4 * (CLOCK >= 50.0)}
    for record in (rising, falling):
        assert len(Record.read(record).notes) == 1


def test_two_columns_of_slip_that_contradict_are_asked_about_without_a_load_point() -> None:
    _, note = Record.read({"time (s)": CLOCK, "mu": FRICTION, "slip (um)": CLOCK, "v (m/s)": 1.0 + 0.0 * CLOCK}).notes
    assert note.startswith("by 100 s slip_rate makes 100 m of slip, where slip grows by 0.1 mm")


def test_greek_letters_are_printed_as_they_are_and_errors_name_what_was_not_understood() -> None:
    with pytest.raises(ss.InputError) as caught:
        Record.read({"time (s)": CLOCK, "σ₃ (MPa)": FRICTION, "Δγ (-)": FRICTION})
    assert str(caught.value) == ("record: nothing measured; write it as friction; not understood: 'σ₃ (MPa)', 'Δγ (-)'")
    with pytest.raises(ss.InputError, match="no column 'time'; write it as time \\(s\\); not understood: 'Zeit'"):
        Record.read({"Zeit": CLOCK, "mu": FRICTION})


def test_a_text_stops_at_the_most_rows_and_takes_no_more_memory_than_its_numbers() -> None:
    short = "t (s),v (m/s)\n" + "0,1\n" * 20_000
    with pytest.raises(ss.InputError, match="a, line 10002: more than 10000 rows"):
        read_text(short, ("time", "slip_rate"), "a", 10_000, raw=True)
    tracemalloc.start()
    table = read_text(short, ("time", "slip_rate"), "a", 20_000, raw=True)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    numbers = sum(one.nbytes for one in (*table.columns.values(), table.lines))
    assert peak < 4 * numbers + 4 * len(short)  # the text in memory is copied once, with four bytes a character


HOLDS_UP = {"blanks": "a" + " " * 40_000 + "b (", "brackets": "(" * 40_000, "numbers": "col 1 " * 900, "micro": "µ" * 40_000}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("line", HOLDS_UP.values(), ids=HOLDS_UP)
def test_lines_made_to_hold_up_a_reader_do_not(line: str) -> None:
    """Each took from seconds to days as a heading, by the patterns that read it."""
    assert read_text(f"{line}\n" * 100 + "1\n", ("time", "friction"), "a", 200, raw=True).columns == {}


def test_a_thousand_columns_are_the_most_and_a_line_is_not_read_to_its_end(tmp_path: Path) -> None:
    with pytest.raises(ss.InputError, match="a, line 1: more than 1000 columns"):
        read_text(",".join(["v"] * 24_000) + "\n1\n", ("slip_rate",), "a", 10)
    path = tmp_path / "a.csv"
    path.write_text("t,mu\n" + "1" * 10_000_000)
    with pytest.raises(ss.InputError, match=r"a\.csv, line 2: longer than 50000 characters"):
        Record.read(path)
