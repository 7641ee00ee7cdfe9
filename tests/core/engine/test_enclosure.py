"""Interval arithmetic on formulas against 50-digit arithmetic: what is said to be enclosed is."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import RATE, SLIP, STATE, Expression
from stickslip.friction.formula.functions import exp
from stickslip.friction.formula.operations import OPERATIONS
from tests.core.engine.balls import EXACT, drawn_formula, values_of
from tests.core.engine.formulas import enclose
from tests.limits import examples

mpmath = pytest.importorskip("mpmath")
mpmath.mp.dps = 50

SLIP_HERE = 0.3


def exact(tree: Expression, rate: Any) -> Any:
    """The formula in 50 digits. Raises ValueError outside its domain, and where exponentials leave nothing else to be seen."""
    found = values_of(tree, (mpmath.mpf(SLIP_HERE), mpmath.mpf(rate), mpmath.mpf(0)), EXACT)
    if not all(isinstance(value, mpmath.mpf) and abs(value) < mpmath.exp(60) for value in found):
        raise ValueError(str(tree))
    return found[-1]


def escapes(seed: int, trees: int, width: float, depth: int = 4) -> tuple[int, int]:
    """How many of so many values and derivatives at points in cells of a relative width are outside their bounds.

    No tolerance: only the error of the 50-digit derivative, 1e-30 of its size, is allowed for.
    """
    rng, outside, checked = np.random.default_rng(seed), 0, 0
    for _ in range(trees):
        tree = drawn_formula(rng, depth, (RATE, RATE, SLIP))
        low = float(10.0 ** rng.uniform(-4.0, 2.0))
        high = low * (1.0 + width * float(rng.random()))
        bounds = enclose(tree, {}, SLIP_HERE, np.array([low]), np.array([high]))
        rate = min(max(low + (high - low) * float(rng.random()), low), high)
        for order in range(3):
            try:
                value = mpmath.diff(lambda v, tree=tree: exact(tree, v), rate, order)
            except (ValueError, ZeroDivisionError, OverflowError):
                continue
            slack = mpmath.mpf(10) ** -30 * (1 + abs(value))
            least, most = (float(one) for one in bounds[order][:, 0])
            outside += not ((least == -math.inf or least - slack <= value) and (most == math.inf or value <= most + slack))
            checked += 1
    return outside, checked


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("width", "trees"), [(0.0, 80), (0.03, 80), (1.0, examples(80))])
def test_bounds_hold_the_exact_values_and_derivatives(width, trees):
    outside, checked = escapes(seed=int(1e3 * width) + 7, trees=trees, width=width)
    assert checked > 2.2 * trees
    assert outside == 0


def test_bounds_at_single_rates_are_tight():
    """A formula of ten operations is enclosed to 1e-14 of its size, absolute where it is of the size of 1."""
    tree = 0.3 + 0.5 / (1.0 + 1.7 * RATE) + 0.1 * exp(-RATE)
    rates = np.geomspace(1e-9, 1e2, 50)
    for low, high in enclose(tree, {}, 0.0, rates, rates)[:2]:
        assert np.all(high > low)
        assert np.all(high - low <= 1e-14)


CELL_FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    **{name: getattr(np, name) for name in ("sin", "cos", "exp", "expm1", "tanh", "arcsinh")},
    "square": np.square,
    "logistic": lambda x: 1.0 / (1.0 + np.exp(x)),
}


def formula_of(name: str) -> Expression:
    """A function of the slip rate, which may be negative here."""
    return RATE * RATE if name == "square" else 1.0 / (1.0 + exp(RATE)) if name == "logistic" else OPERATIONS[name](RATE)


@pytest.mark.parametrize("name", CELL_FUNCTIONS)
def test_functions_of_cells_are_the_hull_of_their_values(name):
    """Sampled at 2001 places: no value lies outside by more than 1e-14, and no bound by more than the samples may miss."""
    numeric = CELL_FUNCTIONS[name]
    rng = np.random.default_rng(11)
    low = np.concatenate((rng.uniform(-20.0, 20.0, 300), 0.25 * np.pi * np.arange(-20, 20)))
    high = low + rng.exponential(2.0, low.shape)
    least, most = enclose(formula_of(name), {}, 0.0, low, high)[0]
    values = numeric(np.linspace(low, high, 2001))
    steepest = np.max(np.abs(np.diff(values, axis=0)), axis=0)
    size = 1e-14 * (1.0 + np.max(np.abs(values), axis=0))
    for outside in (least - values.min(axis=0), values.max(axis=0) - most):
        assert np.all(outside <= size)
        assert np.all(outside >= -steepest - size)


def test_cells_where_a_formula_may_be_undefined_have_no_bounds():
    for tree in (OPERATIONS["log"](RATE - 1.0), OPERATIONS["sqrt"](RATE - 1.0), 1.0 / (RATE - 1.0), (RATE - 1.0) ** 0.5):
        first = enclose(tree, {}, 0.0, np.array([0.5]), np.array([2.0]))[1]
        assert first.tolist() == [[-np.inf], [np.inf]]


def test_products_with_an_infinite_end_are_numbers():
    """0 times an infinite end is 0, for that end is never reached; bounds are never NaN and never cross."""
    rng = np.random.default_rng(3)
    numbers = np.array([-np.inf, -1e300, -1.0, -5e-324, 0.0, 5e-324, 1.0, 1e300, np.inf])
    low, high = np.sort(rng.choice(numbers, size=(2, 400)), axis=0)
    keep = (low < np.inf) & (high > -np.inf)
    cells = np.array([low[keep], high[keep]])
    slip = cells[0, ::-1], cells[1, ::-1]
    for tree in (RATE + SLIP, RATE - SLIP, RATE * SLIP, RATE * RATE, 1.0 / RATE, RATE / SLIP, exp(RATE), OPERATIONS["log"](RATE)):
        with np.errstate(invalid="ignore"):
            for least, most in enclose(tree, {}, slip, *cells)[:2]:
                assert np.all(least <= most)
                assert np.all(least < np.inf)
                assert np.all(most > -np.inf)


def test_a_power_of_the_slip_rate_is_enclosed():
    """(1 + v)**v, whose exponent depends on the slip rate; d/dv = value (log(1 + v) + v / (1 + v))."""
    value, slope, _ = enclose(Expression("pow", (1.0 + RATE, RATE)), {}, 0.0, 1.0, 1.0)
    assert value[0, 0] <= 2.0 <= value[1, 0] <= 2.0 * (1 + 1e-13)
    assert slope[0, 0] <= 2.0 * (math.log(2.0) + 0.5) <= slope[1, 0]


def test_a_formula_with_a_state_is_refused():
    with pytest.raises(InputError, match="state of its own"):
        enclose(RATE * STATE, {}, 0.0, 0.0, 1.0)
