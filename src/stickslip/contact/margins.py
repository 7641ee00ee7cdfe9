"""The smallest g'/Z of many contacts at once: the numbers of `critical.margin`, where one contact after another takes too long.

Contacts whose law has the same formula are computed together, so that numpy evaluates it once for all of them. Each search and each
proof is that of `critical.steepest_fall`, but the proof stops as soon as it is sure that the grid has missed no lower minimum.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from stickslip.contact.critical import MISSED, local_minima, margin, same_to_rounding
from stickslip.contact.equation import Resistance, resistance
from stickslip.contact.folds.lowest import least_on
from stickslip.contact.folds.slope_bounds import Bounds, Cells, Floats, SlopeBounds, joined, stress
from stickslip.friction.formula.differences import difference
from stickslip.friction.formula.enclosure import NotEnclosedError, enclose
from stickslip.friction.formula.expression import Expression
from stickslip.problem.problem import Problem

_PARTS = 4
"""Number of parts into which the proof cuts a cell that it cannot settle."""
_MOST_CELLS = 200
"""Largest number of cells for each contact in one round of the proof; a contact that needs more is computed alone."""


def margins(problems: Sequence[Problem]) -> Floats:
    """Return `margin` of each problem, shape (n,), equal to it up to the rounding of g'. Raises InputError as `margin` does."""
    found = np.empty(len(problems))
    together: dict[Expression, list[tuple[int, Resistance]]] = {}
    for k, problem in enumerate(problems):
        g = resistance(problem)
        if g.law.bends_one_way or g.rate_knots or g.law.static_excess > 0.0:
            found[k] = margin(problem)
        else:
            together.setdefault(_tree(g), []).append((k, g))
    for group in together.values():
        places, contacts = zip(*group, strict=True)
        found[list(places)] = _together(Contacts.of(contacts), [problems[k] for k in places])
    return found


def _tree(g: Resistance) -> Expression:
    """Return the formula that holds at all slip rates of a contact whose law has no knots in slip rate."""
    return g.trees[int(g.law.piece_at(g.law_slip))]


@dataclass(frozen=True)
class Contacts(Bounds):
    """The numbers of n contacts under one formula, each of shape (n,). In `Cells` the number of the contact is the piece."""

    resistances: tuple[Resistance, ...]
    tree: Expression
    numbers: dict[str, Floats]
    law_slip: Floats
    impedance: Floats
    normal: Floats

    @classmethod
    def of(cls, contacts: Sequence[Resistance]) -> Self:
        """Return contacts that have the same formula."""
        values = np.array([g.law.piece_values(int(g.law.piece_at(g.law_slip))) for g in contacts]).T
        numbers = dict(zip(contacts[0].law.parameters(), values, strict=True))
        others = (np.array([getattr(g, name) for g in contacts]) for name in ("law_slip", "impedance", "normal"))
        return cls(tuple(contacts), _tree(contacts[0]), numbers, *others)

    def slope(self, which: NDArray[np.intp], rates: Floats) -> Floats:
        """Return g' (Pa s/m) of some contacts, shape (m,), at slip rates (m/s), shape (m, k): a row for each contact."""
        numbers = {name: values[which, None] for name, values in self.numbers.items()}
        _, slope = difference(self.tree, numbers, self.law_slip[which, None], 0.0, rates)
        return self.impedance[which, None] + self.normal[which, None] * slope

    @override
    def __call__(self, cells: Cells) -> tuple[Floats, Floats]:
        which = cells.piece
        numbers = {name: values[which] for name, values in self.numbers.items()}
        _, one, two = enclose(self.tree, numbers, self.law_slip[which], cells.low, cells.high)
        return stress(one, self.normal[which], self.impedance[which]), stress(two, self.normal[which])

    def first_cells(self) -> Cells:
        """Return the first cells of all contacts."""
        own = [SlopeBounds(g).first_cells() for g in self.resistances]
        return joined([Cells(cells.low, cells.high, np.full(len(cells), k)) for k, cells in enumerate(own)])


def _together(contacts: Contacts, problems: Sequence[Problem]) -> Floats:
    """Return the margins of contacts under one formula."""
    minima = [(k, *one) for k, g in enumerate(contacts.resistances) for one in local_minima(g)]
    which, slope, _, low, high = (np.array(column) for column in zip(*minima, strict=True))
    lowest = np.minimum(slope, _lowest_between(contacts, which, low, high))
    slopes = np.minimum.reduceat(lowest, np.flatnonzero(np.diff(which, prepend=-1)))
    sure = _none_lower(contacts, slopes - MISSED * contacts.impedance)
    found = slopes / contacts.impedance
    for k in np.flatnonzero(~sure).tolist():
        found[k] = margin(problems[k])
    return found


def _lowest_between(contacts: Contacts, which: NDArray[np.intp], low: Floats, high: Floats) -> Floats:
    """Return the smallest g' of contacts between two slip rates each, to the rounding of g'."""
    found, open_ = np.full(len(which), math.inf), np.arange(len(which))
    while len(open_):
        rates = low[:, None] + np.arange(33) * ((high - low) / 32.0)[:, None]
        rates[:, -1] = high
        slope = contacts.slope(which[open_], rates)
        k, rows = np.argmin(slope, axis=1), np.arange(len(open_))
        sides = np.maximum(k - 1, 0), np.minimum(k + 1, 32)
        around = slope[rows[:, None], np.stack((sides[0], k, sides[1]), axis=1)]
        low, high = rates[rows, sides[0]], rates[rows, sides[1]]
        done = same_to_rounding(around, contacts.impedance[which[open_]], low, high)
        found[open_[done]] = slope[rows, k][done]
        open_, low, high = open_[~done], low[~done], high[~done]
    return found


def _none_lower(contacts: Contacts, floors: Floats) -> NDArray[np.bool_]:
    """Return True for each contact whose g' is proven to lie above a floor (Pa s/m) at all slip rates, or has no bounds."""
    cells, undecided = contacts.first_cells(), np.zeros(len(floors), bool)
    try:
        while len(cells):
            seen = contacts.look(cells)
            least, final = least_on(seen)
            done = least >= floors[cells.piece]
            below = np.min((seen.at_low[1], seen.at_high[1], seen.at_middle[1]), axis=0) < floors[cells.piece]
            undecided[cells.piece[~done & (final | below)]] = True
            cells = cells[~done & ~undecided[cells.piece]]
            cells = cells.split(_PARTS)
            undecided |= np.bincount(cells.piece, minlength=len(floors)) > _MOST_CELLS
            cells = cells[~undecided[cells.piece]]
    except NotEnclosedError:
        return np.ones(len(floors), bool)
    return ~undecided
