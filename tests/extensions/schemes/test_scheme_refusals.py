"""Every benchmark or scheme that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["benchmark", "get", "loop", "--out", "a.csv"], "benchmark: --out does not belong to get: get writes files to --folder"),
    (["benchmark", "list", "--folder", "x"], "benchmark: --folder does not belong to list: leave it out"),
    (["benchmark", "list", "x"], "benchmark: list takes no name, got 'x': `get` writes a problem, `judge` reads a file"),
    (["benchmark", "get", "lop"], "benchmark: there is no problem 'lop'; did you mean 'loop'?"),
    (["benchmark", "get", "loop", "lop"], "benchmark: there is no problem 'lop'; did you mean 'loop'?"),
    (["benchmark", "get"], "benchmark: get needs the name of a problem: see `list`"),
    (["benchmark", "gte"], "benchmark: there is nothing called 'gte'; did you mean 'get'?"),
    (["benchmark", "judge"], "benchmark: judge needs a file"),
    (["schemes", "fig4-loop", "--nx", "20;50"], "schemes: --nx must be whole numbers separated by commas"),
    (["schemes", "fig4-loop", "--scheme", "hth"], "schemes: there is no scheme 'hth'; did you mean 'hht'?"),
    (["schemes", "fig4-loop", "--scheme", "theta,theta"], "schemes: the scheme 'theta' is given twice"),
    (["schemes", "fig4-loop", "--out", "a.txt"], "--out a.txt: the name must end in .csv"),
    (["schemes", "fig4-loop", "--series", "a.csv", "--nx", "20"], "schemes: --nx is for schemes of stickslip: leave it out with"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)
