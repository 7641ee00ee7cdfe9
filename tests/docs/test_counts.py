"""A number that a page counts is the number of what there is; what changes often is named there without a number."""

from __future__ import annotations

import re

import pytest
from benchmarks.house import CORE

from stickslip.extension import ANSWERS
from stickslip.extensions.explorer.model.tour import TOUR
from stickslip.extensions.paper.claims import CLAIMS
from stickslip.extensions.paper.plates import PLATES
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import SELECTION_RULES
from tests.docs.pages import PAGES, ROOT

WORDS = (
    *("none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve", "thirteen"),
    *("fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"),
)
TENS = {word: 10 * n for n, word in enumerate(("thirty", "forty", "fifty", "sixty"), 3)}
NUMBER = rf"((?:{'|'.join(WORDS[2:])}|{'|'.join(TENS)}|\d+)(?:-\w+)?)"
COUNTED = {
    rf"\b(?:core of|the) {NUMBER} rooms\b": len(CORE),
    rf"\b{NUMBER} rooms are the core\b": len(CORE),
    rf"\b(?:with|asks) {NUMBER} (?:methods|questions), (?:`stickslip\.|each when)": len(ANSWERS),
    rf"\btour of {NUMBER} steps\b": len(TOUR),
    rf"\bthe {NUMBER} steps of the tour\b": len(TOUR),
    rf"\bopens {NUMBER} steps\b": len(TOUR),
    rf"\b(?:the|under all|## the) {NUMBER} rules\b": len(SELECTION_RULES),
    rf"^#+ (?:the )?{NUMBER} rules\b": len(SELECTION_RULES),
    rf"\b{NUMBER} scripts with a picture\b": len(list((ROOT / "examples").glob("[0-9]*.py"))),
    rf"\b{NUMBER} claims\b": len(CLAIMS),
    rf"\bits {NUMBER} figures\b": len(PLATES),
    rf"\bat most {NUMBER} state variables\b": len(STATE_NAMES),
    rf"\blaw has at most {NUMBER} states\b": len(STATE_NAMES),
}
"""Sentences of pages that count, each with the number of what they count."""


def value(word: str) -> int:
    """Return the number that a word or digits say."""
    if word.isdigit():
        return int(word)
    ten, _, one = word.lower().partition("-")
    return TENS[ten] + (WORDS.index(one) if one else 0) if ten in TENS else WORDS.index(ten)


def counts_in(text: str) -> list[tuple[str, int, int]]:
    """Return the counts of a text: the sentence, the number in it, and the number that there is."""
    joined = re.sub(r"(?<=\S)\n *(?=[^\n#| -])", " ", text)
    found = [
        (one, there_is)
        for pattern, there_is in COUNTED.items()
        for one in re.finditer(pattern, joined, re.IGNORECASE | re.MULTILINE)
    ]
    return [(one[0], value(one[1]), there_is) for one, there_is in found]


def test_pages_count_what_there_is() -> None:
    texts = {page.name: page.read_text(encoding="utf-8") for page in (*PAGES, ROOT / "CONTRIBUTING.md")}
    counts = [(page, *count) for page, text in texts.items() for count in counts_in(text)]
    assert len(counts) >= 10
    assert [count for count in counts if count[2] != count[3]] == []


@pytest.mark.parametrize(
    "text",
    [
        "a core of eleven rooms in one order",
        "`examples` has thirty-one scripts with a\npicture each",
        "a verdict on twenty\n  claims",
        "## The five rules",
        "a guided tour of 9 steps",
    ],
)
def test_a_wrong_count_is_seen(text: str) -> None:
    counts = counts_in(text)
    assert counts
    assert all(said != there_is for _, said, there_is in counts)
