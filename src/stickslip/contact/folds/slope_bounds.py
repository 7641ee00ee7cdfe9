"""Sure bounds of g' = Z + S dmu/dv and of g'' on cells of slip rates, for every piece of a law at once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.equation import Resistance
from stickslip.friction.formula import interval as iv
from stickslip.friction.formula.enclosure import enclose

Floats = NDArray[np.float64]

FASTEST = 1e100
"""Slip rate (m/s) up to which g' is bounded: beyond it squares overflow, and nothing moves."""
_BELOW, _ABOVE = 1e-4, 1e4
"""Between these multiples of the slowest and the fastest scale of a contact the first cells are one for each factor of 2."""
_SLOWEST = 1e-100
"""Slip rate (m/s) below which one cell is enough, and products of rates underflow."""
_FAR = 1e12
"""Ratio of the ends of the first cells beyond the fastest scale."""
_JUST_ABOVE_ONE = 1.0 + 8.0 * float(np.finfo(float).eps)
"""Covers the rounding of the half widths of cells."""
_NOISE = 4.0
"""A cell is given up when g' changes on it by less than this multiple of the rounding of its bounds."""


@dataclass(frozen=True)
class Cells:
    """Intervals of slip rates (m/s), each within one piece of the law."""

    low: Floats
    high: Floats
    piece: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.low)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Cells:
        return Cells(self.low[chosen], self.high[chosen], self.piece[chosen])

    def at(self, rate: Floats) -> Cells:
        """Return cells of one rate each, in the pieces of these."""
        return Cells(rate, rate, self.piece)

    @property
    def middle(self) -> Floats:
        """A rate inside each cell."""
        return self.low + 0.5 * (self.high - self.low)

    @property
    def at_rounding(self) -> NDArray[np.bool_]:
        """Whether hardly another number lies in each cell."""
        return self.high - self.low <= 4.0 * np.spacing(self.high)

    def split(self, parts: int) -> Cells:
        """Cut each cell into parts: of equal width, or of equal ratio where its ends lie far apart."""
        share = np.arange(parts + 1) / parts
        low, high = self.low[:, None], self.high[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = np.exp(np.log(low) + share * (np.log(high) - np.log(low)))
        edges = np.where((low > 0.0) & (high > 4.0 * low), ratios, low + share * (high - low))
        edges = np.clip(edges, low, high)
        edges[:, 0], edges[:, -1] = self.low, self.high
        return Cells(edges[:, :-1].ravel(), edges[:, 1:].ravel(), np.repeat(self.piece, parts))


def joined(parts: list[Cells]) -> Cells:
    """Return all the cells of several."""
    return Cells(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("low", "high", "piece")))


@dataclass(frozen=True)
class Looks:
    """Bounds on cells, each of shape (2, n): of g' all over and at three rates, of g'' all over; and whether to give a cell up."""

    inside: Floats
    at_low: Floats
    at_high: Floats
    at_middle: Floats
    second: Floats
    hopeless: NDArray[np.bool_]


@dataclass(frozen=True)
class SlopeBounds:
    """Bounds of g' and g'' of one resistance by interval arithmetic. Impedance, normal stress and parameters are taken as exact."""

    g: Resistance

    @cached_property
    def _values(self) -> Floats:
        law = self.g.law
        return np.array([law.piece_values(i) for i in range(len(self.g.trees))])

    def __call__(self, cells: Cells) -> tuple[Floats, Floats]:
        """Bound g' (Pa s/m) and g'' (Pa s2/m2) on cells: two arrays of shape (2, n), lower and upper bounds.

        Raises NotEnclosedError for a law whose formula has no sure bounds.
        """
        first, second = np.empty((2, len(cells))), np.empty((2, len(cells)))
        trees = self.g.trees
        used = np.unique(cells.piece).tolist()
        for tree in dict.fromkeys(trees[i] for i in used):
            own = [i for i in used if trees[i] == tree]
            chosen = np.isin(cells.piece, own) if len(own) < len(used) else np.ones(len(cells), bool)
            some = cells[chosen]
            values = self._values[own[0]] if len(own) == 1 else self._values[some.piece].T
            numbers = dict(zip(self.g.law.parameters(), values, strict=True))
            _, one, two = enclose(tree, numbers, self.g.law_slip, some.low, some.high)
            first[:, chosen], second[:, chosen] = self._stress(one, self.g.impedance), self._stress(two, 0.0)
        return first, second

    def look(self, cells: Cells) -> Looks:
        """Bound g' and g'' on cells, at their ends and in their middle, all at once.

        All over a cell g' is within the bounds of its formula, and within those of the mean value form: g' in the middle plus
        g'' times the distance from there.
        """
        middle = cells.middle
        first, second = self(joined([cells, cells.at(cells.low), cells.at(cells.high), cells.at(middle)]))
        whole, at_low, at_high, at_middle = np.split(first, 4, axis=1)
        second = second[:, : len(cells)]
        with np.errstate(invalid="ignore", over="ignore"):
            half = np.maximum(cells.high - middle, middle - cells.low) * _JUST_ABOVE_ONE
            reach = np.nextafter(np.max(np.abs(second), axis=0) * half, np.inf)
            least = np.fmax(whole[0], np.nextafter(at_middle[0] - reach, -np.inf))
            most = np.fmin(whole[1], np.nextafter(at_middle[1] + reach, np.inf))
            hopeless = (reach <= _NOISE * (at_middle[1] - at_middle[0])) | cells.at_rounding
        return Looks(np.stack((least, most)), at_low, at_high, at_middle, second, hopeless)

    def _stress(self, friction: Floats, added: float) -> Floats:
        """Return `added` plus the normal stress times bounds of a derivative of friction."""
        with np.errstate(invalid="ignore", over="ignore"):
            product = iv.multiply(iv.exact(self.g.normal), iv.interval(*friction))
            return np.stack(iv.ends(iv.add(iv.exact(added), product) if added else product))

    def first_cells(self) -> Cells:
        """Return cells that cover all slip rates from 0 to `FASTEST`: geometric over the scales of the contact, cut at knots."""
        low, high = max(min(self.g.scales) * _BELOW, _SLOWEST), min(max(self.g.scales) * _ABOVE, FASTEST)
        count = math.ceil(math.log2(high / low))
        inner = low * np.exp2(np.arange(count + 1))
        far = inner[-1] * _FAR ** np.arange(1, 20)
        cuts = np.unique(np.concatenate(([0.0, FASTEST], inner, far[far < FASTEST], self.g.rate_knots)))
        return Cells(cuts[:-1], cuts[1:], self.piece_from(cuts[:-1]))

    def piece_from(self, rates: Floats) -> NDArray[np.intp]:
        """Return the piece that holds at each rate; at a knot the one above it."""
        return np.broadcast_to(self.g.law.piece_at(self.g.law_slip, rates), rates.shape)
