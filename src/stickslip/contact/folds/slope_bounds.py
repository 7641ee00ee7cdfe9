"""Guaranteed bounds of g' = Z + S dmu/dv and of g'' on cells (intervals) of slip rates, for all pieces of a law at once."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from stickslip.contact.equation import Resistance
from stickslip.friction.formula import interval as iv
from stickslip.friction.formula.enclosure import enclose

Floats = NDArray[np.float64]

FASTEST = 1e100
"""Slip rate (m/s) up to which g' is bounded; beyond it squares overflow, and no contact is that fast."""
_BELOW, _ABOVE = 1e-4, 1e4
"""The first cells have ends in the ratio 2 between these multiples of the slowest and the fastest scale of a contact."""
_SLOWEST = 1e-100
"""Slip rate (m/s) below which a single cell is used, because products of rates underflow there."""
_FAR = 1e12
"""Ratio of the ends of the first cells beyond the fastest scale, where g' hardly changes."""
_JUST_ABOVE_ONE = 1.0 + 8.0 * float(np.finfo(float).eps)
"""Factor that covers the rounding of the half widths of cells."""
_AT_A_TIME = 256
"""Number of cells that one round of subdivision aims at; the cost of a round hardly grows up to this number."""
_MOST_PARTS, _FEWEST_PARTS = 16, 2
"""Largest and smallest number of parts into which a cell is cut in one round."""
_NOISE = 4.0
"""A cell is hopeless if g' changes on it by no more than this multiple of the rounding of its bounds."""


@dataclass(frozen=True)
class Cells:
    """Intervals of slip rates (m/s), shape (n,), each within one piece of the law."""

    low: Floats
    high: Floats
    piece: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.low)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Cells:
        return Cells(self.low[chosen], self.high[chosen], self.piece[chosen])

    def at(self, rate: Floats) -> Cells:
        """Return cells that consist of one rate each, in the same pieces of the law."""
        return Cells(rate, rate, self.piece)

    @property
    def middle(self) -> Floats:
        """The middle of each cell (m/s)."""
        return self.low + 0.5 * (self.high - self.low)

    @property
    def at_rounding(self) -> NDArray[np.bool_]:
        """True for each cell that is only a few floating-point numbers wide."""
        return self.high - self.low <= 4.0 * np.spacing(self.high)

    @property
    def parts(self) -> int:
        """The number of parts into which each cell is cut in a round of subdivision: the more, the fewer cells there are."""
        return int(np.clip(_AT_A_TIME // max(len(self), 1), _FEWEST_PARTS, _MOST_PARTS))

    def split(self, parts: int) -> Cells:
        """Cut each cell into parts of equal width, or of equal ratio if its upper end exceeds 4 times its lower one."""
        share = np.arange(parts + 1) / parts
        low, high = self.low[:, None], self.high[:, None]
        with np.errstate(divide="ignore", invalid="ignore", under="ignore"):
            ratios = np.exp(np.log(low) + share * (np.log(high) - np.log(low)))
        edges = np.where((low > 0.0) & (high > 4.0 * low), ratios, low + share * (high - low))
        edges = np.clip(edges, low, high)
        edges[:, 0], edges[:, -1] = self.low, self.high
        return Cells(edges[:, :-1].ravel(), edges[:, 1:].ravel(), np.repeat(self.piece, parts))


def joined(parts: list[Cells]) -> Cells:
    """Return the cells of several sets as one set."""
    return Cells(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("low", "high", "piece")))


@dataclass(frozen=True)
class Looks:
    """Bounds on n cells, each of shape (2, n): g' on the whole cell, at its ends and in its middle, and g'' on the whole cell.

    The flag `hopeless`, shape (n,), marks cells that are not worth subdividing, because rounding dominates.
    """

    inside: Floats
    at_low: Floats
    at_high: Floats
    at_middle: Floats
    second: Floats
    hopeless: NDArray[np.bool_]


class Bounds(ABC):
    """Bounds of g' and g'' by interval arithmetic; impedance, normal stress and parameters count as exact."""

    @abstractmethod
    def __call__(self, cells: Cells) -> tuple[Floats, Floats]:
        """Return lower and upper bounds of g' (Pa s/m) and of g'' (Pa s^2/m^2) on n cells, each of shape (2, n).

        Raises NotEnclosedError for a law whose formula has no guaranteed bounds.
        """

    def look(self, cells: Cells) -> Looks:
        """Return bounds of g' and g'' on cells, and of g' at their ends and in their middle, in one evaluation.

        On a cell g' lies within the bounds of its formula and within those of the mean value form: g' in the middle plus g'' times
        the distance from the middle. The result is the intersection of both.
        """
        middle = cells.middle
        first, second = self(joined([cells, cells.at(cells.low), cells.at(cells.high), cells.at(middle)]))
        whole, at_low, at_high, at_middle = np.split(first, 4, axis=1)
        second = second[:, : len(cells)]
        with np.errstate(invalid="ignore", over="ignore", under="ignore"):
            half = np.maximum(cells.high - middle, middle - cells.low) * _JUST_ABOVE_ONE
            reach = np.nextafter(np.max(np.abs(second), axis=0) * half, np.inf)
            least = np.fmax(whole[0], np.nextafter(at_middle[0] - reach, -np.inf))
            most = np.fmin(whole[1], np.nextafter(at_middle[1] + reach, np.inf))
            hopeless = (reach <= _NOISE * (at_middle[1] - at_middle[0])) | cells.at_rounding
        return Looks(np.stack((least, most)), at_low, at_high, at_middle, second, hopeless)


@dataclass(frozen=True)
class SlopeBounds(Bounds):
    """Bounds for one resistance."""

    g: Resistance

    @cached_property
    def _values(self) -> Floats:
        law = self.g.law
        return np.array([law.piece_values(i) for i in range(len(self.g.trees))])

    @override
    def __call__(self, cells: Cells) -> tuple[Floats, Floats]:
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
            first[:, chosen], second[:, chosen] = stress(one, self.g.normal, self.g.impedance), stress(two, self.g.normal)
        return first, second

    def first_cells(self) -> Cells:
        """Return cells that cover the slip rates from 0 to `FASTEST`: geometric over the scales of the contact, cut at knots."""
        low, high = max(min(self.g.scales) * _BELOW, _SLOWEST), min(max(self.g.scales) * _ABOVE, FASTEST)
        count = math.ceil(math.log2(high / low))
        inner = low * np.exp2(np.arange(count + 1))
        far = inner[-1] * _FAR ** np.arange(1, 20)
        cuts = np.unique(np.concatenate(([0.0, FASTEST], inner, far[far < FASTEST], self.g.rate_knots)))
        return Cells(cuts[:-1], cuts[1:], self.piece_from(cuts[:-1]))

    def piece_from(self, rates: Floats) -> NDArray[np.intp]:
        """Return the piece of the law that applies at each rate; at a knot, the one above it."""
        return np.broadcast_to(self.g.law.piece_at(self.g.law_slip, rates), rates.shape)


def stress(friction: Floats, normal: float | Floats, added: float | Floats | None = None) -> Floats:
    """Return bounds of the normal stress times a derivative of friction, with bounds (2, n), plus `added`."""
    with np.errstate(invalid="ignore", over="ignore", under="ignore"):
        product = iv.multiply(iv.exact(normal), iv.interval(*friction))
        return np.stack(iv.ends(product if added is None else iv.add(iv.exact(added), product)))
