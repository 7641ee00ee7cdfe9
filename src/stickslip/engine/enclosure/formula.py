"""Bounds of a friction law and of its derivatives by the slip rate while slip and slip rate stay in a box, in compiled code.

A formula is written out as a list of operations once, with a row of numbers for each piece of the law. One compiled function goes
through such a list, so that a law that nobody has seen before needs no compiler. Each node carries the Taylor coefficients of its
value in the slip rate: value, first derivative and half the second derivative, as intervals that contain them at every slip and
slip rate of the box.

Sources: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis; Griewank & Walther 2008, Evaluating Derivatives, ch. 13.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.enclosure import intervals as iv
from stickslip.engine.enclosure.intervals import add, multiply, square, subtract
from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import RATE, SLIP, STATE, Expression, depends_on, nodes_of

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

NAMES = (
    *("number", "slip", "rate", "add", "sub", "mul", "square", "div", "pow"),
    *("sin", "cos", "exp", "log", "sqrt", "tanh", "arcsinh", "expm1", "log1p", "logistic"),
)
"""Operations; their places are their codes."""
NUMBER, OF_SLIP, OF_RATE, ADD, SUB, MUL, SQUARE, DIV, POW = range(9)
SIN, COS, EXP, LOG, SQRT, TANH, ARCSINH, EXPM1, LOG1P, LOGISTIC = range(9, 19)
WIDTH = 6
"""Numbers of each node: low and high end of the value, of the first derivative and of half the second derivative."""


class Formulas(NamedTuple):
    """Hold the formulas of all pieces of a law as lists of operations, and the memory in which they are bounded.

    Row k of `operations` is a node: code, arguments (rows of the same formula), and 1 if the node depends on the slip rate. Formula
    number n has the rows from spans[n, 0] to spans[n, 1], and those before spans[n, 2] do not depend on the slip rate.
    """

    operations: Integers  # (nodes of all formulas, 4)
    spans: Integers  # (formulas, 3)
    of_piece: Integers  # (pieces,): the formula of each piece of the law
    numbers: Floats  # (pieces, nodes of the longest formula): values of constants and parameters
    box: Floats  # (nodes of the longest formula, WIDTH): the bounds that were worked out last


def formulas_of(trees: Sequence[Expression], parameters: Sequence[str], values: Floats) -> Formulas:
    """Write out the formulas of the pieces of a law; a single formula serves all rows of `values`.

    `values` holds the values of the parameters, shape (pieces, parameters). Raises InputError for a formula with a state.
    """
    distinct = tuple(dict.fromkeys(trees))
    operations, spans, leaves = _written(distinct)
    of_piece = np.zeros(len(values), int) if len(trees) == 1 else np.array([distinct.index(tree) for tree in trees])
    numbers = np.zeros((len(of_piece), int((spans[:, 1] - spans[:, 0]).max())))
    for formula, nodes in enumerate(leaves):
        rows = of_piece == formula
        for k, node in enumerate(nodes):
            if node is not None:
                numbers[rows, k] = values[rows, parameters.index(node.name)] if node.operation == "parameter" else node.value
    return Formulas(operations, spans, of_piece, numbers, np.empty((numbers.shape[1], WIDTH)))


@lru_cache(maxsize=256)
def _written(trees: tuple[Expression, ...]) -> tuple[Integers, Integers, tuple[tuple[Expression | None, ...], ...]]:
    """Return the operations of some formulas, their spans, and for each node of each formula its constant or parameter."""
    rows: list[tuple[int, int, int, int]] = []
    spans, leaves = [], []
    for tree in trees:
        nodes = _in_order(_bounded_form(tree))
        place = {node: k for k, node in enumerate(nodes)}
        start = len(rows)
        for node in nodes:
            left, right = [*(place[argument] for argument in node.arguments), 0, 0][:2]
            code = NUMBER if node.operation in ("constant", "parameter") else NAMES.index(_name(node))
            rows.append((code, left, right, int(depends_on(node, RATE))))
        fixed = sum(not row[3] for row in rows[start:])
        spans.append((start, len(rows), start + fixed))
        leaves.append(tuple(node if node.operation in ("constant", "parameter") else None for node in nodes))
    return np.array(rows), np.array(spans), tuple(leaves)


def _name(node: Expression) -> str:
    if node in (SLIP, RATE):
        return "slip" if node == SLIP else "rate"
    return "square" if node.operation == "mul" and node.arguments[0] == node.arguments[1] else node.operation


def _in_order(tree: Expression) -> list[Expression]:
    """Return the nodes of a formula, arguments first and those that do not depend on the slip rate before all others."""
    nodes = list(nodes_of(tree))
    if STATE in nodes:
        raise InputError("the friction law has a state of its own: its slip rate is no root of the contact equation")
    return [node for node in nodes if not depends_on(node, RATE)] + [node for node in nodes if depends_on(node, RATE)]


@lru_cache(maxsize=256)
def _bounded_form(tree: Expression) -> Expression:
    """Return the formula with y / (1 + exp(z)) as y logistic(z), which does not overflow, and powers x**v as exp(v log(x))."""
    made: dict[Expression, Expression] = {}
    for node in nodes_of(tree):
        arguments = tuple(made[argument] for argument in node.arguments)
        made[node] = Expression(node.operation, arguments, node.name, node.value)
        if node.operation == "div" and (exponent := _one_and_exp(arguments[1])) is not None:
            made[node] = Expression("mul", (arguments[0], Expression("logistic", (exponent,))))
        elif node.operation == "pow" and depends_on(node.arguments[1], RATE):
            made[node] = Expression("exp", (arguments[1] * Expression("log", (arguments[0],)),))
    return made[tree]


def _one_and_exp(node: Expression) -> Expression | None:
    """Return z if the node is 1 + exp(z), else None."""
    if node.operation != "add":
        return None
    for one, other in (node.arguments, node.arguments[::-1]):
        if one.operation == "constant" and one.value == 1.0 and other.operation == "exp":
            return other.arguments[0]
    return None


# ---- compiled -----------------------------------------------------------------------------------------------------------------


@kernel
def bound_at_slips(f: Formulas, piece: int, low: float, high: float) -> None:
    """Bound all nodes of a piece's formula that do not depend on the slip rate, for slips (m) between two."""
    formula = f.of_piece[piece]
    begin, end = f.spans[formula, 0], f.spans[formula, 2]
    for row in range(begin, end):
        k, code = row - begin, f.operations[row, 0]
        one = f.box[k]
        for i in range(2, WIDTH):
            one[i] = 0.0
        if code == NUMBER:
            one[0] = one[1] = f.numbers[piece, k]
        elif code == OF_SLIP:
            one[0], one[1] = low, high
        else:
            bound_value(f, row, begin)


