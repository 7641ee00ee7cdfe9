"""Guards: which nodes of a formula end a step, how far their arguments may move, and steps that would jump over a feature."""

from __future__ import annotations

import ctypes
import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.codegen.compiler import compile_formula
from stickslip.engine.codegen.guards import HIDDEN, IN_SIGHT, SHARE
from stickslip.engine.codegen.taylor_series import FormulaWriter
from stickslip.friction.formula.parse import parse

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)


@pytest.mark.parametrize(
    ("formula", "guarded"),
    [
        ("1 + 0.5*sin(5*u)", []),
        ("0.6 - 0.1*u**3 + 0.01*cos(u)*v", []),
        ("0.3 + 0.5/(1 + 2*v)", ["div"]),
        ("0.6 + 0.05*exp(-((u - 1)/0.1)**2)", ["exp"]),
        ("0.6 + 0.05*tanh((u - 1)/0.1)", ["tanh"]),
        ("0.6 + 0.05/(1 + exp((u - 1)/0.1))", ["exp"]),
        ("0.5 + 0.1*(1 + v)**0.3", ["pow"]),
        ("0.5 + 0.1*log(1 + v) + 0.1*sqrt(1 + u*u)", ["sqrt"]),
        ("0.5 + 0.1*exp(-1/0.3)", []),
        ("0.5 + 0.01*arcsinh(v/1e-6)", []),
        ("0.5 + 0.1/(1 + v + exp(-v/0.1))", ["exp"]),
    ],
)
def test_what_can_vanish_below_rounding_is_guarded(formula: str, guarded: list[str]) -> None:
    writer = FormulaWriter(parse(formula, ()), ())
    assert [guard.operation for guard in writer.guards] == guarded


def pulls(formula: str, u: float, v: float) -> np.ndarray:
    """Arguments and pulls of a formula's guards at a slip (m) and a slip rate (m/s), from the compiled code."""
    compiled = compile_formula(parse(formula, ()), ())
    constants, out = np.zeros(compiled.size), np.zeros(2 * compiled.guard_count)
    double = ctypes.POINTER(ctypes.c_double)
    compiled.fill(np.zeros(1), 0.0, constants)
    at = ctypes.CFUNCTYPE(None, double, ctypes.c_double, ctypes.c_double, ctypes.c_double, double)(compiled.address("guards"))
    at(constants.ctypes.data_as(double), u, v, 0.0, out.ctypes.data_as(double))
    return out.reshape(-1, 2)


@pytest.mark.parametrize("z", [-1e4, -60.0, -52.0, -20.0, -1.0, 3.0, 70.0, 1e5])
def test_an_exponent_may_move_to_where_it_counts(z: float) -> None:
    """Towards zero, up to HIDDEN from far away, and by IN_SIGHT from nearer; to 1e-12."""
    ((argument, pull),) = pulls("0.6 + 0.01*exp(u)", z, 0.0)
    assert argument == pytest.approx(z, rel=1e-12)
    room = max(abs(z) - HIDDEN, IN_SIGHT)
    assert 1.0 / pull == pytest.approx(-math.copysign(room, z), rel=1e-12)


@pytest.mark.parametrize(("base", "exponent"), [(1e-3, 40.0), (0.9, 40.0), (30.0, -20.0), (1.2, 0.5), (5.0, 100.0)])
def test_a_power_may_move_to_where_it_counts(base: float, exponent: float) -> None:
    """As the exponential of exponent x log base; to 1e-10."""
    ((argument, pull),) = pulls(f"0.6 + 0.01*u**({exponent})", base, 0.0)
    height = exponent * math.log(base)
    room = max(abs(height) - HIDDEN, IN_SIGHT)
    goal = math.exp((height - math.copysign(room, height)) / exponent)
    assert argument == pytest.approx(base, rel=1e-12)
    assert 1.0 / pull == pytest.approx(goal - base, rel=1e-10)


