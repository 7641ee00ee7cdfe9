"""Evaluate a formula on discs of complex numbers around real centres, by numpy and without anything that the engine compiles.

The disc of a node contains every value that it takes for arguments in their own discs, the rounding of this evaluation included.
With radii of next to nothing that is the formula at a point, and how far rounding may have moved it; with the radii of a step it
bounds the formula around all of it. A disc on which an operation has no analytic continuation gets an infinite radius, or one that
is not a number. Source: Rump 2010, Verification methods, Acta Numerica 19.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.expression import Expression, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.sets import Disc

__all__ = ["Disc", "largest", "on_discs"]


def on_discs(tree: Expression, numbers: Mapping[str, ArrayLike], variables: Mapping[Expression, Disc]) -> Disc:
    """Return a formula on the discs of its variables, which broadcast; `numbers` holds the law's parameters by name."""
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
