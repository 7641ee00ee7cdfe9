"""Sums, differences, products and quotients."""

from __future__ import annotations

import math
import operator
from fractions import Fraction
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.enclosures import (
    difference_of_series,
    product_of_series,
    quotient_of_series,
    sum_of_series,
)
from stickslip.friction.formula.operations.operation import (
    FORMULA_UNITS,
    TINIEST,
    BallsWriter,
    Dimension,
    Levels,
    Operation,
    Radius,
    Recurrence,
    Scaled,
    SeriesWriter,
    unit_text,
    without_zeros,
)
from stickslip.friction.formula.operations.sets import HIGH, LOW, REFERENCE, SLOPE, STEP, VALUE, Disc, multiplied, put, squared

MOST_PARTS = 3
"""A linear combination of at most this many terms is taken apart (see `Operation.parts`); longer sums are added as a tree."""

# ---- sums and differences -----------------------------------------------------------------------------------------------------


def _same(node: Expression, a: Dimension, b: Dimension) -> Dimension:
    """Return the dimension of a sum or difference. Raises InputError if those of the terms are not the same."""
    zero = Expression("constant", value=0.0)
    if a != b and zero not in node.arguments:
        one, other = (unit_text(x) or "a pure number" for x in (a, b))
        raise InputError(f"{one} and {other} cannot be added or subtracted; {FORMULA_UNITS}")
    return b if node.arguments[0] == zero else a


@exact
def _add_change(w: Floats, n: int, i: int, j: int) -> None:
    for k in range(4):
        w[n, k] = w[i, k] + w[j, k]


@exact
def _sub_change(w: Floats, n: int, i: int, j: int) -> None:
    for k in range(4):
        w[n, k] = w[i, k] - w[j, k]


@exact
def _add_bounds(w: Floats, n: int, i: int, j: int) -> None:
    put(w, n, w[i, LOW] + w[j, LOW], w[i, HIGH] + w[j, HIGH])


@exact
def _sub_bounds(w: Floats, n: int, i: int, j: int) -> None:
    put(w, n, w[i, LOW] - w[j, HIGH], w[i, HIGH] - w[j, LOW])


def _apart(a: Disc, b: Disc) -> Any:
    """Return a lower bound on the magnitude of a sum or difference if one of its terms is the larger one everywhere."""
    return np.maximum(a.least - b.most, b.least - a.most)


def _added(*terms: str | None) -> str:
    return " + ".join(term for term in terms if term)


def _subtracted(a: str | None, b: str | None) -> str:
    return f"{a or ''}{f' - {b}' if b else ''}"


def _taken_apart(writer: SeriesWriter, node: Expression, sign: str) -> dict[Expression, str] | None:
    left, right = (writer.parts(argument) for argument in node.arguments)
    if left.keys() & right.keys() or len(left) + len(right) > MOST_PARTS:
        return None
    return left | {part: sign + factor for part, factor in right.items()}


def _add_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, b = node.arguments
    value = f"{writer.coefficient(a, 0)} + {writer.coefficient(b, 0)}"
    return writer.level(node, _added(writer.difference(a), writer.difference(b)), value)


def _sub_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, b = node.arguments
    value = f"{writer.coefficient(a, 0)} - {writer.coefficient(b, 0)}"
    return writer.level(node, _subtracted(writer.difference(a), writer.difference(b)), value)


def _add_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    return _added(*(writer.coefficient(argument, k) for argument in node.arguments)) or "0.0"


def _sub_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a, b = (writer.coefficient(argument, k) for argument in node.arguments)
    return _subtracted(a or "0.0", b)


def _sum_radius(balls: BallsWriter, node: Expression) -> str:
    return _added(*(balls.radius(argument) for argument in node.arguments))


def _sum_least(balls: BallsWriter, node: Expression, plain: str) -> str:
    """Write a lower bound of a sum that may have a term which is the larger one on the whole disc."""
    a, b = node.arguments
    return f"max({plain}, max({balls.least(a)} - {balls.most(b)}, {balls.least(b)} - {balls.most(a)}))"


def _sum_logarithm(balls: BallsWriter, node: Expression, plain: str) -> str:
    a, b = node.arguments
    sides = [
        f"{balls.logarithm(large)} + 2.0 * log_radius({balls.least(large)}, {balls.most(small)})"
        for large, small in ((a, b), (b, a))
    ]
    return f"min({plain}, min({', '.join(sides)}))"


_SUM = Radius(_sum_radius, _sum_least, _sum_logarithm)

