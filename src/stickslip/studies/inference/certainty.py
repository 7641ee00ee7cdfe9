"""What a record determines of the free numbers: covariance, intervals, profiles of the likelihood, and words."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.determined import covariance_of, sizes_and_correlation, undetermined
from stickslip.foundation.formatting import brief
from stickslip.studies.inference.estimate import Estimate
from stickslip.studies.inference.free import Free
from stickslip.studies.inference.losses import cost_of, weights
from stickslip.studies.inference.model import FAILED, Model
from stickslip.studies.inference.search import Tell

Floats = NDArray[np.float64]

EXACT = 1e-10
"""Relative tolerance of the runs from which derivatives at the best fit are taken."""
UNSEEN = 3e-5
"""Effect of a combination, as a share of the largest, below which the record does not see it: noise of differences is near 1e-6."""
IDLE = 0.1
"""Effect of a factor e on all residuals together, in standard deviations, below which a number has no influence."""
AT_BOUND = 1e-4
"""Distance from a bound, in searched numbers, at which a number lies on it."""
ROUGH = 0.1
"""Difference of derivatives to one side from those to both, as a share, from which the fit is not smooth."""
HALF = 0.975
"""Probability below the upper end of an interval of 95 %."""
GAIN = 0.02
"""Fall of twice the logarithm of the likelihood below which a place of a profile is found."""
CHORDS, PLACES = 6, 10
"""Largest number of steps with one matrix of derivatives, and of places of a profile on one side."""


@dataclass(frozen=True)
class Certainty:
    """What a record determines.

    Parameters
    ----------
    covariance
        Covariance of the searched numbers, NaN for those that are not determined and 0 for those on a bound.
    widths
        Their standard uncertainties, infinite where the record does not determine a number, 0 on a bound.
    correlation
        Their correlations.
    factor
        Half the width of an interval of 95 %, in standard uncertainties.
    on_bound
        True for numbers that lie on a bound.
    notes
        Sentences on what is not determined.
    slopes
        Derivatives of the residuals with respect to the searched numbers.
    """

    covariance: Floats
    widths: Floats
    correlation: Floats
    factor: float
    on_bound: NDArray[np.bool_]
    notes: tuple[str, ...]
    slopes: Floats


def certainty_of(found: Estimate) -> Certainty:
    """Return what a record determines at a best fit, from the curvature of the sum of squares."""
    from scipy.stats import t as student

    model, x = found.model.with_(rtol=min(EXACT, found.model.rtol)), found.searched
    slopes, smooth_notes = _slopes(model, x)
    slopes *= np.sqrt(weights(model.residual(x), found.loss))[:, None]
    low, high = model.limits
    idle = np.linalg.norm(slopes, axis=0) < IDLE
    on_bound = ~idle & ((x - low < AT_BOUND) | (high - x < AT_BOUND))
    inner = np.flatnonzero(~on_bound & ~idle)
    covariance = np.zeros((len(x), len(x)))
    part, unseen = covariance_of(slopes[:, inner], 1.0, UNSEEN) if len(inner) else (np.zeros((0, 0)), [])
    covariance[np.ix_(inner, inner)] = part
    covariance[idle] = covariance[:, idle] = np.nan
    covariance[on_bound] = covariance[:, on_bound] = 0.0
    widths, correlation = sizes_and_correlation(covariance)
    free = model.free
    values = dict(zip([one.label for one in free], model.values(x), strict=True))
    notes = [f"{free[i].label} has no influence on what is fitted: fix it" for i in np.flatnonzero(idle)]
    notes += [_bound_note(free[i], values[free[i].label], at_low=bool(x[i] - low[i] < AT_BOUND)) for i in np.flatnonzero(on_bound)]
    labels = [free[i].label for i in inner]
    sizes = {free[i].label: free[i].width(values[free[i].label], float(widths[i])) for i in inner}
    seen_correlation = correlation[np.ix_(inner, inner)]
    texts = undetermined(
        {one: values[one] for one in labels}, sizes, seen_correlation, [[labels[i] for i in one] for one in unseen]
    )
    notes += [
        text.replace("the points do", "the record does").replace("the points determine", "the record determines") for text in texts
    ]
    notes += [text for i, text in smooth_notes.items() if i in inner]
    degrees = max(_independent(model) - len(inner), 1.0)
    return Certainty(covariance, widths, correlation, float(student.ppf(HALF, degrees)), on_bound, tuple(notes), slopes)


def _bound_note(free: Free, value: float, *, at_low: bool) -> str:
    end = "lower" if at_low else "upper"
    why = "its bounds" if free.bounded else "the range that is searched"
    return f"{free.label} lies on the {end} end of {why}, {brief(value, free.declared.unit)}: no value inside fits better"


def _slopes(model: Model, x: Floats) -> tuple[Floats, dict[int, str]]:
    """Return the derivatives of the residuals, and a sentence for each number with which they do not change smoothly.

    A sample that a jump of the run passes within the step of the differences has no derivative with respect to any number: its row
    is 0, so that what such samples tell is left out of the curvature, and intervals are rather too wide.
    """
    right, left = model.jacobian(x, sides=(1.0,)), model.jacobian(x, sides=(-1.0,))
    size, apart = np.maximum(np.abs(right), np.abs(left)), np.abs(right - left)
    rough = (apart > 0.5 * size) & (size > 1e-3 * np.max(size, axis=0, initial=0.0))
    notes = {}
    for i in range(len(x)):
        total = float(np.linalg.norm(0.5 * (right[:, i] + left[:, i])))
        if total > 0.0 and float(np.linalg.norm(apart[:, i])) > ROUGH * total:
            notes[i] = (
                f"the run does not change smoothly with {model.free[i].label}, as where a slip event passes a sample; "
                "such samples are left out of its interval, which is rough: a profile tells more"
            )
    return np.where(rough.any(axis=1)[:, None], 0.0, 0.5 * (right + left)), notes


def _independent(model: Model) -> float:
    """Return how many independent samples there are, as many as the memory of the noise leaves."""
    count = 0.0
    for i in range(len(model.parts)):
        for name, block in model.blocks(i):
            n, memory = len(block.time), model.memory.get(name, 0.0)
            if memory > 0.0 and n > 1:
                rho = math.exp(-float(np.median(np.diff(block.time))) / memory)
                n = max(1.0, n * (1.0 - rho) / (1.0 + rho))  # type: ignore[assignment]
            count += n
    return count


@dataclass(frozen=True)
class Profile:
    """The likelihood along one number, with all others fitted anew.

    Parameters
    ----------
    name
        The number.
    values
        Its values (SI), ascending.
    rise
        Twice the logarithm of the likelihood below that of the best fit, at each value.
    low, high
        Ends of the interval of 95 % (SI); infinite or a bound where the rise is never reached.
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
    """Return the searched number on one side at which the likelihood has fallen to the end of the interval."""
    column, side, least = what
    model, best = found.model, found.searched
    low, high = (end[column] for end in model.limits)
    width, wanted = float(sure.widths[column]), sure.factor
    inner, inner_root = 0.0, 0.0
    outer, outer_root = math.inf, math.inf
    distance = wanted * width
    for _ in range(PLACES):
        target = float(np.clip(best[column] + side * distance, low, high))
        cost = _least_with(found, sure, column, target)
        root = math.sqrt(max(cost - least, 0.0))
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
        trial[others] -= np.linalg.lstsq(slopes[:, others], rest, rcond=UNSEEN)[0]
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
