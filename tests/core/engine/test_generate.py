"""Generated Taylor recurrences, for every operation that a formula may contain."""

from __future__ import annotations

import gc
import math
import weakref

import mpmath
import numpy as np
import pytest
from numpy.polynomial import Polynomial

import stickslip as ss
from stickslip.engine.compiled_formula import compile_formula
from stickslip.engine.input import prepare
from stickslip.engine.state.layout import TERMS
from stickslip.friction.formula import expression as e
from stickslip.friction.formula import functions
from tests.core.engine.balls import EXACT
from tests.core.engine.formulas import FORMULAS, JET, VALUE, functions_of, pointer


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", FORMULAS)
def test_difference_keeps_its_digits(name: str) -> None:
    """mu(u0 + d, s) - mu(u0, 0) against 50 digits, for steps where plain subtraction has none left."""
    formula, reference, out = FORMULAS[name], 0.21, np.zeros(3)
    functions, constants = functions_of(formula, reference)
    for step, rate in ((1e-13, 2e-13), (1e-7, 1e-8), (0.3, 0.2)):
        VALUE(functions.address("value"))(pointer(constants), step, rate, pointer(out))
        with mpmath.workdps(50):
            exact = formula(EXACT, mpmath.mpf(reference) + mpmath.mpf(step), mpmath.mpf(rate))
            exact -= formula(EXACT, mpmath.mpf(reference), mpmath.mpf(0))
        assert out[0] == pytest.approx(float(exact), rel=5e-12, abs=0.0)


def test_the_difference_of_an_exponential_is_exact_where_it_underflows() -> None:
    """exp(-1000) is 0 and exp(1000) is infinite: their product must not be taken."""
    functions, constants = functions_of(lambda f, u, v: 0.3 + 0.5 * f.exp(-1000.0 * u), 1.0)
    out = np.zeros(3)
    for step in (-1.0, -0.99, -0.5, 0.5):
        VALUE(functions.address("value"))(pointer(constants), step, 0.0, pointer(out))
        with mpmath.workdps(50):
            exact = 0.5 * (mpmath.exp(-1000 * (1 + mpmath.mpf(step))) - mpmath.exp(-1000))
            slope = -500 * mpmath.exp(-1000 * (1 + mpmath.mpf(step)))
        assert [out[0], out[2]] == pytest.approx([float(exact), float(slope)], rel=1e-12, abs=0.0)


def layout_of_k(rate: float, mass: float = 0.7, bend: float = 0.0, speed: float = 0.05) -> np.ndarray:
    """Z = 1.3, S = 0.9, chi = 1, dtheta/deta = speed + bend eta, no slip yet, no offset, K = 0.8, free contact."""
    return np.array([1.3, 0.9, 1.0, speed, bend, 0.0, 0.0, mass, 0.8, rate, 1.0, 0.0])


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize("bend", [0.0, 0.03])
@pytest.mark.parametrize("name", FORMULAS)
def test_rate_jet_solves_the_contact_equation(name: str, bend: float) -> None:
    """Z s + S mu(x, s) = L along the whole step, x the integral of the computed s."""
    formula = FORMULAS[name]
    functions, constants = functions_of(formula, 0.21)
    start = 0.4
    load, jet = np.zeros(TERMS), np.zeros(2 * TERMS)
    load[0] = 1.3 * start + 0.9 * (formula(np, 0.21, start) - formula(np, 0.21, 0.0))
    load[1:4] = 0.05, -0.02, 0.01
    JET(functions.address("rate_jet"))(pointer(constants), pointer(layout_of_k(start, bend=bend)), pointer(load), pointer(jet))
    jet = jet[:TERMS]  # the bound of the guards follows
    eta = np.linspace(0.0, 0.4, 9)  # half of what the quotient's series reaches to this accuracy
    rate = Polynomial(jet)
    slip = 0.21 + (Polynomial([0.05, bend]) * rate).integ()(eta)
    residual = 1.3 * rate(eta) + 0.9 * (formula(np, slip, rate(eta)) - formula(np, 0.21, 0.0)) - Polynomial(load)(eta)
    assert jet[0] == pytest.approx(start, rel=1e-12, abs=0.0)
    assert np.abs(residual).max() < 1e-13
    assert np.abs(jet[1:]).max() > 1e-4


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("bend", [0.0, 0.03])
@pytest.mark.parametrize("name", FORMULAS)
def test_motion_jet_solves_the_equation_of_motion(name: str, bend: float) -> None:
    """M ds/dt = L - K q - Z s - S mu along the whole step."""
    formula = FORMULAS[name]
    functions, constants = functions_of(formula, 0.21)
    load, jet = np.zeros(TERMS), np.zeros(2 * TERMS)
    load[:3] = 0.6, 0.05, -0.02
    JET(functions.address("motion_jet"))(pointer(constants), pointer(layout_of_k(0.4, bend=bend)), pointer(load), pointer(jet))
    jet = jet[:TERMS]
    eta = np.linspace(0.0, 0.8, 9)
    rate, clock = Polynomial(jet), Polynomial([0.05, bend])
    walked = (clock * rate).integ()(eta)
    friction = formula(np, 0.21 + walked, rate(eta)) - formula(np, 0.21, 0.0)
    force = Polynomial(load)(eta) - 0.8 * walked - 1.3 * rate(eta) - 0.9 * friction
    assert 0.7 * rate.deriv()(eta) == pytest.approx(force * clock(eta), rel=0.0, abs=1e-13)
    assert math.isclose(jet[0], 0.4)


def test_a_law_compiles_once() -> None:
    tree = e.as_expression(FORMULAS["sin"](functions, e.SLIP, e.RATE))
    assert compile_formula(tree, (), ()) is compile_formula(tree, (), ())


def test_a_formula_lives_as_long_as_a_table_that_holds_its_addresses_and_no_longer() -> None:
    """The caches hold a few; a run that goes on keeps its own, whatever is compiled meanwhile."""
    problem = ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), "0.3 + 0.5/(1 + v)", initial_excess=1e5)
    setup, memory = prepare.prepare(problem, 1e-10)
    law = problem.friction
    formula = weakref.ref(compile_formula(law.trees()[0], law.parameters(), law.state_trees()))
    for cache in (compile_formula, prepare._prepared, prepare._of_problem):
        cache.cache_clear()
    gc.collect()
    assert formula() is not None
    del setup, memory
    gc.collect()
    assert formula() is None