ADD = Operation(
    name="add",
    sign="+",
    rank=1,
    value=operator.add,
    change=_add_change,
    slope_formula=lambda node, da, db: da + db,
    bounds=_add_bounds,
    taylor=sum_of_series,
    disc=lambda a, b: Disc(a.centre + b.centre, a.radius + b.radius, 0.0).rounded(least=_apart(a, b)),
    unit=_same,
    order_zero=_add_order_zero,
    derivative=lambda writer, node, da, db: _added(da, db),
    recurrence=Recurrence(_add_coefficient),
    ball=_SUM,
    parts=lambda writer, node: _taken_apart(writer, node, ""),
    linear=((0,), (1,), (0, 1)),
    carries=(0, 1),
)
SUB = Operation(
    name="sub",
    sign="-",
    rank=1,
    numpy_name="subtract",
    value=operator.sub,
    change=_sub_change,
    slope_formula=lambda node, da, db: da - db,
    bounds=_sub_bounds,
    taylor=difference_of_series,
    disc=lambda a, b: Disc(a.centre - b.centre, a.radius + b.radius, 0.0).rounded(least=_apart(a, b)),
    unit=_same,
    order_zero=_sub_order_zero,
    derivative=lambda writer, node, da, db: _subtracted(da, db),
    recurrence=Recurrence(_sub_coefficient),
    ball=_SUM,
    parts=lambda writer, node: _taken_apart(writer, node, "-1.0 * "),
    linear=((0,), (1,), (0, 1)),
    carries=(0, 1),
)

# ---- products -----------------------------------------------------------------------------------------------------------------


def _of_factors(a: Dimension, b: Dimension, sign: int) -> Dimension:
    return without_zeros({base: a.get(base, Fraction(0)) + sign * b.get(base, Fraction(0)) for base in {**a, **b}})


@exact
def _mul_change(w: Floats, n: int, i: int, j: int) -> None:
    w[n, REFERENCE], w[n, VALUE] = w[i, REFERENCE] * w[j, REFERENCE], w[i, VALUE] * w[j, VALUE]
    w[n, STEP] = w[i, STEP] * w[j, REFERENCE] + w[i, VALUE] * w[j, STEP]
    w[n, SLOPE] = w[i, SLOPE] * w[j, VALUE] + w[i, VALUE] * w[j, SLOPE]


@exact
def _mul_bounds(w: Floats, n: int, i: int, j: int) -> None:
    if i == j:
        w[n, LOW], w[n, HIGH] = squared(w[i, LOW], w[i, HIGH])
    else:
        w[n, LOW], w[n, HIGH] = multiplied(w[i, LOW], w[i, HIGH], w[j, LOW], w[j, HIGH])


def _mul_disc(a: Disc, b: Disc) -> Disc:
    radius = np.abs(a.centre) * b.radius + b.most * a.radius
    return Disc(a.centre * b.centre, radius, 0.0).rounded(least=a.least * b.least)


def _mul_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, b = node.arguments
    a0, ea, eb = writer.coefficient(a, 0), writer.difference(a), writer.difference(b)
    value = f"{a0} * {writer.coefficient(b, 0)}"
    if ea and eb and (writer.vanishes(a) or writer.vanishes(b)):
        return writer.level(node, value, value)  # the reference value is 0
    return writer.level(node, _added(ea and f"{ea} * {writer.reference(b)}", eb and f"{a0} * {eb}"), value)


def _mul_derivative(writer: Levels, node: Expression, da: str | None, db: str | None) -> str:
    a0, b0 = (writer.coefficient(argument, 0) for argument in node.arguments)
    return _added(da and f"{da} * {b0}", db and f"{a0} * {db}")


def _mul_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a, b = node.arguments
    return writer.products(a, b, k, range(k + 1))


def _mul_parts(writer: SeriesWriter, node: Expression) -> dict[Expression, str] | None:
    a, b = node.arguments
    if writer.varies[a] and writer.varies[b]:
        return None
    varying, constant = (a, b) if writer.varies[a] else (b, a)
    return {part: f"{factor} * {writer.reference(constant)}" for part, factor in writer.parts(varying).items()}


def _mul_radius(balls: BallsWriter, node: Expression) -> str:
    a, b = node.arguments
    ra, rb = balls.radius(a), balls.radius(b)
    if a == b:
        return f"{ra} * ({ra} + 2.0 * {balls.size(a)})"
    if ra and rb:
        return f"{balls.size(a)} * {rb} + {balls.most(b)} * {ra}"
    return f"{balls.size(a)} * {rb}" if rb else f"{balls.size(b)} * {ra}"


def _both_turned(balls: BallsWriter, node: Expression, _: str) -> str:
    return " + ".join(balls.logarithm(argument) for argument in node.arguments)


MUL = Operation(
    name="mul",
    sign="*",
    rank=2,
    numpy_name="multiply",
    value=operator.mul,
    change=_mul_change,
    slope_formula=lambda node, da, db: da * node.arguments[1] + node.arguments[0] * db,
    bounds=_mul_bounds,
    taylor=product_of_series,
    disc=_mul_disc,
    unit=lambda node, a, b: _of_factors(a, b, 1),
    order_zero=_mul_order_zero,
    derivative=_mul_derivative,
    recurrence=Recurrence(_mul_coefficient),
    ball=Radius(
        _mul_radius,
        least=lambda balls, node, plain: " * ".join(balls.least(argument) for argument in node.arguments),
        logarithm=_both_turned,
    ),
    parts=_mul_parts,
    linear=((0,), (1,)),
    zeros=(0, 1),
    carries=(0, 1),
    scales=True,
)

