"""What the tests take of the processor, by folder: a table at the end of a long run, which nothing compares."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from pathlib import PurePosixPath

LONG = 60.0
"""Processor time (s) of all tests from which on the table is written."""
SMALL = 0.01
"""Share of it below which folders are told together."""


class Clock:
    """The processor time (s) of this process, and of those that it has started and that have ended."""

    def __init__(self) -> None:
        self._before = self._now()

    @staticmethod
    def _now() -> float:
        return sum(os.times()[:4])

    def lap(self) -> float:
        """Return what was spent since the last call."""
        before, self._before = self._before, self._now()
        return self._before - before


def folder_of(test: str) -> str:
    """Return the folder of a test that a table names: `core/ROOM`, `extensions/NAME`, or the first below `tests`."""
    parts = PurePosixPath(test.partition("::")[0]).parts[1:-1]
    return "/".join(parts[: 2 if parts[:1] in (("core",), ("extensions",)) else 1]) or "above them"


def table_of(spent: Counter[str], tests: Counter[str]) -> Iterator[str]:
    """Yield the lines of the table, the dearest folder first, from the processor time (s) and the number of tests of each."""
    total = spent.total()
    small = {name for name in spent if spent[name] < SMALL * total}
    for name, seconds in spent.most_common():
        if name not in small:
            yield f"{seconds:7.0f} s {seconds / total:5.0%} {tests[name]:6} {name}"
    if small:
        yield f"{sum(spent[one] for one in small):7.0f} s        {sum(tests[one] for one in small):6} elsewhere"
    yield f"{total:7.0f} s        {tests.total():6} in all"
