"""The campaign of mutants and the soak have what they need: places that still exist, code that parses, problems that come again."""

from __future__ import annotations

import ast
import builtins
import importlib
import inspect
import json
from pathlib import Path

import pytest
from benchmarks.mutants import NAMED, PACKAGES, SOURCE, Mutant, drawn, named
from benchmarks.reached import Reached
from benchmarks.soak_checks import run
from benchmarks.soak_problems import draw
from benchmarks.unverified import WITHOUT

from stickslip.friction import LAWS

ROOT = Path(__file__).resolve().parents[2]


def test_every_named_mistake_occurs_once_in_the_source() -> None:
    assert [one.name for one in named(ROOT)] == [one.name for one in NAMED]


@pytest.mark.slow
def test_random_mutants_of_each_package_parse_and_differ_and_are_reproducible() -> None:
    some = ("contact", "engine", "engine/history", "extensions/explorer/model")
    mutants = drawn(ROOT, 80, 3, some)
    assert mutants == drawn(ROOT, 80, 3, some)
    assert {mutant.package for mutant in mutants} == set(some) <= set(PACKAGES)
    assert len({mutant.name for mutant in mutants}) > 76
    for mutant in mutants:
        text = (ROOT / SOURCE / mutant.path).read_bytes()
        assert mutant.applied(text) != text
        ast.parse(mutant.applied(text))


def test_bodies_of_the_build_without_proofs_know_all_their_names() -> None:
    for path, bodies in WITHOUT.items():
        module = importlib.import_module("stickslip." + path.removesuffix(".py").replace("/", "."))
        for name, body in bodies.items():
            used = {node.id for node in ast.walk(ast.parse(f"def {name}():\n    {body}")) if isinstance(node, ast.Name)}
            known = {*vars(module), *vars(builtins), *inspect.signature(inspect.unwrap(getattr(module, name))).parameters}
            assert used <= known, f"{path}, {name}: {used - known}"


@pytest.mark.parametrize("package", PACKAGES)
def test_each_package_has_files(package: str) -> None:
    assert list((ROOT / SOURCE / package).rglob("*.py"))


SCALES = """LONGEST = 3
def first(
    text, many=7
):
    if text:
        return (text +
            text[:LONGEST])
    return many
"""
REACH = [("first[a]", 0.1, [5, 6, 7]), ("first[b]", 0.2, [5, 6, 7]), ("second", 0.3, [5, 6]), ("third", 0.05, [5, 8])]


@pytest.mark.parametrize(
    ("change", "tests"),
    [
        ("[:", ["first[a]", "second", "first[b]"]),
        ("text:", ["third", "first[a]", "second", "first[b]"]),
        ("3", ["first[a]", "first[b]"]),
        ("7", ["third", "first[a]", "second", "first[b]"]),
        ("return many", ["third"]),
    ],
    ids=["second line of a statement", "condition", "constant", "default", "statement"],
)
def test_tests_of_a_mutant_reach_it_each_function_first(change: str, tests: list[str], tmp_path: Path) -> None:
    (tmp_path / SOURCE).mkdir(parents=True)
    (tmp_path / SOURCE / "a.py").write_text(SCALES)
    found = tmp_path / "reach.jsonl"
    found.write_text("\n".join(json.dumps({"test": t, "seconds": s, "lines": {"a.py": lines}}) for t, s, lines in REACH))
    begin = SCALES.index(change)
    assert Reached(tmp_path, found).of(Mutant("", "a.py", begin, begin + 1, ""), most=4) == tests


def test_soak_draws_every_kind_reproducibly() -> None:
    kinds = [draw(1, index).kind for index in range(len(LAWS))]
    assert kinds == list(LAWS)
    assert repr(draw(1, 3)) == repr(draw(1, 3))


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("index", range(4))
def test_soak_finds_nothing_wrong_with_the_first_problems(index: int) -> None:
    assert run(draw(1, index), limit=60.0).wrong == ()
