"""Blocks of numbers: parsed at once, apart by blanks or, where they touch each other, by the width of their columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from stickslip.extensions.strong_motion.layouts.motion import RecordLayout
from stickslip.foundation.arrays import Floats
from stickslip.foundation.record_files import Asked, Lines

_FORMAT = re.compile(r"\(\s*(\d{1,3})\s*[a-z]\s*(\d{1,3})(?:\.\d+)?", re.IGNORECASE)


_WORD = re.compile(r"[a-z]{3}", re.IGNORECASE)


class Columns(NamedTuple):
    """How many numbers stand in a line, and how many characters each has."""

    across: int
    width: int

    @classmethod
    def of(cls, text: str, usual: Columns) -> Columns:
        """Return the columns of a format such as (8f10.5) in a text, or the usual ones."""
        found = _FORMAT.search(text)
        return cls(int(found[1]), int(found[2])) if found and int(found[1]) and int(found[2]) else usual


def rest(lines: Lines) -> list[str]:
    """Return the lines that are left, without those at the end that are blank."""
    found = list(islice(lines, max(len(lines.begin) - lines.number, lines.peeked is not None)))
    found += lines.more  # at once, without counting
    while found and not found[-1].strip():
        found.pop()
    return found


def next_block(lines: Lines, count: int, columns: Columns) -> list[str]:
    """Return the next lines that hold so many numbers."""
    return list(islice(lines, -(-count // columns.across)))


def numbers(texts: Sequence[str], columns: Columns | None = None, count: int | None = None) -> Floats:
    """Return the numbers in lines of text. Raises ValueError if a text is no number.

    Where `columns` are given, numbers may touch each other: they are cut by their width if blanks do not make them `count`.
    """
    try:
        found = _apart(texts)
        if columns is None or count is None or len(found) == count:
            return found
    except ValueError:
        if columns is None:
            raise
    return _by_width(texts, columns)


def _apart(texts: Sequence[str]) -> Floats:
    text = "\n".join(texts)
    if "_" in text:
        raise ValueError("no number")
    if "D" in text or "d" in text:
        text = text.replace("D", "E").replace("d", "e")
    return np.fromiter(map(float, text.split()), float)


def _by_width(texts: Sequence[str], columns: Columns) -> Floats:
    """Return the numbers in columns of one width; blank ones are passed over."""
    width, last = columns.width, columns.width * columns.across
    text = "".join([text[:last].ljust(last) for text in texts]).upper().replace("D", "E")
    if "_" in text:
        raise ValueError("no number")
    cells = np.frombuffer(text.encode("ascii"), f"S{width}")
    return np.asarray(cells[cells != b" " * width], dtype=float)


def samples(
    layout: RecordLayout, asked: Asked, line: int, texts: Sequence[str], *, count: int, columns: Columns | None = None
) -> Floats:
    """Return the samples in lines of text behind `line`. Raises InputError if one is no number, or for another count."""
    try:
        found = numbers(texts, columns, count)
    except ValueError:
        before = next(i for i, text in enumerate(texts) if not _is_of_numbers(text, columns))
        if _WORD.search(texts[before]):  # the next header
            samples(layout, asked, line, texts[:before], count=count, columns=columns)
            raise layout.fault(
                asked, line + before + 1, "text follows its samples: write each record to a file of its own"
            ) from None
        raise layout.fault(asked, line + before + 1, "each sample must be a number") from None
    layout.check_count(asked, line, count, len(found))
    return found


def _is_of_numbers(text: str, columns: Columns | None) -> bool:
    try:
        numbers([text], columns, 0)
    except ValueError:
        return False
    return True
