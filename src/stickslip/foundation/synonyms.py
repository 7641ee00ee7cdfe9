"""Find the names that are meant by the words of the trades: D_c is `distance`, rpm is `pull_rate`, plot is `show` or `--figure`.

A hint (`errors.nearest`) asks here before it looks for words that are spelled alike, whatever is named: a number of a scenario, an
option, a command, a quantity, a column, an argument or an attribute. The words stand in `trade_words.txt`.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator
from functools import cache

_PART = re.compile(r"[A-Z]?[a-z0-9]+|[A-Z]+")
TABLE = "trade_words.txt"
"""The file of words beside this one: in each line a name, a colon, and the words for which it may be meant."""


def plain(word: str) -> str:
    """Return a word without what spellings differ in: capitals, hyphens, dots, underscores and blanks."""
    return "".join(_latin(letter) for letter in word.casefold() if letter.isalnum())


def _latin(letter: str) -> str:
    """Return a letter, or the name of a Greek one."""
    return letter if letter.isascii() else unicodedata.name(letter, letter).rpartition("GREEK SMALL LETTER ")[2].casefold()


def rows() -> Iterator[tuple[str, list[str]]]:
    """Yield the names of the table, each with words for which it may be meant; a name may come again."""
    from importlib import resources  # only where there is something to explain

    text = (resources.files(__name__.rpartition(".")[0]) / TABLE).read_text(encoding="utf-8")
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            name, _, words = line.partition(":")
            yield name, words.split()


@cache
def _meant() -> dict[str, tuple[str, ...]]:
    """Return the names that each word, in its plain form, may mean, in the order of the table."""
    found: dict[str, dict[str, None]] = {}
    for name, words in rows():
        for word in words:
            found.setdefault(plain(word), {})[name] = None
    return {word: tuple(names) for word, names in found.items()}


def meanings(word: str) -> tuple[str, ...]:
    """Return the names that a word may mean, whatever is allowed; none if the table does not have the word."""
    return _meant().get(plain(last(word)), ())


def words() -> Iterable[str]:
    """Return all words of the table, in their plain form."""
    return _meant()


def same(word: str, allowed: Iterable[str]) -> list[str]:
    """Return those of the allowed words that a word means: the same but for its spelling, or else those of the table.

    Of a name with dots, such as "friction.alpha", the last part counts, too; if several names end alike, those with the first part
    of the word come alone.
    """
    by_name: dict[str, list[str]] = {}
    for one in allowed:
        for name in dict.fromkeys((plain(one), plain(last(one)))):
            by_name.setdefault(name, []).append(one)
    place = word.rpartition(".")[0]
    for asked in dict.fromkeys((plain(word), plain(last(word)))):
        meant = (asked,) if asked in by_name else _meant().get(asked, ())
        if found := list(dict.fromkeys(one for name in meant for one in by_name.get(plain(name), ()))):
            return [one for one in found if place and one.startswith(f"{place}.")] or found
    return []


def last(name: str) -> str:
    """Return the part of a name after its last dot."""
    return name.rpartition(".")[2]


def parts_of(name: str) -> list[str]:
    """Return the words that a name is made of, without capitals: "elastic", "slab" of elastic-slab and of ElasticSlab."""
    return [part.casefold() for part in _PART.findall(name)]
