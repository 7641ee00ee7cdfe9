"""Conditions that ask a body or a driver what kind it is are found in every form, and the answers of kinds are none."""

from __future__ import annotations

import ast

import pytest
from benchmarks.kinds import functions_that_ask

ASKS = (
    "if body.has_waves: pass",
    "return 1 if problem.body.is_uniform else 0",
    "assert not body.has_machine",
    "while run.counts.cells > 0: pass",
    "if isinstance(body, OfLayers): pass",
    "if problem.driver_kind == 'machine': pass",
    "return [one for one in found if problem.driver_changes]",
    "match body.structure:\n        case 'rigid': pass",
)
ASKS_NOT = (
    "return KINDS[body.structure].numbers(body)",
    "if why := KINDS[problem.driver_kind].missing(problem): pass",
    "if mesh.cells > 0: pass",
    "if isinstance(body, ElasticSlab): pass",
    "flags = body.has_waves",
)


def asked(line: str) -> int:
    tree = ast.parse(f"def f(body, problem, run, mesh):\n    {line}")
    return sum(map(len, functions_that_ask({"a.py": list(ast.walk(tree))}).values()))


@pytest.mark.parametrize("line", ASKS)
def test_a_condition_that_asks_a_kind_is_found(line: str) -> None:
    assert asked(line) == 1


@pytest.mark.parametrize("line", ASKS_NOT)
def test_what_asks_no_kind_is_not_counted(line: str) -> None:
    assert asked(line) == 0