@kernel
def bound_value(f: Formulas, row: int, begin: int) -> None:
    """Bound the value of a node, from those of its arguments."""
    code, one = f.operations[row, 0], f.box[row - begin]
    a, b = f.box[f.operations[row, 1]], f.box[f.operations[row, 2]]
    if code == ADD:
        one[0], one[1] = add(a[0], a[1], b[0], b[1])
    elif code == SUB:
        one[0], one[1] = subtract(a[0], a[1], b[0], b[1])
    elif code == MUL:
        one[0], one[1] = multiply(a[0], a[1], b[0], b[1])
    elif code == SQUARE:
        one[0], one[1] = square(a[0], a[1])
    elif code == DIV:
        low, high = iv.reciprocal(b[0], b[1])
        one[0], one[1] = multiply(a[0], a[1], low, high)
    elif code == POW:
        one[0], one[1] = iv.power(a[0], a[1], b[0], b[1])
    else:
        one[0], one[1] = function_of(code, a[0], a[1])


@kernel
def function_of(code: int, a: float, b: float) -> tuple[float, float]:
    """Return the bounds of an elementary function on [a, b]."""
    if code == SIN:
        return iv.sine(a, b)
    if code == COS:
        return iv.cosine(a, b)
    if code == EXP:
        return iv.exponential(a, b)
    if code == LOG:
        return iv.logarithm(a, b)
    if code == SQRT:
        return iv.root(a, b)
    if code == TANH:
        return iv.tangent(a, b)
    if code == ARCSINH:
        return iv.inverse_sine(a, b)
    if code == EXPM1:
        return iv.exponential_less_one(a, b)
    if code == LOG1P:
        return iv.logarithm_of_one_and(a, b)
    if code == LOGISTIC:
        return iv.logistic(a, b)
    return -math.inf, math.inf


