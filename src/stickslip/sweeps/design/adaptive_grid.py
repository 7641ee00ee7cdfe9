"""Where answers change: the cells of a grid in which they differ are halved again and again, and only their corners are computed.

Points are whole numbers on the finest grid, so that none is computed twice and every run of the same search asks for the same
points in the same order. A cell is halved along every axis if answers differ among the computed points that touch it: its
corners, and what a finer neighbour has computed on its sides. So a boundary that the coarse grid has seen somewhere is followed
wherever it leads, also into cells whose corners agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Differ = Callable[[Floats, Floats], NDArray[np.bool_]]

MOST_MEMBERS = 10_000_000
"""Where a search ends at the latest: an answer that changes everywhere has no boundary."""


@dataclass(frozen=True)
class Lattice:
    """A coarse grid (points along each axis, two or more) with each of its steps halved `depth` times: all points there may be.

    Raises InputError for fewer than two points, and for more points than can be counted.
    """

    coarse: tuple[int, ...]
    depth: int

    def __post_init__(self) -> None:
        if min(self.coarse) < 2:
            raise InputError(f"refinement: needs at least 2 points along each axis, got {min(self.coarse)}")
        if self.depth < 0 or sum(map(math.log2, self.shape)) + math.log2(self.depth + 1) > 62:
            raise InputError(f"refinement: the depth must be 0 or more, and the finest grid countable in 62 bits, got {self.depth}")

    @property
    def shape(self) -> tuple[int, ...]:
        """Points of the finest grid along each axis."""
        return tuple((count - 1) * 2**self.depth + 1 for count in self.coarse)

    def fractions(self, points: Integers) -> Floats:
        """Where points lie, from 0 to 1 along each axis; shape (points, axes) both."""
        return np.asarray(points / (np.array(self.shape) - 1.0))

    def levels(self, points: Integers) -> Integers:
        """How often the grid must be halved to have each point; 0 for the coarse grid."""
        found = np.full(len(points), self.depth)
        for level in range(self.depth - 1, -1, -1):
            found[(points % self.size(level) == 0).all(axis=1)] = level
        return found

    def size(self, level: int) -> int:
        """Steps of the finest grid along a side of a cell."""
        return int(2 ** (self.depth - level))

    def keys(self, points: Integers) -> Integers:
        """One number for each point, in the order of the axes."""
        return np.asarray(np.ravel_multi_index(tuple(points.T), self.shape), dtype=np.int64)

    def points(self, keys: Integers) -> Integers:
        """The points of these numbers."""
        return np.stack(np.unravel_index(keys, self.shape), axis=1).astype(np.int64)

    def grid(self, counts: tuple[int, ...]) -> Integers:
        """The first so many points of the coarse grid along each axis: all of them, or all but the last, where its cells begin."""
        return np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, len(counts)) * self.size(0)


@dataclass(eq=False)
class Cells:
    """Cells that are not halved: lower corner (cells, axes) on the finest grid, level, and the range of answers around each.

    `least` and `most` are NaN around cells none of whose points has an answer.
    """

    corner: Integers
    level: Integers
    least: Floats
    most: Floats

    @classmethod
    def new(cls, corner: Integers, level: Integers) -> Cells:
        """Cells that nothing is known of."""
        return cls(corner, level, np.full(len(corner), np.nan), np.full(len(corner), np.nan))

    def __getitem__(self, rows: NDArray[np.bool_]) -> Cells:
        return Cells(self.corner[rows], self.level[rows], self.least[rows], self.most[rows])

    def __add__(self, other: Cells) -> Cells:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Cells(*(np.concatenate(pair) for pair in pairs))

    def learn(self, lattice: Lattice, points: Integers, answers: Floats) -> None:
        """Widen the range of answers of every cell that a point touches."""
        keys = lattice.keys(self.corner) * (lattice.depth + 1) + self.level
        order = np.argsort(keys)
        for level in np.unique(self.level):
            for corners, inside in _touched(lattice, points, lattice.size(level)):
                wanted = lattice.keys(corners) * (lattice.depth + 1) + level
                row = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
                there = keys[row] == wanted
                np.fmin.at(self.least, row[there], answers[inside][there])
                np.fmax.at(self.most, row[there], answers[inside][there])


def _touched(lattice: Lattice, points: Integers, size: int) -> Iterator[tuple[Integers, NDArray[np.bool_]]]:
    """Corners of the cells of a size that hold or touch each point, and which points those are of."""
    last = np.array(lattice.shape) - 1 - size
    for shift in product((0, 1), repeat=len(lattice.coarse)):
        corners = (points - np.array(shift)) // size * size
        inside = ((corners >= 0) & (corners <= last)).all(axis=1)
        yield corners[inside], inside


@dataclass(frozen=True, eq=False)
class Refined:
    """What was computed: points (members, axes) on the finest grid in the order of computing, their answers, and the cells.

    `complete` says whether the search came to its end, and not to the most members allowed.
    """

    lattice: Lattice
    points: Integers
    answers: Floats
    cells: Cells
    changes: NDArray[np.bool_]  # whether answers differ around each cell
    complete: bool

    @property
    def boundary(self) -> Floats:
        """Middles of the finest cells around which answers differ, from 0 to 1 along each axis; shape (cells, axes).

        The boundary is nowhere farther from one than half a cell's size along an axis.
        """
        finest = self.changes & (self.cells.level == self.lattice.depth)
        return np.asarray((self.cells.corner[finest] + 0.5) / (np.array(self.lattice.shape) - 1.0))


def unequal(least: Floats, most: Floats) -> NDArray[np.bool_]:
    """Whole numbers differ."""
    return np.asarray(least < most)


def apart(factor: float) -> Differ:
    """Numbers differ by more than a factor, or in sign."""

    def differ(least: Floats, most: Floats) -> NDArray[np.bool_]:
        smaller, larger = np.sort(np.abs([least, most]), axis=0)
        return np.asarray((larger > factor * smaller) | (least * most < 0.0))

    return differ


def refine_cells(
    lattice: Lattice, evaluate: Callable[[Integers], Floats], differ: Differ = unequal, most: int = MOST_MEMBERS
) -> Refined:
    """Compute a coarse grid, then halve the cells where answers differ, down to the lattice's depth.

    `evaluate` takes points (n, axes) and returns n answers; NaN says nothing, and nothing is refined on its account.
    `differ` compares the least and the most around cells. Ends before the round that would bring more than `most` points.
    Raises InputError if the coarse grid alone has more.
    """
    points, answers = np.empty((0, len(lattice.coarse)), np.int64), np.empty(0)
    corners, fresh = (lattice.grid(tuple(count - less for count in lattice.coarse)) for less in (1, 0))
    cells = Cells.new(corners, np.zeros(len(corners), np.int64))
    if len(fresh) > most:
        raise InputError(f"refinement: the coarse grid has {len(fresh)} points, {most} are allowed")
    while True:
        found = np.asarray(evaluate(fresh), float) if len(fresh) else np.empty(0)
        points, answers = np.concatenate([points, fresh]), np.concatenate([answers, found])
        cells.learn(lattice, fresh, found)
        changes = differ(cells.least, cells.most)
        halve = changes & (cells.level < lattice.depth)
        children = _halved(lattice, cells[halve])
        fresh = _missing(lattice, children, points)
        complete = not halve.any()
        if complete or len(points) + len(fresh) > most:
            return Refined(lattice, points, answers, cells, changes, complete)
        children.learn(lattice, points, answers)
        cells = cells[~halve] + children


def _halved(lattice: Lattice, cells: Cells) -> Cells:
    """Every cell in 2^axes parts."""
    half = (2 ** (lattice.depth - cells.level - 1))[:, np.newaxis]
    parts = [cells.corner + half * np.array(shift) for shift in product((0, 1), repeat=len(lattice.coarse))]
    return Cells.new(np.concatenate(parts), np.tile(cells.level + 1, len(parts)))


def _missing(lattice: Lattice, cells: Cells, known: Integers) -> Integers:
    """Corners of cells that are not computed yet, each once, in order."""
    size = (2 ** (lattice.depth - cells.level))[:, np.newaxis]
    corners = [cells.corner + size * np.array(shift) for shift in product((0, 1), repeat=len(lattice.coarse))]
    return lattice.points(np.setdiff1d(lattice.keys(np.concatenate(corners)), lattice.keys(known)))
