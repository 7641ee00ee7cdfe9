"""Bounds of a formula and of its derivatives by the slip rate on cells, one after another, for tests."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.engine.enclosure.formula import bound_at_slips, bound_friction, formulas_of
from stickslip.friction.formula.expression import Expression


def enclose(
    tree: Expression, parameters: Mapping[str, float], slip: float | tuple[float, float], low: ArrayLike, high: ArrayLike
) -> NDArray[np.float64]:
    """Bounds of mu, dmu/dv and d2mu/dv2, shape (3, 2, cells), at a slip or between two, on cells of slip rates."""
    formulas = formulas_of([tree], tuple(parameters), np.array([list(parameters.values())], float).reshape(1, -1))
    slips = slip if isinstance(slip, tuple) else (slip, slip)
    found = []
    for one, other in zip(np.atleast_1d(low).tolist(), np.atleast_1d(high).tolist(), strict=True):
        bound_at_slips(formulas, 0, *slips)
        found.append(np.array(bound_friction(formulas, 0, one, other)).reshape(3, 2) * [[1.0], [1.0], [2.0]])
    return np.stack(found, axis=-1)
