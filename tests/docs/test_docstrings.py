"""Examples in docstrings run and print what they show."""

from __future__ import annotations

import asyncio
import doctest
import inspect
import re
from typing import Any

import matplotlib as mpl
import pytest

import stickslip as ss
from stickslip import studies

FIRST_MET = {
    "simulate": ss.simulate,
    "Problem": ss.Problem,
    "catalogue": ss.catalogue,
    "uniqueness": ss.uniqueness,
    "sweep": ss.sweep,
    "infer": studies.infer,
    "schemes": studies.schemes,
    "compare": studies.compare,
    "explore": ss.explore,
    "FromExpression": ss.friction.FromExpression,
    "find": studies.find,
    "steady": studies.steady,
}
"""What users meet first, and whatever else has an example."""


@pytest.mark.parametrize("name", FIRST_MET)
def test_the_example_prints_what_it_shows(name: str) -> None:
    mpl.use("agg")
    found = inspect.getdoc(FIRST_MET[name]) or ""
    test = doctest.DocTestParser().get_doctest(found, {}, name, None, None)
    assert test.examples, f"{name} has no example"
    said: list[str] = []

    async def cell() -> None:  # as in a notebook, for `explore`
        doctest.DocTestRunner(verbose=False).run(test, out=said.append)

    asyncio.run(cell())
    assert not said, "".join(said)


@pytest.mark.parametrize("name", FIRST_MET)
def test_what_is_named_beside_it_exists(name: str) -> None:
    found = inspect.getdoc(FIRST_MET[name]) or ""
    section = re.search(r"See Also\n-+\n((?:\S.*\n)+)", found)
    for line in section[1].splitlines() if section else ():
        place: Any = ss
        for part in line.split(" : ")[0].split(".")[1:]:
            place = getattr(place, part)
