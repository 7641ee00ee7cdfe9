"""What the changelog says to type in place of what has moved is there, and what it says has moved is not."""

from __future__ import annotations

import ast
import re

import pytest

import stickslip as ss
from tests.docs.pages import ROOT

ROW = re.compile(r"^\s*\| (?P<before>`.*`) \| (?P<now>`.*`.*) \|$", re.MULTILINE)
CODE = re.compile(r"`([^`]+)`")
ROWS = [(row["before"], row["now"]) for row in ROW.finditer((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))]
IMPORTS = [(before, now) for before, now in ROWS if "import" in before]
"""Rows about modules; the others are about attributes of objects."""


@pytest.mark.parametrize(("before", "now"), IMPORTS, ids=[before.strip("`") for before, _ in IMPORTS])
def test_what_to_type_now_works_and_what_was_typed_does_not(before: str, now: str) -> None:
    for code in CODE.findall(now):
        exec(code, {"ss": ss})
    with pytest.raises(ImportError):
        exec(CODE.findall(before)[0], {})


def test_names_of_attributes_are_those_of_a_scenario() -> None:
    (before, now), = [row for row in ROWS if row not in IMPORTS]  # fmt: skip
    scenario = ss.load_scenario("planar-patch")
    for code in CODE.findall(now):
        assert eval(code, {"scenario": scenario}) is not None
    for code in CODE.findall(before):
        with pytest.raises(AttributeError):
            eval(code, {"scenario": scenario})


def test_the_table_is_found_and_each_row_is_python() -> None:
    assert len(IMPORTS) > 20
    for codes in ROWS:
        for code in CODE.findall(" ".join(codes)):
            ast.parse(code)
