"""Roots, maxima and changes of variable of the history's polynomials."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from numpy.polynomial import polynomial as poly

from stickslip.engine.series.polynomial import MOST_CROSSINGS, NONE, crossings, evaluate, first_descent, maximum, restrict
from stickslip.engine.state.layout import TERMS

inside = st.floats(0.05, 0.95)


def padded(coefficients: np.ndarray) -> np.ndarray:
    out = np.zeros(TERMS)
    out[: len(coefficients)] = coefficients
    return out


def descent(coefficients: np.ndarray) -> float:
    return float(first_descent(padded(coefficients), np.empty(TERMS)))


@given(st.lists(inside, min_size=1, max_size=5, unique=True))
@settings(max_examples=200)
def test_first_descent_is_the_first_root(roots: list[float]) -> None:
    roots = sorted(roots)
    if min(np.diff([0.0, *roots])) < 1e-3:
        return
    p = poly.polyfromroots(roots)
    p *= math.copysign(1.0, p[0])
    assert descent(p) == pytest.approx(roots[0], rel=1e-9, abs=1e-12)


@given(st.floats(1e-6, 0.3), inside)
@settings(max_examples=100)
def test_no_crossing_is_missed_between_two_close_roots(gap: float, centre: float) -> None:
    """Both roots lie inside one step: a sign test at its ends would see nothing."""
    if centre + gap >= 1.0:
        return
    assert descent(poly.polyfromroots([centre, centre + gap])) == pytest.approx(centre, rel=0, abs=1e-7)


def test_touching_zero_is_no_descent() -> None:
    assert descent(poly.polyfromroots([0.5, 0.5]) + np.array([1e-14, 0, 0])) == NONE


def test_a_root_at_the_start_counts_only_where_the_polynomial_falls() -> None:
    assert descent(np.array([0.0, 1.0])) == NONE  # rises from zero
    assert descent(np.array([0.0, -1.0])) == 0.0
    assert descent(np.array([-1e-300, 1.0])) == 0.0
    assert descent(np.array([0.0, 0.0, 1.0, -2.0])) == pytest.approx(0.5, rel=1e-14, abs=0.0)
    assert descent(np.zeros(1)) == NONE


@given(st.lists(st.floats(-3, 3), min_size=TERMS, max_size=TERMS), st.floats(0, 0.9), st.floats(0.01, 1.0))
@settings(max_examples=100)
def test_restrict_is_a_change_of_variable(coefficients: list[float], start: float, width: float) -> None:
    c, out = np.array(coefficients), np.empty(TERMS)
    restrict(c, start, width, out)
    y = np.linspace(0, 1, 7)
    values = [evaluate(out, float(x)) for x in y]
    assert values == pytest.approx(Polynomial(c)(start + width * y), rel=1e-9, abs=1e-9)


@given(st.lists(st.floats(-3, 3), min_size=2, max_size=9))
@settings(max_examples=100)
def test_the_maximum_agrees_with_a_dense_scan(coefficients: list[float]) -> None:
    c = padded(np.array(coefficients))
    scan = Polynomial(c)(np.linspace(0, 1, 20001))
    assert maximum(c) >= scan.max() - 1e-12
    assert maximum(c) <= scan.max() + 1e-6


@given(st.lists(inside, min_size=1, max_size=6, unique=True))
@settings(max_examples=100)
def test_crossings_are_all_roots(roots: list[float]) -> None:
    roots = sorted(roots)
    if len(roots) > 1 and min(np.diff(roots)) < 1e-3:
        return
    places, c = np.empty(MOST_CROSSINGS), poly.polyfromroots(roots)
    found = crossings(padded(c), places, np.empty(TERMS))
    assert found == len(roots)
    # a rounding of the coefficients moves a root by sum |c| / |slope| ulp: much where roots crowd
    ulps = np.abs(c).sum() / np.abs(poly.polyval(np.array(roots), poly.polyder(c)))
    assert (np.abs(places[:found] - roots) < 1e-12 + 1e-15 * ulps).all()


def test_zero_polynomial_has_no_crossing() -> None:
    assert crossings(np.zeros(TERMS), np.empty(MOST_CROSSINGS), np.empty(TERMS)) == 0
