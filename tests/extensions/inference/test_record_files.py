"""Records in files of LabVIEW, in LAS and in universal files; files that are no text; and files that break off."""

from __future__ import annotations

import gzip
import io
import re
import tracemalloc
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputWarning
from stickslip.foundation.text_columns import read_text
from stickslip.friction import Points
from tests.extensions.inference.files_of_programs import CLOCK, FORCE, RAM, STEP, Segment, labview, log_ascii, universal

Record = ss.studies.Record
HALVES = (Segment(slice(0, 25)), Segment(slice(25, None)))


def read(folder: Path, text: str, name: str = "a.lvm", encoding: str = "utf-8") -> ss.studies.Record:
    (folder / name).write_text(text, encoding=encoding)
    return Record.read(folder / name)


def agrees(record: ss.studies.Record, shear: str = "shear_force", size: float = 1e3, rtol: float = 1e-8) -> None:
    """Check times, shear and load point against those that were written."""
    assert record.time == pytest.approx(CLOCK, abs=1e-12)
    assert record.measured[shear] == pytest.approx(size * FORCE, rel=rtol)
    assert record.load_point == pytest.approx(1e-3 * RAM, rel=max(rtol, 1e-8))


@pytest.mark.parametrize("x_columns", ["No", "One", "Multi"])
@pytest.mark.parametrize(("decimal", "separator"), [(".", "\t"), (",", "\t"), (".", ",")])
def test_a_labview_file_is_read_as_labview_writes_it(tmp_path: Path, x_columns: str, decimal: str, separator: str) -> None:
    comments = {3: "valve open", 17: "end"}
    text = labview([Segment(comments=comments)], x_columns, decimal=decimal, separator=separator, special=True)
    record = read(tmp_path, text)
    agrees(record)
    begin = text[: text.index("valve open")].count("\n") + 1
    assert record.notes == (f"2 comments in the file, the first in line {begin}: passed over",)


def test_what_the_header_does_not_say_follows_from_its_segment(tmp_path: Path) -> None:
    """Older writers do not name the decimal separator, or the columns of X; Latin letters are not UTF-8 in LabVIEW."""
    for x_columns in ("No", "One", "Multi"):
        text = labview(x_columns=x_columns, decimal=",", units=("kN", "µm"))
        for key in ("Decimal_Separator\t,\n", f"X_Columns\t{x_columns}\n"):
            assert key in text
            text = text.replace(key, "")
        record = read(tmp_path, text, encoding="latin-1")
        assert record.measured["shear_force"] == pytest.approx(1e3 * FORCE, rel=1e-8)
        assert record.load_point == pytest.approx(1e-6 * RAM, rel=1e-8)
        assert record.time == pytest.approx(CLOCK, abs=1e-12)


def test_channels_without_samples_and_rows_fewer_than_promised_are_no_fault(tmp_path: Path) -> None:
    """LabVIEW lists channels that have no samples, with steps of 1 s, and promises more samples than there are."""
    text = labview().replace("Samples\t40\t40", "Samples\t51200\t51200\t0").replace("\tComment", "\tUntitled 2\tComment")
    text = text.replace(f"Delta_X\t{STEP:.9E}\t{STEP:.9E}", f"Delta_X\t{STEP:.9E}\t{STEP:.9E}\t1.000000")
    agrees(read(tmp_path, text))


def test_units_of_labview_do_not_replace_those_in_the_name_of_a_channel(tmp_path: Path) -> None:
    record = read(tmp_path, labview(names=("Shear force (MN)", "Ram displacement"), units=("mm", "mm")))
    assert record.measured["shear_force"] == pytest.approx(1e6 * FORCE, rel=1e-8)
    with pytest.raises(ss.InputError, match=r"line 23, column 2: the unit in the heading does not convert to N"):
        read(tmp_path, labview(units=("mm", "mm")))
    with pytest.warns(InputWarning, match=r"line 23: column 2, shear_force, has no unit and is read in N"):
        read(tmp_path, labview(units=("", "mm")))


