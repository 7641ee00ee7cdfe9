"""`--column`: the user says which heading of a file is what, wherever a command reads a table."""

from __future__ import annotations

from pathlib import Path

import pytest

TABLE = "A (mm/s),B\n1,0.6\n2,0.5\n3,0.45\n4,0.43\n"


@pytest.fixture
def table(command, tmp_path: Path) -> str:
    """A file whose headings nobody knows."""
    (tmp_path / "a.csv").write_text(TABLE)
    return "a.csv"


def test_a_law_is_made_of_columns_that_are_named(command, table):
    shown = command("fit", table, "--smooth", "1e-6", "--column", "slip_rate=A", "--column", "friction=2")
    assert shown.code == 0
    assert "4 points along slip_rate" in shown.out
    assert shown.err == ""


COMMANDS = [
    ("fit", "a.csv"),
    ("infer", "velocity-steps-block", "a.csv", "--free", "a"),
    ("explore", "fig6-slab", "--record", "a.csv"),
    ("benchmark", "judge", "a.csv", "--name", "loop"),
    ("schemes", "fig4-loop", "--series", "a.csv"),
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_a_column_that_is_not_there_is_refused_in_one_line_with_those_that_are(command, table, words):
    name = "slip_rate" if words[0] == "fit" else "time"
    refusal = command(*words, "--column", f"{name}=C").refusal
    assert f"a.csv, line 1: columns: there is no column 'C' for {name}; it has 'A (mm/s)', 'B'" in refusal


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_a_column_that_is_typed_wrongly_is_refused_with_an_example(command, table, words):
    refusal = command(*words, "--column", "time").refusal
    assert refusal.startswith(f"{words[0]}: --column must be NAME=HEADING, as load_point=\"Vert_disp (micron)\", got 'time'")
    assert "--column: 'time' is given twice" in command(*words, "--column", "time=A", "--column", "time=B").refusal


def test_a_column_of_no_file_is_refused(command):
    assert (
        "--column says what the columns of a file of --series are" in command("schemes", "fig4-loop", "--column", "time=C").refusal
    )
    assert "--column does not belong to list" in command("benchmark", "list", "--column", "time=C").refusal
