"""Folds of the resistance g(v) = Z v + S mu(v), and its smallest slope, each with a proof by bounds of g' and g''.

The proofs are those of `engine.folds.turns` and `engine.folds.lowest_slope`; here they meet a contact, and `contact.proofs` says
how they run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, Literal

import numpy as np

from stickslip.contact.equation import Resistance
from stickslip.contact.proofs import Way, compiled, run_proof, way_of_next
from stickslip.engine.codegen.kernels import in_python
from stickslip.engine.enclosure.formula import formulas_of
from stickslip.engine.folds import turns
from stickslip.engine.folds.lowest_slope import find_lowest, polished
from stickslip.engine.folds.panels import MOST_PANELS, panels_between
from stickslip.engine.folds.turns import FASTEST, find_turns, folds_of, new_cells, room_for_turns
from stickslip.foundation.arrays import Floats
from stickslip.foundation.brief_repr import brief_repr
from stickslip.foundation.errors import InputError

Verdict = Literal["proven", "not decided"]
"""proven: by interval arithmetic. not decided: proven except on some intervals of slip rates."""
Interval = tuple[float, float]

_TOLERANCE, _NEAR = 1e-12, 1e3
"""Distance of the two bounds of the smallest g', relative to the larger of Z and |g'|, at which the search ends, and the multiple
of it by which rounding may keep them apart while the smallest g' still counts as proven."""
_ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Relative rounding error allowed for three operations."""
MOST_FOLDS = 1024
"""Largest number of folds that a contact may have. Friction that rises and falls with the slip rate for ever has any number."""
FEW_PANELS = 200
"""Number of panels of an integral from which on they are found in compiled code."""
_MOST_SHOWN = 6
"""Largest number of folds that a sentence names; more would make it unreadable."""


@dataclass(frozen=True)
class Fold:
    """A slip rate (m/s) at which g changes between rising and falling, and the load (Pa) there."""

    rate: float
    load: float
    enclosure: Interval | None = None
    """Slip rates (m/s) between which g is proven to turn exactly once; None if that is not decided."""

    units: ClassVar = {"rate": "m/s", "load": "Pa", "enclosure": "m/s"}
    __repr__ = brief_repr


@dataclass(frozen=True)
class Certificate:
    """A proof of the turns of g at slip rates from 0 to `reach`, ascending; intervals are of slip rates (m/s)."""

    verdict: Verdict
    rates: tuple[float, ...] = ()
    """Slip rates at which g turns: those proven, and those at which g' changes its sign within an undecided interval."""
    turns: tuple[Interval, ...] = ()
    """Intervals that hold exactly one change of sign of g' each; outside them and `undecided` there is none."""
    undecided: tuple[Interval, ...] = ()
    """Intervals in which neither a turn nor its absence is proven."""
    rises_at_rest: bool | None = None
    """True if g rises at 0+, None if that is not decided."""
    evaluations: int = 0
    """Number of cells and single rates at which g' was bounded."""
    reach: float = FASTEST
    """Slip rate (m/s) up to which g was searched: 1e30, or less if it turns more than MOST_FOLDS times."""

    @property
    def regime(self) -> Literal["regular", "irregular"] | None:
        """The regime: regular if g is proven to rise at every slip rate, irregular if to fall at one; None if undecided."""
        if self.turns or self.rises_at_rest is False:
            return "irregular"
        return "regular" if self.verdict == "proven" else None

    def enclosure(self, rate: float) -> Interval | None:
        """Return the interval around a fold in which g is proven to turn exactly once; None if there is none."""
        return next((one for one in self.turns if one[0] <= rate <= one[1]), None)


@dataclass(frozen=True)
class Lowest:
    """The smallest g' (Pa s/m) at slip rates up to 1e30 m/s: proven bounds, its value to rounding, and where it is (m/s).

    The verdict is "not decided" if the lower bound could not be brought close to the upper one.
    """

    verdict: Verdict
    at_least: float
    at_most: float
    slope: float
    rate: float


