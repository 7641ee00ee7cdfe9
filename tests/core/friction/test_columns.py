"""Columns of numbers with units in their headings: from text, from tables in memory, and one line for every mistake."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pint
import pytest

from stickslip import InputError
from stickslip.friction import FromTable, PiecewiseLinearRate, Points
from tests.messages import refused

HEADINGS = [
    ("slip_rate_m_per_s", 1.0),
    ("Slip rate (m/s)", 1.0),
    ("v (mm/s)", 1e-3),
    ("v [mm/s]", 1e-3),
    ("V(mm s^-1)", 1e-3),
    ("v (mm·s⁻¹)", 1e-3),
    ("velocity [ µm/s ]", 1e-6),
    ("velocity [μm/s]", 1e-6),
    ("sliding-speed (km/hour)", 1 / 3.6),
    ("rate (m/year)", 1 / 31_557_600),
]


@pytest.mark.parametrize(("heading", "factor"), HEADINGS)
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_headings_carry_units_under_every_separator(tmp_path: Path, heading: str, factor: float, separator: str) -> None:
    path = tmp_path / "points.csv"
    rows = (("step", "Friction coefficient (-)", heading), ("1", ".5", "0"), ("2", ".4", "3"))
    path.write_text("# from the rig\n" + "".join(f"{separator.join(row)}\n" for row in rows))
    read = Points.read(path)
    np.testing.assert_allclose(read.places, [0.0, 3.0 * factor], rtol=1e-15)
    assert read.friction.tolist() == [0.5, 0.4]
    assert read.has == ("slip_rate",)


@pytest.mark.parametrize(("heading", "factor"), [("u [µm]", 1e-6), ("slip (mm)", 1e-3), ("displacement (km)", 1e3), ("u", 1.0)])
def test_slips_are_read_with_units_also_from_a_frame(heading: str, factor: float) -> None:
    read = Points.read(pd.DataFrame({"note": ["a", "b"], "mu": [0.5, 0.4], heading: [-1.0, 2.0]}))
    np.testing.assert_allclose(read.places, [-factor, 2.0 * factor], rtol=1e-15)


def test_units_are_converted_to_the_last_digit() -> None:
    numbers = [0.1 * i for i in range(1, 100)]
    assert Points.read({"u (mm)": numbers, "mu": numbers}).places.tolist() == [one / 1000 for one in numbers]


def test_a_file_a_frame_a_mapping_points_and_lists_make_the_same_law(tmp_path: Path) -> None:
    wanted = FromTable(rate=[0.0, 0.001, 0.02], friction=[0.7, 0.6, 0.4])
    frame = pd.DataFrame({"v (mm/s)": [0, 1, 20], "mu": [0.7, 0.6, 0.4]})
    path = tmp_path / "points.csv"
    path.write_text("\ufeff" + frame.to_csv(index=False), encoding="utf-8")
    points = Points(np.array([0.7, 0.6, 0.4]), None, np.array([0.0, 0.001, 0.02]))
    for source in (path, str(path), frame, dict(frame), points, wanted, PiecewiseLinearRate((0, 0.001, 0.02), (0.7, 0.6, 0.4))):
        assert FromTable(source) == wanted


def test_arrays_with_a_unit_of_pint_are_converted() -> None:
    registry = pint.UnitRegistry()
    read = Points.read({"v": registry.Quantity(np.array([1.0, 2.0]), "mm/s"), "mu": [0.5, 0.4]})
    np.testing.assert_allclose(read.places, [1e-3, 2e-3], rtol=1e-15)
    with pytest.raises(InputError, match="slip_rate must be a column of numbers"):
        Points.read({"v": registry.Quantity(np.array([1.0, 2.0]), "kg"), "mu": [0.5, 0.4]})


@pytest.mark.parametrize(
    "text",
    ["v,mu\nmm/s,-\n1,.5\n2,.4\n", "v [mm/s],mu\n[mm/s],\n1,.5\n2,.4\n", "note,mu,v\n,(1),(mm/s)\nfirst,.5,1\nsecond,.4,2\n"],
)
def test_units_may_stand_in_a_row_below_the_headings(tmp_path: Path, text: str) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text, encoding="utf-8")
    assert Points.read(path).places.tolist() == [1e-3, 2e-3]


def test_a_plain_heading_wins_over_another_name_for_the_same() -> None:
    assert Points.read({"slip": [1, 2], "displacement": [3, 4], "mu": [0.5, 0.4]}).places.tolist() == [1.0, 2.0]


def test_points_with_both_variables_are_used_along_one() -> None:
    both = Points.read({"u": [2, 1], "v": [3, 4], "mu": [0.5, 0.4]})
    assert both.has == ("slip", "slip_rate")
    assert both.along("slip").places.tolist() == [2.0, 1.0]
    assert FromTable(both.along("slip_rate")) == FromTable(rate=[3, 4], friction=[0.5, 0.4])
    with pytest.raises(InputError, match="the points have slip and slip_rate: choose one with along"):
        both.along()
    with pytest.raises(InputError, match="have no 'rate'; did you mean 'slip_rate'"):
        both.along("rate")


TEXTS = [
    ("v;mu\n1,500;1,600\n", "line 2: slip_rate has a decimal comma, or one that groups thousands; write points: `tr , . < OLD.csv"),
    ('v,mu\n"1,500","1,600"\n', "line 2: slip_rate has a decimal comma, or one that groups thousands"),
    ("v,mu\n0,5,0,6\n", "line 2: 4 cells, but the header has 2; decimal commas?"),
    ("v [kg],mu\n1,1\n2,2\n", "line 1, column 1: the unit in the heading does not convert to m/s; write it like m/s"),
    ("v [m**99],mu\n1,1\n2,2\n", "line 1, column 1: the unit in the heading does not convert"),
    ("v,mu [MPa]\n1,1\n", "line 1, column 2: friction is a pure number: no unit in its heading"),
    ("v,velocity,mu\nx,1,1\n", "line 1: columns 1 and 2 both are the slip_rate: rename or remove one"),
    ("v mu\n1 .5 2\n", "line 1: no column 'friction'; columns are separated by commas, semicolons, tabs or blanks"),
    ("0,.5\n1,.4\n", "line 1: no column 'friction'; the first line must name the columns, as friction"),
    ("v,frictoin\n0,.5\n", "line 1: no column 'friction'; rename 'frictoin'?"),
    ("w,mu\n0,.5\n", "line 1: no column slip or slip_rate; write it as slip_rate (m/s)"),
    ("v,mu\nkg,-\n1,2\n", "line 2: slip_rate must be a number, got text; a unit belongs in the heading, as in slip_rate (m/s)"),
    ("v (mm/s),mu\num/s,-\n1,2\n", "line 2: slip_rate must be a number, got text; a unit belongs in the heading, as in"),
    ("v,mu\n1,\n", "line 2: friction must be a number, got nothing"),
    ("v,mu\n1,.5\n2,NaN\n", "line 3: friction must be finite, got 'nan'; leave out such rows"),
    ("v,mu\n-1,.5\n", "line 2: slip_rate must not be negative, got -1"),
    ("v,mu\n1,-.1\n", "line 2: friction must not be negative, got -0.1"),
    ("v (m/s),mu\n1,.5\n\n# c\n0.5,.4\n", "line 5: slip_rate must ascend, but 0.5 follows 1; sort the rows"),
    ("v (m/s),mu\n1,.5\n1,.4\n", "line 3: slip_rate must ascend, but 1 follows 1; keep one row of each, or their mean"),
    ("v (m/s),u (m),mu\n1,1,.5\n2,2,.4\n", "slip and slip_rate are both there: choose one with along"),
    ("v,mu\n1,.5\n", "at least two points are needed, got 1"),
    ("", "line 1: no column 'friction'"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "message"), TEXTS)
def test_mistakes_in_a_file_are_one_line_with_place_and_cure(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text)
    with refused(message, begins=f"FromTable: {path}"):
        FromTable(path)


SOURCES: list[tuple[Any, str]] = [
    (3, "points must be a CSV file, a DataFrame, or a mapping of headings to numbers, got 3"),
    ({"v": [1, 2], "mu": [0.4]}, "points: columns of different lengths: slip_rate has 2, friction has 1"),
    ({"v": [1, 2], "mu": [0.4, np.nan]}, "points, row 1: friction must be finite, got 'nan'; leave out such rows"),
    ({"v": [1, -2], "mu": [0.4, 0.5]}, "points, row 1: slip_rate must not be negative, got -2"),
    ({"v": ["1,5", "2"], "mu": [1, 2]}, "points: slip_rate must be a column of numbers"),
    ({"v": [[1], [2]], "mu": [1, 2]}, "points: slip_rate must be a column of numbers, got an array of 2 dimensions"),
    ("lost.csv", "lost.csv: no such file"),
    (".", ".: cannot be read: Is a directory"),
    (b"\xff", "points must be a CSV file, a DataFrame, or a mapping"),
]


@pytest.mark.parametrize(("source", "message"), SOURCES)
def test_mistakes_in_a_source_are_one_line(source: Any, message: str) -> None:
    with refused(message):
        FromTable(source)


def test_a_source_and_lists_exclude_each_other() -> None:
    with pytest.raises(InputError, match="give a source of points or lists of numbers, not both"):
        FromTable({"v": [1, 2], "mu": [1, 2]}, slip=[0, 1])
    with pytest.raises(InputError, match="friction is missing: give a file, a DataFrame, or friction with slip or rate"):
        FromTable(slip=[0, 1])


def test_too_many_points_for_a_table_are_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="must have 2 to 10000 numbers, got 10001"):
        FromTable({"v": 1e-3 * np.arange(10_001), "mu": np.full(10_001, 0.5)})


def test_a_file_that_is_no_text_or_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "points.csv"
    path.write_bytes("u [µm],mu\n1,2\n".encode("latin-1"))
    with pytest.raises(InputError, match="not a text file in UTF-8; save it as CSV in UTF-8"):
        FromTable(path)
    monkeypatch.setattr("stickslip.friction.custom.points.LARGEST_FILE", 5)
    with pytest.raises(InputError, match="larger than 5 bytes"):
        FromTable(path)
