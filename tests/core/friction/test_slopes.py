"""Slopes of formulas as formulas: each operation, and formulas drawn at random."""

from __future__ import annotations

import numpy as np
import pytest

from stickslip.friction.formula.differences import slope_formula, value_and_slopes
from stickslip.friction.formula.expression import RATE, SLIP, Expression, as_expression
from stickslip.friction.formula.functions import evaluate
from stickslip.friction.formula.operations import OPERATIONS
from tests.core.engine.balls import drawn_formula

U, V = 0.3, 0.7


def central(tree: Expression, step: float = 1e-5) -> float:
    """The derivative by the slip rate, from values at four places around it."""
    near, far = ((evaluate(tree, {}, U, V + k * step) - evaluate(tree, {}, U, V - k * step)) / (2 * k * step) for k in (1, 2))
    return float((4.0 * near - far) / 3.0)


@pytest.mark.parametrize("name", OPERATIONS)
def test_each_operation_has_its_slope(name: str) -> None:
    """Against differences of fourth order, to 1e-9."""
    inner = as_expression(0.4) + 0.5 * RATE + SLIP * RATE
    operation = OPERATIONS[name]
    tree = operation(inner, as_expression(1.7) if name == "pow" else 2.0 + SLIP * RATE) if operation.sign else operation(inner)
    slope = evaluate(slope_formula(tree, RATE), {}, U, V)
    assert slope == pytest.approx(central(tree), rel=1e-9, abs=0.0)


def test_formulas_drawn_at_random_have_the_slopes_of_the_rules_on_numbers() -> None:
    """To 1e-9 of the slope, in nine tenths of 300 formulas; the rest overflows or cancels at the drawn place."""
    right = 0
    for seed in range(300):
        tree = drawn_formula(np.random.default_rng(seed), 3)
        with np.errstate(all="ignore"):
            slopes = value_and_slopes(tree, {}, U, V, 0.2, 0.1)[1][:2]
            found = [float(evaluate(slope_formula(tree, one), {}, U, V, 0.2, 0.1)) for one in (SLIP, RATE)]
        right += bool(np.allclose(found, slopes, rtol=1e-9, atol=0.0, equal_nan=True))
    assert right > 270
