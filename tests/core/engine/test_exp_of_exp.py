"""Laws whose inner exponential overflows where the law itself is tame run through, and obey the contact equation."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.engine.formula_code.taylor_series import FormulaWriter

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
EXCESS = 2e6
"""Load above static strength at the start, Pa."""
FORMULAS: dict[str, Callable[[Any], Any]] = {
    "0.6 + 0.3/(1 + exp(exp((0.8 - u)/0.01) - 5))": lambda u: 0.6 + 0.3 / (1.0 + np.exp(np.exp((0.8 - u) / 0.01) - 5.0)),
    "0.6 + 0.3*exp(-exp(exp((0.8 - u)/0.05)))": lambda u: 0.6 + 0.3 * np.exp(-np.exp(np.exp((0.8 - u) / 0.05))),
    "0.6 + 0.3*exp(-exp(exp((0.8 - u)/0.05) + 2)/9)": lambda u: 0.6 + 0.3 * np.exp(-np.exp(np.exp((0.8 - u) / 0.05) + 2.0) / 9.0),
    "0.6 + 0.3/(1 + exp(((1.5 - u)/0.1)**12))": lambda u: 0.6 + 0.3 / (1.0 + np.exp(((1.5 - u) / 0.1) ** 20)),
}
"""Friction is 0.6 up to the middle of the rise, which the slip reaches after some seconds."""


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("formula", FORMULAS)
@np.errstate(over="ignore")
def test_slip_and_friction_are_those_of_the_law(formula: str) -> None:
    """Slip against an implicit integrator, to 1e-7 m; friction at 400 moments to within the bound that is proven."""
    mu = FORMULAS[formula]
    run = ss.simulate(ss.Problem(SLAB, ss.friction.FromExpression(formula), initial_excess=EXCESS), 5.0)
    load = 1e8 * mu(0.0) + EXCESS
    assert run.status.name in ("finished", "locked for ever")
    known = solve_ivp(lambda _, u: (load - 1e8 * mu(u)) / SLAB.impedance, (0.0, 5.0), [0.0], "Radau", rtol=1e-10, atol=1e-12)
    assert known.y[0, -1] > 0.7
    assert float(run.slip(5.0)) == pytest.approx(known.y[0, -1], rel=0.0, abs=1e-7)
    times = np.linspace(0.0, 5.0, 401)[1:]
    missed = run.load(times) - SLAB.impedance * run.slip_rate(times) - 1e8 * mu(run.slip(times))
    assert np.abs(missed).max() < 1.1 * run.proven.residual + 1e-6


def test_only_an_exponential_of_steep_functions_counts_as_constant() -> None:
    def counted(formula: str) -> int:
        (tree,) = ss.friction.FromExpression(formula).trees()
        writer = FormulaWriter(tree, ())
        return sum(writer.saturates(node) for node in writer.nodes)

    assert [counted(formula) for formula in FORMULAS] == [1, 1, 1, 1]
    assert counted("0.6 + 0.3/(1 + exp((0.8 - u)/0.001))") == 0
    assert counted("0.6 + 1e-9*exp(sin(u))") == 0
