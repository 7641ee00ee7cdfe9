"""Exponentials, logarithms and sines of small numbers keep the digits that a difference or a sum loses."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.engine.formula_code.taylor_series import ORDER
from stickslip.engine.series.sine import sine, versine
from stickslip.friction.formula.expression import RATE, SLIP
from stickslip.friction.formula.functions import COMPOSED, expm1, log1p
from stickslip.friction.formula.text import parse
from tests.engine.formulas import enclose, series

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


EXACT = {"expm1": mpmath.expm1, "log1p": mpmath.log1p}
ARGUMENTS = [(-60.0, 1.0), (-3.0, 1.0), (-0.4, 1.0), (0.0, 1e-18), (0.0, 1.0), (1e-9, 1e-3), (2.0, 1.0), (40.0, 1.0)]
"""Values of the argument at the reference point, and how far the path leads from there."""


def path(start: float, size: float, seed: int) -> list[float]:
    """Return the coefficients of a path whose terms fall off, all of one sign: sums of products then have no cancellation."""
    rng = np.random.default_rng(seed)
    return [start, *(size * rng.uniform(0.5, 1.0) * 0.4**k for k in range(1, ORDER + 1))]


@pytest.mark.parametrize(("start", "size"), ARGUMENTS)
@pytest.mark.parametrize("name", ["expm1", "log1p"])
def test_value_difference_and_taylor_coefficients_to_order_18_agree_with_mpmath(name: str, start: float, size: float) -> None:
    """1e-13 relative; coefficients of a logarithm have terms of both signs, whose size is the measure for them."""
    if name == "log1p" and start <= -1.0:
        start = -0.99
    function, reference = {"expm1": expm1, "log1p": log1p}[name], 0.5 * start
    slip = path(start - reference, size, 3)
    found, step = series(function(SLIP), reference, slip)
    with mpmath.workdps(60):
        whole = [mpmath.mpf(reference) + mpmath.mpf(slip[0]), *map(mpmath.mpf, slip[1:])]
        exact = composed(name, whole)
        sizes = composed(name, whole, of_magnitudes=True)
        change = EXACT[name](whole[0]) - EXACT[name](mpmath.mpf(reference))
    assert step == pytest.approx(float(change), rel=1e-13, abs=0.0)
    for k in range(ORDER + 1):
        assert found[k] == pytest.approx(float(exact[k]), rel=1e-13, abs=1e-13 * float(abs(sizes[k])))


def composed(name: str, a: list[Any], of_magnitudes: bool = False) -> list[Any]:
    """Return the Taylor coefficients of a function of a series, from its differential equation, in mpmath's precision.

    With `of_magnitudes`, the terms of each coefficient are added without their signs; this is 0 where no digits can be lost.
    """
    if name == "expm1":
        power = [mpmath.exp(a[0])]
        for k in range(1, len(a)):
            power.append(sum(j * a[j] * power[k - j] for j in range(1, k + 1)) / k)
        return [mpmath.mpf(0)] * len(a) if of_magnitudes else [mpmath.expm1(a[0]), *power[1:]]
    exact, sizes = [mpmath.log1p(a[0])], [mpmath.mpf(0)]
    for k in range(1, len(a)):
        terms = [k * a[k], *(-j * exact[j] * a[k - j] for j in range(1, k))]
        exact.append(sum(terms) / (k * (1 + a[0])))
        large = [k * a[k], *(j * (abs(exact[j]) + sizes[j]) * a[k - j] for j in range(1, k))]
        sizes.append(sum(large) / (k * (1 + a[0])) if k > 1 else mpmath.mpf(0))
    return sizes if of_magnitudes else exact


@pytest.mark.parametrize("text", ["0.5 + 1e16*expm1(1e-18*v)", "0.5 + 1e16*log1p(1e-18*v)", "0.5 + 1e16*sinh(1e-18*v)"])
def test_digits_of_small_arguments_are_kept(text: str) -> None:
    """0.51 at 1 m/s: exp(1e-18) - 1 and log(1 + 1e-18) would be 0."""
    law = ss.friction.FromExpression(text)
    assert float(law.coefficient(0.0, 1.0)) == pytest.approx(0.51, rel=1e-15, abs=0.0)
    assert law.slopes(0.0, 1.0)[1] == pytest.approx(0.01, rel=1e-14, abs=0.0)
    (value, value_high), (slope, slope_high), _ = (one[:, 0] for one in enclose(law.tree, {}, 0.0, [1.0], [1.0]))
    assert value <= 0.51 <= value_high <= value * (1.0 + 1e-14)
    assert slope <= 0.01 <= slope_high <= slope * (1.0 + 1e-12)


def test_the_two_functions_are_read_from_text_as_what_they_are() -> None:
    assert parse("expm1(v) + log1p(u)", ()) == expm1(RATE) + log1p(SLIP)
    assert parse("sinh(v)", ()) == COMPOSED["sinh"](RATE)


def test_a_quotient_over_expm1_has_its_limit_where_expm1_overflows() -> None:
    """x / (exp(x) - 1) is 0 beside the rest of the law for x of a million, and its series is finite."""
    law = ss.friction.FromExpression("0.6 + 0.1*(v/1e-6 + 1e-3)/expm1(v/1e-6 + 1e-3)")
    found, step = series(law.tree, 0.0, [0.0] * (ORDER + 1), [1.0, *[0.1] * ORDER])
    assert found[0] == pytest.approx(0.6, rel=1e-14)
    assert np.isfinite(found).all()
    assert step == pytest.approx(-0.1 * 1e-3 / math.expm1(1e-3), rel=1e-12)


LAWS = {
    "weakening with slip": "0.6 + 0.15*expm1(-u/2)",
    "weakening with rate": "0.6 + 0.1*expm1(-v/3) + 0.02*log1p(v/0.5)",
    "strengthening with rate": "0.5 + 0.03*log1p(v)",
    "a power of a logarithm": "0.7 - 0.02*log1p(v/0.2)**2 + 0.01*expm1(0.01*u)",
}
"""Laws whose block slips some metres before it rests."""
MASS, STIFFNESS, NORMAL, EXCESS = 2.8e12, 3.43e13, 1e14, 5e12


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", LAWS)
def test_whole_runs_agree_with_scipy(name: str) -> None:
    """Slip and time of the first arrest of a block, to 1e-9 relative, against DOP853 with numpy's functions."""
    text = LAWS[name]

    def friction(u: float, v: float) -> float:
        return float(eval(text, {"expm1": np.expm1, "log1p": np.log1p}, {"u": u, "v": v}))

    def motion(t: float, y: Any) -> list[float]:
        load = NORMAL * friction(0.0, 0.0) + EXCESS - STIFFNESS * y[0]
        return [y[1], (load - NORMAL * friction(y[0], y[1])) / MASS]

    def rests(t: float, y: Any) -> float:
        return float(y[1])

    rests.terminal, rests.direction = True, -1.0  # type: ignore[attr-defined] # scipy reads them from the function
    truth = solve_ivp(motion, (0.0, 30.0), [0.0, 0.0], method="DOP853", rtol=1e-13, atol=1e-15, events=rests)
    end, slip = float(truth.t[-1]), float(truth.y[0, -1])
    block = ss.SpringBlock(MASS, STIFFNESS, NORMAL)
    run = ss.simulate(ss.Problem(block, text, initial_excess=EXCESS), 1.01 * end)
    assert float(run.catalogue(0.0).end[0]) == pytest.approx(end, rel=1e-9, abs=0.0)
    assert float(run.slip(end)) == pytest.approx(slip, rel=1e-9, abs=0.0)
