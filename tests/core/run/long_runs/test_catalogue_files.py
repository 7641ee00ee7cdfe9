"""The files of a catalogue: nobody else's are touched, two runs do not share them, and a kill leaves them so that it goes on."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd
import pytest

import stickslip as ss
from stickslip.foundation.netcdf_file import read, write
from stickslip.run import catalogue as module
from stickslip.run.catalogue import checkpoint_of
from stickslip.solution.files.catalogue_rows import Rows
from tests.core.run.long_runs.problems import RUNS

PROBLEM, DURATION = RUNS["slab that heals"]


@cache
def first_files(suffix: str) -> dict[str, bytes]:
    """What a catalogue that has begun has written, by the names of its files."""
    with TemporaryDirectory() as folder:
        ss.catalogue(PROBLEM, 0.6 * DURATION, Path(folder) / f"events.{suffix}")
        return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def began(tmp_path: Path, suffix: str = "csv") -> Path:
    for name, content in first_files(suffix).items():
        (tmp_path / name).write_bytes(content)
    return tmp_path / "events.checkpoint.nc"


def changed(path: Path, **attributes: object) -> None:
    write(read(path).assign_attrs(attributes), path)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", ["../victim.csv", "/tmp/victim.csv", "", "a\\b.csv"])
def test_a_path_in_a_checkpoint_is_not_followed(tmp_path: Path, name: str) -> None:
    (tmp_path / "victim.csv").write_text("precious\n")
    folder = tmp_path / "folder"
    folder.mkdir()
    checkpoint = began(folder)
    changed(checkpoint, catalogue=name, bytes=0)
    with pytest.raises(ss.InputError, match="which is no bare name"):
        ss.resume(checkpoint, DURATION)
    assert (tmp_path / "victim.csv").read_text() == "precious\n"


@pytest.mark.skipif(os.name != "posix", reason="needs links")
def test_a_link_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "victim.csv").write_text("precious\n")
    folder = tmp_path / "folder"
    folder.mkdir()
    checkpoint = began(folder)
    (folder / "events.csv").unlink()
    (folder / "events.csv").symlink_to(tmp_path / "victim.csv")
    with pytest.raises(ss.InputError, match=r"events\.csv: is a link"):
        ss.resume(checkpoint, DURATION)
    assert (tmp_path / "victim.csv").read_text() == "precious\n"


def test_a_run_stopped_before_its_first_event_continues_without_a_file(tmp_path: Path) -> None:
    rows = Rows(tmp_path / "events.csv")
    rows.take_up(0, 0, rows.digest(0))
    assert (rows.size, rows.growing.exists()) == (0, False)
    with pytest.raises(ss.InputError, match="has lost rows that the checkpoint counts on"):
        rows.take_up(1, 1, rows.digest(0))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("wrong", [{"told": -1}, {"first": "x"}, {"event_rate": float("nan")}])
def test_numbers_of_a_checkpoint_are_checked(tmp_path: Path, wrong: dict[str, object]) -> None:
    checkpoint = began(tmp_path)
    changed(checkpoint, **wrong)
    with pytest.raises(ss.InputError, match=r"events\.checkpoint\.nc: not a file that stickslip has written"):
        ss.resume(checkpoint, DURATION)


@pytest.mark.sampled(every=2)
@pytest.mark.skipif(os.name != "posix", reason="needs locks")
@pytest.mark.parametrize("other", ["events.csv", "events.nc"])
def test_two_runs_do_not_write_into_one_catalogue(tmp_path: Path, other: str) -> None:
    """Nor into two that have one checkpoint."""
    checkpoint = began(tmp_path)
    before = (tmp_path / "events.csv").read_bytes()
    with module.alone_with(Rows(tmp_path / "events.csv")):
        for begin in (lambda: ss.catalogue(PROBLEM, DURATION, tmp_path / other), lambda: ss.resume(checkpoint, DURATION)):
            with pytest.raises(ss.InputError, match="another run is writing its catalogue there: choose another name"):
                begin()
    assert (tmp_path / "events.csv").read_bytes() == before
    ss.resume(checkpoint, DURATION)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("left", ["", "start,end\n1.0,", "begun"])
def test_a_catalogue_killed_while_it_lengthens_a_table_continues(tmp_path: Path, left: str) -> None:
    """Whatever is in the growing file: its rows are made again from the table."""
    checkpoint = began(tmp_path, "nc")
    rows = Rows(tmp_path / "events.nc")
    if left == "begun":
        text = ss.catalogue(PROBLEM, 0.6 * DURATION, tmp_path / "other.csv").to_csv(index=False)
        left = text[: len(text) // 2]
    rows.growing.write_text(left)
    whole = ss.simulate(PROBLEM, DURATION).catalogue()
    pd.testing.assert_frame_equal(ss.resume(checkpoint, DURATION), whole, check_exact=True)


def test_changed_rows_are_refused(tmp_path: Path) -> None:
    checkpoint = began(tmp_path)
    text = (tmp_path / "events.csv").read_text()
    place = text.index("\n") + 3
    (tmp_path / "events.csv").write_text(text[:place] + ("1" if text[place] != "1" else "2") + text[place + 1 :])
    with pytest.raises(ss.InputError, match=r"events\.csv: has other rows than the checkpoint counts on"):
        ss.resume(checkpoint, DURATION)
    assert checkpoint_of(Rows(tmp_path / "events.csv")) == checkpoint
