"""The campaign of mutants and the soak have what they need: places that still exist, code that parses, problems that come again."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from benchmarks.mutants import NAMED, SOURCE, drawn, named
from benchmarks.soak_checks import run
from benchmarks.soak_problems import draw

from stickslip.friction import LAWS

ROOT = Path(__file__).resolve().parents[2]


def test_every_named_mistake_occurs_once_in_the_source() -> None:
    assert [one.name for one in named(ROOT)] == [one.name for one in NAMED]


def test_random_mutants_parse_and_differ_and_are_reproducible() -> None:
    mutants = drawn(ROOT, 300, seed=3)
    assert mutants == drawn(ROOT, 300, seed=3)
    assert len({mutant.name for mutant in mutants}) > 290
    for mutant in mutants:
        text = (ROOT / SOURCE / mutant.path).read_bytes()
        assert mutant.applied(text) != text
        ast.parse(mutant.applied(text))


def test_soak_draws_every_kind_reproducibly() -> None:
    kinds = [draw(5, index).kind for index in range(len(LAWS))]
    assert kinds == list(LAWS)
    assert repr(draw(5, 3)) == repr(draw(5, 3))


@pytest.mark.parametrize("index", range(4))
def test_soak_finds_nothing_wrong_with_the_first_problems(index: int) -> None:
    assert run(draw(5, index), limit=60.0).wrong == ()
