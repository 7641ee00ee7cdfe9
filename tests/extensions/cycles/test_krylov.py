"""Linear equations and leading eigenvalues of operators beside those of numpy, and the wave of a round trip on a mesh."""

from __future__ import annotations

import numpy as np
import pytest

from stickslip.extensions.cycles.waves.krylov import leading, solved
from stickslip.extensions.cycles.waves.mesh import WaveMesh

SIZE = 60


def matrix() -> np.ndarray:
    """Return a matrix with a pair and two real eigenvalues that are large, among many small ones."""
    rng = np.random.default_rng(5)
    blocks = np.diag(rng.uniform(-0.2, 0.2, SIZE))
    blocks[:2, :2] = [[0.6, 0.8], [-0.8, 0.6]]
    blocks[2, 2], blocks[3, 3] = -1.3, 0.7
    basis = rng.normal(size=(SIZE, SIZE))
    return basis @ blocks @ np.linalg.inv(basis)


def test_leading_eigenvalues_are_those_of_the_matrix() -> None:
    found = leading(lambda way: matrix() @ way, np.ones(SIZE), 6, 0.5, SIZE)
    assert found[:4] == pytest.approx([-1.3, 0.6 + 0.8j, 0.6 - 0.8j, 0.7], abs=1e-7) or found[:4] == pytest.approx(
        [-1.3, 0.6 - 0.8j, 0.6 + 0.8j, 0.7], abs=1e-7
    )


def test_a_space_that_is_whole_ends_the_search() -> None:
    """A contact at rest that keeps no wave: all disturbances end at once."""
    assert leading(lambda way: np.zeros(SIZE), np.ones(SIZE), 6, 0.5, SIZE) == pytest.approx([0.0])


def test_equations_are_solved_to_the_share_that_is_asked() -> None:
    right = np.random.default_rng(6).normal(size=SIZE)
    found, left, count = solved(lambda way: way - 0.5 * (matrix() @ way), right, 1e-8, SIZE)
    assert left <= 1e-8
    assert count < SIZE
    assert np.linalg.norm(found - 0.5 * matrix() @ found - right) <= 2e-8 * np.linalg.norm(right)


def test_a_wave_on_a_mesh_is_itself_between_its_points_and_on_another_mesh() -> None:
    mesh = WaveMesh(np.array([0.0, 0.3, 0.4, 1.0]))
    wave = np.abs(mesh.phases - 0.3) + mesh.phases**5
    phases = np.linspace(0.0, 1.0, 101)
    assert mesh.at(wave, phases) == pytest.approx(np.abs(phases - 0.3) + phases**5, abs=1e-13)