@pytest.mark.parametrize("x_columns", ["No", "One", "Multi"])
def test_segments_go_on_by_their_times_or_by_their_dates(tmp_path: Path, x_columns: str) -> None:
    told = "2 segments, each behind the one before it by the times in the file"
    on = read(tmp_path, labview([HALVES[0], HALVES[1]._replace(x0=25 * STEP)], x_columns))
    agrees(on)
    assert on.notes == (told,)
    again = read(tmp_path, labview([HALVES[0], HALVES[1]._replace(begun="14:02:16.625")], x_columns))
    assert again.time == pytest.approx(np.concatenate([CLOCK[:25], 6.5 + CLOCK[:15]]), abs=1e-9)
    assert again.measured["shear_force"] == pytest.approx(1e3 * FORCE, rel=1e-8)


REFUSED = [
    (labview(HALVES), r"a segment begins again at 0 s, and by date and time not behind .* each segment to a file of its own"),
    (labview(HALVES).replace("Time\t14:02:10.125\t", "Time\tnoon\t"), r"a segment begins again at 0 s"),
    (
        labview([*HALVES[:1], HALVES[1]._replace(x0=5.0)]).replace("X_Value\tShear force", "X_Value\tForce", 1),
        r"line 59: this segment has other channels: write each segment to a file of its own",
    ),
    (
        labview().replace(f"Delta_X\t{STEP:.9E}", "Delta_X\t1.0"),
        r"channels with different Delta_X: write each to a file of its own",
    ),
    (labview().replace(f"{STEP:.9E}", "0"), r"X0 must be a number, and Delta_X above 0, where X_Columns is No"),
    (labview().replace(f"{STEP:.9E}", "fast"), r"line 23: Delta_X must be a number"),
    (labview(x_columns="Multi").replace("\t1.000000000E-01\t", "\t1.1\t"), r"the channels have clocks of their own"),
    (labview(x_columns="One").replace("\n1.000000000E-01\t", "\n0.01\t"), r"X_Value begins again at 0\.01 s within a segment"),
    (labview().replace("***End_of_Header***", "", 1)[:200], r"the header of a LabVIEW file does not end"),
    (labview()[:290], r"a LabVIEW file without data: no line begins with X_Value"),
    (
        labview(x_columns="One").replace("X_Columns\tOne", "X_Columns\tNo"),
        r"a row must begin with an empty cell where X_Columns is No",
    ),
    (labview(decimal=",", separator=","), r"commas separate both columns and decimals: let LabVIEW separate columns by tabs"),
    (labview().replace("kN", "rpm"), r"column 2: the unit in the heading does not convert to N"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED, ids=range(len(REFUSED)))
def test_labview_files_that_leave_a_time_open_are_refused_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("wrap", [False, True])
@pytest.mark.parametrize("version", ["1.2", "2.0"])
def test_a_las_file_is_read_with_its_units_and_by_its_descriptions(tmp_path: Path, version: str, wrap: bool) -> None:
    record = read(tmp_path, log_ascii(version=version, wrap=wrap), "a.las")
    agrees(record, "shear_stress", 1e6)
    assert record.notes == ()


def test_the_null_of_a_las_file_is_left_out_whatever_it_is(tmp_path: Path) -> None:
    text = log_ascii(null="7.5").replace(f"{CLOCK[4]:.4f} {FORCE[4]:.9f}", f"{CLOCK[4]:.4f} 7.5")
    text = text.replace(f"{FORCE[9]:.9f}", "-9999").replace(f"{FORCE[10]:.9f}", "-9999")
    record = read(tmp_path, text, "a.las")
    assert np.flatnonzero(np.isnan(record.measured["shear_stress"])).tolist() == [4, 9, 10]
    assert record.notes[:2] == (
        "-9999 marks a missing number of shear_stress in 2 rows",
        "7.5 marks a missing number of shear_stress in 1 row",
    )


def test_las_files_that_cannot_be_read_are_refused_in_one_line(tmp_path: Path) -> None:
    whole = log_ascii(wrap=True)
    cases = [
        (log_ascii(version="3.0"), r"LAS 3 is not read, LAS 2\.0 is; to CSV in Python: `las = lasio\.read"),
        (log_ascii()[:300], r"a LAS file without a section ~A, which holds its numbers"),
        (log_ascii(curves="#\n"), r"a LAS file without a section ~C"),
        (log_ascii(null="none"), r"NULL must be a number"),
        (whole[: whole.rindex(" ")], r"line 98: 2 numbers of a row that is wrapped, but there are 3 curves"),
        (whole.replace(" -0.", " 1 -0."), r"4 numbers of a row that is wrapped, but there are 3 curves"),
        (log_ascii(rows="0 1 2 3\n"), r"4 cells, but the header has 3; one row has one line where WRAP is NO"),
        (log_ascii().replace("CH3 .MPA", "CH3 .LBM"), r"column 2: the unit in the heading does not convert to Pa"),
    ]
    for text, message in cases:
        with pytest.raises(ss.InputError, match=message):
            read(tmp_path, text, "a.las")


@pytest.mark.parametrize(("kind", "rtol"), [(2, 2e-5), (4, 1e-10)])
@pytest.mark.parametrize("even", [True, False])
def test_a_universal_file_is_read_with_its_units(tmp_path: Path, kind: int, rtol: float, even: bool) -> None:
    agrees(read(tmp_path, universal(kind, even=even), "a.uff"), rtol=rtol)


def test_numbers_of_a_universal_file_may_touch_each_other(tmp_path: Path) -> None:
    """A field of 13 has no blank before a negative number with an exponent of three digits, as Fortran writes it."""
    text = universal(2)
    touching = text.replace(f"{RAM[3]:13.5e}", f"{-1.23456e-101:13.5e}")
    record = read(tmp_path, touching, "a.uff")
    assert record.load_point is not None
    assert record.load_point[3] == pytest.approx(-1.23456e-104)
    assert f"{RAM[2]:13.5e}-1.23456e-101" in touching


def test_the_units_of_dataset_164_are_those_of_axes_without_a_name(tmp_path: Path) -> None:
    for code, metre in ((1, 1.0), (5, 1e-3), (7, 0.0254)):
        record = read(tmp_path, universal(code=code), "a.uff")
        assert record.load_point == pytest.approx(metre * RAM, rel=1e-8)


def test_what_is_no_function_of_time_is_passed_over_and_told(tmp_path: Path) -> None:
    spectrum = universal().replace(f"{17:10d}", f"{18:10d}")
    record = read(tmp_path, universal() + spectrum, "a.uff")
    agrees(record, rtol=1e-9)
    assert record.notes == ("2 datasets 58 not a real function of time: passed over",)


def test_universal_files_that_cannot_be_read_are_refused_in_one_line(tmp_path: Path) -> None:
    text = universal()
    uneven = universal(even=False)
    other = uneven[: uneven.rindex("    58")] + uneven[uneven.rindex("    58") :].replace(f"{CLOCK[5]:13.5e}", f"{0.26:13.5e}")
    cases = [
        (text.replace(f"{17:10d}", f"{18:10d}"), r"no dataset 58 with a real function of time"),
        (other, r"this function has other times than the first: write it to a file of its own"),
        ("\n".join(text.splitlines()[:8]), r"a dataset 58 that ends within its header"),
        ("\n".join(text.splitlines()[:16]), r"a dataset 58 that ends 28 numbers too early"),
        (text.replace(f"{4:10d}{40:10d}", f"{3:10d}{40:10d}"), r"line 9: the type of ordinates must be 2, 4, 5 or 6"),
        (text.replace(f"{4:10d}{40:10d}", f"{4:10d}{9_999_999:10d}"), r"line 9: more than 5000000 rows"),
        (text.replace(f"{FORCE[2]:20.11e}", f"{'x':>20}"), r"line 14: each value must be a number"),
        (text + universal().replace("    58\n", "   58b     1     2\n"), r"dataset 58b is binary and not read"),
    ]
    for content, message in cases:
        with pytest.raises(ss.InputError, match=message):
            read(tmp_path, content, "a.uff")


# ---- wherever a table is read ------------------------------------------------------------------------------------------------


SCENARIO = (
    '[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 1.0\nnormal_force = 1.0\n[friction]\nkind = "coulomb"\nstatic = 0.6\n'
    'dynamic = 0.5\n[loading.ground_acceleration]\nkind = "piecewise-linear"\nfile = "{file}"\n{more}[initial]\nload = 0.0\n'
    "[run]\nduration = 1.0\n"
)


def test_points_and_loading_histories_are_read_from_these_files_too(tmp_path: Path) -> None:
    text = labview(x_columns="One", names=("mu", "ground_acceleration"), units=("", "g"))
    (tmp_path / "quake.lvm").write_text(text)
    (tmp_path / "s.toml").write_text(SCENARIO.format(file="quake.lvm", more=""))
    shaking: Any = ss.load_scenario(tmp_path / "s.toml").problem.ground_acceleration
    assert list(shaking.times) == pytest.approx(CLOCK, abs=1e-12)
    assert list(shaking.values) == pytest.approx(9.80665 * RAM, rel=1e-8)
    rows = "1 0.7 3\n2 0.65 4\n3 -999.25 5\n4 0.6 6\n"
    (tmp_path / "points.las").write_text(log_ascii(curves="V.UM/S : slip rate\nMU. : friction\nX. : 3\n", rows=rows))
    with pytest.warns(InputWarning, match=r"points\.las: -999\.25 marks a missing number of friction in 1 row: left out"):
        points = Points.read(tmp_path / "points.las")
    assert points.slip_rate == pytest.approx([1e-6, 2e-6, 4e-6])
    assert points.friction.tolist() == [0.7, 0.65, 0.6]


# ---- files that are no text --------------------------------------------------------------------------------------------------


def content_of(kind: str) -> bytes:
    """Return a file of a kind: whole where a library here writes it, otherwise as its first bytes are documented."""
    stream = io.BytesIO()
    if kind == "HDF5":
        with h5py.File(stream, "w") as file:
            file["time"] = CLOCK
    elif kind == "another archive":
        with zipfile.ZipFile(stream, "w") as archive:
            archive.writestr("xl/workbook.xml", "<workbook/>")
    elif kind == "gzip":
        stream.write(gzip.compress(b"time (s),mu\n0,0.6\n"))
    elif kind == "NumPy":
        np.save(stream, CLOCK)
    elif kind == "MATLAB 7.3":
        with h5py.File(stream, "w", userblock_size=512) as file:
            file["time"] = CLOCK
        stream.seek(0)
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Nov  2 10:00:00 2026 HDF5 schema 1.00 .")
    return stream.getvalue() or FIRST[kind]


FIRST = {
    "ASAM MDF": b"MDF     4.10    amdf8.8.\x00\x00\x00\x00\x9a\x01" + bytes(64),
    "TDMS": b"TDSm\x0e\x00\x00\x00\x68\x12\x00\x00" + bytes(20),
    "MATLAB": b"MATLAB 5.0 MAT-file Platform: posix, Created on: Mon Nov  2 10:00:00 2026" + bytes(60),
    "MATLAB 4": bytes(4) + b"\x01\x00\x00\x00\x06\x00\x00\x00\x00\x00\x00\x00\x02\x00\x00\x00t\x00" + bytes(48),
    "SEG-Y": ("C 1 CLIENT".ljust(80) + "C 2 LINE".ljust(80)).encode("cp500") + bytes(400),
    "miniSEED": b"000001D STA  00HNZXX" + bytes(44),
    "58b": b"    -1\n   58b     1     2          11          56     0     0           0           0\n" + bytes(60),
    "Parquet": b"PAR1\x15\x04\x15" + bytes(40),
    "(.xls)": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(60),
    "PDF": b"%PDF-1.7\n",
}
FOREIGN = [*FIRST, "HDF5", "another archive", "gzip", "NumPy", "MATLAB 7.3"]


@pytest.mark.parametrize("kind", FOREIGN)
def test_a_file_that_is_no_text_is_named_with_its_way_to_text(tmp_path: Path, kind: str) -> None:
    (tmp_path / "a.dat").write_bytes(content_of(kind))
    message = rf"a\.dat: .*{re.escape(kind)}.*, which is not read: make CSV of it: .+"
    for reader in (Record.read, Points.read):
        with pytest.raises(ss.InputError, match=message) as caught:
            reader(tmp_path / "a.dat")
        assert str(caught.value).isprintable()
    (tmp_path / "s.toml").write_text(SCENARIO.format(file="a.dat", more=""))
    with pytest.raises(ss.InputError, match=r"\[loading\.ground_acceleration\] file 'a\.dat': .*which is not read"):
        ss.load_scenario(tmp_path / "s.toml")


def test_segy_in_ascii_is_named_and_a_table_that_begins_alike_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.sgy").write_bytes(("C 1 CLIENT".ljust(80) + "C 2 LINE".ljust(80)).encode() + bytes(400))
    with pytest.raises(ss.InputError, match="a file of SEG-Y"):
        Record.read(tmp_path / "a.sgy")
    record = read(tmp_path, "C 1 of 2\ntime (s),mu\n0,0.6\n1,0.61\n", "a.csv")
    assert record.measured["friction"].tolist() == [0.6, 0.61]


LONG = np.linspace(0.0, 1.0, 6000)


def long_text(kind: str) -> str:
    """Return a file of 6000 rows."""
    whole = {"lvm": labview(), "las": log_ascii(), "uff": universal()}[kind]
    if kind == "lvm":
        at = whole.rindex("X_Value")
        return whole[: whole.index("\n", at) + 1] + "".join(f"\t{one:.9E}\t{one:.9E}\n" for one in LONG)
    if kind == "las":
        return whole[: whole.index("\n", whole.index("~A")) + 1] + "".join(f"{one:.6f} {one:.6f} {one:.6f}\n" for one in LONG)
    head = whole[: whole.index(f"{FORCE[0]:20.11e}")].replace(f"{40:10d}", f"{6000:10d}")
    rows = ("".join(f"{one:20.11e}" for one in LONG[i : i + 4]) + "\n" for i in range(0, 6000, 4))
    return head + "".join(rows) + "    -1\n"


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", ["lvm", "las", "uff"])
def test_reading_takes_no_more_memory_than_a_few_times_the_numbers(kind: str) -> None:
    text, wanted = long_text(kind), ("time", "shear_force", "shear_stress", "load_point")
    read_text(long_text(kind), wanted, "a", 6000, raw=True)  # what is made on first use
    tracemalloc.start()
    table = read_text(text, wanted, "a", 6000, raw=True)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert {len(one) for one in table.columns.values()} == {6000}
    numbers = sum(one.nbytes for one in (*table.columns.values(), table.lines))
    assert peak < 4 * numbers + 4 * len(text)  # the text in memory is copied once, with four bytes a character


HEADS = {
    "lvm": labview()[: labview().index("Y_Unit_Label")],
    "las": "~V\nVERS. 2.0 :\n~C\n",
    "uff": "    -1\n    58\n",
    "uff, kind": "    -1\n",
    "none": "",
}


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize(
    "line", [" " * 40_000, "." * 40_000, "a:" * 20_000, "-1 " * 13_000, "(" * 40_000, "9" * 40_000, "1e" * 20_000]
)
@pytest.mark.parametrize("head", HEADS.values(), ids=HEADS)
def test_lines_made_to_hold_up_a_reader_do_not(head: str, line: str) -> None:
    """Twenty of them are read in no time, or refused; a pattern that tries all ways through one takes hours."""
    with suppress(ss.InputError):
        read_text(head + f"{line}\n" * 20, ("time", "friction"), "a", 200, raw=True)


# ---- damage ------------------------------------------------------------------------------------------------------------------


WHOLE = {
    "a.lvm": labview([HALVES[0], HALVES[1]._replace(x0=25 * STEP, comments={1: "x"})], special=True),
    "b.lvm": labview(x_columns="Multi", decimal=","),
    "a.las": log_ascii(),
    "b.las": log_ascii(wrap=True),
    "a.uff": universal(code=5),
    "b.uff": universal(2, even=False),
}


@pytest.mark.sampled(every=3)
@pytest.mark.filterwarnings("ignore::stickslip.foundation.errors.InputWarning")
@pytest.mark.parametrize("name", WHOLE)
def test_a_damaged_file_is_read_or_refused_in_one_line(tmp_path: Path, name: str) -> None:
    rng, whole, path = np.random.default_rng(1), WHOLE[name].encode(), tmp_path / name
    outcomes, told = {"read": 0, "refused": 0}, list[str]()
    for _ in range(60):
        content = bytearray(whole)
        begin, end = sorted(rng.integers(len(whole), size=2).tolist())
        how = rng.integers(4)
        if how == 0:
            del content[begin:]
        elif how == 1:
            del content[begin : min(end, begin + 200)]
        elif how == 2:
            content[begin:begin] = content[begin : min(end, begin + 300)]
        else:
            content[begin] = rng.choice(list(b"\t,\n -9eE~*x\x00\xff"))
        path.write_bytes(content)
        try:
            Record.read(path)
            outcomes["read"] += 1
        except ss.InputError as error:
            outcomes["refused"] += 1
            told.append(str(error))
    assert all(one.startswith(str(path)) for one in told)
    assert min(outcomes.values()) > 5, outcomes
