"""How well a record determines the free numbers: covariance, intervals, profiles of the likelihood, and sentences about them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.certainty.bends import rough_words
from stickslip.extensions.inference.certainty.directions import IDLE, better_known, null_directions, told, without
from stickslip.extensions.inference.determined import UNSEEN_CHANGE, covariance_of, sizes_and_correlation, undetermined
from stickslip.extensions.inference.fit.estimate import Estimate
from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.memory import WHITE, Unevenness, spread_by, spreads_of, unevenness
from stickslip.extensions.inference.fit.model import FAILED, Model
from stickslip.extensions.inference.fit.pieces import pieces_of
from stickslip.extensions.inference.fit.progress import Tell
from stickslip.extensions.inference.record.noise import cost_of, weights
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

RTOL_OF_DERIVATIVES = 1e-10
"""Relative tolerance of the runs behind the derivatives at the best fit."""
UNSEEN_EFFECT = 3e-5
"""Profiles ignore combinations with less than this share of the largest effect: differences between runs have noise near 1e-6."""
KNOWN_TOGETHER = 0.9
"""Two numbers more correlated than this get a note if their sum, difference, product or ratio is known much better."""
AT_BOUND = 1e-4
"""A searched number closer to its bound than this lies on the bound."""
ROUGH = 0.1
"""If left and right derivatives differ by more than this share, the fit is not smooth."""
HALF, NORMAL_DEVIATE = 0.975, 1.959963984540054
"""Probability below the upper end of an interval of 95 %, and that end for a normal deviate."""
INDEPENDENT_SAMPLES = 4.0
"""At least this many independent samples beyond the free numbers are assumed; so few widen intervals by a factor of 1.4."""
GAIN = 0.02
"""A point of a profile is found when a further step gains less than this in twice the log-likelihood."""
CHORDS, PLACES = 6, 10
"""Largest number of steps with one matrix of derivatives, and of places of a profile on one side."""


@dataclass(frozen=True)
class Certainty:
    """How well a record determines the searched numbers.

    `covariance` is NaN for numbers that the record does not determine and 0 for those on a bound. `widths` are the standard
    uncertainties: infinite where the record does not determine a number, 0 on a bound. `factor` times a width is half a 95 %
    interval. `excess` is the ratio of each width to that under white noise of the same size. `notes` are sentences on what is not
    determined. `slopes` are the derivatives of the residuals with respect to the searched numbers. `uneven` says for each quantity
    how many times larger the residuals are where the run depends most on its numbers.
    """

    covariance: Floats
    widths: Floats
    correlation: Floats
    on_bound: NDArray[np.bool_]
    notes: tuple[str, ...]
    slopes: Floats
    excess: Floats
    uneven: Mapping[str, Unevenness] = field(default_factory=dict)
    factor: float = NORMAL_DEVIATE


def unknown(found: Estimate) -> Certainty:
    """Return a `Certainty` that knows nothing, as after Ctrl-C."""
    count = len(found.searched)
    nothing = np.full((count, count), np.nan)
    no = np.zeros(count, bool)
    return Certainty(nothing, np.full(count, np.inf), nothing, no, (), np.zeros((0, count)), np.ones(count))


def certainty_of(found: Estimate) -> Certainty:
    """Return how well a record determines the numbers, from derivatives and residuals at the best fit.

    Uncertainties are those of least squares under noise with the estimated correlation time. Where the residuals themselves give
    larger ones, as where a slightly wrong model misfits most at the samples that count most, these are taken (a sandwich
    covariance).
    """
    x = found.searched
    model = found.model.with_(rtol=min(RTOL_OF_DERIVATIVES, found.model.rtol)).fine(x)
    slopes, rough, rough_rows = _slopes(model, x)
    rest = model.residual(x)
    count = np.sqrt(weights(rest, found.loss))
    rest, slopes = rest * count, slopes * count[:, None]
    low, high = model.limits
    idle = np.linalg.norm(slopes, axis=0) < IDLE
    shown = np.array([not one.aside for one in model.free])
    on_bound = ~idle & shown & ((x - low < AT_BOUND) | (high - x < AT_BOUND))
    inner = np.flatnonzero(~on_bound & ~idle)
    covariance, excess, uneven = np.zeros((len(x), len(x))), np.ones(len(x)), dict[str, Unevenness]()
    moves = null_directions(model, x, slopes[:, inner], inner) if len(inner) else np.zeros((0, 0))
    if len(inner):
        seen = without(slopes[:, inner], moves)
        plain = covariance_of(seen, 1.0)[0]
        known = inner[np.isfinite(np.diag(plain))]
        covariance[np.ix_(inner, inner)] = np.nan
        covariance[np.ix_(known, known)], uneven = _covariance(model, rest, slopes[:, known], model.variance(x))
        excess[known] = np.sqrt(np.diag(covariance)[known] / np.diag(plain)[np.isfinite(np.diag(plain))])
    covariance[idle] = covariance[:, idle] = np.nan
    covariance[on_bound] = covariance[:, on_bound] = 0.0
    widths, correlation = sizes_and_correlation(covariance)
    notes = [f"{model.free[i].label} has no influence on what is fitted: fix it" for i in np.flatnonzero(idle)]
    values = model.values(x)
    notes += [_bound_note(model.free[i], values[i], at_low=bool(x[i] - low[i] < AT_BOUND)) for i in np.flatnonzero(on_bound)]
    inner = inner[shown[inner]]  # what was not asked for is last
    notes += _words(model, np.array(values), (slopes, moves[: len(inner)], covariance, correlation), inner, NORMAL_DEVIATE)
    notes += rough_words(model, x, [model.free[i].label for i in rough if i in inner], rough_rows)
    return Certainty(covariance, widths, correlation, on_bound, tuple(notes), slopes, excess, uneven)


def _covariance(model: Model, residual: Floats, slopes: Floats, variance: float) -> tuple[Floats, dict[str, Unevenness]]:
    """Return the covariance of some searched numbers from the residuals, and how uneven the residuals of each quantity are.

    `slopes` are the derivatives of the residuals with respect to these numbers; the record determines all of them. `variance`
    multiplies the covariance, besides the size of the noise.
    """
    from scipy.stats import t as student

    uneven = dict[str, Unevenness]()
    sizes = np.linalg.norm(slopes, axis=0)
    influence = (np.linalg.pinv(slopes / sizes, rcond=UNSEEN_CHANGE) / sizes[:, None]).T
    factor = (
        math.sqrt(variance) * float(student.ppf(HALF, max(model.independent - len(sizes), INDEPENDENT_SAMPLES))) / NORMAL_DEVIATE
    )
    if model.of_means:
        return np.asarray(factor**2 * influence.T @ influence), uneven
    before = influence[model.samples :]
    total, more = model.inflation * before.T @ before, np.zeros(len(sizes))
    for name, rest, rows, weight, blocks in pieces_of(model, residual, np.hstack([influence, slopes])):
        rest, shares, by = rest / weight, rows[:, : len(sizes)] * weight[:, None], rows[:, len(sizes) :] / weight[:, None]
        memory = model.memory.get(name, WHITE)
        noise, uneven[name] = spread_by(shares, memory, blocks), unevenness(rest, by, memory, blocks)
        total = total + noise
        if memory.time > 0.0 or uneven[name].found > 1.0:
            seen = np.max([np.diag(one) for one in spreads_of(shares, rest, blocks)], axis=0)
            more += np.maximum(seen - np.diag(noise), 0.0)
    wider = factor * np.sqrt(1.0 + more / np.diag(total))
    return np.asarray(total * np.outer(wider, wider)), uneven


def _words(
    model: Model, values: Floats, found: tuple[Floats, Floats, Floats, Floats], inner: NDArray[np.intp], factor: float
) -> list[str]:
    slopes, moves, covariance, correlation = found
    slopes, correlation = slopes[:, inner], correlation[np.ix_(inner, inner)].copy()
    labels, free = [model.free[i].label for i in inner], [model.free[i] for i in inner]
    declared = list(model.problem.parameters)
    order = sorted(range(len(inner)), key=lambda i: declared.index(free[i].name) if free[i].name in declared else len(declared))
    words, open_sets = [], []
    for numbers, text in told([labels[i] for i in order], moves[order], slopes[:, order], factor):
        numbers = [order[i] for i in numbers]
        if text and all(free[i].log for i in numbers):
            words.append(text)
        else:
            open_sets.append([labels[i] for i in sorted(numbers)])
    for i, j in np.argwhere(np.abs(np.triu(correlation, 1)) > KNOWN_TOGETHER).tolist():
        alike = free[i].declared.unit == free[j].declared.unit and free[i].name.partition(".")[0] == free[j].name.partition(".")[0]
        chosen = inner[[i, j]]
        text = better_known(values[chosen], covariance[np.ix_(chosen, chosen)], (labels[i], labels[j]), alike=alike)
        if text and free[i].log and free[j].log:
            words.append(f"the record determines {text} ({labels[i]} and {labels[j]} have the correlation {correlation[i, j]:.4f})")
            correlation[i, j] = 0.0
    sizes = {one.label: one.width(values[k], math.sqrt(covariance[k, k])) for k, one in zip(inner, free, strict=True)}
    texts = undetermined(dict(zip(labels, values[inner], strict=True)), sizes, correlation, open_sets)
    return words + [
        one.replace("the points do", "the record does").replace("the points determine", "the record determines") for one in texts
    ]


def _bound_note(free: Free, value: float, *, at_low: bool) -> str:
    end = "lower" if at_low else "upper"
    why = "its bounds" if free.bounded else "the range that is searched"
    return f"{free.label} lies on the {end} end of {why}, {brief(value, free.declared.unit)}: no value inside fits better"


def _slopes(model: Model, x: Floats) -> tuple[Floats, list[int], NDArray[np.bool_]]:
    """Return the derivatives of the residuals, the numbers whose change does not change them smoothly, and the rows where.

    If a jump of the run passes a sample within the step of the differences, this sample has no derivative. Its row is then 0: the
    sample does not add to the curvature, which makes intervals too wide rather than too narrow.
    """
    if model.of_means:
        by = model.jacobian(x)
        return by, [], np.zeros(len(by), bool)
    right, left = model.jacobian(x, sides=(1.0,)), model.jacobian(x, sides=(-1.0,))
    right, left = np.where(right.any(axis=0), right, left), np.where(left.any(axis=0), left, right)  # a limit leaves one side only
    size, apart = np.maximum(np.abs(right), np.abs(left)), np.abs(right - left)
    seen = np.linalg.norm(right + left, axis=0) > 2.0 * IDLE  # any other column is only noise of the runs
    rough = (apart > 0.5 * size) & (size > 1e-3 * np.max(size, axis=0, initial=0.0)) & seen
    total = np.linalg.norm(0.5 * (right + left), axis=0)
    bent = np.flatnonzero((total > 0.0) & (np.linalg.norm(apart, axis=0) > ROUGH * total)).tolist()
    return np.where(rough.any(axis=1)[:, None], 0.0, 0.5 * (right + left)), bent, rough.any(axis=1)


@dataclass(frozen=True)
class Profile:
    """The likelihood along one number (SI, ascending), with all others fitted anew.

    `rise` is twice the fall of the log-likelihood from the best fit, for the number of independent samples. `low` and `high` are
    the ends of the 95 % interval: infinite, or a bound, where the likelihood never falls that far.
    """

    name: str
    values: Floats
    rise: Floats
    low: float
    high: float


def profile_of(found: Estimate, sure: Certainty, column: int, tell: Tell) -> Profile:
    """Return the profile of the likelihood along one free number."""
    x, free = found.searched, found.model.free[column]
    tell(f"profile of {free.label}")
    least = found.cost(x)
    width = float(sure.widths[column])
    places: list[tuple[float, float]] = [(float(x[column]), 0.0)]
    ends = []
    for side in (-1.0, 1.0):
        if not (np.isfinite(width) and width > 0.0):
            ends.append(math.nan)
            continue
        ends.append(_end(found, sure, (column, side, least), places))
    places.sort()
    natural = [free.natural(end) if np.isfinite(end) else end for end in ends]
    at = np.array([free.natural(one) for one, _ in places])
    return Profile(free.label, at, np.array([rise for _, rise in places]), *natural)


def _end(found: Estimate, sure: Certainty, what: tuple[int, float, float], places: list[tuple[float, float]]) -> float:
    """Return one end of the interval, as a searched number."""
    column, side, least = what
    model, best = found.model, found.searched
    low, high = (end[column] for end in model.limits)
    width, excess, wanted = float(sure.widths[column]), float(sure.excess[column]), sure.factor
    inner, inner_root = 0.0, 0.0
    outer, outer_root = math.inf, math.inf
    distance = wanted * width
    for _ in range(PLACES):
        target = float(np.clip(best[column] + side * distance, low, high))
        cost = _least_with(found, sure, column, target)
        root = math.sqrt(max(cost - least, 0.0)) / excess
        places.append((target, root**2))
        reached = abs(target - best[column])
        if abs(root - wanted) < 0.02 * wanted:
            return target
        if root < wanted:
            if target in (low, high):
                return target
            inner, inner_root = reached, root
        else:
            outer, outer_root = reached, root
        if math.isfinite(outer):
            share = (wanted - inner_root) / (outer_root - inner_root) if outer_root < 1e3 * wanted else 0.5
            distance = inner + min(max(share, 0.1), 0.9) * (outer - inner)
        else:
            distance = reached * min(max(wanted / max(root, 1e-6), 1.2), 3.0)
    return float(best[column] + side * distance)


def _least_with(found: Estimate, sure: Certainty, column: int, target: float) -> float:
    """Return the least cost with one searched number fixed."""
    model, best = found.model, found.searched
    others = np.array([i for i in range(len(best)) if i != column and np.isfinite(sure.widths[i]) and not sure.on_bound[i]], int)
    covariance, x = sure.covariance, best.copy()
    x[others] += covariance[others, column] / covariance[column, column] * (target - best[column])
    low, high = model.limits
    x = np.clip(x, low, high)
    x[column] = target
    slopes, rest = sure.slopes, model.residual(x)
    cost, renewed = cost_of(rest, found.loss), False
    for _ in range(CHORDS if len(others) else 0):
        trial = x.copy()
        trial[others] -= np.linalg.lstsq(slopes[:, others], rest, rcond=UNSEEN_EFFECT)[0]
        trial[others] = np.clip(trial[others], low[others], high[others])
        trial_rest = model.residual(trial)
        gain = cost - cost_of(trial_rest, found.loss)
        if gain > 0.0:
            x, rest, cost = trial, trial_rest, cost - gain
        if gain <= GAIN:
            if renewed or gain >= 0.0 or np.all(np.abs(rest) >= FAILED):
                break
            slopes, renewed = model.jacobian(x, sides=(1.0,)), True
    return cost
