"""Branches and folds of the resistance g(s) = Z s + S mu(u, s), and all slip rates s that solve g(s) = load.

A branch is an interval of slip rates with rising g; it ends at folds. A solution of g(s) = load is stable if g rises there.
Source: Campillo et al. 1996, section 3 and Fig. 3.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.folds import Certificate, certificate
from stickslip.contact.roots import bracketed_newton
from stickslip.foundation.errors import InputError
from stickslip.problem import Branch, Problem, Resistance


def resistance(problem: Problem, law_slip: float | None = None, normal: float | None = None) -> Resistance:
    """Return the resistance of a slab's contact at a law slip (m) and under a normal load (Pa); default: the initial ones.

    A contact mass does not enter: a contact with mass settles to g. Raises InputError for a block, whose slip rate is a state and
    solves no contact equation.
    """
    if not problem.body.has_waves:
        raise InputError("contact equation: a block has none, its slip rate follows from its inertia")
    slip = problem.law_slip if law_slip is None else float(law_slip)
    stress = problem.normal if normal is None else normal
    return Resistance(problem.friction.ways[0], problem.body.total_damping, stress, slip, problem.load_unit)


def branches(problem: Problem, law_slip: float | None = None) -> tuple[Branch, ...]:
    """Return the stable branches of a slab's contact equation, slowest first: intervals of slip rates with rising g.

    The law slip (m) is the initial one by default. Raises InputError for a block, and if friction falls at least as fast as Z s
    rises even at the fastest rate of the search.
    """
    return branches_of(resistance(problem, law_slip))


def branches_of(g: Resistance, proof: Certificate | None = None) -> tuple[Branch, ...]:
    """Return the stable branches of a resistance, slowest first, from the proof of its folds (worked out here by default)."""
    if not g.law.depends_on_rate:
        return (Branch(0.0, math.inf, g.start, math.inf, g.load_unit),)
    proof = proof or certificate(g)
    ends = [*([0.0] if len(proof.rates) % 2 == 0 else []), *proof.rates, math.inf]  # g rises at high rates
    return tuple(
        Branch(low, high, g.end_excess(low), math.inf if math.isinf(high) else g.end_excess(high), g.load_unit)
        for low, high in zip(ends[::2], ends[1::2], strict=True)
    )


def rate_on(g: Resistance, branch: Branch, excess: float) -> float:
    """Return the slip rate (m/s) on a branch whose resistance exceeds the static strength by `excess` (Pa), to rounding.

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


@lru_cache(maxsize=256)  # jumps and loops ask for the same places
def _root(g: Resistance, low: float, high: float, excess: float) -> float:
    """Return the rate (m/s) between low and high where g passes an excess (Pa); g must be monotone there."""

    def miss(rate: float) -> tuple[float, float]:
        value, slope = g.excess_and_slope(rate)
        return float(value) - excess, float(slope)

    ends = (miss(low)[0], miss(high)[0])
    for end, value in zip((low, high), ends, strict=True):
        if value == 0.0:
            return end
    return bracketed_newton(miss, low, high, 0.5 * (low + high), rising=ends[1] > 0.0)