def test_a_denominator_may_not_reach_zero() -> None:
    ((argument, pull),) = pulls("0.3 + 0.5/(1 + 2*v)", 0.0, 10.0)
    assert argument == pytest.approx(21.0, rel=1e-12)
    assert 1.0 / pull == pytest.approx(-SHARE * 21.0, rel=1e-12)


def off_the_law(solution: ss.Solution, times: np.ndarray) -> float:
    """Largest |traction / normal stress - mu(u, v)| at times of slip."""
    law, rate = solution.problem.friction, solution.slip_rate(times)
    miss = np.abs(np.abs(solution.traction(times)) / 1e8 - law.coefficient(solution.slip(times), np.abs(rate)))
    return float(np.max(np.where(rate != 0.0, miss, 0.0)))


@pytest.mark.parametrize(
    "formula",
    [
        "0.6 + 0.05*exp(-((u - 1)/{w})**2)",
        "0.6 + 0.05*tanh((u - 1)/{w})",
        "0.6 + 0.05/(1 + exp((u - 1)/{w}))",
        "0.6 + 0.05/(1 + ((u - 1)/{w})**2)",
        "0.6 + 0.05*sqrt((u - 1)**2 + {w}**2)",
        "0.6 + 0.05*exp(-((u - 1)/0.1)**2)*sin(u/{w})",
        "0.6 + 0.04*exp(-((u - 1)/{w})**2) - 0.02*exp(-((u - 1.5)/{w})**2)*tanh((u - 1.5)/{w})",
    ],
)
@pytest.mark.parametrize("width", [1e-1, 1e-2, 1e-4])
def test_slip_meets_every_feature_on_its_way(formula: str, width: float) -> None:
    """The times of slips next to the feature come from the run itself: it is met if they are there, and the law holds at them.

    Traction within 2e-9 of the normal stress; before there were guards it was off by up to 5 %.
    """
    law = F.FromExpression(formula.format(w=width))
    solution = ss.simulate(ss.Problem(SLAB, law, initial_excess=2e7), 4.0)
    pieces = solution.history
    start = pieces.store.slip
    assert solution.status.ok
    assert start[0] == 0.0
    assert np.count_nonzero(np.abs(start - 1.0) < 6.0 * width) >= 3
    near = np.concatenate([np.linspace(a, b, 33) for a, b in zip(pieces.start, pieces.end, strict=True)])
    assert off_the_law(solution, near) < 2e-9


@pytest.mark.parametrize("power", [4, 6, 8])
def test_a_series_with_gaps_is_not_taken_for_a_polynomial(power: int) -> None:
    """Under u^n from u = 0 only every n-th coefficient is not zero: the last two may vanish. Law met to 1e-10."""
    law = F.FromExpression(f"0.6 + 0.05*u**{power}")
    solution = ss.simulate(ss.Problem(SLAB, law, initial_excess=1e7), 4.0)
    assert len(solution.history) > 2
    assert off_the_law(solution, np.linspace(0.0, 4.0, 4001)) < 1e-10


@pytest.mark.parametrize("power", [4, 8, 12, 16])
@pytest.mark.parametrize("start", [1e-6, 1e-4, 1e-3, 1e-2])
def test_the_contact_equation_is_met_where_the_last_coefficients_are_next_to_nothing(power: int, start: float) -> None:
    """Under u^n from a small slip on the last two coefficients are tiny, and those before them are not: a step far too long.

    No guard holds here. Law met to 1e-10; without the look at the contact equation it is missed by up to 6e-2, and slip
    grows beyond all measure for n = 8.
    """
    law = F.FromExpression(f"0.6 + 0.05*u**{power}")
    solution = ss.simulate(ss.Problem(SLAB, law, initial_slip=start, initial_excess=1e7), 2.0)
    assert solution.status.ok
    assert off_the_law(solution, np.linspace(0.0, 2.0, 2001)) < 1e-10
