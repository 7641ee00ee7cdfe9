"""Residuals of a least-squares fit: their correlation time ("memory"), the uncertainty it causes, and whether they are noise.

The fit itself is plain least squares: if weights followed from the residuals, a misfit would choose which samples count.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats

FORGOTTEN = 0.02
"""Noise is white if neighbouring samples are less correlated than this."""
UNSEEN_EIGENVALUE = 1e-9
"""A combination of numbers is undetermined if its eigenvalue of the normal matrix (diagonal 1) is below this."""
LONGEST_MEMORY = 1.0 / 8.0
"""Longest correlation time considered, as a share of the longest part of a record; anything longer is a misfit, not noise."""
SAMPLES_OF_MEMORY = 4000
"""Largest number of samples to estimate the memory from; if there are more, means over neighbours are used."""
TIMES, SHARES = (2.0, 8.0, 32.0, 128.0), (0.05, 0.5, 0.9)
"""Starting values for the correlation time (samples) and for the share of white noise."""
SPREAD = 8
"""Sums over neighbouring samples extend over at most 1/SPREAD of a block."""
CHANCE = 1e-4
"""Significance level of the test whether residuals are larger where the run changes than elsewhere."""
ACTIVE = 0.5
"""The active samples are those with the largest leverage, which together have this share of it."""
ACTIVE_SAMPLES = 3
"""With fewer active samples than this, or fewer others, nothing is said: their second differences have no mean."""


class ResidualBlock(NamedTuple):
    """Residuals that follow each other in time: their indices among all, and their times (s)."""

    rows: slice
    time: Floats


class Memory(NamedTuple):
    """The noise in residuals: a correlated part and a white part.

    `time` is the correlation time (s; 0 if all noise is white), `size` the standard deviation of the correlated part (0 if all
    noise is white), and `white` that of the white part.
    """

    time: float
    size: float
    white: float

    @property
    def total(self) -> float:
        """The standard deviation of both parts together."""
        return math.hypot(self.size, self.white)


WHITE = Memory(0.0, 0.0, 1.0)
"""White noise of the assumed size."""


def independent(time: Floats, memory: Memory) -> float:
    """Return the effective number of independent samples at some times, given the memory of the noise."""
    if memory.time <= 0.0 or len(time) < 2 or memory.total == 0.0:
        return float(len(time))
    rho = math.exp(-float(np.median(np.diff(time))) / memory.time)
    share = (memory.size / memory.total) ** 2
    return max(1.0, len(time) / (1.0 + share * 2.0 * rho / (1.0 - rho)))


def memory_of(residual: Floats, slopes: Floats, blocks: Sequence[ResidualBlock]) -> Memory:
    """Return the memory of residuals by restricted maximum likelihood; white noise if that explains them as well.

    `slopes` are the derivatives of the residuals with respect to the fitted parameters, shape (n, p): they allow for the noise that
    the fit has absorbed (Patterson & Thompson 1971, Biometrika 58, 545). The noise is the sum of white noise and of noise with the
    correlation exp(-dt/time).
    """
    from scipy.optimize import minimize

    width = -(-len(residual) // SAMPLES_OF_MEMORY)
    if width > 1:
        residual, slopes, blocks = _means(residual, slopes, blocks, width)
    slopes = independent_columns(slopes)
    n, p = slopes.shape
    white = rms(residual, slopes)
    steps = np.concatenate([np.diff(time) for _, time in blocks]) if blocks else np.zeros(0)
    alone = Memory(0.0, 0.0, white * math.sqrt(width))
    if n < p + 10 or not len(steps) or white == 0.0:
        return alone
    usual, longest = float(np.median(steps)), LONGEST_MEMORY * max(float(np.ptp(time)) for _, time in blocks)
    shortest = usual / -math.log(FORGOTTEN)
    if longest <= shortest:
        return alone

    def criterion(x: Floats) -> float:
        return _restricted(residual, slopes, blocks, math.exp(x[0]), float(x[1]))[0]

    bounds = [(math.log(shortest), math.log(longest)), (0.0, 0.99)]
    starts = [(math.log(min(max(time * usual, shortest), longest)), share) for time in TIMES for share in SHARES]
    begin = min(starts, key=lambda x: criterion(np.array(x)))
    found = minimize(criterion, begin, method="Nelder-Mead", bounds=bounds, options={"xatol": 0.02, "fatol": 0.05, "maxfev": 80})
    if found.fun > 2.0 * (n - p) * math.log(white) - 2.0 * math.log(n):
        return alone
    time, share = math.exp(found.x[0]), float(found.x[1])
    size = _restricted(residual, slopes, blocks, time, share)[1]
    return Memory(time, size * math.sqrt(1.0 - share), size * math.sqrt(share * width))


def _restricted(
    residual: Floats, slopes: Floats, blocks: Sequence[ResidualBlock], time: float, share: float
) -> tuple[float, float]:
    """Return minus twice the logarithm of the restricted likelihood, up to a constant, and the size of the noise.

    `slopes` are orthonormal, so that white noise has the criterion 2 (n - p) log(size). A `share` w of the variance is white; the
    rest has the covariance A with the tridiagonal inverse T. Hence ((1 - w) A + w)^-1 is ((1 - w) + w T)^-1 T.
    """
    from scipy.linalg import cho_solve_banded, cholesky_banded

    rho = np.concatenate([np.append(np.exp(-np.diff(times) / time), 0.0) for _, times in blocks])[:-1]
    left = rho / (1.0 - rho**2)
    diagonal = 1.0 + np.append(0.0, left * rho) + np.append(left * rho, 0.0)
    values = np.column_stack([residual, slopes])
    after = diagonal[:, None] * values
    after[1:] -= left[:, None] * values[:-1]
    after[:-1] -= left[:, None] * values[1:]
    root = cholesky_banded(np.vstack([np.append(0.0, -share * left), 1.0 - share + share * diagonal]))
    square = values.T @ cho_solve_banded((root, False), after)
    log_det = 2.0 * float(np.sum(np.log(root[1]))) + float(np.sum(np.log1p(-(rho**2))))
    n, p = slopes.shape
    inner = square[1:, 1:]
    total = float(square[0, 0] - square[0, 1:] @ np.linalg.solve(inner, square[1:, 0])) if p else float(square[0, 0])
    total = max(total, 1e-300)
    return (n - p) * math.log(total / (n - p)) + log_det + float(np.linalg.slogdet(inner)[1]), math.sqrt(total / (n - p))


def _means(
    residual: Floats, slopes: Floats, blocks: Sequence[ResidualBlock], width: int
) -> tuple[Floats, Floats, list[ResidualBlock]]:
    """Return means of residuals and of derivatives over so many neighbouring samples of one block, and their blocks."""
    rests, by, found, count = [residual[:0]], [slopes[:0]], list[ResidualBlock](), 0
    for rows, time in blocks:
        n = len(time) // width
        end = rows.start + n * width
        rests.append(residual[rows.start : end].reshape(n, width).mean(axis=1))
        by.append(slopes[rows.start : end].reshape(n, width, slopes.shape[1]).mean(axis=1))
        found.append(ResidualBlock(slice(count, count + n), time[: n * width].reshape(n, width).mean(axis=1)))
        count += n
    return np.concatenate(rests), np.concatenate(by), [one for one in found if len(one.time)]


def independent_columns(slopes: Floats) -> Floats:
    """Return orthonormal columns that span all changes of the residuals by the parameters."""
    sizes = np.linalg.norm(slopes, axis=0)
    left, seen, _ = np.linalg.svd(slopes[:, sizes > 0.0] / sizes[sizes > 0.0], full_matrices=False)
    return np.asarray(left[:, seen**2 > UNSEEN_EIGENVALUE])


def rms(residual: Floats, slopes: Floats) -> float:
    """Return the size of residuals after a linear fit of the parameters, whose derivatives are `slopes`."""
    used = independent_columns(slopes)
    along = used.T @ residual
    return math.sqrt(max(float(residual @ residual - along @ along), 0.0) / max(len(residual) - used.shape[1], 1))


def spread_by(influence: Floats, memory: Memory, blocks: Sequence[ResidualBlock]) -> Floats:
    """Return the covariance of numbers under noise with a memory, shape (p, p); `influence` of each sample has shape (n, p).

    That is influence.T C influence with the covariance C of the noise. A recurrence along the samples gives the product with C.
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


