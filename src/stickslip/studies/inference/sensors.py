"""Samples that tell of a sensor and not of friction: at the end of its range, or far beyond the rest for a moment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RAIL = 8
"""Number of equal samples at the end of the range of a quantity from which its sensor counts as saturated."""
LONE = 10.0
"""Factor by which such a run is longer than other runs of equal samples."""
BEYOND = 10.0
"""Factor by which a lone sample is larger than nine of ten samples: noise, and the marks of a missing number, as -999."""
MOMENT = 3
"""Largest number of such samples that follow each other."""


def saturated(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples of a run of one value at an end of the range, which is longer than other runs of equal samples."""
    flat = np.zeros(len(values), bool)
    if len(values) < 2 * RAIL:
        return flat
    begins = np.flatnonzero(np.append(True, values[1:] != values[:-1]))
    lengths = np.diff(np.append(begins, len(values)))
    usual = float(np.quantile(lengths, 0.9))
    ends = (np.nanmin(values), np.nanmax(values))
    for begin, length in zip(begins.tolist(), lengths.tolist(), strict=True):
        if length >= max(RAIL, LONE * usual) and length < 0.5 * len(values) and values[begin] in ends:
            flat[begin : begin + length] = True
    return flat


def spikes(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples far beyond the rest that stand alone, or with one or two neighbours."""
    sizes = np.abs(values)
    usual = float(np.nanquantile(sizes, 0.9))
    far = sizes > BEYOND * usual if usual > 0.0 else np.zeros(len(values), bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], far, [False]])))
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if end - begin > MOMENT:
            far[begin:end] = False
    return far
