"""Polynomials have all their roots, and in ball arithmetic no value on complex discs lies outside its ball."""

from __future__ import annotations

import ctypes
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from numpy.polynomial import polynomial as poly

from stickslip.engine.compiled_formula import compile_formula
from stickslip.engine.lanes.workspace import apart
from stickslip.engine.series import ball_radii, polynomial
from stickslip.engine.series.polynomial import (
    MOST_CROSSINGS,
    NONE,
    crossings,
    restrict,
)
from stickslip.engine.state.layout import TERMS, Ball
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.friction.formula import expression as e
from stickslip.friction.formula import functions as elementary
from stickslip.friction.formula.text import to_text
from tests.core.engine.balls import Disc, Drawn, drawn, exact_distance, farthest, radius_of
from tests.core.engine.compiled import compiled
from tests.core.engine.formulas import FORMULAS, JET, functions_of
from tests.limits import all_tests, examples

bounds_on_disc, bound_of_slope = compiled(polynomial.bounds_on_disc), compiled(polynomial.bound_of_slope)
evaluate, extremes, first_descent = map(compiled, (polynomial.evaluate, polynomial.extremes, polynomial.first_descent))

inside = st.floats(0.05, 0.95)


def padded(coefficients: np.ndarray) -> np.ndarray:
    out = np.zeros(TERMS)
    out[: len(coefficients)] = coefficients
    return out


def descent(coefficients: np.ndarray) -> float:
    return float(first_descent(padded(coefficients), np.empty(TERMS)))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("radius", [0.3, 1.0, 8.0])
def test_bounds_on_a_disc_hold_and_are_reached(radius: float) -> None:
    """Of value, mean and slope, at 64 places around the disc: 1e-13 above what they are for coefficients that are all positive."""
    drawn = np.random.default_rng(5).normal(size=TERMS) * 0.7 ** np.arange(TERMS)
    around = radius * np.exp(2j * math.pi * np.arange(64) / 64)
    for c in (drawn, abs(drawn)):
        p = Polynomial(c)
        bounds = (*bounds_on_disc(c, radius), bound_of_slope(c, radius))
        straight = (p(around) - c[0], (p.integ()(around) - c[0] * around) / radius, p.deriv()(around) - c[1])
        for bound, values in zip(bounds, straight, strict=True):
            assert np.max(abs(values)) <= bound * (1.0 + 1e-13)
    assert bounds == pytest.approx([abs(values[0]) for values in straight], rel=1e-13)


@given(st.lists(inside, min_size=1, max_size=5, unique=True))
@settings(max_examples=examples(200))
def test_first_descent_is_the_first_root(roots: list[float]) -> None:
    roots = sorted(roots)
    if min(np.diff([0.0, *roots])) < 1e-3:
        return
    p = poly.polyfromroots(roots)
    p *= math.copysign(1.0, p[0])
    assert descent(p) == pytest.approx(roots[0], rel=1e-9, abs=1e-12)


@given(st.floats(1e-6, 0.3), inside)
@settings(max_examples=examples(100))
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
@settings(max_examples=examples(100))
def test_restrict_is_a_change_of_variable(coefficients: list[float], start: float, width: float) -> None:
    c, out = np.array(coefficients), np.empty(TERMS)
    restrict(c, start, width, out)
    y = np.linspace(0, 1, 7)
    values = [evaluate(out, float(x)) for x in y]
    assert values == pytest.approx(Polynomial(c)(start + width * y), rel=1e-9, abs=1e-9)


@given(st.lists(st.floats(-3, 3), min_size=2, max_size=9))
@settings(max_examples=examples(100))
def test_the_extremes_agree_with_a_dense_scan(coefficients: list[float]) -> None:
    c = padded(np.array(coefficients))
    scan = Polynomial(c)(np.linspace(0, 1, 20001))
    least, largest = extremes(c)
    assert least - 1e-12 <= scan.min() <= least + 1e-6
    assert largest - 1e-6 <= scan.max() <= largest + 1e-12


