"""`--column`: the user says which heading of a file is what."""

from __future__ import annotations

from tests.command_line import Command, check_columns_named


def test_a_column_that_is_not_there_or_is_typed_wrongly_is_refused_in_one_line(command: Command) -> None:
    check_columns_named(command, "schemes", "fig4-loop", "--series", "a.csv")


def test_a_column_of_a_judged_file_is_refused_likewise(command: Command) -> None:
    check_columns_named(command, "benchmark", "judge", "a.csv", "--name", "loop")


def test_a_column_of_no_file_is_refused(command: Command) -> None:
    said = command("schemes", "fig4-loop", "--column", "time=C").refusal
    assert "--column says what the columns of a file of --series are" in said
    assert "--column does not belong to list" in command("benchmark", "list", "--column", "time=C").refusal
