"""Compute guaranteed bounds of a friction law and of its derivatives by the slip rate, by interval arithmetic on its formula.

Each node of the tree carries the Taylor coefficients of its value in the slip rate: value, first derivative and half the second
derivative. They are intervals that contain the coefficients at every rate of a cell. Coefficients that vanish for all rates are
left out and stay exactly 0.

Sources: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis; Griewank & Walther 2008, Evaluating Derivatives, ch. 13.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.friction.formula import interval as iv
from stickslip.friction.formula.expression import RATE, SLIP, STATE, Expression, depends_on, nodes_of

Array = NDArray[np.float64]
Jet = list[Array]
"""Taylor coefficients in the slip rate, at most three, each an array of intervals; missing ones are 0."""

_ORDERS = 3
"""Number of Taylor coefficients: folds need mu and its first two derivatives by the slip rate."""


class NotEnclosedError(Exception):
    """A formula contains an operation or a variable for which there are no guaranteed bounds."""


def enclose(
    tree: Expression, parameters: Mapping[str, ArrayLike], slip: float | Array, low: ArrayLike, high: ArrayLike
) -> tuple[Array, Array, Array]:
    """Bound a formula and its derivatives by the slip rate on cells of slip rates.

    Parameters
    ----------
    tree
        The formula of one piece of a friction law.
    parameters
        Values of its parameters by name, taken as exact: numbers, or one for each cell, shape (n,).
    slip
        Slip (m): a number, or one for each cell.
    low, high
        Ends of the cells of slip rates (m/s), shape (n,).

    Returns
    -------
    tuple of arrays
        Bounds of mu (no unit), of dmu/dv (s/m) and of d2mu/dv2 (s2/m2), each of shape (2, n): lower and upper bounds. They hold
        at every slip rate of the cell at which the formula has derivatives, rounding included. They are (-inf, inf) where nothing
        is known.

    Raises
    ------
    NotEnclosedError
        If the formula contains an operation or a variable for which there are no guaranteed bounds.
    """
    tree = _bounded_form(tree)
    cells = iv.interval(np.asarray(low, float), np.asarray(high, float))
    found: dict[Expression, Jet] = {RATE: [cells, iv.exact(1.0)], SLIP: [iv.exact(slip)]}
    with np.errstate(all="ignore"):
        for node in _nodes(tree):
            if node.operation == "parameter":
                found[node] = [iv.exact(np.asarray(parameters[node.name], float))]
            elif node.operation == "constant":
                found[node] = [iv.exact(node.value)]
            elif node.arguments:
                found[node] = _jet(node, [found[argument] for argument in node.arguments])
        result = found[tree] + [np.zeros((2, 1))] * (_ORDERS - len(found[tree]))
        result[2] = iv.scale(result[2], 2.0)
    shaped = (np.broadcast_to(one, cells.shape) for one in result)
    return tuple(np.stack(iv.ends(np.where(np.isnan(one), np.inf, one))) for one in shaped)  # type: ignore[return-value] # three


@lru_cache(maxsize=256)
def _nodes(tree: Expression) -> tuple[Expression, ...]:
    """Return the nodes of a formula, arguments first. Raise NotEnclosedError if one of them cannot be bounded."""
    nodes = nodes_of(tree)
    if STATE in nodes:
        raise NotEnclosedError("the formula has a state of its own")
    for node in nodes:
        if node.arguments and node.operation not in _BINARY and node.operation not in _UNARY:
            raise NotEnclosedError(f"the operation {node.operation} has no sure bounds")
        if node.operation == "pow" and depends_on(node.arguments[1], RATE):
            raise NotEnclosedError("an exponent depends on the slip rate")
    return tuple(nodes)


@lru_cache(maxsize=256)
def _bounded_form(tree: Expression) -> Expression:
    """Return the formula with y / (1 + exp(z)) written as y logistic(z), which does not overflow where exp(z) does."""
    made: dict[Expression, Expression] = {}
    for node in nodes_of(tree):
        arguments = tuple(made[argument] for argument in node.arguments)
        made[node] = Expression(node.operation, arguments, node.name, node.value)
        if node.operation == "div" and (exponent := _one_and_exp(arguments[1])) is not None:
            made[node] = Expression("mul", (arguments[0], Expression("logistic", (exponent,))))
    return made[tree]


def _one_and_exp(node: Expression) -> Expression | None:
    """Return z if the node is 1 + exp(z), else None."""
    if node.operation != "add":
        return None
    for one, other in (node.arguments, node.arguments[::-1]):
        if one.operation == "constant" and one.value == 1.0 and other.operation == "exp":
            return other.arguments[0]
    return None


def _jet(node: Expression, arguments: list[Jet]) -> Jet:
    """Return the Taylor coefficients of a node from those of its arguments."""
    if node.operation == "mul" and node.arguments[0] == node.arguments[1]:
        return _square(arguments[0])
    if len(arguments) == 2:
        return _BINARY[node.operation](*arguments)
    return _composed(_UNARY[node.operation], arguments[0])


def _add(a: Jet, b: Jet) -> Jet:
    short, long = sorted((a, b), key=len)
    return [iv.add(x, y) for x, y in zip(short, long, strict=False)] + long[len(short) :]


def _negative(a: Jet) -> Jet:
    return [iv.negative(x) for x in a]


def _subtract(a: Jet, b: Jet) -> Jet:
    return _add(a, _negative(b))


def _multiply(a: Jet, b: Jet) -> Jet:
    orders = min(len(a) + len(b) - 1, _ORDERS)
    terms = [[iv.multiply(a[i], b[k - i]) for i in range(len(a)) if 0 <= k - i < len(b)] for k in range(orders)]
    return [_sum(one) for one in terms]


def _sum(terms: list[Array]) -> Array:
    total = terms[0]
    for term in terms[1:]:
        total = iv.add(total, term)
    return total


def _square(a: Jet) -> Jet:
    """Return a**2, with narrower bounds than a product of two factors that vary independently."""
    found = [iv.square(a[0])]
    if len(a) > 1:
        found.append(iv.scale(iv.multiply(a[0], a[1]), 2.0))
        bent = iv.square(a[1])
        found.append(iv.add(iv.scale(iv.multiply(a[0], a[2]), 2.0), bent) if len(a) > 2 else bent)
    return found


def _divide(a: Jet, b: Jet) -> Jet:
    inverse = iv.reciprocal(b[0])
    if len(b) == 1:
        return [iv.multiply(x, inverse) for x in a]
    found: Jet = []
    for k in range(_ORDERS):
        known = [iv.multiply(found[i], b[k - i]) for i in range(k) if k - i < len(b)]
        terms = a[k : k + 1] + [iv.negative(one) for one in known]
        found.append(iv.multiply(_sum(terms), inverse))
    return found


def _power(a: Jet, b: Jet) -> Jet:
    (exponent,) = b
    less = iv.subtract(exponent, iv.exact(1.0))
    first = iv.multiply(exponent, iv.power(a[0], less))
    if len(a) == 1:
        return [iv.power(a[0], exponent)]
    second = iv.multiply(iv.multiply(exponent, less), iv.power(a[0], iv.subtract(exponent, iv.exact(2.0))))
    return _chain(a, (iv.power(a[0], exponent), first, iv.scale(second, 0.5)))


def _composed(function: Callable[[Array], tuple[Array, Array, Array]], a: Jet) -> Jet:
    return _chain(a, function(a[0]))


def _chain(a: Jet, outer: tuple[Array, Array, Array]) -> Jet:
    """Return the Taylor coefficients of f(a), from f, f' and f''/2 at a."""
    if len(a) == 1:
        return [outer[0]]
    bent = iv.multiply(outer[2], iv.square(a[1]))
    if len(a) > 2:
        bent = iv.add(iv.multiply(outer[1], a[2]), bent)
    return [outer[0], iv.multiply(outer[1], a[1]), bent]


