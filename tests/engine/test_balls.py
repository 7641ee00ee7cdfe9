"""Ball arithmetic of formulas: no value on complex discs lies outside its ball, and a wrong ball is noticed."""

from __future__ import annotations

import ctypes
from functools import cache

import numpy as np
import pytest

from stickslip.batch.workspace import apart
from stickslip.engine.codegen.compiler import compile_formula
from stickslip.engine.codegen.simd import WIDTH
from stickslip.engine.series import ball_radii
from stickslip.engine.state.layout import TERMS, Ball
from stickslip.friction.formula import expression as e
from stickslip.friction.formula.text import to_text
from tests.engine.balls import Disc, Drawn, drawn_disc, drawn_formula, exact_distance, farthest, radius_of
from tests.engine.formulas import FORMULAS, JET, compiled

MANY = 600
FRICTION = Ball.places["friction"].first
"""Place of the radius of friction in a `Ball`."""
NOTHING = 1e100
"""A radius above it says nothing."""
RULES = ("exp_radius", "sine_radius", "log_radius", "power_radius", "arcsinh_radius", "tanh_radius")


@cache
def drawn(seed: int) -> Drawn:
    """A random formula of depth 4, a disc, and points on it."""
    rng = np.random.default_rng(seed)
    formula, disc = drawn_formula(rng, 4), drawn_disc(rng)
    return Drawn(formula, disc, disc.points(rng, 40))


def test_no_value_on_the_disc_is_outside_its_ball() -> None:
    """Relative 1e-12. Half of the balls are finite, and a third of these at most twice as large as they need to be."""
    known = tight = 0
    for seed in range(MANY):
        one = drawn(seed)
        radius = radius_of(one.formula, one.disc)
        if radius < NOTHING:
            share = farthest(one, radius)
            assert share <= 1.0 + 1e-12, f"seed {seed}: {to_text(one.formula)}, {one.disc}: {share}"
            known, tight = known + 1, tight + (share > 0.5)
    assert known > 0.5 * MANY
    assert tight > 0.33 * known


def test_balls_of_half_the_disc_are_too_small() -> None:
    """The test above would notice: a third of the finite balls."""
    caught = known = 0
    for seed in range(MANY // 4):
        one = drawn(seed)
        half = radius_of(one.formula, Disc(one.disc.centre, tuple(0.5 * r for r in one.disc.radius)))  # type: ignore[arg-type]
        if half < NOTHING:
            known, caught = known + 1, caught + (farthest(one, half) > 1.0 + 1e-12)
    assert caught > 0.33 * known


@pytest.mark.parametrize("rule", RULES)
def test_a_rule_that_is_too_small_by_a_tenth_is_noticed(rule: str) -> None:
    true = getattr(ball_radii, rule)
    wrong = {rule: lambda *numbers: 0.9 * true(*numbers)}
    ones = (drawn(seed) for seed in range(MANY))
    radii = ((one, radius_of(one.formula, one.disc, wrong)) for one in ones)
    assert any(farthest(one, radius) > 1.0 + 1e-12 for one, radius in radii if radius < NOTHING)


CENTRES = (-1e3, -300.0, -30.0, -3.0, -0.1, 0.0, 0.01, 1.0, 10.0, 100.0, 1e3)
NESTED = {
    "logistic": lambda u: 1.0 / (1.0 + e.exp(u)),
    "product of logistics": lambda u: 1.0 / ((1.0 + e.exp(u)) * (2.0 + e.exp(-u))),
    "hyperbolic secant": lambda u: 1.0 / (0.5 * (e.exp(u) + e.exp(-u))),
    "logarithm of cosh": lambda u: e.log(0.5 * (e.exp(u) + e.exp(-u))),
    "root of a logistic": lambda u: e.sqrt(1.0 / (1.0 + e.exp(u))),
    "power of a logistic": lambda u: e.Expression("pow", (1.0 + e.exp(-u), e.as_expression(-7.3))),
    "tanh": e.tanh,
    "arcsinh": e.arcsinh,
    "logarithm": lambda u: e.log(1e-6 + u * u),
    "root": lambda u: e.sqrt(1e-6 + u * u),
    "power": lambda u: e.Expression("pow", (1.0 + u * u, e.as_expression(0.3))),
    "bump": lambda u: e.exp(-(u * u)),
    "Gompertz": lambda u: e.exp(-e.exp(-u)),
    "sine of an exponential": lambda u: e.sin(e.exp(-u * u)),
}


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


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", list(FORMULAS))
def test_radii_after_a_series_are_the_same_in_lanes_and_floats_and_hold(name: str) -> None:
    """`radii` uses what the series has left. Relative 1e-14: a processor may fuse products and sums otherwise in lanes."""
    functions, constants = compiled(FORMULAS[name], 0.0)
    rng = np.random.default_rng(3)
    c, k, load, series, ball = (apart(rows, WIDTH) for rows in (len(constants), 12, TERMS, 2 * TERMS, Ball.total))
    c[:] = constants[:, None]
    k[:] = np.array([9.8, 100.0, 1.0, 0.05, 0.0, 0.0, 0.0, 3.0, 0.5, 0.1, 1.0, 0.0])[:, None]
    k[5] = rng.uniform(0.05, 0.3, WIDTH)
    load[0], ball[0], ball[1] = 60.0, rng.uniform(1e-3, 0.1, WIDTH), rng.uniform(1e-3, 0.1, WIDTH)
    pointers = [block.ctypes.data for block in (c, k, load, series, ball)]
    ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(functions.address("motion_jets"))(*pointers[:4])
    three = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)
    three(functions.address("radii_in_lanes"))(pointers[0], pointers[3], pointers[4])
    double = ctypes.POINTER(ctypes.c_double)
    tree = e.as_expression(FORMULAS[name](e, e.SLIP, e.RATE))
    for n in range(WIDTH):
        own = [np.ascontiguousarray(block[:, n]) for block in (c, k, load, np.zeros_like(series), ball)]
        own[4][FRICTION] = 0.0
        JET(functions.address("motion_jet"))(*(array.ctypes.data_as(double) for array in own[:4]))
        three(functions.address("radii"))(*(array.ctypes.data for array in (own[0], own[3], own[4])))
        assert float(ball[FRICTION, n]) == pytest.approx(float(own[4][FRICTION]), rel=1e-14, abs=0.0)
        disc = Disc((float(k[5, n]), float(own[3][0]), 0.0), (float(ball[0, n]), float(ball[1, n]), 0.0))
        assert farthest(Drawn(tree, disc, disc.points(rng, 200)), float(ball[FRICTION, n])) <= 1.0 + 1e-12


def test_an_exponential_that_underflows_at_the_centre_still_has_a_ball() -> None:
    """exp(-746) is zero in doubles, and the disc reaches exp(-53)."""
    formula, disc = 1e30 * e.exp(e.SLIP), Disc((-746.0, 0.0, 0.0), (693.0, 0.0, 0.0))
    reached = exact_distance(formula, disc, np.array([-53.0, 0.0, 0.0]))
    assert radius_of(formula, disc) >= reached
