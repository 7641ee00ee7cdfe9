"""What a least-squares fit leaves: how long it remembers itself, how sure numbers are in spite of that, and whether it is noise.

The fit itself is plain least squares: weights that follow from what is left would let a misfit choose what is fitted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats

FORGOTTEN = 0.02
"""Correlation of neighbouring samples below which noise counts as white."""
UNSEEN = 1e-9
"""Eigenvalue of the normal matrix, whose diagonal is 1, below which a combination is not determined."""
LONGEST = 1.0 / 8.0
"""Longest time of correlation that is looked for, as a share of the longest part of a record: what lasts longer is a misfit."""
COARSER, MOST_BINS = 4, 64
"""Factor between numbers of samples over which residuals are averaged, and least number of such means."""
RESOLVED, LONGER = 2.0, 2.0
"""Number of means within the time of correlation from which it counts as found, and factor by which it must be longer."""
SPREAD = 8
"""Share of a block, 1/SPREAD, up to which sums of neighbouring samples are compared with chance."""
CHANCE = 1e-4
"""Probability with which noise of one size may look larger where the run changes than elsewhere."""
ACTIVE = 0.5
"""Share of all that determines the numbers which the active samples hold."""


class Block(NamedTuple):
    """Residuals that follow each other in time: their indices among all, and their times (s)."""

    rows: slice
    time: Floats


class Memory(NamedTuple):
    """What is known of residuals as noise.

    `time` is the time over which they remember themselves (s; 0 for white noise); `size` is the standard deviation of the part
    that does, and `white` of the part that does not; for white noise `size` is 0.
    """

    time: float
    size: float
    white: float

    @property
    def total(self) -> float:
        """The standard deviation of both parts together."""
        return math.hypot(self.size, self.white)


WHITE = Memory(0.0, 0.0, 1.0)
"""White noise of the size that was assumed."""


def independent(time: Floats, memory: Memory) -> float:
    """Return how many independent samples there are among those at some times, as many as the memory of the noise leaves."""
    if memory.time <= 0.0 or len(time) < 2 or memory.total == 0.0:
        return float(len(time))
    rho = math.exp(-float(np.median(np.diff(time))) / memory.time)
    share = (memory.size / memory.total) ** 2
    return max(1.0, len(time) / (1.0 + share * 2.0 * rho / (1.0 - rho)))


def memory_of(residual: Floats, slopes: Floats, blocks: Sequence[Block]) -> Memory:
    """Return the memory of residuals by restricted maximum likelihood; white noise if that explains them as well.

    `slopes` are the derivatives of the residuals with respect to the parameters that were fitted, shape (n, p): what the fit took
    from the noise is allowed for (Patterson & Thompson 1971, Biometrika 58, 545). The noise is white, with another on top whose
    correlation falls as exp(-dt/time): means over more and more samples show it below the white one.
    """
    slopes = independent_columns(slopes)
    total, width = rms(residual, slopes), 1
    found = Memory(0.0, 0.0, total)
    while True:
        rest, by, binned = (residual, slopes, blocks) if width == 1 else _means(residual, slopes, blocks, width)
        if len(rest) < max(MOST_BINS if width > 1 else 0, slopes.shape[1] + 10):
            return found
        time, size = _correlation(rest, by, binned)
        step = float(np.median(np.concatenate([np.diff(one.time) for one in binned])))
        if time > LONGER * found.time and (width == 1 or time > RESOLVED * step):
            slow = max(size**2 - total**2 / width, 0.0) * width / (width - 1.0) if width > 1 else size**2
            found = Memory(time, math.sqrt(slow), math.sqrt(max(total**2 - slow, 0.0)) if width > 1 else 0.0)
        width *= COARSER


def _means(residual: Floats, slopes: Floats, blocks: Sequence[Block], width: int) -> tuple[Floats, Floats, list[Block]]:
    """Return means of residuals and of derivatives over so many neighbouring samples of one block, and their blocks."""
    rests, by, found, count = [residual[:0]], [slopes[:0]], list[Block](), 0
    for rows, time in blocks:
        n = len(time) // width
        if n < 2:
            continue
        end = rows.start + n * width
        rests.append(residual[rows.start : end].reshape(n, width).mean(axis=1))
        by.append(slopes[rows.start : end].reshape(n, width, -1).mean(axis=1))
        found.append(Block(slice(count, count + n), time[: n * width].reshape(n, width).mean(axis=1)))
        count += n
    return np.concatenate(rests), np.concatenate(by), found


def _correlation(residual: Floats, slopes: Floats, blocks: Sequence[Block]) -> tuple[float, float]:
    """Return the time of correlation of first-order autoregressive noise, 0 if white noise explains it as well, and its size."""
    from scipy.optimize import minimize_scalar

    n, p = slopes.shape
    steps = np.concatenate([np.diff(time) for _, time in blocks])
    usual, longest = float(np.median(steps)), LONGEST * max(float(np.ptp(time)) for _, time in blocks)

    def criterion(log_time: float) -> float:
        time = math.exp(log_time)
        white, by = whitened(residual, blocks, time), whitened(slopes, blocks, time)
        size, log_det = _size_and_determinant(white, by)
        spread = sum(float(np.sum(np.log1p(-np.exp(-2.0 * np.diff(one) / time)))) for _, one in blocks)
        return float(2.0 * (n - p) * math.log(max(size, 1e-300)) + spread + log_det)

    size, log_det = _size_and_determinant(residual, slopes)
    white = 2.0 * (n - p) * math.log(max(size, 1e-300)) + log_det
    shortest = usual / -math.log(FORGOTTEN)
    if longest <= shortest:
        return 0.0, size
    found = minimize_scalar(criterion, bounds=(math.log(shortest), math.log(longest)), method="bounded", options={"xatol": 0.01})
    if found.fun > white - math.log(n):
        return 0.0, size
    time = math.exp(found.x)
    return time, rms(whitened(residual, blocks, time), whitened(slopes, blocks, time))


def whitened(residual: Floats, blocks: Sequence[Block], time: float) -> Floats:
    """Return residuals, or derivatives of residuals, less what the sample before tells of each.

    They are those of a first-order autoregressive noise whose correlation falls as exp(-dt/time), of variance 1 before and after.
    """
    result = residual.copy()
    for rows, times in blocks:
        rho = np.exp(-np.diff(times) / time)
        rho = rho[:, None] if residual.ndim == 2 else rho
        part = residual[rows]
        result[rows][1:] = (part[1:] - rho * part[:-1]) / np.sqrt(1.0 - rho**2)
    return result


def independent_columns(slopes: Floats) -> Floats:
    """Return columns of unit length, and at right angles, for all that the parameters can change together."""
    sizes = np.linalg.norm(slopes, axis=0)
    left, seen, _ = np.linalg.svd(slopes[:, sizes > 0.0] / sizes[sizes > 0.0], full_matrices=False)
    return np.asarray(left[:, seen**2 > UNSEEN])


def rms(residual: Floats, slopes: Floats) -> float:
    """Return the size of residuals after a linear fit of the parameters, whose derivatives are `slopes`."""
    return _size_and_determinant(residual, slopes)[0]


def _size_and_determinant(residual: Floats, slopes: Floats) -> tuple[float, float]:
    """Return the size of residuals after a linear fit of the parameters, and the logarithm of the normal matrix's determinant."""
    n = len(residual)
    total = float(residual @ residual)
    sizes = np.linalg.norm(slopes, axis=0)
    used = slopes[:, sizes > 0.0] / sizes[sizes > 0.0]
    if not used.shape[1]:
        return math.sqrt(total / max(n, 1)), 0.0
    spectrum, vectors = np.linalg.eigh(used.T @ used)
    seen = spectrum > UNSEEN
    along = vectors[:, seen].T @ (used.T @ residual)
    taken = float(np.sum(along**2 / spectrum[seen]))
    log_det = float(np.sum(np.log(np.maximum(spectrum, UNSEEN)))) + 2.0 * float(np.sum(np.log(sizes[sizes > 0.0])))
    return math.sqrt(max(total - taken, 0.0) / max(n - used.shape[1], 1)), log_det