@given(st.lists(inside, min_size=1, max_size=6, unique=True))
@settings(max_examples=examples(100))
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


MANY = examples(1200)
FRICTION = Ball.places["friction"].first
"""Place of the radius of friction in a `Ball`."""
NOTHING = 1e100
"""A radius above it says nothing."""
RULES = ("exp_radius", "sine_radius", "log_radius", "power_radius", "arcsinh_radius", "tanh_radius")


def test_no_value_on_the_disc_is_outside_its_ball() -> None:
    """Relative 1e-12. Half of the balls are finite, and a third of these at most twice as large as they need to be."""
    known = tight = 0
    many = MANY if all_tests() else MANY // 2
    for seed in range(many):
        one = drawn(seed)
        radius = radius_of(one.formula, one.disc)
        if radius < NOTHING:
            share = farthest(one, radius)
            assert share <= 1.0 + 1e-12, f"seed {seed}: {to_text(one.formula)}, {one.disc}: {share}"
            known, tight = known + 1, tight + (share > 0.5)
    assert known > 0.5 * many
    assert tight > 0.33 * known


@pytest.mark.parametrize("rule", RULES)
def test_a_rule_that_is_too_small_by_a_tenth_is_noticed(rule: str) -> None:
    true = getattr(ball_radii, rule)
    wrong = {rule: lambda *numbers: 0.9 * true(*numbers)}
    ones = (drawn(seed) for seed in range(MANY))
    radii = ((one, radius_of(one.formula, one.disc, wrong)) for one in ones)
    assert any(farthest(one, radius) > 1.0 + 1e-12 for one, radius in radii if radius < NOTHING)


