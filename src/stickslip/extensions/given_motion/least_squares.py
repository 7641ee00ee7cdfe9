"""Search for the free numbers by weighted least squares, and say how well they are determined."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.friction_model import FrictionModel
    from stickslip.extensions.given_motion.measured_rate import MeasuredRate

NUDGE = 1e-4
"""Step for derivatives of friction by what is searched (1)."""
ROUNDS = 2
"""The weights of samples, which follow from the noise of the motion, are renewed so often."""
DRAWS = 60
"""Draws of the error of the slip rate, whose effect on friction enters weights and covariance."""
SPREAD = 3.0
"""Further starts of the search lie within this factor around the given one."""
REFUSED = 1e6
"""Residual, in units of the scatter of friction, of numbers that a law refuses."""
DRAWS_OF_SHIFT = 12
"""Draws that say by how much noise of the motion shifts the numbers."""
LARGEST_SHIFT = 5.0
"""A shift by noise of the motion of more standard errors is no longer small: it is not taken off."""
LONGEST_LAG = 0.1
"""Residuals are compared with those up to this share (1) of the record later."""


def searched(model: FrictionModel, rate: MeasuredRate, limits: tuple[Floats, Floats], drawn: tuple[int, int]) -> dict[str, Any]:
    """Return what was searched, with its covariance and residuals. Raises InputError if nothing fits."""
    starts, seed = drawn
    x = _best_start(model, limits, starts, seed)
    sensor, spread, effects = _sensor_noise(model, x), np.zeros(len(model.rate)), np.zeros((0, len(model.rate)))
    for _ in range(ROUNDS if rate.draw is not None else 1):
        x = _solved(model, x, 1.0 / np.sqrt(sensor**2 + spread**2), limits)
        if rate.draw is not None:
            effects = _effects(model, x, rate, seed)
            spread = np.sqrt(np.nanmean((effects - np.nanmean(effects, axis=0)) ** 2, axis=0))
        sensor = _sensor_noise(model, x, spread)
    weight = 1.0 / np.sqrt(sensor**2 + spread**2)
    x = _solved(model, x, weight, limits)
    left = model.record.friction - model.friction(x)
    known = np.isfinite(left) & np.isfinite(weight)
    slopes = (derivatives(model, x, limits) * weight[:, None])[known]
    inverse = np.asarray(np.linalg.pinv(slopes.T @ slopes), float)
    memory = _memory((left * weight)[known], np.nan_to_num(effects * weight)[:, known])
    covariance = inverse @ (slopes.T * (np.square(sensor * weight)[known] * memory)) @ slopes @ inverse
    shift = np.zeros(len(x))
    if len(effects):
        moved = np.nan_to_num(effects * weight)[:, known] @ slopes @ inverse
        covariance = covariance + np.cov(moved, rowvar=False).reshape(len(x), len(x))
        shift = _shift(model, x, rate, (weight, inverse, seed), limits)
        shift = np.where(np.abs(shift) < LARGEST_SHIFT * np.sqrt(np.diag(covariance)), shift, 0.0)
    singular = np.linalg.svd(slopes, compute_uv=False)
    return {
        "searched": np.clip(x - shift, *limits),
        "covariance": covariance,
        "shift": shift,
        "sensor": float(np.sqrt(np.mean(sensor**2))),
        "memory": memory,
        "determined": bool(singular[-1] > 1e-8 * singular[0]),
        "on_bound": (x - limits[0] < 1e-6) | (limits[1] - x < 1e-6),
    }


def derivatives(model: FrictionModel, x: Floats, limits: tuple[Floats, Floats]) -> Floats:
    """Return the derivatives of friction by what is searched, shape (samples, numbers), by differences within the limits."""
    found = []
    for i in range(len(x)):
        ends = []
        for sign in (-1.0, 1.0):
            y = x.copy()
            y[i] = np.clip(x[i] + sign * NUDGE, limits[0][i], limits[1][i])
            ends.append(y)
        found.append((model.friction(ends[1]) - model.friction(ends[0])) / (ends[1][i] - ends[0][i]))
    return np.stack(found, axis=1)


def _residual(model: FrictionModel, x: Floats, weight: Floats) -> Floats:
    try:
        left = model.friction(x) - model.record.friction
    except InputError:
        return np.full(len(model.rate), REFUSED)
    return np.nan_to_num(left * weight, nan=0.0, posinf=REFUSED, neginf=-REFUSED)


def _solved(model: FrictionModel, x: Floats, weight: Floats, limits: tuple[Floats, Floats]) -> Floats:
    from scipy.optimize import least_squares

    def slopes(y: Floats) -> Floats:
        return np.nan_to_num(derivatives(model, y, limits) * weight[:, None])

    inside = np.clip(x, limits[0] + 1e-9, limits[1] - 1e-9)
    found = least_squares(
        lambda y: _residual(model, y, weight),
        inside,
        slopes,
        limits,
        x_scale="jac",
        xtol=1e-8,
        ftol=1e-9,
        gtol=1e-12,
        max_nfev=60,
    )
    return np.asarray(found.x)


def _best_start(model: FrictionModel, limits: tuple[Floats, Floats], starts: int, seed: int) -> Floats:
    """Return the best of some fits with equal weights, from the given start and from draws around it."""
    draw, begin = np.random.default_rng(seed), model.begin()
    weight = np.full(len(model.rate), 1.0 / (float(np.std(model.record.friction)) or 1.0))
    tried = [begin]
    for _ in range(1, starts):
        spread = draw.uniform(-np.log(SPREAD), np.log(SPREAD), len(begin))
        tried.append(np.clip(begin + spread, limits[0] + 1e-9, limits[1] - 1e-9))
    ends: list[tuple[float, int, Floats]] = []
    for one in tried:
        try:
            end = _solved(model, one, weight, limits)
        except InputError:
            continue
        ends.append((float(np.sum(_residual(model, end, weight) ** 2)), len(ends), end))
    if not ends:
        raise InputError("identify: no start leads to numbers that the law allows: give begin_at or bounds")
    return min(ends)[2]


def _sensor_noise(model: FrictionModel, x: Floats, spread: Floats | float = 0.0) -> Floats:
    """Return the standard deviation of the noise of friction at each sample: as given, or what the residuals leave for it."""
    given = model.record.friction_deviation
    if given is not None:
        return given
    left = model.record.friction - model.friction(x)
    known = np.isfinite(left)
    free = max(int(known.sum()) - len(x), 1)
    squares, others = left[known] ** 2, np.square(np.broadcast_to(spread, left.shape)[known])
    low, high = 1e-4 * float(squares.sum()) / free, float(squares.sum()) / free
    for _ in range(50):  # the size with which all residuals are as large as they should be
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(np.sum(squares / (middle + others))) > free else (low, middle)
    return np.full(len(left), float(np.sqrt(high)))


def _shift(
    model: FrictionModel, x: Floats, rate: MeasuredRate, solved: tuple[Floats, Floats, int], limits: tuple[Floats, Floats]
) -> Floats:
    """Return by how much noise of the motion has shifted what was searched: as much as more of the same noise shifts it again.

    This is one of Newton's steps for each of some draws, with derivatives along the noisier motion (Cook & Stefanski 1994, J. Am.
    Stat. Assoc. 89, 1314, to first order in the variance).
    """
    assert rate.draw is not None
    (weight, inverse, seed), found = solved, []
    draw = np.random.default_rng(seed + 1)
    for _ in range(DRAWS_OF_SHIFT // 2):
        error = rate.draw(draw)
        for sign in (1.0, -1.0):
            nudged = replace(model, rate=model.rate + sign * error)
            slopes = np.nan_to_num(derivatives(nudged, x, limits) * weight[:, None])
            left = np.nan_to_num((model.record.friction - nudged.friction(x)) * weight)
            found.append(inverse @ slopes.T @ left)
    return np.asarray(np.mean(found, axis=0))


def _effects(model: FrictionModel, x: Floats, rate: MeasuredRate, seed: int) -> Floats:
    """Return by how much draws of the error of the slip rate change friction, shape (draws, samples)."""
    assert rate.draw is not None
    draw, plain, found = np.random.default_rng(seed), model.friction(x), []
    for _ in range(DRAWS // 2):
        error = rate.draw(draw)
        found += [model.friction(x, model.rate + sign * error) - plain for sign in (1.0, -1.0)]
    return np.stack(found)


def _memory(left: Floats, effects: Floats) -> float:
    """Return how many times the variance of means of the sensor's noise is that of white noise.

    It is 1 plus twice the correlations of residuals, less what the noise of the motion explains of them.
    """
    count = len(left)
    longest = max(3, int(LONGEST_LAG * count)) // 2 * 2 + 1
    found = _autocovariance(left, longest)
    if len(effects):
        found = found - np.mean([_autocovariance(one, longest) for one in effects], axis=0)
    if not found[0] > 0.0:
        return 1.0
    found = found / found[0]
    pairs = found[1::2] + found[2::2]
    small = pairs <= 2.0 / np.sqrt(count)
    return float(max(1.0, 1.0 + 2.0 * pairs[: int(np.argmax(small)) if small.any() else None].sum()))


def _autocovariance(left: Floats, longest: int) -> Floats:
    """Return the mean products of a series with itself, so many samples later, up to a lag."""
    spectrum = np.abs(np.fft.rfft(left - left.mean(), 2 * len(left))) ** 2
    return np.asarray(np.fft.irfft(spectrum)[:longest] / len(left))
