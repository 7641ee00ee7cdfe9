"""The regime (regular or irregular) as a function of slip.

A law of both slip and slip rate moves its folds as the contact slips, and may enter or leave the irregular regime on the way.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stickslip.contact.critical import Regime, margin
from stickslip.contact.roots import sign_change
from stickslip.foundation.quantities import NamedNumbers, Part, Quantity, Series, fields_of
from stickslip.friction import FrictionLaw
from stickslip.problem.problem import Problem

_POINTS = 65
"""Number of equally spaced slips at which the regime is sampled; each sample costs a search over all slip rates."""
_UNKNOWN = 10.0
"""Longest slip (m) assumed for a law whose parameters name none; user expressions are checked up to the same slip."""


@dataclass(frozen=True)
class RegimeInterval:
    """An interval of law slip (m) on which the regime does not change."""

    slip_from: float
    slip_to: float
    regime: Regime


def slip_reach(law: FrictionLaw) -> float:
    """Return a slip (m) that covers all features of the law in slip: twice its longest characteristic slip or period."""
    return 2.0 * max(_slips(law), default=_UNKNOWN)


def _slips(law: FrictionLaw) -> Iterator[float]:
    """Yield the characteristic slips (m) of a law: its parameters in m, and 2 pi divided by its parameters in 1/m."""
    for name, (declared, _) in fields_of(type(law)).items():
        value = getattr(law, name)
        if isinstance(declared, Part):
            yield from _slips(value)
        elif isinstance(declared, Series) and declared.item.unit == "m" and value:
            yield abs(value[-1])
        elif isinstance(declared, Quantity) and value:
            yield from _length(value, declared.unit)
        elif isinstance(declared, NamedNumbers):
            for one in value:
                yield from _length(one.value, one.unit)


def _length(value: float, unit: str) -> Iterator[float]:
    if unit == "m" and value:
        yield abs(value)
    elif unit in ("1/m", "m^-1") and value:
        yield 2.0 * math.pi / abs(value)


def regimes_along_slip(problem: Problem) -> tuple[RegimeInterval, ...]:
    """Return the intervals of law slip with one regime each, from the initial slip over the length `slip_reach`.

    Changes of regime are found to rounding, but two changes between neighbouring samples (65 slips and the law's knots) are missed.
    A law that does not depend on both slip and slip rate gives a single interval. Raises InputError for a block.
    """
    start = problem.law_slip
    end = start + slip_reach(problem.friction)
    if not (problem.friction.depends_on_slip and problem.friction.depends_on_rate):
        return (RegimeInterval(start, end, "irregular" if margin(problem) < 0.0 else "regular"),)
    knots = problem.friction.knots if problem.friction.knot_variable == "slip" else ()
    slips = np.unique([*np.linspace(start, end, _POINTS), *(knot for knot in knots if start < knot < end)]).tolist()
    falls = [margin(problem, slip) < 0.0 for slip in slips]
    pairs = zip(pairwise(slips), pairwise(falls), strict=True)
    changes = [sign_change(lambda slip: margin(problem, slip), *ends) for ends, (one, other) in pairs if one != other]
    edges = [start, *changes, end]
    regimes: tuple[Regime, Regime] = ("irregular", "regular") if falls[0] else ("regular", "irregular")
    return tuple(RegimeInterval(low, high, regimes[k % 2]) for k, (low, high) in enumerate(pairwise(edges)))