CENTRES = (-1e3, -300.0, -30.0, -3.0, -0.1, 0.0, 0.01, 1.0, 10.0, 100.0, 1e3)
NESTED = {
    "logistic": lambda u: 1.0 / (1.0 + elementary.exp(u)),
    "product of logistics": lambda u: 1.0 / ((1.0 + elementary.exp(u)) * (2.0 + elementary.exp(-u))),
    "hyperbolic secant": lambda u: 1.0 / (0.5 * (elementary.exp(u) + elementary.exp(-u))),
    "logarithm of cosh": lambda u: elementary.log(0.5 * (elementary.exp(u) + elementary.exp(-u))),
    "root of a logistic": lambda u: elementary.sqrt(1.0 / (1.0 + elementary.exp(u))),
    "power of a logistic": lambda u: e.Expression("pow", (1.0 + elementary.exp(-u), e.as_expression(-7.3))),
    "tanh": elementary.tanh,
    "arcsinh": elementary.arcsinh,
    "logarithm": lambda u: elementary.log(1e-6 + u * u),
    "root": lambda u: elementary.sqrt(1e-6 + u * u),
    "power": lambda u: e.Expression("pow", (1.0 + u * u, e.as_expression(0.3))),
    "bump": lambda u: elementary.exp(-(u * u)),
    "Gompertz": lambda u: elementary.exp(-elementary.exp(-u)),
    "sine of an exponential": lambda u: elementary.sin(elementary.exp(-u * u)),
}


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", NESTED)
def test_balls_hold_from_small_to_huge_discs_at_centres_from_small_to_huge(name: str) -> None:
    """Relative 1e-12, with radii from 1e-6 to 1e3; at least a third of the balls are finite."""
    formula, rng = NESTED[name](e.SLIP), np.random.default_rng(5)
    known, discs = 0, 0
    for centre in CENTRES:
        for size in (1e-6, 1e-3, 0.1, 0.9, 1.3, 1.6, 3.0, 10.0, 100.0, 1e3):
            disc = Disc((centre, 0.0, 0.0), (size, 0.0, 0.0))
            one = Drawn(formula, disc, disc.points(rng, 200))
            radius = radius_of(formula, disc)
            discs, known = discs + 1, known + (radius < NOTHING)
            assert not radius < NOTHING or farthest(one, radius) <= 1.0 + 1e-12, f"{centre}, {size}"
    assert known > 0.33 * discs


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("seed", range(8))
def test_compiled_balls_are_those_of_the_text(seed: int) -> None:
    """Relative 1e-9, for mu and for the rate of change of a state, which the same formula gives here."""
    one = drawn(seed)
    functions = compile_formula(one.formula, (), (one.formula, one.formula))
    constants, ball = np.zeros(functions.size), Ball(np.zeros(Ball.total))
    functions.fill(np.zeros(1), 0.0, constants)
    ball.slip, ball.rate, ball.state[0] = one.disc.radius
    ball.at_slip, ball.at_rate, ball.at_state[0] = one.disc.centre
    functions.fill_radii(constants, ball.numbers)
    expected = radius_of(one.formula, one.disc)
    assert float(ball.friction) == pytest.approx(expected, rel=1e-9, abs=0.0, nan_ok=True)
    for n in range(2):
        assert float(ball.change[n]) == pytest.approx(expected, rel=1e-9, abs=0.0, nan_ok=True)


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", list(FORMULAS))
def test_radii_after_a_series_are_the_same_in_lanes_and_floats_and_hold(name: str) -> None:
    """`radii` uses what the series has left. Relative 1e-14: a processor may fuse products and sums otherwise in lanes."""
    functions, constants = functions_of(FORMULAS[name], 0.0)
    rng = np.random.default_rng(3)
    c, k, load, series, ball = (apart(rows, SIMD_WIDTH) for rows in (len(constants), 12, TERMS, 2 * TERMS, Ball.total))
    c[:] = constants[:, None]
    k[:] = np.array([9.8, 100.0, 1.0, 0.05, 0.0, 0.0, 0.0, 3.0, 0.5, 0.1, 1.0, 0.0])[:, None]
    k[5] = rng.uniform(0.05, 0.3, SIMD_WIDTH)
    load[0], ball[0], ball[1] = 60.0, rng.uniform(1e-3, 0.1, SIMD_WIDTH), rng.uniform(1e-3, 0.1, SIMD_WIDTH)
    pointers = [block.ctypes.data for block in (c, k, load, series, ball)]
    ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(functions.address("motion_jets"))(*pointers[:4])
    three = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)
    three(functions.address("radii_in_lanes"))(pointers[0], pointers[3], pointers[4])
    double = ctypes.POINTER(ctypes.c_double)
    tree = e.as_expression(FORMULAS[name](elementary, e.SLIP, e.RATE))
    for n in range(SIMD_WIDTH):
        own = [np.ascontiguousarray(block[:, n]) for block in (c, k, load, np.zeros_like(series), ball)]
        own[4][FRICTION] = 0.0
        JET(functions.address("motion_jet"))(*(array.ctypes.data_as(double) for array in own[:4]))
        three(functions.address("radii"))(*(array.ctypes.data for array in (own[0], own[3], own[4])))
        assert float(ball[FRICTION, n]) == pytest.approx(float(own[4][FRICTION]), rel=1e-14, abs=0.0)
        disc = Disc((float(k[5, n]), float(own[3][0]), 0.0), (float(ball[0, n]), float(ball[1, n]), 0.0))
        assert farthest(Drawn(tree, disc, disc.points(rng, 200)), float(ball[FRICTION, n])) <= 1.0 + 1e-12


def test_an_exponential_that_underflows_at_the_centre_still_has_a_ball() -> None:
    """exp(-746) is zero in doubles, and the disc reaches exp(-53)."""
    formula, disc = 1e30 * elementary.exp(e.SLIP), Disc((-746.0, 0.0, 0.0), (693.0, 0.0, 0.0))
    reached = exact_distance(formula, disc, np.array([-53.0, 0.0, 0.0]))
    assert radius_of(formula, disc) >= reached