def _sin(x: Array) -> tuple[Array, Array, Array]:
    sine = iv.sin(x)
    return sine, iv.cos(x), iv.scale(iv.negative(sine), 0.5)


def _cos(x: Array) -> tuple[Array, Array, Array]:
    cosine = iv.cos(x)
    return cosine, iv.negative(iv.sin(x)), iv.scale(iv.negative(cosine), 0.5)


def _exp(x: Array) -> tuple[Array, Array, Array]:
    value = iv.exp(x)
    return value, value, iv.scale(value, 0.5)


def _expm1(x: Array) -> tuple[Array, Array, Array]:
    slope = iv.exp(x)
    return iv.expm1(x), slope, iv.scale(slope, 0.5)


def _log1p(x: Array) -> tuple[Array, Array, Array]:
    _, first, second = _log(iv.add(x, iv.exact(1.0)))
    return iv.log1p(x), first, second


def _log(x: Array) -> tuple[Array, Array, Array]:
    inverse = iv.reciprocal(_positive(x))
    return iv.log(x), inverse, iv.negative(iv.scale(iv.square(inverse), 0.5))


def _sqrt(x: Array) -> tuple[Array, Array, Array]:
    root, inverse = iv.sqrt(x), iv.reciprocal(_positive(x))
    first = iv.scale(iv.reciprocal(iv.sqrt(_positive(x))), 0.5)
    return root, first, iv.negative(iv.scale(iv.multiply(first, inverse), 0.25))


def _tanh(x: Array) -> tuple[Array, Array, Array]:
    value, slope = iv.tanh(x), iv.sech_squared(x)
    return value, slope, iv.negative(iv.multiply(value, slope))


def _logistic(x: Array) -> tuple[Array, Array, Array]:
    half = iv.scale(x, 0.5)
    quarter = iv.scale(iv.sech_squared(half), 0.25)
    return iv.logistic(x), iv.negative(quarter), iv.scale(iv.multiply(iv.tanh(half), quarter), 0.5)


def _arcsinh(x: Array) -> tuple[Array, Array, Array]:
    slope = iv.arcsinh_slope(x)
    return iv.arcsinh(x), slope, iv.negative(iv.scale(iv.multiply(x, iv.multiply(slope, iv.square(slope))), 0.5))


def _positive(x: Array) -> Array:
    """Return x where the whole interval is above 0, else (-inf, inf), whose reciprocal is unbounded too."""
    return np.where(x[..., :1, :] < 0.0, x, np.inf)


_BINARY: dict[str, Callable[[Jet, Jet], Jet]] = {
    "add": _add,
    "sub": _subtract,
    "mul": _multiply,
    "div": _divide,
    "pow": _power,
}
_UNARY: dict[str, Callable[[Array], Any]] = {
    "sin": _sin,
    "cos": _cos,
    "exp": _exp,
    "log": _log,
    "sqrt": _sqrt,
    "tanh": _tanh,
    "arcsinh": _arcsinh,
    "expm1": _expm1,
    "log1p": _log1p,
    "logistic": _logistic,
}
