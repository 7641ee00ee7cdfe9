"""Branches and folds of the resistance g(s) = Z s + S mu(u, s), and all slip rates s that solve g(s) = load.

A branch is an interval of slip rates on which g rises; it ends at folds. A solution of g(s) = load is stable where g rises.
Source: Campillo et al. 1996, section 3 and Fig. 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.equation import Resistance, resistance
from stickslip.contact.folds.certified import Certificate, certificate
from stickslip.contact.roots import bracketed_newton
from stickslip.foundation.brief_repr import brief_repr
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

_POINTS_PER_DECADE = 64
"""Density of the geometric part of the search grid: laws vary smoothly with the logarithm of the slip rate."""
_EVEN_POINTS, _EVEN_REACH = 2001, 10.0
"""Number of points of the evenly spaced part of the search grid, and its end as a multiple of the fastest scale."""
_BELOW, ABOVE = 1e-8, 1e4
"""The search grid extends from this multiple of the slowest scale of the contact to this multiple of the fastest one."""
_ROUNDING = 1e-9
"""Relative distance by which a fold found from rounded values of g' may lie outside its proven interval."""


@dataclass(frozen=True)
class Branch:
    """A maximal interval of slip rates (m/s) on which g rises, with the excess over the static strength (Pa) at its two ends.

    The last branch extends to infinity. The first may start at rate 0, with excess_from = g(0+) - S mu_static. Every other finite
    end is a fold.
    """

    rate_from: float
    rate_to: float
    excess_from: float
    excess_to: float

    units: ClassVar = {"rate_from": "m/s", "rate_to": "m/s", "excess_from": "Pa", "excess_to": "Pa"}
    __repr__ = brief_repr


def branches(problem: Problem, law_slip: float | None = None) -> tuple[Branch, ...]:
    """Return the stable branches of a slab's contact equation, slowest first.

    Parameters
    ----------
    problem : Problem
        Problem whose body is a slab.
    law_slip : float, optional
        Slip (m) as the law counts it; the initial one by default.

    Returns
    -------
    tuple of Branch
        Intervals of slip rates on which g rises.

    Raises
    ------
    InputError
        If the body is a block, or if friction falls at least as fast as Z s rises even at the fastest rate of the search.
    """
    return branches_of(resistance(problem, law_slip))


def branches_of(g: Resistance, proof: Certificate | None = None) -> tuple[Branch, ...]:
    """Return the stable branches of a resistance, slowest first, with folds accurate to rounding.

    Folds are searched on a grid of slip rates. If friction is convex or concave in the slip rate, the grid misses none. Otherwise
    the result is compared with `proof` (computed here by default): folds that the grid missed are added, and folds that are only
    rounding errors of g' are dropped.
    """
    if not g.law.depends_on_rate:
        return (Branch(0.0, math.inf, g.start, math.inf),)
    if g.law.bends_one_way:
        rising, folds = _searched(g)
    else:
        proof = proof or certificate(g)
        if proof.always_rises:
            return (_branch(g, 0.0, math.inf),)
        rising, folds = _agreed(g, proof, *_searched(g))
    ends = [*([0.0] if rising else []), *folds, math.inf]
    return tuple(_branch(g, low, high) for low, high in zip(ends[::2], ends[1::2], strict=True))


def _searched(g: Resistance) -> tuple[bool, list[float]]:
    """Return whether g rises at 0+, and its folds (m/s), from a search on a grid.

    Raises InputError if g still falls at the fastest rate of the grid.
    """
    rates = _refined_grid(g)
    rising = g.slope(rates) > 0.0
    rising[0] |= bool(g.slope(0.0) == 0.0 and rising[1])
    if not rising[-1]:
        raise InputError(f"{type(g.law).__name__}: friction still falls at least as fast as Z v rises at {rates[-1]:.3g} m/s")
    turns = np.flatnonzero(rising[1:] != rising[:-1])
    return bool(rising[0]), [_fold(g, rates[i], rates[i + 1]) for i in turns]


def _agreed(g: Resistance, proof: Certificate, rising: bool, folds: list[float]) -> tuple[bool, list[float]]:
    """Return whether g rises at 0+, and its folds (m/s): proven results where there are any, otherwise those of the search."""
    if proof.verdict == "searched":
        return rising, folds
    seen, left = _matched(proof, folds)
    found = [_fold(g, *turn) if fold is None else fold for turn, fold in zip(proof.turns, seen, strict=True)]
    found += [fold for fold in left if any(within(fold, one) for one in proof.undecided)]
    starts = rising if proof.rises_at_rest is None else proof.rises_at_rest
    if starts != (len(found) % 2 == 0):  # g rises at high rates, so this count of folds cannot be right: trust the search
        return rising, folds
    return starts, sorted(found)


def _matched(proof: Certificate, folds: list[float]) -> tuple[list[float | None], list[float]]:
    """Return the fold that the search found in each proven interval (None if it missed it), and the folds outside all of them."""
    left = list(folds)
    found: list[float | None] = []
    for turn in proof.turns:
        seen = next((fold for fold in left if within(fold, turn)), None)
        if seen is not None:
            left.remove(seen)
        found.append(seen)
    return found, left


def scan_rates(g: Resistance) -> NDArray[np.float64]:
    """Return the slip rates (m/s) between which compiled code looks for folds: the search grid and proven intervals it misses.

    The intervals hold at the law slip of `g` only. If a narrow feature of the law moves out of them as the contact slips, compiled
    code misses it.
    """
    rates = search_grid(g)
    if g.law.bends_one_way:
        return rates
    proof = certificate(g)
    found, _ = _matched(proof, _searched(g)[1])
    missed = [turn for turn, fold in zip(proof.turns, found, strict=True) if fold is None]
    return np.unique(np.concatenate((rates, np.ravel(missed)))) if missed else rates


