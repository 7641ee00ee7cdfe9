"""The smallest g' = Z + S dmu/dv over all slip rates, between proven bounds: branch and bound with interval arithmetic.

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

_AT_A_TIME, _FEWEST_PARTS, _MOST_PARTS = 256, 2, 16
"""Cells that a round of cutting aims at, and between how many parts each of them is cut into."""
_TOLERANCE = 1e-12
"""Distance of the two bounds, relative to Z or to g' there, at which the search ends: cells are then its root times the scale."""
_NEAR = 1e3
"""Rounding may keep the two bounds apart by this multiple of the tolerance, and the smallest g' still counts as proven."""


@dataclass(frozen=True)
class Lowest:
    """Between which numbers (Pa s/m) the smallest g' lies at slip rates up to 1e100 m/s, and a cell (m/s) with the upper one.

    The verdict is "not decided" where the lower bound could not be brought near to the upper one, and "searched" where there are
    no sure bounds: they are infinite then.
    """

    verdict: Verdict
    at_least: float = -math.inf
    at_most: float = math.inf
    rate_from: float = 0.0
    rate_to: float = 0.0


def lowest_slope(g: Resistance, tolerance: float = _TOLERANCE) -> Lowest:
    """Enclose the smallest g', to a tolerance relative to Z or to itself, whichever is larger."""
    bounds = SlopeBounds(g)
    try:
        return _lowest(bounds, tolerance)
    except NotEnclosedError:
        return Lowest("searched")


def bounded(g: Resistance) -> bool:
    """Return True if there are sure bounds of g' at all."""
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
        least, final = _least(seen)
        slack = tolerance * max(bounds.g.impedance, abs(most))
        done = (least >= most - slack) | final
        settled = min(settled, float(least[done].min(initial=math.inf)))
        cells = cells[~done]
        parts = _parts(len(cells))
        if spent + 4 * parts * len(cells) > MOST_EVALUATIONS:
            return Lowest("not decided", min(settled, float(least[~done].min())), most, *place)
        cells = cells.split(parts)
    least_of_all = min(settled, most)
    near = most - least_of_all <= _NEAR * tolerance * max(bounds.g.impedance, abs(most))
    return Lowest("proven" if near else "not decided", least_of_all, most, *place)


def _parts(count: int) -> int:
    return int(np.clip(_AT_A_TIME // max(count, 1), _FEWEST_PARTS, _MOST_PARTS))


def _least(seen: Looks) -> tuple[Floats, NDArray[np.bool_]]:
    """Return a lower bound of g' on each cell, and whether cutting the cell would not raise it."""
    monotone = (seen.second[0] > 0.0) | (seen.second[1] < 0.0)
    ends = np.minimum(seen.at_low[0], seen.at_high[0])
    return np.where(monotone, np.fmax(ends, seen.inside[0]), seen.inside[0]), monotone | seen.hopeless


def proven_regime(g: Resistance) -> Literal["regular", "irregular"] | None:
    """Return whether g' is above 0 at every slip rate, or below 0 at one, with proof; None where that is not decided."""
    bounds = SlopeBounds(g)
    cells, spent = bounds.first_cells(), 0
    open_: list[Cells] = []
    try:
        while len(cells):
            spent += 4 * len(cells)
            seen = bounds.look(cells)
            if min(float(one[1].min()) for one in (seen.at_low, seen.at_high, seen.at_middle)) < 0.0:
                return "irregular"
            least, final = _least(seen)
            open_.append(cells[(least <= 0.0) & final])
            cells = cells[(least <= 0.0) & ~final]
            if spent + 4 * _parts(len(cells)) * len(cells) > MOST_EVALUATIONS:
                return None
            cells = cells.split(_parts(len(cells)))
    except NotEnclosedError:
        return None
    return None if len(joined(open_)) else "regular"


def normal_stress_between(g: Resistance, lowest: Lowest) -> tuple[float, float] | None:
    """Enclose the critical normal stress Z / max(-dmu/dv) (Pa) by the bounds of the smallest g'; None where nothing follows."""
    if lowest.verdict == "searched":
        return None
    steepest, at_least = ((g.impedance - bound) / g.normal for bound in (lowest.at_least, lowest.at_most))
    if not (at_least > 0.0 and math.isfinite(steepest)):
        return None
    return g.impedance / steepest * (1.0 - _ROUNDING), g.impedance / at_least * (1.0 + _ROUNDING)


_ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Relative error allowed to three operations."""
