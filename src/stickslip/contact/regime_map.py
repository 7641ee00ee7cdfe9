"""Find the regime over two parameters of a problem, with the critical curve, and along the slip of a law of slip and slip rate."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from stickslip.contact.branches import resistance
from stickslip.contact.critical import Regime, check_no_contact_mass, margin, margins
from stickslip.contact.roots import sign_changes
from stickslip.foundation.arrays import Floats
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LawField, NamedNumbers, NumberSeries, Quantity, fields_of
from stickslip.friction import FrictionLaw
from stickslip.problem import Parameter, Problem, put_many

_POINTS = 65
"""Sample the regime at this many equally spaced slips; each sample costs a search over all slip rates."""
_UNKNOWN = 10.0
"""Longest slip (m) assumed for a law whose parameters name none; user expressions are checked up to the same slip."""


@dataclass(frozen=True)
class RegimeInterval:
    """An interval of law slip (m) with one regime."""

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
        if isinstance(declared, LawField):
            yield from _slips(value)
        elif isinstance(declared, NumberSeries) and declared.item.unit == "m" and value:
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

    def margins_at(slips: Iterable[float]) -> list[float]:
        return margins([resistance(problem, slip) for slip in slips])

    falls = [one < 0.0 for one in margins_at(slips)]
    pairs = [ends for ends, (one, other) in zip(pairwise(slips), pairwise(falls), strict=True) if one != other]
    edges = [start, *sign_changes(lambda wanted: margins_at(slip for _, slip in wanted), pairs), end]
    regimes: tuple[Regime, Regime] = ("irregular", "regular") if falls[0] else ("regular", "irregular")
    return tuple(RegimeInterval(low, high, regimes[k % 2]) for k, (low, high) in enumerate(pairwise(edges)))


_AT_A_TIME = 100
"""Compute this many points together: enough for numpy, and seldom enough for a progress display."""


@dataclass(frozen=True)
class RegimeMap:
    """The result of `regime_map` over two axes.

    `margin`, of shape (y.points, x.points), is the smallest g'/Z over all slip rates: negative is irregular, NaN where the problem
    is refused. `boundary` holds straight segments of the critical curve, whose ends are critical values to rounding, by segment,
    end of the segment, and coordinate (x, y). `present` is the point (x, y) of the problem itself.
    """

    x: Axis
    y: Axis
    margin: Floats
    boundary: Floats
    present: tuple[float, float]


def two_parameters(problem: Problem, x: Axis, y: Axis, where: str) -> tuple[Parameter[Problem], Parameter[Problem]]:
    """Return the parameters of two axes. Raises InputError, which begins with `where`, if both are the same."""
    names = (problem.parameters[x.parameter], problem.parameters[y.parameter])
    if names[0].name == names[1].name:
        raise InputError(f"{where}: needs two different parameters, got {names[0].name} twice")
    return names


def put_both(names: tuple[Parameter[Problem], Parameter[Problem]], values: tuple[float, float]) -> Problem | None:
    """Return the problem with other values of two parameters, or None if it refuses them."""
    with suppress(InputError):
        return put_many(names[0].problem, {names[0].name: values[0], names[1].name: values[1]})
    return None


def regime_map(problem: Problem, x: Axis, y: Axis, progress: Callable[[int, int], None] | None = None) -> RegimeMap:
    """Compute the regime of a problem over two of its parameters, with everything else fixed.

    `progress` is called with the number of finished points and the number of all points. Raises InputError if a name is no
    parameter, if both axes have the same one, or if the body is a block or has a contact mass, so that the motion is unique.
    """
    names = two_parameters(problem, x, y, "regime map")
    check_no_contact_mass(problem, "regime map")

    def at(points: Sequence[tuple[float, float]]) -> Floats:
        problems = [put_both(names, point) for point in points]
        found = np.full(len(points), math.nan)
        contacts = [resistance(problem) for problem in problems if problem is not None]
        found[[problem is not None for problem in problems]] = margins(contacts)
        return found

    points = [(x_value, y_value) for y_value in y.values.tolist() for x_value in x.values.tolist()]
    found = np.empty(len(points))
    for first in range(0, len(points), _AT_A_TIME):
        some = slice(first, first + _AT_A_TIME)
        found[some] = at(points[some])
        if progress is not None:
            progress(min(first + _AT_A_TIME, len(points)), len(points))
    values = found.reshape(y.points, x.points)
    return RegimeMap(x, y, values, _boundary(x.values, y.values, values, at), (names[0].value, names[1].value))


Point = tuple[float, float]


def _boundary(x: Floats, y: Floats, values: Floats, at: Callable[[Sequence[Point]], Floats]) -> Floats:
    """Return segments of the critical curve: in each cell of four points, the critical values on its sides, joined by a line."""
    sides = [((i, j), (i, j + 1)) for i in range(len(y)) for j in range(len(x) - 1)]
    sides += [((i, j), (i + 1, j)) for i in range(len(y) - 1) for j in range(len(x))]
    crossed = [(a, b) for a, b in sides if not np.isnan(values[a] + values[b]) and (values[a] < 0.0) != (values[b] < 0.0)]

    def place(side: int, value: float) -> Point:
        (i, j), (k, _) = crossed[side]
        return (value, float(y[i])) if i == k else (float(x[j]), value)

    brackets = [(float(x[j]), float(x[m])) if i == k else (float(y[i]), float(y[k])) for (i, j), (k, m) in crossed]
    found = sign_changes(lambda wanted: at([place(*one) for one in wanted]).tolist(), brackets)
    known = {side: place(n, found[n]) for n, side in enumerate(crossed)}
    pieces = []
    for i, j in product(range(len(y) - 1), range(len(x) - 1)):
        corners = ((i, j), (i, j + 1)), ((i, j), (i + 1, j)), ((i, j + 1), (i + 1, j + 1)), ((i + 1, j), (i + 1, j + 1))
        ends = [known[side] for side in corners if side in known]
        pieces += [ends[k : k + 2] for k in range(0, len(ends) - 1, 2)]
    return np.array(pieces).reshape(-1, 2, 2)
