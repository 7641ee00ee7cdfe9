"""Boundaries whose place is known: found to the finest cell, whole, with few members, the same in any surroundings."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import stickslip as ss
from stickslip.sweeps.design.adaptive_grid import Lattice, Refined, refine_cells

Floats = NDArray[np.float64]


def fractions(lattice: Lattice, points: NDArray[np.float64] | NDArray[np.int64]) -> Floats:
    """The positions of points, from 0 to 1 along each axis."""
    return np.asarray(points / (np.array(lattice.shape) - 1.0))


def boundary(found: Refined) -> Floats:
    """The midpoints of the finest cells around which answers differ: every point of the boundary is within half a cell of one."""
    finest = found.changes & (found.cells.level == found.lattice.depth)
    return fractions(found.lattice, found.cells.corner[finest] + 0.5)


def search(lattice: Lattice, answer: Callable[[Floats], Floats], **options: object) -> Refined:
    """Refine where `answer` of fractions changes; no point may be asked for twice."""
    asked: set[tuple[int, ...]] = set()

    def evaluate(points: NDArray[np.int64]) -> Floats:
        fresh = set(map(tuple, points.tolist()))
        assert len(fresh) == len(points)
        assert not fresh & asked
        asked.update(fresh)
        return np.asarray(answer(fractions(lattice, points)), float)

    return refine_cells(lattice, evaluate, **options)  # type: ignore[arg-type]


def disc(x: float, y: float, radius: float) -> Callable[[Floats], Floats]:
    return lambda at: np.hypot(at[:, 0] - x, at[:, 1] - y) < radius


def test_a_circle_is_found_to_a_ten_thousandth() -> None:
    lattice = Lattice((21, 21), 9)
    found = search(lattice, disc(0.5, 0.47, 0.3))
    off = np.hypot(boundary(found)[:, 0] - 0.5, boundary(found)[:, 1] - 0.47) - 0.3
    assert found.complete
    assert np.abs(off).max() < 1e-4  # absolute; relative to the range it is the same
    assert len(found.points) < 2e-3 * np.prod(lattice.shape)


def test_a_slanted_line_is_found_to_a_ten_thousandth() -> None:
    found = search(Lattice((11, 11), 10), lambda at: at[:, 1] > 0.2 + 0.5 * at[:, 0])
    off = (boundary(found)[:, 1] - 0.2 - 0.5 * boundary(found)[:, 0]) / np.hypot(1.0, 0.5)
    assert np.abs(off).max() < 1e-4
    assert np.sort(boundary(found)[:, 0])[[0, -1]] == pytest.approx([0.0, 1.0], abs=1e-4)  # from side to side


def test_one_axis_is_a_bisection() -> None:
    found = search(Lattice((5,), 20), lambda at: at[:, 0] > 1.0 / 3.0)
    assert boundary(found) == pytest.approx(np.array([[1.0 / 3.0]]), abs=2**-22)
    assert len(found.points) == 5 + 20


def test_a_sphere_over_three_axes_is_found() -> None:
    lattice = Lattice((7, 7, 7), 3)
    found = search(lattice, lambda at: np.linalg.norm(at - 0.5, axis=1) < 0.3)
    off = np.abs(np.linalg.norm(boundary(found) - 0.5, axis=1) - 0.3)
    assert off.max() < 0.5 * np.sqrt(3.0) / 48
    assert len(found.points) < 0.25 * np.prod(lattice.shape)


@given(
    st.floats(0.0, 1.0),
    st.floats(0.0, 1.0),
    st.floats(0.15, 0.6),
    st.tuples(st.integers(8, 12), st.integers(8, 12)),
    st.integers(0, 5),
)
@settings(max_examples=40)
def test_every_point_of_a_circle_is_near_a_finest_cell(
    x: float, y: float, radius: float, coarse: tuple[int, int], depth: int
) -> None:
    """A circle larger than the coarse cells is seen, and then followed all the way: nothing of it is missed, nothing added."""
    lattice = Lattice(coarse, depth)
    step = 1.0 / (np.array(lattice.shape) - 1.0)
    found = search(lattice, disc(x, y, radius))
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    circle = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)
    circle = circle[((circle >= step) & (circle <= 1.0 - step)).all(axis=1)]
    cells = boundary(found) / step
    for point in circle / step:
        assert np.abs(cells - point).max(axis=1).min() <= 2.0  # steps of the finest grid
    off = np.abs(np.hypot(boundary(found)[:, 0] - x, boundary(found)[:, 1] - y) - radius)
    assert (off <= 0.5 * np.hypot(*step) * (1.0 + 1e-9)).all()


@given(st.lists(st.integers(0, 3), min_size=81, max_size=81), st.integers(0, 3))
@settings(max_examples=60)
def test_cells_tile_the_square_and_agree_within(values: list[int], depth: int) -> None:
    """Any answers at all: the cells cover everything once, and only finest ones have answers that differ around them."""
    table = np.array(values).reshape(9, 9)
    lattice = Lattice((3, 3), depth)

    def answer(at: Floats) -> Floats:
        row, column = np.rint(8.0 * at).astype(int).T
        return table[row, column]

    found = search(lattice, answer)
    size = 2.0 ** (depth - found.cells.level)
    assert (size**2).sum() == (np.array(lattice.shape) - 1).prod()
    assert (found.cells.level[found.changes] == depth).all()
    for corner, side, changes in zip(found.cells.corner, size, found.changes, strict=True):
        near = ((found.points >= corner) & (found.points <= corner + side)).all(axis=1)
        assert (np.ptp(found.answers[near]) > 0.0) == changes


def test_a_corner_that_the_coarse_grid_cannot_see_is_followed_from_outside() -> None:
    """A tongue enters a coarse cell through one side, between two corners that agree with the others."""
    lattice = Lattice((3, 3), 6)
    found = search(lattice, lambda at: (at[:, 0] < 0.9) & (np.abs(at[:, 1] - 0.3) < 0.05) | (at[:, 0] < 0.1))
    tongue = boundary(found)[(boundary(found)[:, 0] > 0.55) & (boundary(found)[:, 0] < 0.85)]
    assert np.unique(np.rint(tongue[:, 1] / 0.05)).tolist() == [5.0, 7.0]


def test_members_that_failed_are_no_boundary() -> None:
    """Where there is no answer nothing is refined; a boundary between answers is followed up to there."""
    lattice = Lattice((9, 9), 4)
    found = search(lattice, lambda at: np.where(at[:, 0] < 0.4, np.nan, at[:, 1] > 0.6))
    assert boundary(found)[:, 0].min() > 0.3
    assert np.abs(boundary(found)[:, 1] - 0.6).max() < 1.0 / 128


def test_a_jump_by_a_factor_is_a_boundary_a_slope_is_not() -> None:
    lattice = Lattice((9, 9), 4)
    found = search(lattice, lambda at: (1.0 + at[:, 1]) * np.where(at[:, 0] < 0.4, 1.0, -5.0), factor=1.5)
    assert np.abs(boundary(found)[:, 0] - 0.4).max() < 1.0 / 128
    smooth = search(lattice, lambda at: 1.0 + at[:, 1], factor=1.5)
    assert len(smooth.points) == 81


def test_the_search_ends_where_answers_change_everywhere() -> None:
    lattice = Lattice((5, 5), 12)
    found = search(lattice, lambda at: np.sin(1e5 * at.sum(axis=1)) > 0.0, most=2000)
    assert not found.complete
    assert 25 < len(found.points) <= 2000


def test_levels_say_when_a_point_came_in() -> None:
    lattice = Lattice((3, 3), 2)
    points = np.array([[0, 4], [2, 4], [1, 4], [2, 2], [3, 0]])
    assert lattice.levels(points).tolist() == [0, 1, 2, 1, 2]
    assert fractions(lattice, points)[1] == pytest.approx([0.25, 0.5], rel=0, abs=0)


@pytest.mark.parametrize(("coarse", "depth"), [((1, 5), 2), ((5, 5), -1), ((5, 5), 40)])
def test_impossible_grids_are_refused(coarse: tuple[int, ...], depth: int) -> None:
    with pytest.raises(ss.InputError, match="refinement"):
        Lattice(coarse, depth)
