"""Maxwell's rule: at each load take the stable slip rate with the smallest phi(s) = integral from 0 to s of (g - load) ds.

Source: Campillo et al. 1996, section 3. Stick has phi = 0. The faster a branch, the faster its phi falls as the load grows.
Therefore each branch has the smallest phi on a single interval of loads, and the change between two neighbours is at the load at
which the areas between g and the load line are equal. Loads are excesses over the static strength, in Pa.
"""

from __future__ import annotations

import math
from itertools import combinations, pairwise

import numpy as np

from stickslip.contact.branches import Branch, rate_on
from stickslip.contact.equation import Resistance
from stickslip.contact.folds import bounds_of
from stickslip.contact.roots import bracketed_newton
from stickslip.engine.folds.panels import MOST_PANELS, NODES, WEIGHTS, panels_between

_STICK = Branch(0.0, 0.0, -math.inf, 0.0)


def best_branches(g: Resistance, stable: tuple[Branch, ...]) -> dict[int, tuple[float, float]]:
    """Return the interval of excess (Pa) on which each branch has the smallest phi, keyed by its index (-1: stick).

    Branches that never have the smallest phi are left out.
    """
    candidates = {-1: _STICK, **dict(enumerate(stable))}
    levels = {end for b in candidates.values() for end in (b.excess_from, b.excess_to) if math.isfinite(end)}
    levels |= {level for a, b in combinations(candidates.values(), 2) if (level := equal_area_level(g, a, b)) is not None}
    cuts = [-math.inf, *sorted(levels), math.inf]
    best: dict[int, tuple[float, float]] = {}
    for low, high in pairwise(cuts):
        winner = _winner(g, candidates, _between(low, high))
        best[winner] = (best.get(winner, (low, high))[0], high)
    return best


def _between(low: float, high: float) -> float:
    """Return an excess inside an interval that may be infinite on one side."""
    if math.isinf(low):
        return high - 1.0 - abs(high)
    return low + 1.0 + abs(low) if math.isinf(high) else low + 0.5 * (high - low)


def _winner(g: Resistance, candidates: dict[int, Branch], excess: float) -> int:
    """Return the index of the candidate with the smallest phi among those that exist at this excess."""
    alive = {i: b for i, b in candidates.items() if b.excess_from <= excess <= b.excess_to}
    potential = {i: area(g, 0.0, _rate(g, b, excess), excess) for i, b in alive.items()}
    return min(potential, key=potential.__getitem__)


def equal_area_level(g: Resistance, slower: Branch, faster: Branch) -> float | None:
    """Return the excess (Pa) at which two branches have the same phi, to rounding; None if there is no such excess."""
    low, high = max(slower.excess_from, faster.excess_from), min(slower.excess_to, faster.excess_to)
    if not low < high or _gap(g, slower, faster, low)[0] <= 0.0 or _gap(g, slower, faster, high)[0] >= 0.0:
        return None
    return bracketed_newton(lambda excess: _gap(g, slower, faster, excess), low, high, high, rising=False)


def _gap(g: Resistance, slower: Branch, faster: Branch, excess: float) -> tuple[float, float]:
    """Return phi of the faster branch minus phi of the slower one, and its derivative with respect to the excess."""
    start, end = _rate(g, slower, excess), _rate(g, faster, excess)
    return area(g, start, end, excess), start - end


def _rate(g: Resistance, branch: Branch, excess: float) -> float:
    return 0.0 if branch is _STICK else rate_on(g, branch, excess)


def area(g: Resistance, start: float, end: float, excess: float) -> float:
    """Return the integral of g - load from start to end (m/s), in Pa m/s: Gauss's rule on panels that resolve the law."""
    if end <= start:
        return 0.0
    edges = np.empty(MOST_PANELS + 1)
    edges = edges[: panels_between(bounds_of(g), g.law_slip, start, end, edges) + 1]
    half = 0.5 * np.diff(edges)
    rates = edges[:-1, None] + half[:, None] * (1.0 + NODES)
    return float(np.sum(half * ((g.excess(rates) - excess) @ WEIGHTS)))