# ---- quotients ----------------------------------------------------------------------------------------------------------------


@exact
def _div_change(w: Floats, n: int, i: int, j: int) -> None:
    """Write the change of a quotient; an exponential below that overflows makes it zero."""
    start, end = w[i, REFERENCE] / w[j, REFERENCE], w[i, VALUE] / w[j, VALUE]
    w[n, REFERENCE], w[n, VALUE] = start, end
    if math.isinf(w[j, VALUE]):
        w[n, STEP], w[n, SLOPE] = end - start, 0.0
    else:
        w[n, STEP] = (w[i, STEP] - start * w[j, STEP]) / w[j, VALUE]
        w[n, SLOPE] = (w[i, SLOPE] - end * w[j, SLOPE]) / w[j, VALUE]


@exact
def _div_bounds(w: Floats, n: int, i: int, j: int) -> None:
    if w[j, LOW] <= 0.0 <= w[j, HIGH]:
        w[n, LOW], w[n, HIGH] = -math.inf, math.inf
    else:
        w[n, LOW], w[n, HIGH] = multiplied(w[i, LOW], w[i, HIGH], 1.0 / w[j, HIGH], 1.0 / w[j, LOW])


def _logistic_form(node: Expression) -> Expression:
    """Return y / (1 + exp(z)) as y logistic(z), which does not overflow."""
    above, below = node.arguments
    for one, other in (below.arguments, below.arguments[::-1]) if below.operation == "add" else ():
        if one.operation == "constant" and one.value == 1.0 and other.operation == "exp":
            return above * Expression("logistic", other.arguments)
    return node


def _div_disc(a: Disc, b: Disc) -> Disc:
    centre = a.centre / b.centre
    moved = np.fmin((a.radius + np.abs(centre) * b.radius) / b.least, a.most / b.least + np.abs(centre))
    return Disc(centre, moved, 0.0).rounded(least=a.least / b.most)


def _div_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, b = node.arguments
    eb, b0 = writer.difference(b), writer.coefficient(b, 0)
    above = _subtracted(writer.difference(a), eb and f"{writer.reference(node)} * {eb}")
    return writer.level(node, f"({above}) / {b0}", f"{writer.coefficient(a, 0)} / {b0}")


def _div_derivative(writer: Levels, node: Expression, da: str | None, db: str | None) -> str:
    above = _subtracted(da, db and f"{writer.coefficient(node, 0)} * {db}")
    return f"({above}) / {writer.coefficient(node.arguments[1], 0)}"


def _div_products(writer: SeriesWriter, node: Expression, k: int) -> str:
    return writer.products(node.arguments[1], node, k, range(1, k + 1))


def _div_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    return f"({writer.coefficient(node.arguments[0], k) or '0.0'} - ({_div_products(writer, node, k)})) * i{writer.index[node]}"


def _div_parts(writer: SeriesWriter, node: Expression) -> dict[Expression, str] | None:
    a, b = node.arguments
    if writer.varies[b]:
        return None
    return {part: f"{factor} / {writer.reference(b)}" for part, factor in writer.parts(a).items()}


def _div_radius(balls: BallsWriter, node: Expression) -> str:
    a, b = node.arguments
    ra, rb = balls.radius(a), balls.radius(b)
    if not rb:
        return f"{ra} / {balls.size(b)}"
    moved = f"{ra} + {balls.size(node)} * {rb}" if ra else f"{balls.size(node)} * {rb}"
    if not balls.varies_much(b):
        return f"({moved}) / max({balls.size(b)} - {rb}, {TINIEST!r})"
    least = balls.least(b)
    return f"min({balls.most(a)} / {least} + {balls.size(node)}, ({moved}) / {least})"


DIV = Operation(
    name="div",
    sign="/",
    rank=2,
    numpy_name="divide",
    value=operator.truediv,
    change=_div_change,
    slope_formula=lambda node, da, db: (da - node * db) / node.arguments[1],
    bounds=_div_bounds,
    taylor=quotient_of_series,
    bounded=_logistic_form,
    disc=_div_disc,
    unit=lambda node, a, b: _of_factors(a, b, -1),
    order_zero=_div_order_zero,
    derivative=_div_derivative,
    recurrence=Recurrence(
        _div_coefficient,
        divisor=lambda writer, node: f"{writer.coefficient(node.arguments[1], 0)}",
        scaled=Scaled(
            where=lambda writer, node: not writer.varies[node.arguments[0]],
            total=_div_products,
            factor=lambda writer, node, k: f"-i{writer.index[node]}",
        ),
    ),
    ball=Radius(
        _div_radius,
        least=lambda balls, node, plain: f"{balls.least(node.arguments[0])} / {balls.most(node.arguments[1])}",
        logarithm=_both_turned,
    ),
    parts=_div_parts,
    linear=((0,),),
    zeros=(0,),
    settles=(1,),
    carries=(0,),
    scales=True,
    shrinks=True,
)
