"""Bound a formula over intervals of slip and slip rate, by interval arithmetic.

The bounds are guaranteed but for rounding, and need not be sharp. `enclosure` has bounds that include rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.sets import EVERYTHING, Interval
from stickslip.friction.formula.slopes import slope_formula


def bounds(tree: Expression, numbers: Mapping[str, Any], slip: Interval, rate: Interval) -> Interval:
    """Return bounds of the formula while slip (m) and slip rate (m/s) stay in their intervals, at any state.

    The law's numbers and the ends of intervals may be arrays with one entry for each member of a batch.
    """
    given = {SLIP: slip, RATE: rate} | dict.fromkeys(STATES, EVERYTHING)
    found: dict[Expression, Interval] = {
        one: (np.asarray(low, float), np.asarray(high, float)) for one, (low, high) in given.items()
    }
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = operation_of(node).bounds(node, *(found[argument] for argument in node.arguments))
            elif node not in found:
                value = np.asarray(numbers[node.name] if node.operation == "parameter" else node.value, float)
                found[node] = (value, value)
    return found[tree]


def bends_one_way(tree: Expression, numbers: Mapping[str, Any], slip: Any) -> Any:
    """Return True where a formula is proven to be convex, or concave, over all slip rates at a slip (m): see `bounds`."""
    bend = slope_formula(slope_formula(tree, RATE), RATE)
    low, high = bounds(bend, numbers, (slip, slip), (0.0, np.inf))
    return (low >= 0.0) | (high <= 0.0)
