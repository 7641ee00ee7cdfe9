"""Sentences are as one would say them aloud: the noun carries what is meant, and not 'of which', 'at which' or 'of what'."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import stickslip

RELATIVE = re.compile(r"\b(?:of|from|in|at|by) which\b|\bof what\b", re.IGNORECASE)
MOST_LINES = 150
"""Lines of the package may have such words; their number may only fall."""


def relative_lines(text: str) -> list[str]:
    """Return the lines of a text that have such words."""
    return [line.strip() for line in text.splitlines() if RELATIVE.search(line)]


def test_few_lines_of_the_package_say_of_which() -> None:
    files = Path(stickslip.__file__).parent.rglob("*.py")
    found = [line for path in files for line in relative_lines(path.read_text(encoding="utf-8"))]
    assert 0 < len(found) <= MOST_LINES, found


@pytest.mark.parametrize("text", ["the file from which\nit is read", '"""Of what it is."""', "pieces, of which two rest"])
def test_such_a_line_is_seen(text: str) -> None:
    assert len(relative_lines(text)) == 1


def test_a_plain_line_is_none() -> None:
    assert relative_lines("the file that it is read from, and the witch of whatever") == []
