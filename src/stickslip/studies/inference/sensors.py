"""Samples that tell of a sensor and not of friction: at the end of its range, or far beyond the rest for a moment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.studies.inference.noise import noise_of, rounding_of

RAIL = 8
"""Number of equal samples at the end of the range of a quantity from which its sensor counts as saturated."""
LONE = 10.0
"""Factor by which such a run is longer than other runs of equal samples."""
FEW, DIGITS_OF_NOISE = 3, 10.0
"""Number of equal samples that noise makes unlikely, and its size, in steps of the digitiser, from which it does."""
LEAST_NOISE = 1e-4
"""The same as a share of the range: a record without noise may rest at one value."""
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
    step = 2.0 * rounding_of(values)
    noisy = noise_of(values) > max(DIGITS_OF_NOISE * step, LEAST_NOISE * float(np.nanmax(values) - np.nanmin(values)))
    longest = max(FEW, 2.0 * usual) if noisy and step > 0.0 else max(RAIL, LONE * usual)
    ends = (np.nanmin(values), np.nanmax(values))
    for begin, length in zip(begins.tolist(), lengths.tolist(), strict=True):
        if length >= longest and length < 0.5 * len(values) and values[begin] in ends:
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
