"""Compute friction on arrays: its value and slopes, and its difference from rest without cancellation.

The difference is mu(u + du, v) - mu(u, 0), which keeps its digits where the two are nearly equal. The rules for each node (sin(r+e)
- sin(r), expm1, log1p ...) are those that `stickslip.engine.codegen.taylor_series` compiles. Here numpy evaluates them, for
quantities that are computed once per problem rather than once per step. Near the critical value of a rate law all folds of the
contact equation lie within 3e-4 Pa at a load of 8e7 Pa: they are visible only in differences.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.denominators import LARGEST_EXPONENT, harmless_overflows
from stickslip.friction.formula.expression import RATE, SLIP, STATES, VARIABLES, Expression, nodes_of


@dataclass(frozen=True)
class _Node:
    """A node's value at the reference point, its change to the end point, its value there, and its derivative there.

    The derivative is that by the slip rate or, with one more axis in front, those by VARIABLES. The value at the
    end point is computed independently: reference + step would lose the digits of a value that has become small.
    """

    reference: Any
    step: Any
    value: Any
    slope: Any


def difference(
    tree: Expression, parameters: Mapping[str, ArrayLike], slip: float | Floats, slip_step: ArrayLike, rate: ArrayLike
) -> tuple[Floats, Floats]:
    """Return mu(slip + slip_step, rate) - mu(slip, 0), and dmu/drate (s/m) at the end point.

    `slip` and `slip_step` are in m, `rate` >= 0 in m/s. `tree` is one piece of a law's formula and `parameters` holds the law's
    numbers by name. All of them broadcast to the shape of `slip_step` and `rate` together. A state variable is 0,
    healed, at both points. Raise KeyError for a parameter without a value.
    """
    du, v = np.broadcast_arrays(np.asarray(slip_step, float), np.asarray(rate, float))
    ends = {SLIP: _Node(slip, du, slip + du, 0.0), RATE: _Node(0.0, v, v, 1.0)}
    ends |= dict.fromkeys(STATES, _Node(0.0, 0.0, 0.0, 0.0))
    result = _evaluated(tree, parameters, ends)
    return np.broadcast_to(result.step, v.shape) + 0.0, np.broadcast_to(result.slope, v.shape) + 0.0


def value_and_slopes(
    tree: Expression, parameters: Mapping[str, ArrayLike], slip: ArrayLike, rate: ArrayLike, *states: ArrayLike
) -> tuple[Floats, Floats]:
    """Return a formula and its derivatives by slip, slip rate and each of the states, as an array with one axis more in front.

    The arguments are those of `difference`; `states` are in the form that the formulas use. All broadcast, and so do parameters:
    each point may have its own.
    """
    shape = np.broadcast_shapes(*(np.shape(given) for given in (slip, rate, *states, *parameters.values())))
    many = 2 + len(states)
    seeds = np.eye(many).reshape(many, many, *(1 for _ in shape))
    given = zip(VARIABLES, (slip, rate, *states), seeds, strict=False)
    result = _evaluated(tree, parameters, {symbol: _Node(x := np.asarray(at, float), 0.0, x, seed) for symbol, at, seed in given})
    return np.broadcast_to(result.value, shape) + 0.0, np.broadcast_to(result.slope, (many, *shape)) + 0.0


def _evaluated(tree: Expression, parameters: Mapping[str, ArrayLike], variables: Mapping[Expression, _Node]) -> _Node:
    """Return the node of a whole formula from those of its variables."""
    found = dict(variables)
    limited = _limited(tree)
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        for node in nodes_of(tree):
            if node in limited:
                found[node] = _RULES[node.operation](_at_most(found[node.arguments[0]], LARGEST_EXPONENT))
            elif node.arguments:
                found[node] = _RULES[node.operation](*(found[argument] for argument in node.arguments))
            elif node not in found:
                number = parameters[node.name] if node.operation == "parameter" else node.value
                found[node] = _Node(number, 0.0, number, 0.0)
    return found[tree]


@lru_cache(maxsize=256)
def _limited(tree: Expression) -> frozenset[Expression]:
    """Return the exponentials of a formula whose exponents are limited."""
    return frozenset(node for node in harmless_overflows(nodes_of(tree)) if node.operation in ("exp", "expm1"))


def _at_most(a: _Node, largest: float) -> _Node:
    """Return the node of min(a, largest)."""
    start, end = np.minimum(a.reference, largest), np.minimum(a.value, largest)
    within = (np.asarray(a.reference) <= largest) & (np.asarray(a.value) <= largest)
    return _Node(start, np.where(within, a.step, end - start), end, np.where(np.asarray(a.value) <= largest, a.slope, 0.0))


def _add(a: _Node, b: _Node) -> _Node:
    return _Node(a.reference + b.reference, a.step + b.step, a.value + b.value, a.slope + b.slope)


def _sub(a: _Node, b: _Node) -> _Node:
    return _Node(a.reference - b.reference, a.step - b.step, a.value - b.value, a.slope - b.slope)


def _mul(a: _Node, b: _Node) -> _Node:
    step = a.step * b.reference + a.value * b.step
    return _Node(a.reference * b.reference, step, a.value * b.value, a.slope * b.value + a.value * b.slope)


def _div(a: _Node, b: _Node) -> _Node:
    start, end = np.divide(a.reference, b.reference), np.divide(a.value, b.value)
    infinite = np.isinf(b.value)  # an exponential that overflows: the quotient and its slope are zero
    with np.errstate(invalid="ignore"):
        step = np.where(infinite, end - start, (a.step - start * b.step) / b.value)
        return _Node(start, step, end, np.where(infinite, 0.0, (a.slope - end * b.slope) / b.value))


def _pow(a: _Node, b: _Node) -> _Node:
    """Return the node of a power, whose exponent does not vary: it depends only on numbers of the law."""
    exponent, start, end = b.reference, np.power(a.reference, b.reference), np.power(a.value, b.reference)
    near = (np.asarray(a.reference) > 0) & (np.asarray(a.value) > 0)
    ratio = np.divide(a.step, a.reference, where=near, out=np.zeros(np.broadcast_shapes(near.shape, np.shape(a.step))))
    step = np.where(near, start * np.expm1(exponent * np.log1p(ratio)), end - start)
    return _Node(start, step, end, _chain(exponent * np.power(a.value, exponent - 1.0), a.slope))


def _sin(a: _Node) -> _Node:
    half = np.sin(0.5 * a.step)
    step = 2.0 * half * (np.cos(a.reference) * np.cos(0.5 * a.step) - np.sin(a.reference) * half)
    return _Node(np.sin(a.reference), step, np.sin(a.value), np.cos(a.value) * a.slope)


def _cos(a: _Node) -> _Node:
    half = np.sin(0.5 * a.step)
    step = -2.0 * half * (np.sin(a.reference) * np.cos(0.5 * a.step) + np.cos(a.reference) * half)
    return _Node(np.cos(a.reference), step, np.cos(a.value), -np.sin(a.value) * a.slope)


def _exp(a: _Node) -> _Node:
    with np.errstate(over="ignore"):
        start, end = np.exp(a.reference), np.exp(a.value)
    near = np.abs(a.step) < 1.0  # for larger steps a subtraction loses nothing, and expm1 may overflow where start underflows
    with np.errstate(invalid="ignore"):
        step = np.where(near, start * np.expm1(np.where(near, a.step, 0.0)), end - start)
        return _Node(start, step, end, end * a.slope)


def _expm1(a: _Node) -> _Node:
    """Return the node of exp - 1, which has the step and the slope of exp."""
    power = _exp(a)
    with np.errstate(over="ignore"):
        return _Node(np.expm1(a.reference), power.step, np.expm1(a.value), power.slope)


def _log1p(a: _Node) -> _Node:
    return _Node(np.log1p(a.reference), np.log1p(a.step / (1.0 + a.reference)), np.log1p(a.value), a.slope / (1.0 + a.value))


def _log(a: _Node) -> _Node:
    return _Node(np.log(a.reference), np.log1p(a.step / a.reference), np.log(a.value), a.slope / a.value)


def _sqrt(a: _Node) -> _Node:
    start, end = np.sqrt(a.reference), np.sqrt(a.value)
    step = np.divide(a.step, start + end, where=np.asarray(start + end) > 0, out=np.zeros(np.shape(end)))
    return _Node(start, step, end, _chain(np.divide(0.5, end), a.slope))


def _tanh(a: _Node) -> _Node:
    """Return the node of tanh, with tanh x - tanh y = sinh(x - y) / (cosh x cosh y) near the reference.

    Farther from it a subtraction loses no digits.
    """
    start, end = np.tanh(a.reference), np.tanh(a.value)
    # with the same sign, both may differ from 1 or -1 only in their last digits: subtraction would cancel even for large steps
    one_side = (np.abs(a.step) < 300.0) & (np.multiply(a.reference, a.value) > 0.0)
    near = (np.abs(a.step) < 1.0) | one_side
    with np.errstate(over="ignore"):  # where cosh overflows, 1 / cosh is 0, and so is the slope
        across = np.cosh(a.value)
        step = np.where(near, np.sinh(np.where(near, a.step, 0.0)) / np.cosh(a.reference) / across, end - start)
        return _Node(start, step, end, a.slope / across / across)


def _arcsinh(a: _Node) -> _Node:
    """Return the node of arcsinh, by arcsinh x - arcsinh y = arcsinh((x - y) (1 + p q - x y) / (p + q)).

    Here p = sqrt(1 + x^2) and q = sqrt(1 + y^2). Where the squares would overflow, subtract.
    """
    x, y = a.value, a.reference
    start, end = np.arcsinh(y), np.arcsinh(x)
    with np.errstate(over="ignore", invalid="ignore"):
        p, q, xy = np.hypot(1.0, x), np.hypot(1.0, y), x * y
        gap = np.where(xy > 0.0, (1.0 + x * x + y * y) / (p * q + np.abs(xy)), p * q - xy)
        step = np.arcsinh(a.step * (1.0 + gap) / (p + q))
    return _Node(start, np.where(np.maximum(p, q) > 1e150, end - start, step), end, a.slope / p)


def _chain(outer: Any, inner: Any) -> Any:
    """Return outer * inner, and 0 where inner is 0: without dependence the product is 0 even if the outer slope is infinite."""
    inner = np.asarray(inner, float)
    return np.multiply(outer, inner, where=inner != 0.0, out=np.zeros(np.broadcast_shapes(np.shape(outer), inner.shape)))


_RULES: dict[str, Callable[..., _Node]] = {
    **{"add": _add, "sub": _sub, "mul": _mul, "div": _div, "pow": _pow},
    **{"sin": _sin, "cos": _cos, "exp": _exp, "log": _log, "sqrt": _sqrt, "tanh": _tanh, "arcsinh": _arcsinh},
    **{"expm1": _expm1, "log1p": _log1p},
}
"""Rule of each operation."""
