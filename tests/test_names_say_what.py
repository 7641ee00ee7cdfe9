"""A constant or a function says what it is of: grep for its name finds the one that is meant, or a few."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator

import pytest

from tests.source import HOUSE

MOST_MODULES = 3
ASKED_BY_NAME = {"ANSWERS", "EXTENSION"}
"""What every kind and every extension is asked for by this name."""


def targets(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement at the top of a module gives to values; a variable of types is none."""
    match statement:
        case ast.Assign(targets=given, value=value) if not (isinstance(value, ast.Call) and ast.unparse(value.func) in VARIABLES):
            yield from (one.id for target in given for one in ast.walk(target) if isinstance(one, ast.Name))
        case ast.AnnAssign(target=ast.Name(id=name)):
            yield name


VARIABLES = {"TypeVar", "ParamSpec"}


def words_of_modules(trees: dict[str, ast.Module]) -> dict[str, list[str]]:
    """Return the constants of one word, each with the modules where it stands."""
    found = defaultdict(set)
    for module, tree in trees.items():
        for name in (name for statement in tree.body for name in targets(statement)):
            if name.isupper() and "_" not in name.strip("_"):
                found[name].add(module)
    return {name: sorted(modules) for name, modules in found.items() if name not in ASKED_BY_NAME}


def test_a_constant_of_one_word_stands_in_three_modules_at_most() -> None:
    found = words_of_modules(HOUSE.trees)
    assert len(found) > 500
    assert {name: modules for name, modules in found.items() if len(modules) > MOST_MODULES} == {}


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("POINTS = 8", {"POINTS"}),
        ("POINTS: Final = 8", {"POINTS"}),
        ("FIRST, POINTS = LAST = 8, 9", {"FIRST", "POINTS", "LAST"}),
        ("POINTS_OF_CURVE = 8", set()),
        ("ANSWERS = 8", set()),
        ("T = TypeVar('T')", set()),
        ("def draw():\n    POINTS = 8", set()),
    ],
)
def test_every_way_to_write_a_constant_is_counted(line: str, names: set[str]) -> None:
    assert set(words_of_modules({"one.py": ast.parse(line)})) == names


def test_a_function_that_draws_says_what() -> None:
    functions = {file: [one.name for one in tree.body if isinstance(one, ast.FunctionDef)] for file, tree in HOUSE.trees.items()}
    assert sum(name.startswith("draw_") for names in functions.values() for name in names) > 15
    assert [path for path, names in functions.items() if {"draw", "data"} & set(names)] == []
