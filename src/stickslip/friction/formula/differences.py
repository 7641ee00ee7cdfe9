"""Compute friction on arrays, its value, its slopes and its difference from rest without cancellation; derive a formula.

The difference is mu(u + du, v) - mu(u, 0), which keeps its digits where the two are nearly equal. The rules for each node (sin(r+e)
- sin(r), expm1, log1p ...) are those that `stickslip.engine.formula_code.taylor_series` compiles. Here numpy evaluates them, for
quantities that are computed once per problem rather than once per step. Near the critical value of a rate law all folds of the
contact equation lie within 3e-4 Pa at a load of 8e7 Pa: they are visible only in differences.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.expression import RATE, SLIP, STATES, VARIABLES, Expression, as_expression, depends_on, nodes_of
from stickslip.friction.formula.operations import LARGEST_EXPONENT, operation_of
from stickslip.friction.formula.operations.operation import Change

ZERO, ONE = as_expression(0.0), as_expression(1.0)


@lru_cache(maxsize=256)
def slope_formula(tree: Expression, variable: Expression) -> Expression:
    """Return the derivative of a formula by a variable, one of VARIABLES."""
    found = {variable: ONE}
    for node in nodes_of(tree):
        if node not in found:
            varies = bool(node.arguments) and depends_on(node, variable)
            slopes = [found[argument] for argument in node.arguments]
            found[node] = operation_of(node).slope_formula(node, *slopes) if varies else ZERO
    return found[tree]


@lru_cache(maxsize=256)
def limited(tree: Expression) -> frozenset[Expression]:
    """Return the exponentials of a formula whose exponents are limited to LARGEST_EXPONENT."""
    return frozenset(node for node in harmless_overflows(nodes_of(tree)) if node.arguments and operation_of(node).overflows)


def harmless_overflows(nodes: Sequence[Expression]) -> set[Expression]:
    """Return the nodes whose every way into the formula leads to a denominator, or to an argument such as that of exp.

    The way may lead through sums, differences, roots and products, but not through a product with a factor that may be as small as
    the node is large, nor over a divisor that may be as large.
    """
    parents: dict[Expression, list[Expression]] = {node: [] for node in nodes}
    for node in nodes:
        for argument in node.arguments:
            parents[argument].append(node)
    found: set[Expression] = set()
    for node in reversed(nodes):
        ways = parents[node]
        if ways and all(_settles(node, parent) or (parent in found and _keeps_large(node, parent)) for parent in ways):
            found.add(node)
    return found


def _places(node: Expression, parent: Expression) -> set[int]:
    return {place for place, argument in enumerate(parent.arguments) if argument == node}


def _settles(node: Expression, parent: Expression) -> bool:
    """Return True if the parent of a node no longer changes where the node is large."""
    return _places(node, parent) <= set(operation_of(parent).settles)


def _keeps_large(node: Expression, parent: Expression) -> bool:
    """Return True if the parent of a node is large wherever the node is."""
    operation = operation_of(parent)
    others = [part for argument in parent.arguments if argument != node for part in nodes_of(argument) if part.arguments]
    small = operation.scales and any(operation_of(part).shrinks for part in others)
    return bool(_places(node, parent) & set(operation.carries)) and not small


def difference(
    tree: Expression, parameters: Mapping[str, ArrayLike], slip: float | Floats, slip_step: ArrayLike, rate: ArrayLike
) -> tuple[Floats, Floats]:
    """Return mu(slip + slip_step, rate) - mu(slip, 0), and dmu/drate (s/m) at the end point.

    `slip` and `slip_step` are in m, `rate` >= 0 in m/s. `tree` is one piece of a law's formula and `parameters` holds the law's
    numbers by name. All of them broadcast to the shape of `slip_step` and `rate` together. A state variable is 0,
    healed, at both points. Raise KeyError for a parameter without a value.
    """
    du, v = np.asarray(slip_step, float), np.asarray(rate, float)
    if du.shape != v.shape:
        du, v = np.broadcast_arrays(du, v)
    ends = {SLIP: Change(slip, du, slip + du, 0.0), RATE: Change(0.0, v, v, 1.0)}
    ends |= dict.fromkeys(STATES, Change(0.0, 0.0, 0.0, 0.0))
    result = _evaluated(tree, parameters, ends)
    return _of_shape(result.step, v.shape), _of_shape(result.slope, v.shape)


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
    result = _evaluated(tree, parameters, {symbol: Change(x := np.asarray(at, float), 0.0, x, seed) for symbol, at, seed in given})
    return _of_shape(result.value, shape), _of_shape(result.slope, (many, *shape))


def _of_shape(result: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Return a result in a new array of this shape."""
    return np.broadcast_to(result, shape) + 0.0 if np.shape(result) != shape else np.add(result, 0.0)


def _evaluated(tree: Expression, parameters: Mapping[str, ArrayLike], variables: Mapping[Expression, Change]) -> Change:
    """Return the change of a whole formula from those of its variables."""
    found: list[Change] = []
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        for node, places, is_limited in _order(tree):
            if places:
                given = [found[place] for place in places]
                if is_limited:
                    given = [_at_most(given[0], LARGEST_EXPONENT)]
                operation = operation_of(node)
                start = operation.on_arrays(*[one.reference for one in given])
                end = operation.on_arrays(*[one.value for one in given])
                found.append(Change(start, operation.step(start, end, *given), end, operation.slope(end, *given)))
            elif node in variables:
                found.append(variables[node])
            else:
                number = parameters[node.name] if node.operation == "parameter" else node.value
                found.append(Change(number, 0.0, number, 0.0))
    return found[-1]


@lru_cache(maxsize=256)
def _order(tree: Expression) -> tuple[tuple[Expression, tuple[int, ...], bool], ...]:
    """Return the nodes of a formula, arguments first: each with the places of its arguments, and whether its exponent is limited.

    To look for nodes by their hashes would take half of the time of an evaluation.
    """
    nodes, cut = nodes_of(tree), limited(tree)
    place = {node: n for n, node in enumerate(nodes)}
    return tuple((node, tuple(place[argument] for argument in node.arguments), node in cut) for node in nodes)


def _at_most(a: Change, largest: float) -> Change:
    """Return the change of min(a, largest)."""
    start, end = np.minimum(a.reference, largest), np.minimum(a.value, largest)
    within = (np.asarray(a.reference) <= largest) & (np.asarray(a.value) <= largest)
    return Change(start, np.where(within, a.step, end - start), end, np.where(np.asarray(a.value) <= largest, a.slope, 0.0))