def spread_by(influence: Floats, memory: Memory, blocks: Sequence[Block]) -> Floats:
    """Return the covariance of numbers that noise with a memory makes, shape (p, p); `influence` of each sample has shape (n, p).

    That is influence.T C influence, with the covariance of the noise C, whose product is a recurrence along the samples.
    """
    from scipy.linalg import solve_banded

    rows = [one.rows for one in blocks]
    found = memory.white**2 * sum(influence[one].T @ influence[one] for one in rows)
    if memory.time > 0.0:
        for one, time in blocks:
            part, rho = influence[one], np.exp(-np.diff(time) / memory.time)
            before = solve_banded((1, 0), np.vstack([np.ones(len(time)), np.append(-rho, 0.0)]), part)  # sums of earlier samples
            both = part.T @ before
            found = found + memory.size**2 * (both + both.T - part.T @ part)
    return np.asarray(found)


def spreads_of(influence: Floats, residual: Floats, blocks: Sequence[Block]) -> list[Floats]:
    """Return covariances of numbers, each of shape (p, p), from what is left itself, for sums over more and more samples.

    Where residuals are largest where they count most, these are larger than noise of one size makes them (White 1980, Econometrica
    48, 817; Newey & West 1987, Econometrica 55, 703, with Bartlett's weights).
    """
    n, p = influence.shape
    parts = [influence[rows] * residual[rows, None] for rows, _ in blocks]
    longest = max(len(part) for part in parts) // SPREAD
    found, width = list[Floats](), 1
    while width <= max(longest, 1):
        total = np.zeros((p, p))
        for part in parts:
            sums, at = np.vstack([np.zeros(p), np.cumsum(part, axis=0)]), np.arange(1, len(part) + width)
            within = sums[np.minimum(at, len(part))] - sums[np.maximum(at - width, 0)]
            total += within.T @ within / width
        found.append(total * n / max(n - p, 1))
        width *= 2
    return found


def unevenness(residual: Floats, slopes: Floats, memory: Memory, blocks: Sequence[Block]) -> float:
    """Return how many times larger residuals are where the run depends most on its numbers than elsewhere; 1 if chance explains it.

    Noise does not know where the run changes; what the law, the loading or the machine cannot follow does.
    """
    from scipy.stats import f

    columns = independent_columns(slopes)
    if not columns.shape[1] or len(residual) < 4 * columns.shape[1] + 20:
        return 1.0
    leverage = np.sum(columns**2, axis=1)
    order = np.argsort(leverage)[::-1]
    active = order[: int(np.searchsorted(np.cumsum(leverage[order]), ACTIVE * leverage.sum())) + 1]
    rest = np.delete(residual, active)
    share = sum(independent(time, memory) for _, time in blocks) / len(residual)
    freedom = [max(1.0, share * len(one)) for one in (active, rest)]
    quiet = float(np.mean(rest**2))
    ratio = float(np.mean(residual[active] ** 2)) / quiet if quiet > 0.0 else 1.0
    return math.sqrt(ratio) if ratio > 1.0 and float(f.sf(ratio, *freedom)) < CHANCE else 1.0
