"""`--column`: the user says which heading of a file is what."""

from __future__ import annotations

from tests.command_line import Command, check_columns_named


def test_a_column_that_is_not_there_or_is_typed_wrongly_is_refused_in_one_line(command: Command) -> None:
    check_columns_named(command, "infer", "velocity-steps-block", "a.csv", "--free", "a")


def test_columns_of_points_that_are_named_are_read_and_others_refused(command: Command) -> None:
    check_columns_named(command, "fit", "a.csv", name="slip_rate")
    shown = command("fit", "a.csv", "--smooth", "1e-6", "--column", "slip_rate=A", "--column", "friction=2")
    assert shown.code == 0
    assert "4 points along slip_rate" in shown.out
    assert shown.err == ""
