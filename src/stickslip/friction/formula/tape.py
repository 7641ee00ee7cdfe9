"""A formula as a tape: its nodes in order, as numbers that compiled code reads, so that a new formula needs no new machine code.

A row of `steps` is a node: the code of its operation, the places of its arguments on the tape, their numbers of orders (see
`operations.enclosures`), and 1 if it does not depend on the slip rate. A leaf has the code of its kind, and of a number of the law
the place in the law's numbers; the slip is the last of these.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of
from stickslip.friction.formula.operations import OPERATIONS, operation_of
from stickslip.friction.formula.operations.enclosures import ORDERS
from stickslip.friction.formula.operations.hyperbolic import logistic

Integers = NDArray[np.int64]

CONSTANT, NUMBER, MOVING = 0, 1, 2
"""Codes of leaves: a constant, a number of the law or its slip, and the slip rate."""
_RULES = {name: one.taylor for name, one in OPERATIONS.items()} | {"logistic": logistic}
_ADD, _SUB, _MUL, _DIV, _POW, _SIN, _COS, _EXP, _LOG, _SQRT, _TANH, _ARCSINH, _EXPM1, _LOG1P, _LOGISTIC = _RULES.values()
CODES = {name: MOVING + 1 + k for k, name in enumerate(_RULES)}
"""Codes of operations: they follow those of leaves."""


class Tape(NamedTuple):
    """Formulas as rows of numbers, one formula after the other."""

    steps: Integers  # (nodes, 6): code, two places, two numbers of orders, 1 if it stands still
    values: Floats  # (nodes,): values of constants
    first: Integers  # (formulas + 1,): first row of each formula, and the end


@lru_cache(maxsize=256)
def tape_of(trees: tuple[Expression, ...], parameters: tuple[str, ...]) -> Tape:
    """Return formulas as a tape. Raises InputError for a formula with a state."""
    place_of_number = {name: k for k, name in enumerate(parameters)}
    rows: list[tuple[int, ...]] = []
    values, first = [], [0]
    for tree in trees:
        nodes = nodes_of(_as_bounded(tree))
        if not {*STATES}.isdisjoint(nodes):
            raise InputError("the friction law has a state of its own: its slip rate is no root of the contact equation")
        place = {node: k for k, node in enumerate(nodes)}
        orders: list[int] = []
        for node in nodes:
            at = [place[argument] for argument in node.arguments] or [_leaf_place(node, place_of_number)]
            given = [orders[k] for k in at] if node.arguments else [1]
            orders.append(_orders(node, given))
            rows.append((_code(node), at[0], at[-1], given[0], given[-1], int(orders[-1] == 1)))
            values.append(0.0 if node.arguments else node.value)
        first.append(len(rows))
    return Tape(np.array(rows, np.int64), np.array(values), np.array(first))


def _as_bounded(tree: Expression) -> Expression:
    """Return a formula whose nodes are as their rules should see them."""
    made: dict[Expression, Expression] = {}
    for node in nodes_of(tree):
        arguments = tuple(made[argument] for argument in node.arguments)
        copy = Expression(node.operation, arguments, node.name, node.value)
        made[node] = operation_of(copy).bounded(copy) if arguments else node
    return made[tree]


def _leaf_place(node: Expression, numbers: dict[str, int]) -> int:
    if node.operation == "parameter":
        return numbers[node.name]
    return len(numbers) if node == SLIP else 0


def _code(node: Expression) -> int:
    if node.arguments:
        return CODES[node.operation]
    return MOVING if node == RATE else NUMBER if node == SLIP or node.operation == "parameter" else CONSTANT


def _orders(node: Expression, given: list[int]) -> int:
    """Return how many Taylor coefficients of a node may differ from 0: what is linear in the slip rate has two."""
    if not node.arguments:
        return 2 if node == RATE else 1
    if max(given) == 1 or _code(node) in (CODES["add"], CODES["sub"]):
        return max(given)
    is_linear = (node.operation == "mul" and min(given) == 1) or (node.operation == "div" and given[1] == 1)
    return max(given) if is_linear else ORDERS


class Formulas(NamedTuple):
    """What compiled code needs to bound formulas: their tape, the law's numbers of each member, and room for one cell."""

    steps: Integers
    values: Floats
    first: Integers
    formula: Integers  # (members,): place of each member's formula on the tape
    low: Floats  # (members, numbers + 1): low and high ends of the law's numbers and of the slip
    high: Floats
    room: Floats  # (nodes, 6): rows as in `operations.enclosures`
    present: Integers  # (1,): the member whose nodes that stand still are in `room`


