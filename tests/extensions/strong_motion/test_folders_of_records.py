"""Folders of records: what lies beside the records does not end a study."""

from pathlib import Path

import pytest

import stickslip as ss
from tests.messages import refused

RECORD = "time (s),ground acceleration (g)\n0,0\n0.01,0.3\n0.02,0\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with two records."""
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text(RECORD)
    return tmp_path


def test_results_that_were_written_into_the_folder_are_no_records_the_next_time(folder: Path) -> None:
    first = ss.studies.sliding(folder, 0.1)
    first.to_csv(folder / "c.csv")
    assert ss.studies.sliding(folder, 0.1).table.equals(first.table)


def test_a_file_that_is_no_record_is_left_out_with_a_warning(folder: Path) -> None:
    whole = ss.studies.sliding(folder, 0.1)
    (folder / "velocities.csv").write_text("time (s),velocity (m/s)\n0,0\n0.01,1\n0.02,0\n")
    with pytest.warns(UserWarning, match="velocities.csv, line 1: no column 'ground_acceleration'.*: left out"):
        assert ss.studies.sliding(folder, 0.1).table.equals(whole.table)
    with refused("velocities.csv, line 1: no column 'ground_acceleration'"):
        ss.studies.sliding([folder / "a.csv", folder / "velocities.csv"], 0.1)


def test_a_folder_without_any_record_says_why_the_first_is_none(folder: Path) -> None:
    for name in ("a.csv", "b.csv"):
        (folder / name).write_text("x,y\n1,2\n3,4\n")
    with refused("a.csv, line 1: no column 'ground_acceleration'"):
        ss.studies.sliding(folder, 0.1)
