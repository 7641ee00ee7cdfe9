"""Adaptive refinement of a grid along the boundaries at which an answer changes.

Cells around which answers differ are halved again and again, and only the corners of cells are computed. Points are stored as
integer coordinates on the finest grid. Hence no point is computed twice, and every run of the same search asks for the same points
in the same order. A cell is halved along every axis if answers differ among the computed points that touch it: its corners, and
the points that a finer neighbour has computed on its sides. A boundary that the coarse grid detects somewhere is therefore
followed wherever it leads, also into cells whose corners agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

Integers = NDArray[np.int64]

MOST_MEMBERS = 10_000_000
"""Default limit on the number of computed points. It ends a search for an answer that changes everywhere and has no boundary."""


@dataclass(frozen=True)
class Lattice:
    """The finest grid of a search: a coarse grid of which every step is halved `depth` times.

    `coarse` is the number of points of the coarse grid along each axis, at least two. Raises InputError for fewer than two points
    along an axis, for a negative depth, and for a finest grid whose cells cannot be numbered in 62 bits.
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
        """The number of points of the finest grid along each axis."""
        return tuple((count - 1) * 2**self.depth + 1 for count in self.coarse)

    def levels(self, points: Integers) -> Integers:
        """Return the number of halvings after which the grid contains each point; 0 for a point of the coarse grid."""
        found = np.full(len(points), self.depth)
        for level in range(self.depth - 1, -1, -1):
            found[(points % self.size(level) == 0).all(axis=1)] = level
        return found

    def size(self, level: int) -> int:
        """Return the side length of a cell of the given level, in steps of the finest grid."""
        return int(2 ** (self.depth - level))

    def keys(self, points: Integers) -> Integers:
        """Return a single integer for each point: its index in the flattened finest grid, the last axis varying fastest."""
        return np.asarray(np.ravel_multi_index(tuple(points.T), self.shape), dtype=np.int64)

    def points(self, keys: Integers) -> Integers:
        """Return the points (points, axes) with the given indices in the flattened finest grid, the inverse of `keys`."""
        return np.stack(np.unravel_index(keys, self.shape), axis=1).astype(np.int64)

    def grid(self, counts: tuple[int, ...]) -> Integers:
        """Return the first `counts` points of the coarse grid along each axis, as points (n, axes) of the finest grid.

        With all points but the last along each axis, these are the lower corners of the coarse cells.
        """
        return np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, len(counts)) * self.size(0)


@dataclass(eq=False)
class Cells:
    """The cells that have not been halved: their lower corners, levels, and the range of the answers around each.

    `corner` has the shape (cells, axes), in steps of the finest grid. `least` and `most` are the smallest and the largest answer
    at the points that touch a cell. They are NaN if none of these points has an answer.
    """

    corner: Integers
    level: Integers
    least: Floats
    most: Floats

    @classmethod
    def new(cls, corner: Integers, level: Integers) -> Cells:
        """Return cells around which no answer is known yet."""
        return cls(corner, level, np.full(len(corner), np.nan), np.full(len(corner), np.nan))

    def __getitem__(self, rows: NDArray[np.bool_]) -> Cells:
        return Cells(self.corner[rows], self.level[rows], self.least[rows], self.most[rows])

    def __add__(self, other: Cells) -> Cells:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Cells(*(np.concatenate(pair) for pair in pairs))

    def learn(self, lattice: Lattice, points: Integers, answers: Floats) -> None:
        """Widen the range of answers of every cell that is touched by one of the points."""
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
    """Yield the lower corners of the cells of the given size (steps of the finest grid) that contain or touch each point.

    Each array of corners comes with a mask of the points to which they belong, because a point at the edge of the grid has fewer
    cells around it.
    """
    last = np.array(lattice.shape) - 1 - size
    for shift in product((0, 1), repeat=len(lattice.coarse)):
        corners = (points - np.array(shift)) // size * size
        inside = ((corners >= 0) & (corners <= last)).all(axis=1)
        yield corners[inside], inside


@dataclass(frozen=True, eq=False)
class Refined:
    """The result of a search: points (members, axes) on the finest grid in the order of computation, their answers, and the cells.

    `complete` is False if the search ended early at the largest number of members allowed.
    """

    lattice: Lattice
    points: Integers
    answers: Floats
    cells: Cells
    changes: NDArray[np.bool_]  # True for each cell around which answers differ
    complete: bool


def differ(least: Floats, most: Floats, factor: float | None = None) -> NDArray[np.bool_]:
    """Return True where the smallest and the largest answer differ; with a factor, where by more than it, or in sign."""
    if factor is None:
        return np.asarray(least < most)
    smaller, larger = np.sort(np.abs([least, most]), axis=0)
    return np.asarray((larger > factor * smaller) | (least * most < 0.0))


def refine_cells(
    lattice: Lattice, evaluate: Callable[[Integers], Floats], factor: float | None = None, most: int = MOST_MEMBERS
) -> Refined:
    """Compute a coarse grid, then halve the cells around which answers differ, down to the depth of the lattice.

    `evaluate` takes points (n, axes) and returns n answers. NaN means that there is no answer, and causes no refinement.
    Answers differ if they are not the same, or by more than a factor (`differ`). The search ends before a round that would take it
    beyond `most` points. Raises InputError if the coarse grid alone has more points than that.
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
        changes = differ(cells.least, cells.most, factor)
        halve = changes & (cells.level < lattice.depth)
        children = _halved(lattice, cells[halve])
        fresh = _missing(lattice, children, points)
        complete = not halve.any()
        if complete or len(points) + len(fresh) > most:
            return Refined(lattice, points, answers, cells, changes, complete)
        children.learn(lattice, points, answers)
        cells = cells[~halve] + children


def _halved(lattice: Lattice, cells: Cells) -> Cells:
    half = (2 ** (lattice.depth - cells.level - 1))[:, np.newaxis]
    parts = [cells.corner + half * np.array(shift) for shift in product((0, 1), repeat=len(lattice.coarse))]
    return Cells.new(np.concatenate(parts), np.tile(cells.level + 1, len(parts)))


def _missing(lattice: Lattice, cells: Cells, known: Integers) -> Integers:
    """Return the corners of cells that have not been computed yet, without repetition and in the order of their keys."""
    size = (2 ** (lattice.depth - cells.level))[:, np.newaxis]
    corners = [cells.corner + size * np.array(shift) for shift in product((0, 1), repeat=len(lattice.coarse))]
    return lattice.points(np.setdiff1d(lattice.keys(np.concatenate(corners)), lattice.keys(known)))
