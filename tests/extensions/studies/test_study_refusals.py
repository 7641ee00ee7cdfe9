"""Every study that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["compare"], "compare: RUNS is missing; `stickslip compare --help` explains it, with examples"),
    (["compare", "fig6-slab"], "compare: needs two runs or more, got 1"),
    (["compare", "fig6-slab", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["analogy", "fig6-slab"], 'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got 0'),
    (["analogy", "fig6-slab", "--map", "alpha=1..2", "--map", "alpha=1..2"], "analogy: needs two different parameters"),
    (["ensemble", "fig6-slab", "--members", "many"], "ensemble: --members must be a whole number, got 'many'"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["compare", "fig6-slab", "fig6-slab", "--rules"], "compare: every rule is that of one scenario, got 2 of them"),
        (["compare", "fig6-slab"], "--rules runs one under each selection rule"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(command: Command, tmp_path: Path, arguments: list[str], message: str) -> None:
    assert message in command(*arguments).refusal
    assert not [path.name for path in tmp_path.iterdir()]
