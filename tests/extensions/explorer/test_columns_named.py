"""`--column`: the user says which heading of a file is what."""

from __future__ import annotations

from tests.command_line import Command, check_columns_named


def test_a_column_that_is_not_there_or_is_typed_wrongly_is_refused_in_one_line(command: Command) -> None:
    check_columns_named(command, "explore", "fig6-slab", "--record", "a.csv")