def within(rate: float, interval: tuple[float, float]) -> bool:
    """Return True if a rate lies in an interval that is widened by the rounding error of a fold."""
    return interval[0] * (1.0 - _ROUNDING) <= rate <= interval[1] * (1.0 + _ROUNDING)


def _branch(g: Resistance, low: float, high: float) -> Branch:
    return Branch(low, high, g.end_excess(low), math.inf if math.isinf(high) else g.end_excess(high))


def search_grid(g: Resistance) -> NDArray[np.float64]:
    """Return the ascending slip rates (m/s) at which the slope of g is sampled in the search for folds.

    The grid holds 0, a geometric progression over all scales of the contact, an even spacing up to `_EVEN_REACH` times the fastest
    scale, and the law's knots in slip rate. Each knot is sampled from both sides, and each interval between two knots in its
    middle, so that none is overlooked.
    """
    low, high = math.log10(min(g.scales) * _BELOW), math.log10(max(g.scales) * ABOVE)
    knots = np.array([0.0, *g.rate_knots])
    count = math.ceil((high - low) * _POINTS_PER_DECADE)
    # the geometric points lie too far apart for a law that oscillates in v up to its fastest scale
    even = np.linspace(0.0, _EVEN_REACH * max(g.scales), _EVEN_POINTS)
    between = 0.5 * (knots[1:] + knots[:-1])
    return np.unique(np.concatenate((even, np.logspace(low, high, count), knots, np.nextafter(knots[1:], 0.0), between)))


def _refined_grid(g: Resistance) -> NDArray[np.float64]:
    """Return the search grid with additional slip rates where g' may touch zero between two grid points."""
    rates = search_grid(g)
    for _ in range(3):
        slope = g.slope(rates)
        left, middle, right = slope[:-2], slope[1:-1], slope[2:]
        # a parabola through three values of one sign reaches 0 between them only if its second difference exceeds 8 times the
        # middle value; half of that is the condition here, for safety
        bend = 4.0 * np.abs(middle) < np.sign(middle) * (left - 2.0 * middle + right)
        near = np.flatnonzero(bend & (left * middle > 0.0) & (middle * right > 0.0)) + 1
        extra = np.linspace(rates[near - 1], rates[near + 1], 17)
        rates = np.unique(np.concatenate((rates, extra.ravel())))
    return rates


def _fold(g: Resistance, low: float, high: float) -> float:
    """Return the rate between low and high at which g' changes sign, to rounding.

    The bracket is cut into 64 parts in each round, so that numpy evaluates them all at once.
    """
    first = bool(g.slope(low) > 0.0)
    for _ in range(40):
        rates = np.linspace(low, high, 65)
        other = np.flatnonzero((g.slope(rates[1:]) > 0.0) != first)
        k = int(other[0]) if other.size else 63
        low, high = float(rates[k]), float(rates[k + 1])
        if high - low <= 2.0 * np.spacing(high):
            break
    end = high if not first else low
    return next((knot for knot in g.rate_knots if abs(knot - end) <= 2.0 * np.spacing(end)), end)


def rate_on(g: Resistance, branch: Branch, excess: float) -> float:
    """Return the slip rate (m/s) on a branch at which the resistance exceeds the static strength by `excess` (Pa), to rounding.

    Raises ValueError if the branch does not exist at that excess.
    """
    if not branch.excess_from <= excess <= branch.excess_to:
        raise ValueError(f"branch from {branch.excess_from:g} to {branch.excess_to:g} Pa has no slip rate at {excess:g} Pa")
    high = branch.rate_to if math.isfinite(branch.rate_to) else max(branch.rate_from, g.fastest(excess))
    return _root(g, branch.rate_from, high, excess)


def rates_at(g: Resistance, stable: tuple[Branch, ...], excess: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return all slip rates s >= 0 (m/s) that solve the contact equation at an excess (Pa), ascending, and whether each is stable.

    Stick (0) is included. It is stable as long as the static strength holds (excess <= 0). A fold counts once, as not stable.
    """
    found = {0.0: True} if excess <= 0.0 else {}
    rate, level = 0.0, g.start
    for branch in stable:
        if branch.excess_from < excess < level and branch.rate_from > rate:
            found.setdefault(_root(g, rate, branch.rate_from, excess), False)
        if branch.excess_from < excess < branch.excess_to:
            found.setdefault(rate_on(g, branch, excess), True)
        for end, height in ((branch.rate_from, branch.excess_from), (branch.rate_to, branch.excess_to)):
            if height == excess:
                found.setdefault(end, False)
        rate, level = branch.rate_to, branch.excess_to
    rates = np.array(sorted(found))
    return rates, np.array([found[rate] for rate in rates.tolist()], bool)


def _root(g: Resistance, low: float, high: float, excess: float) -> float:
    """Return the rate (m/s) between low and high at which g passes an excess (Pa); g must be monotone there."""

    def miss(rate: float) -> tuple[float, float]:
        value, slope = g.excess_and_slope(rate)
        return float(value) - excess, float(slope)

    ends = (miss(low)[0], miss(high)[0])
    for end, value in zip((low, high), ends, strict=True):
        if value == 0.0:
            return end
    return bracketed_newton(miss, low, high, 0.5 * (low + high), rising=ends[1] > 0.0)