@exact
def rule(code: int, w: Floats, n: int, i: int, j: int, p: int, q: int) -> None:
    """Write the Taylor coefficients of a node."""
    if code == 3:
        _ADD(w, n, i, j, p, q)
    elif code == 4:
        _SUB(w, n, i, j, p, q)
    elif code == 5:
        _MUL(w, n, i, j, p, q)
    elif code == 6:
        _DIV(w, n, i, j, p, q)
    elif code == 7:
        _POW(w, n, i, j, p, q)
    elif code == 8:
        _SIN(w, n, i, j, p, q)
    elif code == 9:
        _COS(w, n, i, j, p, q)
    elif code == 10:
        _EXP(w, n, i, j, p, q)
    elif code == 11:
        _LOG(w, n, i, j, p, q)
    elif code == 12:
        _SQRT(w, n, i, j, p, q)
    elif code == 13:
        _TANH(w, n, i, j, p, q)
    elif code == 14:
        _ARCSINH(w, n, i, j, p, q)
    elif code == 15:
        _EXPM1(w, n, i, j, p, q)
    elif code == 16:
        _LOG1P(w, n, i, j, p, q)
    else:
        _LOGISTIC(w, n, i, j, p, q)


@exact
def _stand(of: Formulas, member: int, first: int, last: int) -> None:
    """Work out the nodes of a member that do not depend on the slip rate."""
    w = of.room
    for row in range(first, last):
        code, n = of.steps[row, 0], row - first
        if code == CONSTANT:
            w[n, 0], w[n, 3] = of.values[row], of.values[row]
        elif code == NUMBER:
            w[n, 0], w[n, 3] = of.low[member, of.steps[row, 1]], of.high[member, of.steps[row, 1]]
        elif of.steps[row, 5] == 1:
            rule(code, w, n, of.steps[row, 1], of.steps[row, 2], of.steps[row, 3], of.steps[row, 4])
    w[last - first - 1, 1:3], w[last - first - 1, 4:6] = 0.0, 0.0
    of.present[0] = member


@exact
def enclose(of: Formulas, member: int, low: float, high: float) -> int:
    """Bound a formula on a cell of slip rates (m/s), and return the row of `of.room` with its three coefficients."""
    formula = of.formula[member]
    first, last = of.first[formula], of.first[formula + 1]
    if of.present[0] != member:
        _stand(of, member, first, last)
    w = of.room
    for row in range(first, last):
        if of.steps[row, 5] == 0:
            n = row - first
            if of.steps[row, 0] == MOVING:
                w[n, 0], w[n, 1], w[n, 2], w[n, 3], w[n, 4], w[n, 5] = low, 1.0, 0.0, high, 1.0, 0.0
            else:
                rule(of.steps[row, 0], w, n, of.steps[row, 1], of.steps[row, 2], of.steps[row, 3], of.steps[row, 4])
    return last - first - 1


@exact
def enclose_cells(
    steps: Integers,
    values: Floats,
    firsts: Integers,
    formula: Integers,
    low_numbers: Floats,
    high_numbers: Floats,
    room: Floats,
    present: Integers,
    member: Integers,
    low: Floats,
    high: Floats,
    found: Floats,
) -> None:
    """Bound formulas on cells, each of one member; `found` has a row for each cell, as `room` has for each node."""
    of = Formulas(steps, values, firsts, formula, low_numbers, high_numbers, room, present)
    for k in range(len(low)):
        row = enclose(of, member[k], low[k], high[k])
        found[k] = room[row]
