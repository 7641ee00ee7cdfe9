"""A formula as a tape: its nodes in order, as numbers that compiled code reads, so that a new formula needs no new machine code.

A row of `steps` is a node: the code of its operation and the rows of its arguments, counted from the first row of its formula. A
leaf has the code of its kind, and the place of a number of the law or of a variable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import RATE, STATES, VARIABLES, Expression, nodes_of
from stickslip.friction.formula.operations import OPERATIONS, operation_of
from stickslip.friction.formula.operations.enclosures import ORDERS

Integers = NDArray[np.int64]

CONSTANT, NUMBER, VARIABLE = range(3)
"""Codes of leaves: a constant, a number of the law, and a variable, at its place in VARIABLES."""
LOGISTIC = "logistic"
"""Name of the operation 1 / (1 + exp(a)), which is in formulas as they are bounded only."""
CODES = {name: VARIABLE + 1 + k for k, name in enumerate((*OPERATIONS, LOGISTIC))}
"""Codes of operations: they follow those of leaves."""
CODE, LEFT, RIGHT, OTHER = range(4)
"""Columns of `steps`; the last one has the number of orders of a node that is bounded, and for a node whose changes are asked
whether its argument is limited."""


def rule_by_code(rules: Sequence[Callable[..., None]]) -> Any:
    """Return compiled code that calls the rule of an operation, given its code: `rules` are those of CODES, in order.

    Its arguments are the code, the rows of nodes, and the places of a node and of its arguments.
    """
    names: dict[str, Any] = {f"rule_{n}": rule for n, rule in enumerate(rules)} | {"__name__": __name__}
    branches = (f"if code == {VARIABLE + 1 + n}:\n        rule_{n}(w, n, i, j)\n" for n in range(len(rules)))
    exec(f"def rule(code, w, n, i, j):\n    {'    el'.join(branches)}", names)
    return exact(names["rule"])


class Tape(NamedTuple):
    """OnCells as rows of numbers, one formula after the other."""

    steps: Integers  # (nodes, 4)
    values: Floats  # (nodes,): values of constants
    spans: Integers  # (formulas, 2): first row of each formula, and the end
    longest: int  # largest number of nodes of a formula


def written(formulas: Sequence[Sequence[Expression]], parameters: Sequence[str], others: Sequence[Sequence[int]]) -> Tape:
    """Return formulas, given by their nodes, as a tape; `others` are the last columns."""
    rows: list[tuple[int, ...]] = []
    values, first = [], [0]
    numbers = {name: k for k, name in enumerate(parameters)}
    for nodes, other in zip(formulas, others, strict=True):
        place = {node: k for k, node in enumerate(nodes)}
        for node, last in zip(nodes, other, strict=True):
            at = [place[argument] for argument in node.arguments] or [_place(node, numbers)]
            rows.append((_code(node), at[0], at[-1], last))
            values.append(0.0 if node.arguments else node.value)
        first.append(len(rows))
    spans = np.column_stack((first[:-1], first[1:]))
    return Tape(np.array(rows, np.int64), np.array(values, float), spans, int(np.diff(first).max()))


def _code(node: Expression) -> int:
    if node.arguments:
        return CODES[node.operation]
    return {"parameter": NUMBER, "constant": CONSTANT}.get(node.operation, VARIABLE)


def _place(node: Expression, numbers: dict[str, int]) -> int:
    if node.operation == "parameter":
        return numbers[node.name]
    return VARIABLES.index(node) if node in VARIABLES else 0


@lru_cache(maxsize=256)
def tape_of_bounds(trees: tuple[Expression, ...], parameters: tuple[str, ...]) -> Tape:
    """Return formulas as a tape with the number of orders of each node. Raises InputError for a formula with a state."""
    formulas = [nodes_of(_as_bounded(tree)) for tree in trees]
    if any(not {*STATES}.isdisjoint(nodes) for nodes in formulas):
        raise InputError("the friction law has a state of its own: its slip rate is no root of the contact equation")
    return written(formulas, parameters, [_orders(nodes) for nodes in formulas])


def _as_bounded(tree: Expression) -> Expression:
    """Return a formula whose nodes are as their rules should see them."""
    made: dict[Expression, Expression] = {}
    for node in nodes_of(tree):
        arguments = tuple(made[argument] for argument in node.arguments)
        copy = Expression(node.operation, arguments, node.name, node.value)
        made[node] = operation_of(copy).bounded(copy) if arguments else node
    return made[tree]


def _orders(nodes: Sequence[Expression]) -> list[int]:
    """Return how many Taylor coefficients of each node may differ from 0: what is linear in the slip rate has two."""
    found: dict[Expression, int] = {}
    for node in nodes:
        given = [found[argument] for argument in node.arguments]
        if not given:
            found[node] = 2 if node == RATE else 1
            continue
        keeps = node.operation in ("add", "sub") or max(given) == 1
        keeps |= (node.operation == "mul" and min(given) == 1) or (node.operation == "div" and given[1] == 1)
        found[node] = max(given) if keeps else ORDERS
    return list(found.values())
