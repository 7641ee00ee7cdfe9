"""Find where code asks a body or a driver what kind it is: `python -m benchmarks.kinds`.

Each such condition is a place where another kind may need a formula of its own. Kinds answer in modules of their own
(`foundation.by_kind`), so that the functions that ask may only become fewer: `benchmarks/rooms.toml` bounds them.
"""

from __future__ import annotations

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from benchmarks.house import House

FLAGS = {
    *("has_waves", "is_uniform", "has_machine", "is_block", "is_driven_rigidly", "is_joined", "driver_changes"),
    *("driver_may_change", "has_ground", "moves", "cells", "driven"),
}
"""Attributes that say what kind a body or a driver is."""
OWNERS = {"cells": r"counts?$", "driven": r"counts?$", "moves": r"driver$"}
"""Those that other things have, too, with what must stand before them."""
NAMES = ("structure", "driver_kind")
"""Attributes with the name of a kind: comparing it with a name is asking, taking the answers of a kind by it is not."""
CLASSES = ("OfLayers", "OfOneSide", "WithWaves", "OnSpring", "Machine", "LossyDriver", "RigidDriver", "ChangingDriver", "Spring")
"""Classes that all bodies or drivers of a kind have in common."""


def asked_in(test: ast.expr) -> str | None:
    """Return what a condition asks a body or a driver; None if it asks nothing of the sort."""
    for node in ast.walk(test):
        if isinstance(node, ast.Attribute) and node.attr in FLAGS and re.search(OWNERS.get(node.attr, ""), ast.unparse(node.value)):
            return node.attr
        if isinstance(node, ast.Compare):
            for one in (node.left, *node.comparators):
                if isinstance(one, ast.Attribute) and one.attr in NAMES:
                    return one.attr
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
            named = {one.id for one in ast.walk(node.args[1]) if isinstance(one, ast.Name)}
            if found := named & set(CLASSES):
                return found.pop()
    return None


def conditions(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield the conditions in a function, those of comprehensions among them; the subject of a match counts as compared."""
    for node in ast.walk(tree):
        if isinstance(node, ast.If | ast.IfExp | ast.While | ast.Assert):
            yield node.test
        elif isinstance(node, ast.comprehension):
            yield from node.ifs
        elif isinstance(node, ast.Match):
            yield ast.copy_location(ast.Compare(node.subject, [], []), node.subject)


def may_ask(nodes: list[ast.AST]) -> bool:
    """Return True for a file that has one of the words with which a kind is asked: most have none, and are not looked through."""
    return any(
        (isinstance(node, ast.Attribute) and (node.attr in FLAGS or node.attr in NAMES))
        or (isinstance(node, ast.Name) and node.id in CLASSES)
        for node in nodes
    )


def functions_that_ask(nodes: Mapping[str, list[ast.AST]]) -> dict[tuple[str, str], list[tuple[int, str]]]:
    """Return for each function that asks a kind, by its file and name, the line and the word of each condition.

    What is given are the nodes of each file, as `House.nodes` has them.
    """
    found: dict[tuple[str, str], list[tuple[int, str]]] = {}
    for file in (file for file, there in nodes.items() if may_ask(there)):
        for node in nodes[file]:
            if isinstance(node, ast.FunctionDef):
                asks = [(test.lineno, word) for test in conditions(node) if (word := asked_in(test))]
                if asks:
                    found[file, node.name] = found.get((file, node.name), []) + asks
    return found


def main() -> None:
    """Print each function that asks, with its lines, and the sums by room."""
    house = House(Path(__file__).parents[1] / "src" / "stickslip")
    found = functions_that_ask(house.nodes)
    for (file, name), asks in sorted(found.items()):
        sys.stdout.write(f"{file} {name}: {', '.join(f'{line} {word}' for line, word in asks)}\n")
    rooms = Counter(house.room_of(file) for file, _ in found)
    total = f"{len(found)} functions with {sum(map(len, found.values()))} conditions in {len({file for file, _ in found})} files"
    sys.stdout.write(f"{total}: {', '.join(f'{room} {count}' for room, count in rooms.most_common())}\n")


if __name__ == "__main__":
    main()
