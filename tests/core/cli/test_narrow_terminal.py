"""What commands print on narrow terminals: no line is too long, and no number is broken."""

from __future__ import annotations

from io import StringIO

import pytest
from rich.console import Console

from stickslip.cli.output.show import print_words
from tests.command_line import Command
from tests.core.cli.narrow import NUMBER, check_narrow

COMMANDS = [
    ["run", "fig6-slab"],
    ["run", "fig5-slab-printed", "--duration", "5 minutes"],
    ["check", "fig6-slab"],
]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: " ".join(arguments[:2]))
def test_numbers_do_not_break_and_lines_fit(command: Command, monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    check_narrow(command, monkeypatch, arguments)


def test_every_column_of_a_divided_table_is_shown_once_beside_the_first(command: Command, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("COLUMNS", "40")
    out = command("run", "fig6-slab").out
    events = out.partition("1 slip event\n")[2].partition("2 shocks")[0]
    rows = [line.split() for line in events.splitlines() if NUMBER.fullmatch(line.split()[0] if line.split() else "")]
    assert [row[0] for row in rows] == ["0"] * len(rows)
    assert [value for row in rows for value in row[1:]] == [
        *("5.7142857", "5.7142857", "23.440233", "4.1020408"),
        *("80.4", "80.4", "1"),
    ]


def test_sentences_break_between_words_on_a_terminal_and_not_in_a_file(command: Command, monkeypatch: pytest.MonkeyPatch):
    sentence = "selection rule perfect-delay: the contact equation has several solutions, this run depends on the rule"
    assert sentence in command("run", "fig6-slab").out
    monkeypatch.setenv("COLUMNS", "60")
    narrow = command("run", "fig6-slab").out
    assert sentence not in narrow
    assert sentence in " ".join(narrow.split())


@pytest.mark.parametrize(
    ("width", "lines"),
    [
        (80, ["x   y   some words", "x2  y2  words that go on for longer"]),
        (30, ["x  y", "    some words", "x2  y2", "    words that go on for", "    longer"]),
    ],
)
def test_prose_stands_beside_its_row_or_where_that_is_too_narrow_below_it(width: int, lines: list[str]) -> None:
    shown = StringIO()
    print_words(
        Console(width=width, file=shown), ("", "", ""), [("x", "y", "some words"), ("x2", "y2", "words that go on for longer")]
    )
    assert [line.rstrip() for line in shown.getvalue().splitlines()] == lines
