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

    The law's numbers and the ends of intervals may be arrays with one entry for each member of a batch. A number may also be an
    interval: the bounds then hold for all numbers in it.
    """
    found: dict[Expression, Interval] = {SLIP: _ends(slip), RATE: _ends(rate)} | dict.fromkeys(STATES, _ends(EVERYTHING))
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = operation_of(node).bounds(node, *(found[argument] for argument in node.arguments))
            elif node not in found:
                found[node] = _ends(numbers[node.name] if node.operation == "parameter" else node.value)
    return found[tree]


def _ends(given: Any) -> Interval:
    low, high = given if isinstance(given, tuple) else (given, given)
    return np.asarray(low, float), np.asarray(high, float)


def bends_one_way(tree: Expression, numbers: Mapping[str, Any], slip: Interval) -> bool:
    """Return True if a formula is proven to be convex, or concave, over all slip rates; slips (m) and numbers as in `bounds`."""
    low, high = bounds(slope_formula(slope_formula(tree, RATE), RATE), numbers, slip, (0.0, np.inf))
    return bool(np.all(low >= 0.0) or np.all(high <= 0.0))