def bounds_of(g: Resistance) -> turns.Resistance:
    """Return what compiled code needs for bounds of g' of a contact.

    Raises InputError for a law with a state, under which the slip rate is no root of the contact equation.
    """
    knots = np.array(g.rate_knots)
    pieces = np.atleast_1d(g.law.piece_at(g.law_slip, np.array([0.0, *g.rate_knots])))
    values = np.array([g.law.piece_values(i) for i in range(len(g.trees))]).reshape(len(g.trees), -1)
    formulas = formulas_of(g.trees, g.law.parameters(), values)
    return turns.Resistance(
        formulas, knots, pieces.astype(np.int64), g.damping, g.normal, min(g.scales), max(g.scales), in_python(new_cells)()
    )


@lru_cache(maxsize=64)
def certificate(g: Resistance, budget: int = turns.MOST_EVALUATIONS) -> Certificate:
    """Prove where g' changes its sign, with at most so many evaluations.

    Raises InputError if friction falls at least as fast as Z v rises even at the fastest rate of the search, unless Z is 0.
    """
    bounds, reach = bounds_of(g), FASTEST
    found, table, way = _turns(bounds, g, reach, budget)
    if found.intervals < 0:
        reach = g.reach if g.damping else FASTEST
        found, table, way = _turns(bounds, g, reach, budget)
    if found.intervals < 0:
        raise InputError(
            f"{type(g.law).__name__}: g = Z v + S mu(v) turns more than {MOST_FOLDS} times up to {reach:.3g} m/s: friction that "
            "rises and falls so often with the slip rate cannot be followed; make its features wider, or their height smaller"
        )
    if found.at_end < 0 and reach == FASTEST and g.damping:
        raise InputError(f"{type(g.law).__name__}: friction still falls at least as fast as Z v rises at {FASTEST:.3g} m/s")
    intervals = zip(*(column[: found.intervals].tolist() for column in (table.low, table.high, table.proven)), strict=True)
    sure: list[Interval] = []
    open_: list[Interval] = []
    for low, high, proven in intervals:
        (sure if proven == 1 else open_).append((low, high))
    at_rest = None if found.at_rest == 0 else found.at_rest > 0
    folds = np.empty(2 * MOST_FOLDS)
    rates = tuple(folds[: way(folds_of)(table, found.intervals, folds)].tolist())
    if reach < FASTEST and rates and g.slope(reach) <= 0.0:
        rates, sure = rates[:-1], sure[:-1]  # the last branch counts as endless, and its end is at a load that is never reached
    return Certificate("not decided" if open_ else "proven", rates, tuple(sure), tuple(open_), at_rest, found.evaluations, reach)


def _turns(bounds: turns.Resistance, g: Resistance, reach: float, budget: int) -> tuple[turns.Account, turns.Turns, Way]:
    """Return the turns of g up to a slip rate (m/s), and the way in which they were found.

    The number of intervals is -1 if there are more than MOST_FOLDS.
    """

    def search(way: Way, most: int) -> tuple[int, tuple[turns.Account, turns.Turns]]:
        for room in (64, MOST_FOLDS):
            table = in_python(room_for_turns)(room)
            found = way(find_turns)(bounds, g.law_slip, reach, most, table)
            if found.intervals >= 0:
                break
        return found.evaluations, (found, table)

    (found, table), way = run_proof(search, budget)
    return found, table, way


def panels(g: Resistance, low: float, high: float) -> Floats:
    """Return the edges (m/s) of panels from one slip rate to another, in each of which a rule of Gauss integrates g to rounding.

    For one contact the same slip rates always give the same edges, so that areas which should cancel do.
    """
    bounds, way = bounds_of(g), _way_of(g)
    if way is in_python:
        with np.errstate(all="ignore"):
            edges, is_whole = _panels(bounds, g.law_slip, (low, high), way, FEW_PANELS)
        if is_whole:
            return edges
    return _panels(bounds, g.law_slip, (low, high), compiled, MOST_PANELS)[0]


