"""sin e and 1 - cos e by a few multiplications, against 60 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from numba import njit

from stickslip.engine.series.sine import sine, versine

ROUNDINGS = 5
"""Of numbers up to 2: what the libraries' functions and a product or two make."""


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0, 3.2, 100.0, 1e6, 1e11])
def test_sine_and_versine_agree_with_60_digits(size: float) -> None:
    for e in np.random.default_rng(2).uniform(-size, size, 300).tolist():
        with mpmath.workdps(60):
            angle = mpmath.mpf(e)
            exact, exact_versine = mpmath.sin(angle), 2 * mpmath.sin(angle / 2) ** 2
            assert abs(mpmath.mpf(_sine(e)) - exact) <= ROUNDINGS * 2.0**-53 * 2
            assert abs(mpmath.mpf(_versine(e)) - exact_versine) <= ROUNDINGS * 2.0**-53 * 2


@pytest.mark.parametrize("size", [1e-150, 1e-9, 1e-3, 0.5])
def test_small_angles_keep_their_digits(size: float) -> None:
    for e in np.random.default_rng(2).uniform(0.5 * size, size, 100).tolist():
        with mpmath.workdps(60):
            angle = mpmath.mpf(e)
            assert _sine(e) == pytest.approx(float(mpmath.sin(angle)), rel=1e-15, abs=0.0)
            assert _versine(e) == pytest.approx(float(2 * mpmath.sin(angle / 2) ** 2), rel=1e-15, abs=0.0)


@njit(fastmath={"contract"})
def _sine(e: float) -> float:
    return sine(e)


@njit(fastmath={"contract"})
def _versine(e: float) -> float:
    return versine(e)
