"""How residuals count in the sum that a search minimises."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stickslip.foundation.arrays import Floats

OUTLYING = 2.0
"""Residual, in standard deviations, from which a loss other than the linear one counts it less."""


def cost_of(residual: Floats, loss: str = "linear") -> float:
    """Return the sum that a search minimises; unless the loss is linear, residuals beyond `OUTLYING` count less than squares."""
    return OUTLYING**2 * float(np.sum(_LOSSES[loss][0]((residual / OUTLYING) ** 2)))


def weights(residual: Floats, loss: str) -> Floats:
    """Return the weight of each squared residual in the derivatives of the sum."""
    return np.asarray(_LOSSES[loss][1]((residual / OUTLYING) ** 2))


_LOSSES: dict[str, tuple[Callable[[Floats], Floats], Callable[[Floats], Floats]]] = {
    "linear": (lambda z: z, np.ones_like),
    "soft_l1": (lambda z: 2.0 * (np.sqrt(1.0 + z) - 1.0), lambda z: 1.0 / np.sqrt(1.0 + z)),
    "huber": (lambda z: np.where(z <= 1.0, z, 2.0 * np.sqrt(z) - 1.0), lambda z: 1.0 / np.sqrt(np.maximum(z, 1.0))),
    "cauchy": (np.log1p, lambda z: 1.0 / (1.0 + z)),
}
"""Functions of squared residuals, as in scipy's least_squares, and their derivatives."""
LOSSES = tuple(_LOSSES)
"""Names of the functions of squared residuals that may be summed."""
