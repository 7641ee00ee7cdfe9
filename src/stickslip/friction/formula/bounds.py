"""Bound a formula over intervals of slip and slip rate, by interval arithmetic.

The bounds are guaranteed but for rounding, and need not be sharp. `enclosure` has bounds that include rounding.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.sets import EVERYTHING, Interval


def bounds(tree: Expression, numbers: Mapping[str, float], slip: Interval, rate: Interval) -> Interval:
    """Return bounds of the formula while slip (m) and slip rate (m/s) stay in their intervals, at any state."""
    found: dict[Expression, Interval] = {SLIP: slip, RATE: rate} | dict.fromkeys(STATES, EVERYTHING)
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.operation == "parameter":
                found[node] = (numbers[node.name], numbers[node.name])
            elif node.operation == "constant":
                found[node] = (node.value, node.value)
            elif node.arguments:
                found[node] = operation_of(node).bounds(node, *(found[argument] for argument in node.arguments))
    return found[tree]
