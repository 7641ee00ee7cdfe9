"""The exponential law of magnitudes: its most likely slope, exact for magnitudes in bins and for a largest one, and completeness.

Magnitudes x above completeness have the density beta exp(-beta x), cut off at a largest magnitude D above it if one is given. With
f(z) = 1/z - 1/(exp(z) - 1), the mean of the law in units of D, all four mean values are

    exact magnitudes:             1/beta                          cut off:   D f(beta D)
    in bins of width d, x = k d:  1/(exp(beta d) - 1)  (mean k)   cut off:   n f(n beta d) - f(beta d),   k = 0 ... n - 1

The likelihood depends on the magnitudes through their mean alone, and is largest where the mean of the law is that of the
magnitudes: the first two are solved in closed form, the others, which fall with beta, by bracketing. The geometric law of bins
is exact for magnitudes that were rounded to the middle of their bin: integrating the exponential over a bin changes nothing but
the constant before it.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from stickslip.foundation.arrays import Floats

STEEPEST = 350.0
"""Beyond this value of beta D the largest magnitude makes no difference to a number of 16 digits."""
SERIES = 0.05
"""Below this |z| f is its power series, whose next term is then below 1e-15."""
DRAWN_AT_ONCE = 5_000_000
"""Draw at most so many numbers at once: 40 MB."""
EQUAL = 1e-9
"""Magnitudes of events that are equal but for rounding differ by less than this."""
SHARE_OF_QUARTILES = 0.2
"""Width of the bins for completeness as a share of the distance between the quartiles: 0.1 for b = 1."""
BINS_ADDED = 2
"""Completeness lies so many of these bins above the fullest one: 0.2 for b = 1, as in Woessner & Wiemer 2005."""


def mean_cut(z: float) -> float:
    """Return f(z) = 1/z - 1/(exp(z) - 1): the mean of exp(-z y) on 0 < y < 1, which falls from 1 to 0."""
    if abs(z) < SERIES:
        return 0.5 - z * (1.0 / 12.0 - z**2 * (1.0 / 720.0 - z**2 / 30240.0))
    if abs(z) > STEEPEST:
        return 1.0 / z + (1.0 if z < 0.0 else 0.0)
    return 1.0 / z - 1.0 / math.expm1(z)


def slope(mean: float, width: float = 0.0, span: float = math.inf) -> float:
    """Return the most likely beta of magnitudes whose mean excess over completeness is given.

    `width` is that of bins, 0 for exact magnitudes; `span` is the distance from completeness to the largest magnitude, between the
    middles of bins. The result is infinite where all magnitudes are the smallest, and minus infinite where all are the largest.
    """
    if mean <= 0.0:
        return math.inf
    free = math.log1p(width / mean) / width if width else 1.0 / mean
    if math.isinf(span) or free * span > STEEPEST:
        return free
    if mean >= span:
        return -math.inf
    places = round(span / width) + 1 if width else 0

    def excess(z: float) -> float:
        """Return the mean of the law, in units of span, over that of the magnitudes; z is beta times span."""
        if not width:
            return mean_cut(z) - mean / span
        step = z / (places - 1)
        return (places * mean_cut(places * step) - mean_cut(step)) / (places - 1) - mean / span

    return float(brentq(excess, -STEEPEST, STEEPEST, xtol=1e-13, rtol=1e-14)) / span if excess(-STEEPEST) > 0.0 else -math.inf


def share_below(excess: Floats, beta: float, width: float, span: float) -> Floats:
    """Return the share of the law at or below an excess over completeness; of magnitudes in bins up to the bin's upper edge."""
    reach = excess + width
    total = span + width
    if not math.isfinite(total):
        return np.asarray(-np.expm1(-beta * reach))
    if beta == 0.0:
        return np.asarray(reach / total)
    return np.asarray(np.expm1(-beta * reach) / np.expm1(-beta * total))


def largest_gap(excess: Floats, beta: float, width: float, span: float) -> float:
    """Return the largest distance of the law's share from that of the ascending magnitudes (Kolmogorov's)."""
    count = len(excess)
    if width:
        values, counts = np.unique(excess, return_counts=True)
        return float(np.abs(np.cumsum(counts) / count - share_below(values, beta, width, span)).max())
    law = share_below(excess, beta, 0.0, span)
    steps = np.arange(count + 1) / count
    return float(max((steps[1:] - law).max(), (law - steps[:-1]).max()))


def drawn_excess(beta: float, width: float, span: float, shape: tuple[int, ...], rng: np.random.Generator) -> Floats:
    """Return magnitudes drawn from the law, as excess over completeness."""
    total = span + width
    uniform = rng.uniform(size=shape)
    if beta == 0.0:
        found = uniform * total
    else:
        cut = np.expm1(-beta * total) if math.isfinite(total) else -1.0
        found = -np.log1p(uniform * cut) / beta
    return np.minimum(np.floor(found / width), round(span / width) if math.isfinite(span) else math.inf) * width if width else found


def resampled_means(excess: Floats, resamples: int, seed: int) -> Floats:
    """Return the means of as many samples as asked for, each drawn from the magnitudes with replacement."""
    rng, count = np.random.default_rng(seed), len(excess)
    values, counts = np.unique(excess, return_counts=True)
    if len(values) < count // 4:  # in bins: how often each value is drawn says as much as which ones are
        return np.asarray(rng.multinomial(count, counts / count, size=resamples) @ values / count)
    at_once = max(DRAWN_AT_ONCE // count, 1)
    parts = [min(at_once, resamples - done) for done in range(0, resamples, at_once)]
    return np.concatenate([excess[rng.integers(0, count, (rows, count))].mean(axis=1) for rows in parts])


def completeness_of(magnitudes: Floats, width: float) -> float:
    """Return the magnitude of completeness by the largest curvature: two bins above the lower end of the fullest one.

    The bins are a fifth of the distance between the quartiles wide, of magnitudes in bins a whole number of theirs; neither they
    nor their places depend on the smallest or the largest magnitude.
    """
    low, high = np.quantile(magnitudes, [0.25, 0.75])
    wide = SHARE_OF_QUARTILES * float(high - low)
    if width:
        wide = max(round(wide / width), 1) * width
        phase = float(magnitudes[len(magnitudes) // 4]) - 0.5 * width  # an edge of the bins
    elif wide <= EQUAL:
        return float(magnitudes[np.searchsorted(magnitudes, low - EQUAL)])
    else:
        phase = float(low)
    place = np.floor((magnitudes - phase) / wide + (1e-9 if width else 0.0)).astype(np.int64)
    values, counts = np.unique(place, return_counts=True)
    fullest = phase + float(values[counts.argmax()]) * wide
    return fullest + BINS_ADDED * wide + 0.5 * width
