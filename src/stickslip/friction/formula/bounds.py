"""Bound a formula over intervals of slip and slip rate, and over discs of complex numbers, by numpy alone.

Bounds need not be sharp. Those of `Enclosure` and `on_discs` include rounding; those of `bounds` are guaranteed but for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.formula.differences import slope_formula
from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.enclosures import Rule
from stickslip.friction.formula.operations.hyperbolic import logistic
from stickslip.friction.formula.operations.sets import EVERYTHING, Disc, Interval


def bounds(tree: Expression, numbers: Mapping[str, Any], slip: Interval, rate: Interval) -> Interval:
    """Return bounds of the formula while slip (m) and slip rate (m/s) stay in their intervals, at any state.

    The law's numbers and the ends of intervals may be arrays with one entry for each member of a batch. A number may also be an
    interval: the bounds then hold for all numbers in it.
    """
    given = {SLIP: slip, RATE: rate} | dict.fromkeys(STATES, EVERYTHING)
    leaves = [node for node in nodes_of(tree) if not node.arguments]
    ends = [_ends(given[node] if node in given else _number(node, numbers)) for node in leaves]
    axes = max(one.ndim for one in ends)
    found = {node: one.reshape(2, *(1,) * (axes - one.ndim), *one.shape[1:]) for node, one in zip(leaves, ends, strict=True)}
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = operation_of(node).bounds(node, *(found[argument] for argument in node.arguments))
    low, high = found[tree]
    return low, high


def _ends(given: Any) -> Floats:
    low, high = given if isinstance(given, tuple) else (given, given)
    return np.array(np.broadcast_arrays(low, high), float)


def _number(node: Expression, numbers: Mapping[str, Any]) -> Any:
    return numbers[node.name] if node.operation == "parameter" else node.value


class Enclosure:
    """Bounds of a formula's Taylor coefficients by the slip rate, by interval arithmetic that includes rounding.

    Slip (m) and the law's numbers are single ones, have one entry for each member, or are intervals of such. What does not depend
    on the slip rate is worked out once.
    """

    def __init__(self, tree: Expression, numbers: Mapping[str, Any], slip: Any) -> None:
        """Raise InputError for a formula with a state."""
        self._steps = _steps(tree)
        self._still: list[Floats | None] = []
        with np.errstate(all="ignore"):
            for node, rule, places in self._steps:
                arguments = [self._still[place] for place in places]
                if node is RATE or any(argument is None for argument in arguments):
                    self._still.append(None)
                elif rule is not None:
                    self._still.append(rule(node, *arguments))
                else:
                    self._still.append(_ends(slip if node is SLIP else _number(node, numbers)).reshape(2, 1, -1))

    def on(self, low: Floats, high: Floats, member: Any = 0) -> Floats:
        """Return the bounds on cells of slip rates, from `low` to `high` (m/s), each of one `member`.

        They are an array as in `operations.enclosures`: low and high ends of mu, dmu/dv (s/m) and half of d2mu/dv2 (s2/m2), of
        which those at the end may be left out if they are 0.
        """
        one = np.ones_like(low)
        rate = np.array([[low, one], [high, one]])
        found: list[Floats] = []
        with np.errstate(all="ignore"):
            for (node, rule, places), still in zip(self._steps, self._still, strict=True):
                if still is not None:
                    found.append(still if still.shape[2] == 1 else still[:, :, member])
                else:
                    found.append(rate if rule is None else rule(node, *(found[place] for place in places)))
        return found[-1]


@lru_cache(maxsize=256)
def _steps(tree: Expression) -> tuple[tuple[Expression, Rule | None, tuple[int, ...]], ...]:
    """Return the nodes of a formula in order, each with its rule and the places of its arguments."""
    made: dict[Expression, Expression] = {}
    for node in nodes_of(tree):
        arguments = tuple(made[argument] for argument in node.arguments)
        copy = Expression(node.operation, arguments, node.name, node.value)
        made[node] = operation_of(copy).bounded(copy) if arguments else {SLIP: SLIP, RATE: RATE}.get(node, node)
    nodes = nodes_of(made[tree])
    if not {*STATES}.isdisjoint(nodes):
        raise InputError("the friction law has a state of its own: its slip rate is no root of the contact equation")
    place = {node: k for k, node in enumerate(nodes)}
    return tuple((node, _rule(node), tuple(place[argument] for argument in node.arguments)) for node in nodes)


def _rule(node: Expression) -> Rule | None:
    if node.operation == "logistic":
        return logistic
    return operation_of(node).taylor if node.arguments else None


def bends_one_way(tree: Expression, numbers: Mapping[str, Any], slip: Interval) -> bool:
    """Return True if a formula is proven to be convex, or concave, over all slip rates; slips (m) and numbers as in `bounds`."""
    low, high = bounds(slope_formula(slope_formula(tree, RATE), RATE), numbers, slip, (0.0, np.inf))
    return bool(np.all(low >= 0.0) or np.all(high <= 0.0))


def on_discs(tree: Expression, numbers: Mapping[str, ArrayLike], variables: Mapping[Expression, Disc]) -> Disc:
    """Return a formula on the discs of its variables, which broadcast; `numbers` holds the law's parameters by name.

    A disc of complex numbers lies around a real centre. The disc of a node contains every value that the node takes for arguments
    in their own discs, the rounding of this evaluation included. With tiny radii it is the formula at a point, with a bound on its
    rounding; with the radii of a step it bounds the formula around all of the step. If an operation has no analytic continuation on
    a disc, the radius is infinite or not a number. Source: Rump 2010, Acta Numerica 19.
    """
    found = dict(variables)
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = operation_of(node).disc(*(found[argument] for argument in node.arguments))
            elif node not in found:
                found[node] = Disc.of(np.asarray(numbers[node.name] if node.operation == "parameter" else node.value, float))
    return found[tree]


def largest(values: Disc) -> Floats:
    """Return an upper bound of the magnitude on each disc; infinite where nothing is known."""
    return np.asarray(np.nan_to_num(values.most, nan=np.inf, posinf=np.inf))
