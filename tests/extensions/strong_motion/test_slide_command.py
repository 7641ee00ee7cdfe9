"""`stickslip slide`: from files to a table and figures in one command, and what it refuses before it writes anything."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from stickslip.extensions.strong_motion.sliding_block import ShakenBlock
from stickslip.foundation.constants import GRAVITY
from tests.extensions.strong_motion.made import made_motion


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder `records` with two records, each in two columns."""
    (tmp_path / "records").mkdir()
    for name, scale in (("one", 1.0), ("two", 1.7)):
        motion = made_motion(scale=scale)
        rows = "\n".join(f"{0.01 * n:.2f},{a / GRAVITY:.17g}" for n, a in enumerate(motion.acceleration))
        (tmp_path / "records" / f"{name}.csv").write_text(f"time (s),acceleration (g)\n{rows}\n")
    return tmp_path


def slid(scale: float, polarity: int, coefficient: float) -> float:
    motion = made_motion(scale=scale)
    return float(ShakenBlock(-polarity * motion.acceleration, 0.01).slide(np.array([coefficient * GRAVITY]))[0, 0])


def test_a_folder_becomes_a_table_and_two_figures(command, folder: Path):
    files = ("--out", "table.csv", "--figure", "d.svg", "--record-figure", "motion.svg", "--record", "two")
    shown = command("slide", "records", "--yield", "0.05..0.15:3", "--both-signs", "--unit", "cm", *files)
    assert (shown.code, shown.err) == (0, "")
    table = pd.read_csv(folder / "table.csv", comment="#")
    assert len(table) == 2 * 2 * 3
    moved = [slid(scale, sign, y) for scale in (1.0, 1.7) for sign in (1, -1) for y in (0.05, 0.1, 0.15)]
    assert table["permanent displacement (cm)"].to_numpy() == pytest.approx(100.0 * np.array(moved), rel=1e-9)
    assert table.record.tolist() == ["one.csv"] * 6 + ["two.csv"] * 6
    for text in (
        "2 records, 4 with their polarities",
        "D5-95",
        "median",
        "written: table.csv",
        "written: d.svg",
        "written: motion.svg",
    ):
        assert text in shown.out
    assert (folder / "d.svg").read_text() != (folder / "motion.svg").read_text()
    assert f"{100.0 * np.median(moved[1::3]):.5g}" in shown.out


def test_one_record_shows_a_row_for_each_polarity_and_yield(command, folder: Path):
    shown = command("slide", "records/one.csv", "-y", "0.1,0.05", "--scale-to-pga", "0.4")
    assert shown.code == 0
    factor = 0.4 * GRAVITY / made_motion().measures.pga
    for sign in (1, -1):
        for coefficient in (0.1, 0.05):
            assert f"{slid(factor, sign, coefficient):.6g}"[:7] in shown.out
    assert "+1" in shown.out
    assert "-1" in shown.out


def test_a_column_comes_from_a_scenario(command, folder: Path):
    stiff = ("--body", "sliding-slab-shaken", "--set", "body.wave_speed=4000")
    found = {}
    for analysis in ("coupled", "decoupled"):
        shown = command(
            "slide", "records/one.csv", "-y", "0.1", "--polarity", "1", "--analysis", analysis, *stiff, "--out", "a.csv"
        )
        assert shown.code == 0, shown.err
        found[analysis] = pd.read_csv(folder / "a.csv", comment="#")["permanent displacement (m)"][0]
    assert list(found.values()) == pytest.approx([slid(1.0, 1, 0.1)] * 2, rel=2e-2)


def test_help_teaches_by_examples(command):
    shown = " ".join(command("slide", "--help").out.split())
    for text in (
        "stickslip slide records/*.AT2 --yield 0.1",
        "--scale-to-pga",
        "Newmark 1965",
        "One of: rigid, coupled, decoupled",
    ):
        assert text in shown


WRONG = {
    "a yield in steps that are not counted": (["--yield", "0.05..0.3"], "a range needs its number of points"),
    "a yield of one point": (["--yield", "0.05..0.3:1"], "a range needs its number of points, at least 2"),
    "a yield that falls": (["--yield", "0.3..0.05:3"], "must go from a smaller to a larger number"),
    "a yield of 0": (["--yield", "0"], "--yield must be above 0"),
    "a yield in words": (["--yield", "low"], "--yield must be above 0"),
    "yields without commas": (["--yield", "0.1 0.2"], "values are written with commas, as 0.1,0.2"),
    "another polarity": (["--yield", "0.1", "--polarity", "2"], "slide: --polarity must be 1"),
    "a scale below 0": (
        ["--yield", "0.1", "--scale", "-2"],
        "slide: --scale must be a number above 0, got -2.0; --polarity -1",
    ),
    "both signs and one": (["--yield", "0.1", "--both-signs", "--polarity", "1"], "exclude each other"),
    "two scales": (["--yield", "0.1", "--scale", "2", "--scale-to-pga", "0.4"], "slide: give --scale or --scale-to-pga, not both"),
    "no column": (["--yield", "0.1", "--analysis", "coupled"], "needs a column: name its scenario"),
    "a column that is too much": (["--yield", "0.1", "--body", "sliding-slab-shaken"], "--body is for --analysis coupled"),
    "another analysis": (["--yield", "0.1", "--analysis", "decopled"], "did you mean 'decoupled'?"),
    "another unit": (["--yield", "0.1", "--unit", "inch"], "slide: --unit must be one of m, cm, mm, in, ft"),
    "a record that is not there": (["--yield", "0.1", "--record-figure", "m.svg", "--record", "three"], "no record has 'three'"),
    "a record without its figure": (["--yield", "0.1", "--record", "one"], "--record says what --record-figure draws"),
    "a component that is not there": (["--yield", "0.1", "--component", "N90E"], "N90E"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_is_refused_in_one_line_and_nothing_is_written(case: str, command, folder: Path):
    given, message = WRONG[case]
    shown = command("slide", "records", *given, "--out", "a.csv")
    assert message in shown.refusal
    assert sorted(one.name for one in folder.iterdir()) == ["records"]


def test_one_bad_file_is_named_with_its_reason_and_nothing_is_written(command, folder: Path):
    (folder / "records" / "third.csv").write_text("time (s),acceleration (g)\n0.0,0.1\n0.01,nan\n0.02,0\n")
    refused = command("slide", "records", "--yield", "0.1", "--out", "a.csv").refusal
    assert refused.startswith("slide: ")
    assert "third.csv" in refused
    assert not (folder / "a.csv").exists()
    assert "no such file" in command("slide", "records/four.AT2", "--yield", "0.1").refusal
