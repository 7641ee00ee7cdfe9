"""Cases of a test that compiles much for each: some of them in every run of the tests, the others with `-m slow`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import pytest


def some(cases: Iterable[Any], every: int) -> list[Any]:
    """Return the cases for `parametrize`: each `every`-th one as it is, from the first on, and the others marked as slow.

    Values of a mapping keep their names. A tuple is a case of several arguments.
    """
    named = cases.items() if isinstance(cases, Mapping) else ((None, case) for case in cases)
    made = []
    for i, (name, case) in enumerate(named):
        marks = [] if i % every == 0 else [pytest.mark.slow]
        values = case if isinstance(case, tuple) else (case,)
        made.append(pytest.param(*values, id=name, marks=marks))
    return made
