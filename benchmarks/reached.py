"""The tests that are run on a mutant: those that reach what was changed, as `benchmarks.reach` found them."""

from __future__ import annotations

import ast
import json
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from benchmarks.mutants import SOURCE, Mutant


class Reached:
    """What is known of each test: its seconds, and the lines that it reaches."""

    def __init__(self, root: Path, found: Path) -> None:
        self.sources = root / SOURCE
        self.seconds: dict[str, float] = {}
        self.tests: dict[tuple[str, int], set[str]] = defaultdict(set)
        for line in found.read_text().splitlines():
            one = json.loads(line)
            self.seconds[one["test"]] = one["seconds"]
            for path, numbers in one["lines"].items():
                for number in numbers:
                    self.tests[path, number].add(one["test"])

    def of(self, mutant: Mutant, most: int) -> list[str]:
        """Up to `most` tests that reach the mutant, one of each function before a second of any, the quick ones first."""
        tests = self._at(self.places(mutant))
        if not tests:  # what runs in another process, or is used through another name: all tests that reach the file
            tests = self._at({(path, number) for path, number in self.tests if path == mutant.path})
        cases: dict[str, list[str]] = defaultdict(list)
        for test in sorted(tests, key=self.seconds.__getitem__):
            cases[test.partition("[")[0]].append(test)
        ranks = {test: (rank, self.seconds[test]) for group in cases.values() for rank, test in enumerate(group)}
        return sorted(ranks, key=ranks.__getitem__)[:most]

    def _at(self, places: set[tuple[str, int]]) -> set[str]:
        return set().union(*(self.tests.get(place, set()) for place in places))

    def places(self, mutant: Mutant) -> set[tuple[str, int]]:
        """Files and lines of the changed statement, or, where it runs at import, of all that uses what it defines."""
        path = self.sources / mutant.path
        line = path.read_bytes()[: mutant.begin].count(b"\n") + 1
        statement, in_function = _innermost(path, line)
        if in_function:
            return {(mutant.path, number) for number in _lines(statement)}
        if isinstance(statement, ast.FunctionDef):  # a default
            return {(mutant.path, number) for part in statement.body for number in range(part.lineno, (part.end_lineno or 0) + 1)}
        targets = statement.targets if isinstance(statement, ast.Assign) else [getattr(statement, "target", None)]
        names = [node.id for one in targets if one is not None for node in ast.walk(one) if isinstance(node, ast.Name)]
        return set(self._uses("|".join(names))) if names else {(mutant.path, number) for number in range(1, 1000)}

    def _uses(self, names: str) -> Iterator[tuple[str, int]]:
        """Lines within functions that have one of the names."""
        for path in sorted(self.sources.rglob("*.py")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if re.search(rf"\b({names})\b", line) and _innermost(path, number)[1]:
                    yield str(path.relative_to(self.sources)), number


def _lines(statement: ast.stmt) -> range:
    """The lines of a statement without the statements in it."""
    body = getattr(statement, "body", None)
    last = body[0].lineno - 1 if body else statement.end_lineno or statement.lineno
    return range(statement.lineno, max(last, statement.lineno) + 1)


@cache
def _innermost(path: Path, line: int) -> tuple[ast.stmt, bool]:
    """The innermost statement around a line, and whether it is in a function."""
    found: tuple[ast.stmt, bool] = (ast.Pass(), False)
    inner: list[ast.AST] = [_tree(path)]
    in_function = False
    while inner:
        node = inner.pop()
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.stmt | ast.ExceptHandler | ast.match_case) and _spans(child, line):
                in_function |= isinstance(node, ast.FunctionDef)
                if isinstance(child, ast.stmt):
                    found = child, in_function
                inner = [child]
    return found


def _spans(node: ast.AST, line: int) -> bool:
    if isinstance(node, ast.match_case):
        return any(_spans(child, line) for child in node.body)
    return node.lineno <= line <= (node.end_lineno or 0)  # type: ignore[attr-defined, no-any-return]


@cache
def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text())
