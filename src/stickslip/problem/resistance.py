"""The resistance g(s) = Z s + S mu(u, s) of a contact that slips at rate s, and its branches.

A branch is an interval of slip rates on which g rises. Loads are stored as excesses over the static strength. Selection rules,
which a problem may bring, are functions of the terms of this page; proofs and searches for branches are in `contact`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.names import si_unit
from stickslip.foundation.show import brief_repr
from stickslip.friction import FrictionLaw
from stickslip.friction.formula import AtPoints, Expression, changes, evaluate, points_of, tape_of_changes

_LOADS = 2.0
"""Many solutions are distinguished up to this load, as a multiple (1) of the largest friction."""
_FASTEST = 1e9
"""Largest scale of a law that is kept, as a multiple of S (variation of mu)/Z; at faster rates Z s dominates g."""
_FLAT = 1e-9
"""An interval may be flat if the slope of g is below this, relative to Z, and if g varies on it by no more than its rounding."""


@dataclass(frozen=True)
class Plateau:
    """An interval of slip rates (m/s) on which g is constant, and the excess of g over the static strength (Pa) there."""

    rate_from: float
    rate_to: float
    excess: float
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"rate_from": "slip_rate", "rate_to": "slip_rate", "excess": "load"}
    __repr__ = brief_repr


@dataclass(frozen=True)
class Resistance:
    """The function g of one contact at one law slip: damping Z (Pa s/m), normal stress S (Pa), law_slip (m).

    The contact equation, paper eqs (12)-(13), reads excess(s) = load - S mu_static, where s >= 0 is the magnitude of the slip rate
    (m/s). For backward slip the load changes sign.
    """

    law: FrictionLaw
    damping: float
    normal: float
    law_slip: float
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"damping": "impedance", "normal": "load", "law_slip": "slip"}
    __repr__ = brief_repr

    @property
    def rate_unit(self) -> str:
        """The unit of slip rates: m/s, or rad/s of a contact that turns."""
        return si_unit("slip_rate", self.load_unit)

    @property
    def strength(self) -> float:
        """The static strength S mu_static (Pa)."""
        return self.normal * float(self.law.static_coefficient(self.law_slip))

    @property
    def start(self) -> float:
        """The excess at s = 0+ (Pa), which is minus the step from static to sliding friction."""
        return -self.normal * self.law.static_excess if self.law.static_excess else 0.0

    def excess_and_slope(self, rate: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return g(s) - S mu_static (Pa) and g'(s) (Pa s/m) at slip rates s >= 0 (m/s; 0 means 0+).

        The excess keeps its digits down to s = 0, because nearly equal values of friction are never subtracted.
        """
        piece, rate = self.law.piece_at(self.law_slip, rate), np.asarray(rate, float)
        excess, slope = self._by_formula(piece, rate)
        if self.rate_knots and self.plateaus:
            level = self._levels[piece]
            flat = ~np.isnan(level)
            excess, slope = np.where(flat, level, excess), np.where(flat, 0.0, slope)
        return excess, slope

    def _by_formula(self, piece: NDArray[np.intp], rate: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return excess and slope from the formulas of the pieces; pieces that share a formula are evaluated together."""
        step, slope = changes(self._points, piece, 0.0, rate)
        first, home = self._home if len(self.trees) > 1 else (0, 0.0)
        if len(self.trees) > 1 and (piece != first).any():
            used, place = np.unique(piece, return_inverse=True)
            values, offset = np.array([self.law.piece_values(i) for i in used.tolist()]), np.zeros(len(used))
            for tree in dict.fromkeys(self.trees[i] for i in used.tolist()):
                own = np.array([self.trees[i] is tree for i in used.tolist()]) & (used != first)
                numbers = dict(zip(self.law.parameters(), values[own].T, strict=True))
                offset[own] = self._at_rest(tree, numbers) - home
            step += offset[place.reshape(rate.shape)]
        return self.damping * rate + self.normal * step + self.start, self.damping + self.normal * slope

    @cached_property
    def _points(self) -> AtPoints:
        """What compiled code needs for the friction of each piece of the law."""
        trees = tuple(dict.fromkeys(self.trees))
        place = {tree: k for k, tree in enumerate(trees)}
        numbers = np.array([(*self.law.piece_values(i), self.law_slip) for i in range(len(self.trees))], float)
        formula = np.array([place[tree] for tree in self.trees])
        return points_of(tape_of_changes(trees, self.law.parameters()), formula, numbers)

    @cached_property
    def rate_knots(self) -> tuple[float, ...]:
        """The slip rates (m/s) above 0 where the law changes its formula."""
        return tuple(knot for knot in self.law.knots if knot > 0.0) if self.law.knot_variable == "rate" else ()

    @cached_property
    def _levels(self) -> NDArray[np.float64]:
        """The excess (Pa) of each piece on which friction falls exactly as fast as Z s rises, NaN for the others.

        "Exactly" means that g varies by no more than its own rounding. Only a whole piece can be flat, because formulas are
        analytic within a piece.
        """
        levels = np.full(len(self.trees), np.nan)
        if not self.rate_knots:
            return levels
        edges = np.array((0.0, *self.rate_knots))
        rates = np.linspace(edges[:-1], edges[1:], 9, axis=1)
        pieces = self.law.piece_at(self.law_slip, edges[:-1])
        excess, slope = self._by_formula(np.repeat(pieces[:, None], 9, axis=1), rates)
        size = abs(self.strength) + np.max(np.abs(excess), axis=1) + self.damping * edges[1:]
        still = np.ptp(excess, axis=1) <= 8.0 * np.finfo(float).eps * size
        for k in np.flatnonzero(still & (np.max(np.abs(slope), axis=1) <= _FLAT * self.damping)).tolist():
            before = levels[pieces[k - 1]] if k > 0 else np.nan
            levels[pieces[k]] = excess[k, 0] if np.isnan(before) else before
        return levels

    @cached_property
    def plateaus(self) -> tuple[Plateau, ...]:
        """The intervals with flat g, slowest first: all their slip rates solve the contact equation at one load."""
        found: list[Plateau] = []
        for low, high in pairwise((0.0, *self.rate_knots)):
            level = float(self._levels[int(self.law.piece_at(self.law_slip, low))])
            if not np.isnan(level):
                joined = bool(found) and found[-1].rate_to == low
                start = found.pop().rate_from if joined else low
                found.append(Plateau(start, high, level, self.load_unit))
        return tuple(found)

    def end_excess(self, rate: float) -> float:
        """Return the excess (Pa) at the end of a branch, taken from the plateau that begins or ends there if one does."""
        level = next((p.excess for p in self.plateaus if rate in (p.rate_from, p.rate_to)), None)
        return float(self.excess(rate)) if level is None else level

    @cached_property
    def trees(self) -> tuple[Expression, ...]:
        """The law's formulas, one for each piece."""
        return self.law.trees()

    @cached_property
    def _home(self) -> tuple[int, Any]:
        """The piece of the law that applies at s = 0, and its friction coefficient there."""
        first = int(self.law.piece_at(self.law_slip))
        return first, self._at_rest(self.trees[first], self.law.numbers(first))

    def _at_rest(self, tree: Expression, numbers: Mapping[str, Any]) -> Any:
        """Evaluate the formula of a piece at s = 0, even if the piece applies only at higher rates."""
        return evaluate(tree, numbers, np.float64(self.law_slip), np.float64(0.0))

    def excess(self, rate: ArrayLike) -> NDArray[np.float64]:
        """Return g(s) - S mu_static (Pa); see `excess_and_slope`."""
        return self.excess_and_slope(rate)[0]

    def slope(self, rate: ArrayLike) -> NDArray[np.float64]:
        """Return g'(s) (Pa s/m); see `excess_and_slope`."""
        return self.excess_and_slope(rate)[1]

    @cached_property
    def scales(self) -> tuple[float, ...]:
        """The characteristic slip rates (m/s) of the contact: S (variation of mu)/Z and those of the law.

        Scales of the law that exceed the first by the factor `_FASTEST` are left out: g rises there whatever the law does.
        Without damping there is no such first scale.
        """
        own = self.normal * self.law.variation / self.damping if self.damping else math.inf
        found = (own, *(scale for scale in self.law.rate_scales if scale <= _FASTEST * own))
        return tuple(scale for scale in found if 0.0 < scale < math.inf) or (1.0,)

    @cached_property
    def largest_friction(self) -> float:
        """The largest friction at rest and in slip (Pa): an estimate for a law whose friction has no upper bound."""
        high = float(self.law.range()[1])
        return max(self.normal * high, self.strength) if np.isfinite(high) else self.normal * self.law.variation + self.strength

    @property
    def largest_load(self) -> float:
        """The largest load (Pa) with distinguished solutions under a law whose friction rises and falls for ever."""
        return _LOADS * self.largest_friction

    @property
    def reach(self) -> float:
        """A slip rate (m/s) so fast that g exceeds `largest_load` from far below it on."""
        return (self.largest_load + 2.0 * self.normal * self.law.variation) / self.damping

    def fastest(self, excess: float) -> float:
        """Return a slip rate (m/s) that certainly makes g exceed the given excess (Pa), because friction is bounded below."""
        fall = self.strength - self.normal * self.law.range()[0]
        bound = max(excess + fall, 0.0) / self.damping
        return 2.0 * bound + float(np.finfo(float).tiny)


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
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"rate_from": "slip_rate", "rate_to": "slip_rate", "excess_from": "load", "excess_to": "load"}
    __repr__ = brief_repr
