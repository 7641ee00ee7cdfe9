"""Smooth measured points of friction to a law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from stickslip.extensions.inference.points.penalised_spline import PenalisedSpline
from stickslip.foundation.arguments import NamesAttributes, for_users, is_number, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, gathered, nearest
from stickslip.foundation.show import ShownAsTable
from stickslip.friction import FromTable, Points
from stickslip.friction.piecewise import IGNORED_NOISE, reversals

SCALES = ("auto", "linear", "log")
"""Scales of slip or slip rate for smoothing."""
LARGEST_STRENGTH = 1e6
"""Largest strength: it makes a straight line of any points."""
CLOSE_CURVE = 0.3
"""A curve follows almost every point if its degrees of freedom exceed this share of the number of points."""
DECIMALS_OF_LAW = 12
"""Write the law with this many decimals, so that rounding makes no reversals."""
FINEST = 1025
"""The law follows the smooth curve with at most this many points."""
FINE = 4 * (FINEST - 1) + 1
"""Number of points for the comparison of the smooth curve with the law."""
FOLLOWS = 0.01
"""Largest distance between the law and the smooth curve, as a share of the residual."""


@dataclass(frozen=True, eq=False, repr=False)
class Smooth(NamesAttributes, ShownAsTable):
    """The result of `smooth`: a law through the smooth curve, constant outside the range of the points, and what was smoothed away.

    `residual` is the standard deviation of the points about the curve (no unit), with the degrees of freedom taken into account;
    their effective number is `freedom`. `strength` was chosen by cross-validation or given, and the curve is smooth in slip or slip
    rate on the `scale` "linear" or "log". `monotone` is True if it was made to rise or to fall throughout. `reversals` say how
    often friction turns from rise to fall or back: through the points exactly, and in the law.
    """

    points: Points
    law: FromTable
    residual: float
    strength: float
    freedom: float
    scale: str
    monotone: bool
    reversals: tuple[int, int]
    _spline: PenalisedSpline
    _axis: _Axis

    @property
    def title(self) -> str:
        """What was done, in one line."""
        kind = " monotone" if self.monotone else ""
        return f"Smoothed{kind} curve through {len(self.points)} points along {self.points.has[0]}"

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """Name, value and unit or meaning of each number of the result, as text."""
        before, after = self.reversals
        return [
            ("residual", f"{self.residual:.3g}", "standard deviation of the points about the curve"),
            ("strength", f"{self.strength:.3g}", f"of smoothing, in {self.scale} {self.points.has[0]}"),
            ("freedom", f"{self.freedom:.1f}", "effective number of parameters of the curve"),
            ("reversals", f"{before} -> {after}", "turns of friction from rise to fall or back: in the points, in the law"),
            ("points", f"{len(self.points)} -> {len(self.law.friction)}", "measured, in the table of the law"),
        ]

    @property
    def notes(self) -> list[str]:
        """Sentences on the limits of the result."""
        found = ["a reversal that survives depends on the strength: try a stronger and a weaker one"] if self.reversals[1] else []
        if self.freedom > CLOSE_CURVE * len(self.points) and self.residual > IGNORED_NOISE:
            found.append("the curve follows almost every point: the noise of neighbouring points may not be independent")
        return found

    @property
    def _caption(self) -> str:
        """The title."""
        return self.title

    def _lines(self) -> list[tuple[str, ...]]:
        """Return rows and notes."""
        return [*self.rows, *(("note", note) for note in self.notes)]


@dataclass(frozen=True)
class _Axis:
    """The map of slips or slip rates to [0, 1]: linear, or the logarithm of 1 + place / unit."""

    low: float
    high: float
    unit: float | None

    def forward(self, places: ArrayLike) -> Floats:
        """Return where places are on the axis, in [0, 1]; those outside are put at its ends."""
        low, high = self._ends
        scaled = self._scaled(np.clip(np.asarray(places, float), self.low, self.high))
        return np.asarray((scaled - low) / (high - low))

    def even(self, count: int) -> Floats:
        """Return the places (m or m/s) of points that are evenly spaced on the axis, from one of its ends to the other."""
        low, high = self._ends.tolist()
        scaled = np.linspace(low, high, count)
        places = scaled if self.unit is None else self.unit * np.expm1(scaled)
        places[[0, -1]] = self.low, self.high
        return np.asarray(places)

    @property
    def scale(self) -> str:
        """The name of the scale."""
        return "linear" if self.unit is None else "log"

    @property
    def _ends(self) -> Floats:
        return self._scaled(np.array([self.low, self.high]))

    def _scaled(self, places: Floats) -> Floats:
        return places if self.unit is None else np.log1p(places / self.unit)


@for_users
def smooth(
    points: Any,
    strength: float | Literal["auto"] = "auto",
    *,
    monotone: bool = False,
    along: str | None = None,
    scale: Literal["auto", "linear", "log"] = "auto",
) -> Smooth:
    """Smooth measured points to a law, by the cubic smoothing spline.

    Parameters
    ----------
    points : Points, str, Path, DataFrame or mapping
        The points; `Points.read` says what is understood. They may be in any order, and repeat a slip or a slip rate.
    strength : float or "auto"
        Strength of smoothing: the weight of the curve's mean squared second derivative (along an axis that is scaled so that the
        points reach from 0 to 1) relative to the mean squared difference from the points. By default cross-validation chooses it.
    monotone : bool
        If True, the law rises throughout or falls throughout, whichever the points do on the whole: it follows the curve of this
        kind that is closest to the smooth curve.
    along : {"slip", "slip_rate"}, optional
        The variable of the law, for points that have both.
    scale : {"auto", "linear", "log"}
        Scale for smoothing: slip or slip rate x itself, or ln(1 + x / smallest x above 0). By default the scale that predicts
        left-out points better.

    Raises
    ------
    InputError
        If the points or an argument cannot be used.
    """
    read = Points.read(points).along(along)
    if read.backward is not None:
        cure = "fit a law (--law), or in Python smooth each of points.ways, and join their laws by BothWays"
        raise InputError(f"{read.name}: slip was measured in both directions: {cure}")
    given = _checked(strength)
    tried = []
    for axis in _axes(read, scale):
        spline = PenalisedSpline.of(axis.forward(read.places), read.friction)
        tried.append((axis, spline, spline.cross_validated() if given is None else given))
    axis, spline, chosen = min(tried, key=lambda one: one[1].score(one[2]))
    x, fine = axis.forward(read.places), np.linspace(0.0, 1.0, FINE)
    curve = np.maximum(spline.curve(chosen)(fine), 0.0).round(DECIMALS_OF_LAW)
    if monotone:
        from scipy.optimize import isotonic_regression

        curve = isotonic_regression(curve, increasing=bool(np.polyfit(x, read.friction, 1)[0] > 0.0)).x
    freedom = spline.freedom(chosen)
    rest = read.friction - np.interp(x, fine, curve)
    residual = float(np.sqrt(np.sum(rest**2) / max(len(read) - freedom, 1.0)))
    law = _law(read, axis.even(FINE), curve, residual)
    order = np.argsort(read.places, kind="stable")
    turns = reversals(read.friction[order]), reversals(law.friction)
    return Smooth(read, law, residual, chosen, freedom, axis.scale, monotone, turns, spline, axis)


def _checked(strength: Any) -> float | None:
    """Return a given strength as a number, or None for "auto". Raises InputError."""
    if isinstance(strength, str) and strength == "auto":
        return None
    if not is_number(strength) or not 0.0 < float(strength) <= LARGEST_STRENGTH:
        raise InputError(f"smooth: strength must be 'auto' or a number above 0, up to 1e6, got {shown(strength)}")
    return float(strength)


def _axes(points: Points, scale: str) -> list[_Axis]:
    """Return the possible axes for smoothing. Raises InputError if points and scale do not match."""
    places = points.places
    if scale not in SCALES:
        raise InputError(f"smooth: scale {ascii(scale)[:40]} is unknown; {nearest(str(scale), SCALES)}")
    if len(np.unique(places)) < 4:
        raise InputError(f"smooth: at least 4 different values of {points.has[0]} are needed, got {len(np.unique(places))}")
    low, high = float(places.min()), float(places.max())
    if scale == "log" and low < 0.0:
        raise InputError("smooth: scale 'log' needs slips that are not negative")
    linear, log = [_Axis(low, high, None)], []
    if low >= 0.0:
        log = [_Axis(low, high, float(places[places > 0.0].min()))]
    return {"linear": linear, "log": log, "auto": linear + log}[scale]


def _law(points: Points, places: Floats, curve: Floats, residual: float) -> FromTable:
    """Return the law through the fewest points, evenly spaced on the axis, that follows the curve closely enough."""
    near = max(FOLLOWS * residual, 1e-9)
    for step in (2**k for k in range(9, 1, -1)):
        law = _table(points, places[::step], curve[::step])
        found = law.coefficient(places) if law.slip is not None else law.coefficient(0.0, places)
        if np.abs(found - curve).max() <= near:
            break
    return law


def _table(points: Points, places: Floats, friction: Floats) -> FromTable:
    """Return a table law without a warning of noise: its points are smooth, or as rough as a given strength lets them be."""
    along = "slip" if points.has == ("slip",) else "rate"
    with gathered():
        law = FromTable(friction=friction.tolist(), counts="net" if places[0] < 0.0 else "path", **{along: places.tolist()})
    points.of_contact(law)
    return law
