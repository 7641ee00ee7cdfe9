"""Where a branch of stable cycles and stable steady sliding are there together: the contact then keeps to the one it came from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

from scipy.optimize import brentq

from stickslip.contact import steady_slidings
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem

BETWEEN = (0.2, 0.5, 0.8)
"""Where (1, shares of the distance) between two cycles of a branch the stability of steady sliding is asked."""
SLIVER = 1e-9
"""A part of an interval that is narrower than this share (1) of its value is rounding beside an edge."""
UNSTABLE = 1.0
"""What counts as the growth (1/s) where there is no steady sliding."""


class Placed(Protocol):
    """A cycle on a branch."""

    @property
    def value(self) -> float:
        """The value (SI) of the parameter."""
        ...

    @property
    def edge(self) -> str:
        """The name of an edge, or ""."""
        ...

    @property
    def stable(self) -> bool | None:
        """Whether its disturbances fade."""
        ...


class Interval(NamedTuple):
    """Values (SI) of a parameter."""

    low: float
    high: float


def with_stable_cycles(points: Sequence[Placed]) -> list[Interval]:
    """Return where there are stable cycles, up to the edges of the branch."""
    found: list[Interval] = []
    for one, other in pairwise(points):
        known = [each.stable for each in (one, other) if not each.edge]
        if known and all(known) and one.value != other.value:
            found.append(Interval(*sorted((one.value, other.value))))
    return joined(found)


def joined(intervals: Sequence[Interval]) -> list[Interval]:
    """Return intervals in their order, those that touch as one."""
    found: list[Interval] = []
    for one in sorted(intervals):
        if found and one.low <= found[-1].high:
            found[-1] = Interval(found[-1].low, max(found[-1].high, one.high))
        else:
            found.append(one)
    return found


def with_stable_sliding(among: Interval, values: Sequence[float], problem_at: Callable[[float], Problem]) -> list[Interval]:
    """Return the parts of an interval where steady sliding is stable; `values` in it tell where to look for a change."""

    def growth(value: float) -> float:
        try:
            return steady_slidings(problem_at(value)).slidings[-1].growth
        except (InputError, IndexError):  # no steady sliding there
            return UNSTABLE

    # At an edge in steady sliding, which is among the values, the growth is 0 or rounding: its signs are asked between them.
    places = sorted({among.low, among.high, *(one for one in values if among.low < one < among.high)})
    between = [low + share * (high - low) for low, high in pairwise(places) for share in BETWEEN]
    seen = [(one, grown) for one in [among.low, *between, among.high] if (grown := growth(one)) != 0.0]
    borders, stable = [among.low], [grown < 0.0 for _, grown in seen[:1]]
    for (low, before), (high, after) in pairwise(seen):
        if before * after < 0.0:
            borders.append(float(brentq(growth, low, high, xtol=1e-14 * max(abs(low), abs(high)), rtol=1e-14)))
            stable.append(after < 0.0)
    borders.append(among.high)
    parts = [Interval(*one) for one, kept in zip(pairwise(borders), stable, strict=False) if kept]
    return joined([one for one in parts if one.high - one.low > SLIVER * max(abs(one.low), abs(one.high))])
