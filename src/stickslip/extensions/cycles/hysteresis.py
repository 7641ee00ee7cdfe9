"""Where a branch of stable cycles and stable steady sliding are there together: the contact then keeps to the one it came from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

from scipy.optimize import brentq

from stickslip.contact import steady_slidings
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem


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
        return steady_slidings(problem_at(value)).slidings[-1].growth

    try:
        places = sorted({among.low, among.high, *(one for one in values if among.low < one < among.high)})
        grown = [growth(one) for one in places]
        changes = [ends for ends, sizes in zip(pairwise(places), pairwise(grown), strict=True) if sizes[0] * sizes[1] < 0.0]
        borders = [among.low, *(float(brentq(growth, *ends, xtol=1e-14 * abs(ends[1]), rtol=1e-14)) for ends in changes)]
        borders.append(among.high)
        return [Interval(*one) for one in pairwise(borders) if one[0] < one[1] and growth(0.5 * (one[0] + one[1])) < 0.0]
    except (InputError, IndexError):  # no steady sliding there
        return []
