"""Narrow terminals: no line is too long, and no number is broken."""

from __future__ import annotations

import re

import pytest

from tests.command_line import Command

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


def check_fits(narrow: str, wide: str, width: int) -> None:
    """Fail if a line of `narrow` is wider than `width`, or a number in it is not one of `wide`, nor one with fewer digits."""
    whole = {number for word in wide.split() for number in NUMBER.findall(word)}
    shorter = {f"{float(number):.5g}" for number in whole} | {f"{float(number):.3f}" for number in whole}
    for line in narrow.splitlines():
        assert len(line.rstrip()) <= width, line
        for number in NUMBER.findall(line):
            assert number in whole | shorter, (number, line)


def check_narrow(command: Command, monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    """Fail if what a command prints at 40 columns is too wide, breaks a number, or leaves out a word."""
    wide = command(*arguments)
    monkeypatch.setenv("COLUMNS", "40")
    narrow = command(*arguments)
    assert narrow.code == wide.code == 0
    check_fits(narrow.out, wide.out, 40)
    assert {word for word in wide.out.split() if word.isalpha()} - {"meaning"} <= set(narrow.out.split())  # a heading