def _panels(bounds: turns.Resistance, slip: float, ends: Interval, way: Way, most: int) -> tuple[Floats, bool]:
    """Return the edges of panels, and whether so many panels are enough for them to be as short as they should be."""
    edges = np.empty(most + len(bounds.pieces) + 4)
    count = way(panels_between)(bounds, slip, *ends, edges)
    return edges[: count + 1], count <= most


@lru_cache(maxsize=64)
def _way_of(g: Resistance) -> Way:
    """Return the way in which the panels of a contact are found, for as long as the contact is remembered."""
    return way_of_next(FEW_PANELS)


@lru_cache(maxsize=64)
def lowest_slope(g: Resistance, tolerance: float = _TOLERANCE) -> Lowest:
    """Bound the smallest g' to a tolerance relative to the larger of Z and its own magnitude, and find it to rounding."""
    bounds = bounds_of(g)

    def search(way: Way, most: int) -> tuple[int, Any]:
        found = way(find_lowest)(bounds, g.law_slip, tolerance, most)
        return found.evaluations, found

    found, way = run_proof(search, turns.MOST_EVALUATIONS)
    with np.errstate(all="ignore"):
        rate, slope = map(float, way(polished)(bounds, g.law_slip, found))
    least, most = float(found.at_least), float(found.at_most)
    near = most - least <= _NEAR * tolerance * max(g.damping, abs(most))
    return Lowest("proven" if near else "not decided", least, most, slope, rate)


def critical_stress_between(g: Resistance) -> Interval | None:
    """Enclose the critical normal stress Z / max(-dmu/dv) (Pa) by the bounds of the smallest g'.

    Returns None if friction is not proven to fall with the slip rate, if it steps down as slip begins, or without finite bounds.
    """
    if not g.law.depends_on_rate or g.law.static_excess > 0.0:
        return None
    lowest = lowest_slope(g)
    steepest, at_least = ((g.damping - bound) / g.normal for bound in (lowest.at_least, lowest.at_most))
    if not (at_least > 0.0 and math.isfinite(steepest)):
        return None
    return g.damping / steepest * (1.0 - _ROUNDING), g.damping / at_least * (1.0 + _ROUNDING)


def sentence(g: Resistance, proof: Certificate, folds: tuple[Fold, ...]) -> str:
    """Return a sentence on what is proven of the folds, with a leading space; "" if friction does not depend on the slip rate."""
    if not g.law.depends_on_rate:
        return ""
    if proof.verdict == "not decided":
        places = _listed([f"between {low:.6g} and {high:.6g} m/s" for low, high in proof.undecided])
        return f" Interval arithmetic does not decide whether g = Z v + S mu(v) turns {places}; elsewhere its turns are proven."
    reach = f"up to {proof.reach:.3g} m/s"
    if proof.reach < FASTEST:
        reach += f", which loads up to {g.largest_load:.3g} Pa do not exceed; at faster ones it goes on turning"
    if not proof.turns:
        return f" Proven by interval arithmetic: g = Z v + S mu(v) rises at every slip rate above 0, {reach}."
    places = _listed([_place(fold) for fold in folds])
    return f" Proven by interval arithmetic: g = Z v + S mu(v) turns only at {places}, of all slip rates {reach}."


def _place(fold: Fold) -> str:
    low, high = fold.enclosure or (fold.rate, fold.rate)
    return f"{fold.rate:.9g} m/s" + (f" (to within {high - low:.1g})" if high > low else "")


def _listed(places: list[str]) -> str:
    shown = places[:_MOST_SHOWN] + ([f"{len(places) - _MOST_SHOWN} more places"] if len(places) > _MOST_SHOWN else [])
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
