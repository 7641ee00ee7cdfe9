"""Noise of a record, samples that show the sensor and not friction, and the loss function of a search."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

OUTLYING = 2.0
"""Residuals above this many standard deviations count less, unless the loss is linear."""


def cost_of(residual: Floats, loss: str = "linear") -> float:
    """Return the sum that a search minimises; unless the loss is linear, residuals beyond `OUTLYING` count less than squared."""
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
"""Names of these functions."""


GAUSSIAN = 0.6744897501960817
"""Median magnitude of a normal deviate with standard deviation 1."""


def noise_of(values: Floats) -> float:
    """Return the standard deviation of the noise from sample to sample, from second differences; trends do not count."""
    known = values[np.isfinite(values)]
    if len(known) < 3:
        return 0.0
    bends = known[2:] - 2.0 * known[1:-1] + known[:-2]
    size = float(np.median(np.abs(bends))) / (GAUSSIAN * math.sqrt(6.0))
    return size if size > 0.0 else float(np.sqrt(np.mean(bends**2) / 6.0))


def rounding_of(values: Floats) -> float:
    """Return half the step of the digitiser or of the last written digit if values change by multiples of a step; otherwise 0."""
    known = values[np.isfinite(values)]
    if len(known) < 3:
        return 0.0
    bends = np.abs(known[2:] - 2.0 * known[1:-1] + known[:-2])
    exact = 16.0 * float(np.max(np.abs(known))) * float(np.finfo(float).eps)
    bends = bends[bends > exact]
    return 0.5 * float(bends.min()) if len(bends) > max(10, 0.02 * len(known)) else 0.0


def first_value(time: Floats, values: Floats, noise: float) -> tuple[float, float]:
    """Return the value at the first time and its standard error, from a line through as many samples as fit it within the noise."""
    known = np.isfinite(values)
    time, values = time[known], values[known]
    best = float(values[0]), noise
    count = 4
    while count <= min(len(values), 256):
        t, y = time[:count] - time[0], values[:count]
        slope, level = np.polyfit(t, y, 1)
        rest = float(np.sqrt(np.sum((y - level - slope * t) ** 2) / (count - 2)))
        if rest > 1.3 * noise:
            break
        best = float(level), noise * 2.0 / math.sqrt(count)
        count *= 2
    return best


RAIL = 8
"""A sensor counts as saturated after this many equal samples at an end of its range."""
LONE = 10.0
"""Such a run must also be longer than other runs of equal samples by this factor."""
FEW, DIGITS_OF_NOISE = 3, 10.0
"""In noise above DIGITS_OF_NOISE steps of the digitiser, a run of FEW equal samples is unlikely enough."""
LEAST_NOISE = 1e-4
"""The noise must also be above this share of the range: a record without noise may rest at one value."""
FACTOR_OF_SPIKE = 10.0
"""A spike is larger than nine of ten samples by this factor: a disturbance, or a mark of a missing number such as -999."""
MOMENT = 3
"""Largest number of consecutive samples in a spike."""


def saturated(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples of a saturated sensor: equal samples at an end of the range, more than elsewhere in a row.

    If half of all samples or more are like this, the quantity has levels: none of them counts as saturated.
    """
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
        if length >= longest and values[begin] in ends:
            flat[begin : begin + length] = True
    return flat if flat.sum() < 0.5 * len(values) else np.zeros(len(values), bool)


def spikes(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples far beyond the rest that stand alone, or with one or two neighbours."""
    sizes = np.abs(values)
    usual = float(np.nanquantile(sizes, 0.9))
    far = sizes > FACTOR_OF_SPIKE * usual if usual > 0.0 else np.zeros(len(values), bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], far, [False]])))
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if end - begin > MOMENT:
            far[begin:end] = False
    return far
