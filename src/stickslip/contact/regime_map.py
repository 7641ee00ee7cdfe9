"""The regime over two numbers of a problem, with the critical curve between regular and irregular."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.critical import margin
from stickslip.contact.roots import sign_change
from stickslip.foundation.errors import InputError
from stickslip.problem.parameters import parameter
from stickslip.problem.problem import Problem

Floats = NDArray[np.float64]

MOST_POINTS = 1000
"""Points of the longest axis."""


@dataclass(frozen=True)
class Axis:
    """A number of a problem (see `stickslip.parameters`) from low to high (SI), at so many points, evenly or in its logarithm.

    Raises InputError where low is not below high, or not above 0 for a logarithm, or there are not 2 to 1000 points.
    """

    parameter: str
    low: float
    high: float
    points: int = 40
    log: bool = False

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise InputError(f"axis {self.parameter}: must go from a smaller to a larger value, got {self.low:g} to {self.high:g}")
        if self.log and not self.low > 0.0:
            raise InputError(f"axis {self.parameter}: a logarithmic axis must begin above 0, got {self.low:g}")
        if not 2 <= self.points <= MOST_POINTS:
            raise InputError(f"axis {self.parameter}: must have 2 to {MOST_POINTS} points, got {self.points}")

    @property
    def values(self) -> Floats:
        """The points."""
        spaced = np.geomspace if self.log else np.linspace
        return np.asarray(spaced(self.low, self.high, self.points))


@dataclass(frozen=True)
class RegimeMap:
    """Smallest g'/Z over all slip rates at each point, shape (y, x): negative is irregular, NaN where the problem is refused.

    `boundary` holds straight pieces of the critical curve, shape (pieces, end, coordinate): their ends are critical values to
    rounding. `present` is the problem's own point.
    """

    x: Axis
    y: Axis
    margin: Floats
    boundary: Floats
    present: tuple[float, float]


def regime_map(problem: Problem, x: Axis, y: Axis, progress: Callable[[int, int], None] | None = None) -> RegimeMap:
    """The regime over two numbers, all else kept; `progress` is told how many points of how many are done.

    Raises InputError for a name that is none, for the same one twice, and for a block or a contact mass, whose motion is unique.
    """
    names = (parameter(problem, x.parameter), parameter(problem, y.parameter))
    if names[0].name == names[1].name:
        raise InputError(f"regime map: needs two different parameters, got {names[0].name} twice")
    if getattr(problem.body, "contact_mass", 0.0) > 0.0:
        raise InputError("regime map: the contact mass makes the slip rate a state, the motion is unique whatever the law")
    margin(problem)  # refuses a block

    def at(x_value: float, y_value: float) -> float:
        pairs = list(zip(names, (x_value, y_value), strict=True))
        for (first, one), (second, other) in (pairs, pairs[::-1]):  # one alone may be refused where both together are not
            try:
                return margin(parameter(first.put(one), second.name).put(other))
            except InputError:
                continue
        return math.nan

    values = np.empty((y.points, x.points))
    for row, column in product(range(y.points), range(x.points)):
        values[row, column] = at(float(x.values[column]), float(y.values[row]))
        if progress is not None:
            progress(row * x.points + column + 1, values.size)
    return RegimeMap(x, y, values, _boundary(x.values, y.values, values, at), (names[0].value, names[1].value))


def _boundary(x: Floats, y: Floats, values: Floats, at: Callable[[float, float], float]) -> Floats:
    """Within each cell of four points, the critical values on its sides, joined by a line."""
    known: dict[tuple[int, int, int, int], tuple[float, float]] = {}

    def on_side(a: tuple[int, int], b: tuple[int, int]) -> tuple[float, float] | None:
        ends = values[a], values[b]
        if np.isnan(ends).any() or (ends[0] < 0.0) == (ends[1] < 0.0):
            return None
        if (*a, *b) not in known:
            (i, j), (k, m) = a, b
            if i == k:
                known[*a, *b] = sign_change(lambda one: at(one, float(y[i])), float(x[j]), float(x[m])), float(y[i])
            else:
                known[*a, *b] = float(x[j]), sign_change(lambda one: at(float(x[j]), one), float(y[i]), float(y[k]))
        return known[*a, *b]

    pieces = []
    for i, j in product(range(len(y) - 1), range(len(x) - 1)):
        corners = ((i, j), (i, j + 1)), ((i, j), (i + 1, j)), ((i, j + 1), (i + 1, j + 1)), ((i + 1, j), (i + 1, j + 1))
        found = [point for side in corners if (point := on_side(*side)) is not None]
        pieces += [found[k : k + 2] for k in range(0, len(found) - 1, 2)]
    return np.array(pieces).reshape(-1, 2, 2)
