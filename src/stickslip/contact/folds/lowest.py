"""Proven bounds of the smallest g' = Z + S dmu/dv over all slip rates, by branch and bound with interval arithmetic.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.equation import Resistance
from stickslip.contact.folds.certified import MOST_EVALUATIONS, Verdict
from stickslip.contact.folds.slope_bounds import Cells, Floats, Looks, SlopeBounds, joined
from stickslip.friction.formula.enclosure import NotEnclosedError

_TOLERANCE = 1e-12
"""Distance of the two bounds, relative to the larger of Z and |g'|, at which the search ends.

The minimum is quadratic, so the cells are then as wide as the square root of this number times the scale of the slip rate.
"""
_NEAR = 1e3
"""Multiple of the tolerance by which rounding may keep the two bounds apart while the smallest g' still counts as proven."""


@dataclass(frozen=True)
class Lowest:
    """Bounds (Pa s/m) of the smallest g' at slip rates up to 1e100 m/s, and a cell (m/s) in which the upper bound is reached.

    The verdict is "not decided" if the lower bound could not be brought close to the upper one, and "searched" if the law has no
    guaranteed bounds; both bounds are then infinite.
    """

    verdict: Verdict
    at_least: float = -math.inf
    at_most: float = math.inf
    rate_from: float = 0.0
    rate_to: float = 0.0


def lowest_slope(g: Resistance, tolerance: float = _TOLERANCE) -> Lowest:
    """Enclose the smallest g' to a tolerance relative to the larger of Z and its own magnitude."""
    bounds = SlopeBounds(g)
    try:
        return _lowest(bounds, tolerance)
    except NotEnclosedError:
        return Lowest("searched")


def bounded(g: Resistance) -> bool:
    """Return True if the law has guaranteed bounds of g'."""
    bounds = SlopeBounds(g)
    try:
        bounds(bounds.first_cells())
    except NotEnclosedError:
        return False
    return True


def _lowest(bounds: SlopeBounds, tolerance: float) -> Lowest:
    cells, spent, settled = bounds.first_cells(), 0, math.inf
    most, place = math.inf, (0.0, 0.0)
    while len(cells):
        spent += 4 * len(cells)
        seen = bounds.look(cells)
        here = np.min((seen.at_low[1], seen.at_high[1], seen.at_middle[1]), axis=0)
        i = int(np.argmin(here))
        if here[i] < most:
            most, place = float(here[i]), (float(cells.low[i]), float(cells.high[i]))
        least, final = least_on(seen)
        slack = tolerance * max(bounds.g.impedance, abs(most))
        done = (least >= most - slack) | final
        settled = min(settled, float(least[done].min(initial=math.inf)))
        cells = cells[~done]
        if spent + 4 * cells.parts * len(cells) > MOST_EVALUATIONS:
            return Lowest("not decided", min(settled, float(least[~done].min())), most, *place)
        cells = cells.split(cells.parts)
    least_of_all = min(settled, most)
    near = most - least_of_all <= _NEAR * tolerance * max(bounds.g.impedance, abs(most))
    return Lowest("proven" if near else "not decided", least_of_all, most, *place)


def least_on(seen: Looks) -> tuple[Floats, NDArray[np.bool_]]:
    """Return a lower bound of g' on each cell, and True for cells whose bound would not rise by subdivision."""
    monotone = (seen.second[0] > 0.0) | (seen.second[1] < 0.0)
    ends = np.minimum(seen.at_low[0], seen.at_high[0])
    return np.where(monotone, np.fmax(ends, seen.inside[0]), seen.inside[0]), monotone | seen.hopeless


def proven_regime(g: Resistance) -> Literal["regular", "irregular"] | None:
    """Return "regular" if g' is proven positive at every slip rate, "irregular" if proven negative at one, None if undecided."""
    bounds = SlopeBounds(g)
    cells, spent = bounds.first_cells(), 0
    open_: list[Cells] = []
    try:
        while len(cells):
            spent += 4 * len(cells)
            seen = bounds.look(cells)
            if min(float(one[1].min()) for one in (seen.at_low, seen.at_high, seen.at_middle)) < 0.0:
                return "irregular"
            least, final = least_on(seen)
            open_.append(cells[(least <= 0.0) & final])
            cells = cells[(least <= 0.0) & ~final]
            if spent + 4 * cells.parts * len(cells) > MOST_EVALUATIONS:
                return None
            cells = cells.split(cells.parts)
    except NotEnclosedError:
        return None
    return None if len(joined(open_)) else "regular"


def critical_stress_between(g: Resistance) -> tuple[float, float] | None:
    """Enclose the critical normal stress Z / max(-dmu/dv) (Pa) by the bounds of the smallest g'.

    Returns None if friction is not proven to fall with the slip rate, if it steps down as slip begins, or without finite bounds.
    """
    if not g.law.depends_on_rate or g.law.static_excess > 0.0:
        return None
    lowest = lowest_slope(g)
    if lowest.verdict == "searched":
        return None
    steepest, at_least = ((g.impedance - bound) / g.normal for bound in (lowest.at_least, lowest.at_most))
    if not (at_least > 0.0 and math.isfinite(steepest)):
        return None
    return g.impedance / steepest * (1.0 - _ROUNDING), g.impedance / at_least * (1.0 + _ROUNDING)


_ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Relative rounding error allowed for three operations."""
