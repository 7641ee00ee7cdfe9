"""Compute friction on arrays, its value, its slopes and its difference from rest without cancellation; derive a formula.

The difference is mu(u + du, v) - mu(u, 0), which keeps its digits where the two are nearly equal. The rules for each node (sin(r+e)
- sin(r), expm1, log1p ...) are those that `stickslip.engine.formula_code.taylor_series` compiles. Here they work on arrays, for
quantities that are computed once per problem rather than once per step. Near the critical value of a rate law all folds of the
contact equation lie within 3e-4 Pa at a load of 8e7 Pa: they are visible only in differences.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.at_points import NUMBER_OF_VARIABLES, AtPoints, changes_at, slopes_at
from stickslip.friction.formula.expression import Expression, as_expression, depends_on, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.tape import Integers, Tape, written

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
    shape = v.shape if du.shape in ((), v.shape) else np.broadcast_shapes(du.shape, v.shape)
    given = (*parameters.values(), slip)
    many = any(map(np.ndim, given))
    numbers = _columns(given, shape if many else ())
    tape = tape_of_changes((tree,), tuple(parameters))
    of = points_of(tape, np.zeros(len(numbers), np.int64), numbers)
    return changes(of, np.arange(len(numbers)) if many else np.zeros(int(np.prod(shape)), np.int64), du, np.broadcast_to(v, shape))


def points_of(tape: Tape, formula: Integers, numbers: Floats) -> AtPoints:
    """Return what compiled code needs to follow formulas of members, with a row of numbers each, the slip last."""
    return AtPoints(tape.steps, tape.values, tape.spans[formula], numbers, np.empty((NUMBER_OF_VARIABLES + tape.longest + 1, 4)))


def changes(of: AtPoints, member: Integers, slip_step: ArrayLike, rate: Floats) -> tuple[Floats, Floats]:
    """Return what `difference` does for points that have a rate and a member each."""
    step, found = np.asarray(slip_step, float), np.empty((2, *rate.shape))
    steps = np.ascontiguousarray(np.broadcast_to(step, rate.shape) if step.ndim else step).reshape(-1)
    changes_at(of, member.reshape(-1), steps, np.ascontiguousarray(rate).reshape(-1), found.reshape(2, -1))
    return found[0], found[1]


def _columns(numbers: Iterable[ArrayLike], shape: tuple[int, ...]) -> Floats:
    """Return the law's numbers as columns of a table with a row for each point, or with one row for all if `shape` is empty."""
    given = list(numbers)
    found = np.empty((int(np.prod(shape)), len(given)))
    for column, number in zip(found.T, given, strict=True):
        column[:] = np.broadcast_to(number, shape).reshape(-1)
    return found


def value_and_slopes(
    tree: Expression, parameters: Mapping[str, ArrayLike], slip: ArrayLike, rate: ArrayLike, *states: ArrayLike
) -> tuple[Floats, Floats]:
    """Return a formula and its derivatives by slip, slip rate and each of the states, as an array with one axis more in front.

    The arguments are those of `difference`; `states` are in the form that the formulas use. All broadcast, and so do parameters:
    each point may have its own.
    """
    shape = np.broadcast_shapes(*(np.shape(given) for given in (slip, rate, *states, *parameters.values())))
    points = _columns((slip, rate, *states), shape)
    numbers = _columns(parameters.values(), shape if any(map(np.ndim, parameters.values())) else ())
    tape = tape_of_changes((tree,), tuple(parameters))
    found = np.empty((1 + points.shape[1], len(points)))
    slopes_at(points_of(tape, np.zeros(len(numbers), np.int64), numbers), points, found)
    return found[0].reshape(shape), found[1:].reshape(-1, *shape)


@lru_cache(maxsize=256)
def tape_of_changes(trees: tuple[Expression, ...], parameters: tuple[str, ...]) -> Tape:
    """Return formulas as a tape that says of each exponential whether its exponent is limited to LARGEST_EXPONENT."""
    formulas = [nodes_of(tree) for tree in trees]
    limits = [limited(tree) for tree in trees]
    others = [[int(node in cut) for node in nodes] for nodes, cut in zip(formulas, limits, strict=True)]
    return written(formulas, parameters, others)