@kernel
def bound_friction(f: Formulas, piece: int, low: float, high: float) -> Floats:
    """Bound friction and its derivatives by the slip rate, at slip rates (m/s) between two and the slips of `bound_at_slips`.

    Returns the bounds of mu, of dmu/dv (s/m) and of half of d2mu/dv2 (s2/m2): low and high end of each, in memory of `f`.
    """
    formula = f.of_piece[piece]
    begin, end, first = f.spans[formula, 0], f.spans[formula, 1], f.spans[formula, 2]
    for row in range(first, end):
        code, one = f.operations[row, 0], f.box[row - begin]
        left, right = f.operations[row, 1], f.operations[row, 2]
        a, b = f.box[left], f.box[right]
        if code == OF_RATE:
            one[0], one[1], one[2], one[3], one[4], one[5] = low, high, 1.0, 1.0, 0.0, 0.0
        elif code <= SUB:
            bound_sum(one, a, b, code == SUB)
        elif code == MUL:
            bound_product(one, a, b)
        elif code == SQUARE:
            bound_square(one, a)
        elif code == DIV:
            bound_quotient(one, a, b, f.operations[begin + right, 3])
        else:
            bound_value(f, row, begin)
            bound_chain(code, one, a, b)
    return f.box[end - begin - 1]


@kernel
def bound_sum(one: Floats, a: Floats, b: Floats, is_difference: bool) -> None:
    """Bound a sum or a difference."""
    for i in (0, 2, 4):
        if is_difference:
            one[i], one[i + 1] = subtract(a[i], a[i + 1], b[i], b[i + 1])
        elif a[i] == 0.0 and a[i + 1] == 0.0:
            one[i], one[i + 1] = b[i], b[i + 1]
        elif b[i] == 0.0 and b[i + 1] == 0.0:
            one[i], one[i + 1] = a[i], a[i + 1]
        else:
            one[i], one[i + 1] = add(a[i], a[i + 1], b[i], b[i + 1])


@kernel
def bound_product(one: Floats, a: Floats, b: Floats) -> None:
    """Bound a product."""
    one[0], one[1] = multiply(a[0], a[1], b[0], b[1])
    low, high = multiply(a[0], a[1], b[2], b[3])
    other = multiply(a[2], a[3], b[0], b[1])
    one[2], one[3] = add(low, high, other[0], other[1])
    low, high = multiply(a[0], a[1], b[4], b[5])
    other = multiply(a[4], a[5], b[0], b[1])
    low, high = add(low, high, other[0], other[1])
    other = multiply(a[2], a[3], b[2], b[3])
    one[4], one[5] = add(low, high, other[0], other[1])


@kernel
def bound_square(one: Floats, a: Floats) -> None:
    """Bound a square, which is narrower than a product of two factors that vary independently."""
    one[0], one[1] = square(a[0], a[1])
    low, high = multiply(a[0], a[1], a[2], a[3])
    one[2], one[3] = 2.0 * low, 2.0 * high
    low, high = multiply(a[0], a[1], a[4], a[5])
    other = square(a[2], a[3])
    one[4], one[5] = add(2.0 * low, 2.0 * high, other[0], other[1])


@kernel
def bound_quotient(one: Floats, a: Floats, b: Floats, varies: int) -> None:
    """Bound a quotient, whose denominator depends on the slip rate if `varies` is 1."""
    low, high = iv.reciprocal(b[0], b[1])
    one[0], one[1] = multiply(a[0], a[1], low, high)
    if varies == 0:
        one[2], one[3] = multiply(a[2], a[3], low, high)
        one[4], one[5] = multiply(a[4], a[5], low, high)
        return
    known = multiply(one[0], one[1], b[2], b[3])
    left = subtract(a[2], a[3], known[0], known[1])
    one[2], one[3] = multiply(left[0], left[1], low, high)
    known = multiply(one[0], one[1], b[4], b[5])
    left = subtract(a[4], a[5], known[0], known[1])
    known = multiply(one[2], one[3], b[2], b[3])
    left = subtract(left[0], left[1], known[0], known[1])
    one[4], one[5] = multiply(left[0], left[1], low, high)


