"""The regime along slip: a law of slip and slip rate moves its folds as it slips, and may leave or enter the irregular regime."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stickslip.contact.critical import Regime, margin
from stickslip.contact.roots import sign_change
from stickslip.foundation.quantities import Quantity
from stickslip.friction import FrictionLaw
from stickslip.friction.parameters import NamedNumbers, Part, Series, fields_of
from stickslip.problem.problem import Problem

_POINTS = 65
_UNKNOWN = 10.0
"""Reach (m) where the law names no slip: an expression is checked as far."""


@dataclass(frozen=True)
class Stretch:
    """An interval of law slip (m) with one regime."""

    slip_from: float
    slip_to: float
    regime: Regime


def slip_reach(law: FrictionLaw) -> float:
    """A slip (m) in which everything that the law says of slip happens: twice its longest slip, or two periods."""
    return 2.0 * max(_slips(law), default=_UNKNOWN)


def _slips(law: FrictionLaw) -> Iterator[float]:
    """The slips (m) among the numbers of a law: those in m, and 2 pi over those in 1/m."""
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


def regimes_along_slip(problem: Problem) -> tuple[Stretch, ...]:
    """The regime from the start on, over `slip_reach`; changes are found to rounding, two between neighbours of 65 slips are not.

    One stretch for a law that does not depend on both slip and slip rate. Raises InputError for a block.
    """
    start = problem.law_slip
    end = start + slip_reach(problem.friction)
    if not (problem.friction.depends_on_slip and problem.friction.depends_on_rate):
        return (Stretch(start, end, "irregular" if margin(problem) < 0.0 else "regular"),)
    knots = problem.friction.knots if problem.friction.knot_variable == "slip" else ()
    slips = np.unique([*np.linspace(start, end, _POINTS), *(knot for knot in knots if start < knot < end)]).tolist()
    falls = [margin(problem, slip) < 0.0 for slip in slips]
    pairs = zip(pairwise(slips), pairwise(falls), strict=True)
    changes = [sign_change(lambda slip: margin(problem, slip), *ends) for ends, (one, other) in pairs if one != other]
    edges = [start, *changes, end]
    regimes: tuple[Regime, Regime] = ("irregular", "regular") if falls[0] else ("regular", "irregular")
    return tuple(Stretch(low, high, regimes[k % 2]) for k, (low, high) in enumerate(pairwise(edges)))
