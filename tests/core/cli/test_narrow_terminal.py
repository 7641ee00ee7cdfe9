"""What commands print on narrow terminals: no line is too long, and no number is broken."""

import re
from collections.abc import Callable
from io import StringIO

import pytest
from rich.console import Console

from stickslip.cli.output.show import print_words
from stickslip.extensions.schemes.schemes import schemes
from stickslip.extensions.schemes.summary import show_schemes
from stickslip.problem.scenarios.scenario import load_scenario
from tests.core.cli.conftest import Outcome

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
COMMANDS = [
    ["run", "fig6-slab"],
    ["run", "fig5-slab-printed", "--duration", "5 minutes"],
    ["check", "fig6-slab"],
    ["sweep", "fig6-slab", "-v", "alpha=0.1..1:4", "-v", "thickness=5km,10km"],
    ["compare", "fig6-block-reconstructed", "fig6-slab"],
    ["analogy", "block-or-slab", "--map", "wavelength=5..41.6:2:log", "--map", "alpha=0.00392..1:2:log"],
]


def check_fits(narrow: str, wide: str, width: int) -> None:
    """Fail if a line of `narrow` is wider than `width`, or a number in it is not one of `wide`, nor one with fewer digits."""
    whole = {number for word in wide.split() for number in NUMBER.findall(word)}
    shorter = {f"{float(number):.5g}" for number in whole} | {f"{float(number):.3f}" for number in whole}
    for line in narrow.splitlines():
        assert len(line.rstrip()) <= width, line
        for number in NUMBER.findall(line):
            assert number in whole | shorter, (number, line)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: " ".join(arguments[:2]))
def test_numbers_do_not_break_and_lines_fit(command: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch, arguments: list[str]):
    wide = command(*arguments)
    monkeypatch.setenv("COLUMNS", "40")
    narrow = command(*arguments)
    assert narrow.code == wide.code == 0
    check_fits(narrow.out, wide.out, 40)
    assert {word for word in wide.out.split() if word.isalpha()} - {"meaning"} <= set(narrow.out.split())  # a heading


@pytest.mark.parametrize("width", [60, 40])
def test_the_table_of_schemes_fits(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int):
    scenario = load_scenario("fig4-loop")
    study = schemes(scenario, scheme=["lag", "central-differences-cfl1"], cells=[20, 40])
    show_schemes(scenario, study)
    wide = capsys.readouterr().out
    monkeypatch.setenv("COLUMNS", str(width))
    show_schemes(scenario, study)
    check_fits(capsys.readouterr().out, wide, width)


def test_every_column_of_a_divided_table_is_shown_once_beside_the_first(
    command: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("COLUMNS", "40")
    out = command("run", "fig6-slab").out
    events = out.partition("1 slip event\n")[2].partition("2 shocks")[0]
    rows = [line.split() for line in events.splitlines() if NUMBER.fullmatch(line.split()[0] if line.split() else "")]
    assert [row[0] for row in rows] == ["0"] * len(rows)
    assert [value for row in rows for value in row[1:]] == [
        *("5.7142857", "5.7142857", "23.440233", "4.1020408"),
        *("80.4", "80.4", "1"),
    ]


def test_sentences_break_between_words_on_a_terminal_and_not_in_a_file(
    command: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch
):
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