@kernel
def bound_chain(code: int, one: Floats, a: Floats, b: Floats) -> None:
    """Bound the derivatives of f(a), or of a**b for a fixed b, whose value is bounded already."""
    first, second = derivatives_of(code, one, a, b)
    one[2], one[3] = multiply(first[0], first[1], a[2], a[3])
    low, high = square(a[2], a[3])
    low, high = multiply(second[0], second[1], low, high)
    other = multiply(first[0], first[1], a[4], a[5])
    one[4], one[5] = add(low, high, other[0], other[1])


@kernel
def derivatives_of(code: int, one: Floats, a: Floats, b: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of f' and of f''/2 on the interval of a, from those of f(a); for powers the exponent is b."""
    if code in (EXP, EXPM1):
        slope = (one[0], one[1]) if code == EXP else iv.exponential(a[0], a[1])
        return slope, (0.5 * slope[0], 0.5 * slope[1])
    if code in (SIN, COS):
        slope = iv.cosine(a[0], a[1]) if code == SIN else iv.sine(a[0], a[1])
        return (slope if code == SIN else (-slope[1], -slope[0])), (-0.5 * one[1], -0.5 * one[0])
    if code == TANH:
        slope = iv.tangent_slope(a[0], a[1])
        bent = multiply(one[0], one[1], slope[0], slope[1])
        return slope, (-bent[1], -bent[0])
    if code == LOGISTIC:
        low, high = iv.tangent_slope(0.5 * a[0], 0.5 * a[1])
        half = iv.tangent(0.5 * a[0], 0.5 * a[1])
        bent = multiply(half[0], half[1], 0.25 * low, 0.25 * high)
        return (-0.25 * high, -0.25 * low), (0.5 * bent[0], 0.5 * bent[1])
    if code == ARCSINH:
        slope = iv.inverse_sine_slope(a[0], a[1])
        cube = square(slope[0], slope[1])
        cube = multiply(cube[0], cube[1], slope[0], slope[1])
        bent = multiply(a[0], a[1], cube[0], cube[1])
        return slope, (-0.5 * bent[1], -0.5 * bent[0])
    if code == POW:
        return derivatives_of_power(a, b)
    return derivatives_of_root_or_logarithm(code, one, a)


@kernel
def derivatives_of_root_or_logarithm(code: int, one: Floats, a: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of f' and of f''/2 for sqrt, log and log1p; nothing is known where the argument may not be positive."""
    shift = 1.0 if code == LOG1P else 0.0
    low, high = add(a[0], a[1], shift, shift)
    if not low > 0.0:
        return (-math.inf, math.inf), (-math.inf, math.inf)
    inverse = iv.reciprocal(low, high)
    if code == SQRT:
        slope = iv.reciprocal(2.0 * one[0], 2.0 * one[1])
        bent = multiply(slope[0], slope[1], inverse[0], inverse[1])
        return slope, (-0.25 * bent[1], -0.25 * bent[0])
    bent = square(inverse[0], inverse[1])
    return inverse, (-0.5 * bent[1], -0.5 * bent[0])


@kernel
def derivatives_of_power(a: Floats, b: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of f' and of f''/2 for f = a**b with a fixed exponent b."""
    less = subtract(b[0], b[1], 1.0, 1.0)
    slope = iv.power(a[0], a[1], less[0], less[1])
    slope = multiply(b[0], b[1], slope[0], slope[1])
    factor = multiply(b[0], b[1], less[0], less[1])
    less = subtract(b[0], b[1], 2.0, 2.0)
    bent = iv.power(a[0], a[1], less[0], less[1])
    bent = multiply(factor[0], factor[1], bent[0], bent[1])
    return slope, (0.5 * bent[0], 0.5 * bent[1])