def spreads_of(influence: Floats, residual: Floats, blocks: Sequence[ResidualBlock]) -> list[Floats]:
    """Return covariances of numbers from the residuals themselves, each of shape (p, p), for sums over more and more samples.

    They exceed the covariance under noise of uniform size if residuals are largest at the samples that count most (White 1980,
    Econometrica 48, 817; Newey & West 1987, Econometrica 55, 703, with Bartlett's weights).
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


class Unevenness(NamedTuple):
    """How many times larger residuals are where a run depends most on its numbers than elsewhere; 1 if chance explains it.

    `misfit` is the part of this factor that larger noise from sample to sample does not explain.
    """

    found: float
    misfit: float


EVEN = Unevenness(1.0, 1.0)


def unevenness(residual: Floats, slopes: Floats, memory: Memory, blocks: Sequence[ResidualBlock]) -> Unevenness:
    """Return how uneven residuals are; `slopes` are their derivatives with respect to the numbers, shape (n, p).

    Noise does not depend on where the run changes; a misfit of law, loading or machine does.
    """
    from scipy.stats import f

    columns = independent_columns(slopes)
    if not columns.shape[1] or len(residual) < 4 * columns.shape[1] + 20:
        return EVEN
    leverage = np.sum(columns**2, axis=1)
    order = np.argsort(leverage)[::-1]
    last = int(np.searchsorted(np.cumsum(leverage[order]), ACTIVE * leverage.sum())) + 1
    active, rest = residual[np.sort(order[:last])], residual[np.sort(order[last:])]
    if min(len(active), len(rest)) < ACTIVE_SAMPLES:
        return EVEN
    share = sum(independent(time, memory) for _, time in blocks) / len(residual)
    freedom = [max(1.0, share * len(one)) for one in (active, rest)]
    quiet, noise = max(float(np.mean(rest**2)), 1e-300), max(float(np.mean(np.diff(rest, 2) ** 2)), 1e-300)
    ratio = float(np.mean(active**2)) / quiet
    net = ratio / max(float(np.mean(np.diff(active, 2) ** 2)) / noise, 1.0)  # noise from sample to sample is no misfit
    return Unevenness(*(math.sqrt(one) if one > 1.0 and float(f.sf(one, *freedom)) < CHANCE else 1.0 for one in (ratio, net)))
