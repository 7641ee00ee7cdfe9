"""Sobol indices from a sweep of given members are those of a slip in closed form, which quadrature gives without samples."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import qmc

import stickslip as ss
from stickslip.foundation.arrays import Floats
from tests.docs.pages import blocks_of

NAMES = ["friction.static", "friction.dynamic", "friction.alpha", "body.thickness"]
BOUNDS = np.array([[0.7, 0.9], [0.2, 0.4], [1.0, 3.0], [5e3, 20e3]])
IMPEDANCE, PRESSING, WAVE_SPEED = 2800.0 * 3500.0, 100e6, 3500.0
PAGE = Path(__file__).parents[3] / "docs" / "sweeps.md"


def slip_by_hand(static: Floats, dynamic: Floats, alpha: Floats, thickness: Floats) -> Floats:
    """Slip (m) of the slab of Figure 6: its rate after the onset, for one two-way travel time. The pulling adds 1e-8 m."""
    rate = (static - dynamic) * PRESSING / IMPEDANCE - 1.0 / alpha
    return rate * 2.0 * thickness / WAVE_SPEED


def indices_by_quadrature(points: int = 16) -> tuple[Floats, Floats]:
    """Return the first and total Sobol indices of the closed form: variances of means over some of the four numbers."""
    x, weights = np.polynomial.legendre.leggauss(points)
    low, high = BOUNDS.T
    axes = low[:, None] + (high - low)[:, None] * (x + 1.0) / 2.0
    values, share = slip_by_hand(*np.meshgrid(*axes, indexing="ij")), weights / 2.0

    def variance_of_mean_over(others: list[int]) -> float:
        mean = values
        for axis in sorted(others, reverse=True):
            mean = np.tensordot(mean, share, (axis, 0))
        left = np.ones(())
        for _ in range(4 - len(others)):
            left = np.multiply.outer(left, share)
        return float((left * mean**2).sum() - (left * mean).sum() ** 2)

    whole = variance_of_mean_over([])
    first = [variance_of_mean_over([j for j in range(4) if j != i]) / whole for i in range(4)]
    total = [1.0 - variance_of_mean_over([i]) / whole for i in range(4)]
    return np.array(first), np.array(total)


def test_indices_by_saltelli_of_a_sweep_are_those_of_the_closed_form() -> None:
    count = 1024
    drawn = qmc.scale(qmc.Sobol(8, rng=np.random.default_rng(1)).random(count), [*BOUNDS[:, 0]] * 2, [*BOUNDS[:, 1]] * 2)
    a, b = drawn[:, :4], drawn[:, 4:]
    mixed = [np.where(np.arange(4) == i, b, a) for i in range(4)]
    members = np.concatenate([a, b, *mixed])
    slip = ss.sweep("fig6-slab", NAMES, design=members, quantities=["slip"]).slip.values
    np.testing.assert_allclose(slip, slip_by_hand(*members.T), rtol=1e-7)
    of_a, of_b, *of_mixed = slip.reshape(6, count)
    variance = np.concatenate([of_a, of_b]).var()
    first = [np.mean(of_b * (one - of_a)) / variance for one in of_mixed]  # Saltelli et al. 2010, table 2
    total = [0.5 * np.mean((of_a - one) ** 2) / variance for one in of_mixed]
    exact = indices_by_quadrature()
    np.testing.assert_allclose(first, exact[0], atol=0.02)
    np.testing.assert_allclose(total, exact[1], atol=0.02)


def test_the_lines_of_the_page_give_the_indices_of_the_closed_form_with_salib(tmp_path: Path) -> None:
    pytest.importorskip("SALib")
    (block,) = (one for one in blocks_of(PAGE) if "SALib" in one.text)
    (tmp_path / "five_lines.py").write_text(block.text)
    found = runpy.run_path(str(tmp_path / "five_lines.py"))
    assert found["problem"]["names"] == NAMES
    assert found["problem"]["bounds"] == BOUNDS.tolist()
    first, total = indices_by_quadrature()
    np.testing.assert_allclose(found["indices"]["S1"], first, atol=0.02)
    np.testing.assert_allclose(found["indices"]["ST"], total, atol=0.02)
