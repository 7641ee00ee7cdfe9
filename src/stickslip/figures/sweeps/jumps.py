"""Jumps of a quantity along a varied key: between which neighbouring members a line would hide a discontinuity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

NEAR = 3
"""Number of steps on each side with which a step is compared."""
STEEP = 6.0
"""A jump is larger than this multiple of the median of the steps near it ..."""
SHARE = 0.05
"""... and larger than this share of the whole range, so that small steps of a nearly constant quantity are no jumps."""


def jumps(values: Floats, *, whole: bool = False) -> NDArray[np.bool_]:
    """Return for each step between neighbours whether the quantity jumps there.

    Parameters
    ----------
    values : ndarray
        Values of the quantity as they are drawn (logarithms on a logarithmic axis), n of them; NaN where there is none.
    whole : bool
        True for counts, which jump wherever they change.

    Returns
    -------
    ndarray
        n - 1 truth values; False beside a missing value.
    """
    steps = np.abs(np.diff(values))
    known = np.isfinite(steps)
    if whole or not known.any():
        return known & (steps > 0.0)
    least = SHARE * np.ptp(values[np.isfinite(values)])
    found = np.zeros(steps.shape, bool)
    for place in np.flatnonzero(known & (steps > least)):
        near = np.concatenate([steps[max(place - NEAR, 0) : place], steps[place + 1 : place + 1 + NEAR]])
        near = near[np.isfinite(near)]
        # Without neighbours nothing says that the quantity is smooth, and nothing says that it is not.
        found[place] = near.size > 0 and steps[place] > STEEP * np.median(near)
    return found
