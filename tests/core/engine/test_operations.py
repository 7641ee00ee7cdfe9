"""Every operation of formulas is asked for every rule, and each rule is compared with mpmath."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from stickslip.engine.formula_code.taylor_series import ORDER
from stickslip.foundation.errors import InputError
from stickslip.friction.formula.bounds import bounds
from stickslip.friction.formula.differences import difference, limited, value_and_slopes
from stickslip.friction.formula.expression import RATE, SLIP, Expression, as_expression
from stickslip.friction.formula.functions import evaluate
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS, Operation
from stickslip.friction.formula.text import parse, to_text
from tests.core.engine.balls import EXACT, Disc, radius_of
from tests.core.engine.formulas import series, written_slopes

Formula = Callable[[Any, Any], Any]
"""A formula of slip and slip rate, for nodes and for numbers of mpmath alike."""
INNER: tuple[Formula, ...] = (
    lambda u, v: 2.0 + 0.75 * u,
    lambda u, v: 0.5 + u * u + 3.0 * v,
    lambda u, v: 1.0 / (1.0 + v) + 0.25 * u,
)
"""Arguments: linear in slip, and two that are not; all are positive where they are used, as a logarithm wants it."""
DIGITS, ORDERS = 40, 9
POINTS = [(0.0, 1e-9, 1e-12), (0.7, -1e-6, 0.3), (2.0, 0.5, 4.0)]
"""Slip at the reference point (m), how far slip is from it (m), and slip rate (m/s)."""


def formulas(operation: Operation) -> list[tuple[Expression, Formula]]:
    """Trees with the operation, and the same for numbers of mpmath; the exponent of a power is a constant."""
    exact = operation.value if operation.sign else getattr(EXACT, operation.name)
    found = []
    for n, first in enumerate(INNER):
        seconds = (INNER[n - 1], lambda u, v: -1.25) if operation.sign else (None,)
        for second in seconds if operation.name != "pow" else seconds[1:]:
            inner = (first, second) if second else (first,)
            tree = operation(*(as_expression(one(SLIP, RATE)) for one in inner))
            found.append((tree, lambda u, v, inner=inner: exact(*(mpmath.mpmathify(one(u, v)) for one in inner))))
    return found


def check_values(operation: Operation) -> None:
    for tree, exact in formulas(operation):
        for slip, step, rate in POINTS:
            with mpmath.workdps(DIGITS):
                wanted = exact(mpmath.mpf(slip) + mpmath.mpf(step), mpmath.mpf(rate))
            assert float(evaluate(tree, {}, slip + step, rate)) == pytest.approx(float(wanted), rel=1e-13, abs=1e-15)


def check_steps_and_slopes(operation: Operation) -> None:
    for tree, exact in formulas(operation):
        for slip, step, rate in POINTS:
            found = difference(tree, {}, slip, step, rate)
            slopes = value_and_slopes(tree, {}, slip + step, rate)[1]
            with mpmath.workdps(DIGITS):
                u, v = mpmath.mpf(slip) + mpmath.mpf(step), mpmath.mpf(rate)
                wanted = exact(u, v) - exact(mpmath.mpf(slip), mpmath.mpf(0))
                apart = abs(exact(u, mpmath.mpf(0)) - exact(mpmath.mpf(slip), mpmath.mpf(0))) + abs(wanted)
                by_slip, by_rate = mpmath.diff(exact, (u, v), (1, 0)), mpmath.diff(exact, (u, v), (0, 1))
            assert float(found[0]) == pytest.approx(float(wanted), rel=0.0, abs=1e-13 * float(apart))
            assert float(found[1]) == pytest.approx(float(by_rate), rel=1e-12, abs=1e-14)
            assert [float(slopes[0]), float(slopes[1])] == pytest.approx([float(by_slip), float(by_rate)], rel=1e-12, abs=1e-14)


def check_bounds(operation: Operation) -> None:
    """All values lie within, and bounds of small intervals are small."""
    rng = np.random.default_rng(1)
    for tree, _ in formulas(operation):
        for width in (1.0, 1e-6):
            slips, rates = np.sort(rng.uniform(0.0, width, (2, 2)) + 0.3, axis=1).tolist()
            low, high = bounds(tree, {}, tuple(slips), tuple(rates))
            found = evaluate(tree, {}, rng.uniform(*slips, 500), rng.uniform(*rates, 500))
            assert (low <= found * (1.0 + 1e-15) + 1e-15).all()
            assert (found * (1.0 - 1e-15) - 1e-15 <= high).all()
            assert width == 1.0 or high - low < 1e-3 or (low, high) == (-1.0, 1.0)
    ends = np.array([-np.inf, -2.0, -0.5, 0.0, 0.3, 1.7, np.inf])
    low, high = (one.ravel() for one in np.meshgrid(ends, ends))
    slip, rate = (low[low <= high], high[low <= high]), (np.abs(ends[3:5])[:, None], ends[4:6][:, None])
    for tree, _ in formulas(operation):
        many = np.broadcast_arrays(*bounds(tree, {}, slip, rate), slip[0] + rate[0])
        for n, k in np.ndindex(many[0].shape):
            alone = bounds(tree, {}, (slip[0][k], slip[1][k]), (rate[0][n, 0], rate[1][n, 0]))
            assert (many[0][n, k], many[1][n, k]) == alone


def check_series(operation: Operation) -> None:
    """Difference from the reference, and the first Taylor coefficients along a path."""
    slip = [0.25, *(0.3**k for k in range(1, ORDER + 1))]
    for tree, exact in formulas(operation):
        found, change = series(tree, 0.5, slip)
        with mpmath.workdps(DIGITS):
            path = [mpmath.mpf(x) for x in (0.75, *slip[1:])]

            def moving(t: Any, path: Any = path, exact: Formula = exact) -> Any:
                rate = sum(k * x * t ** (k - 1) for k, x in enumerate(path) if k)
                return exact(sum(x * t**k for k, x in enumerate(path)), rate)

            along = mpmath.taylor(moving, 0, ORDERS)
            wanted = along[0] - exact(mpmath.mpf(0.5), mpmath.mpf(0))
        assert change == pytest.approx(float(wanted), rel=1e-12, abs=1e-15)
        size = max(abs(float(x)) * 2.0**-k for k, x in enumerate(along))
        for k in range(ORDERS + 1):
            assert found[k] == pytest.approx(float(along[k]), rel=1e-11, abs=1e-13 * size * 2.0**k)


def check_written_slopes(operation: Operation) -> None:
    for tree, exact in formulas(operation):
        with mpmath.workdps(DIGITS):
            by_rate, by_slip = (mpmath.diff(exact, (0.75, 0.5), order) for order in ((0, 1), (1, 0)))
        assert written_slopes(tree, 0.5, 0.25, 0.5) == pytest.approx([float(by_rate), float(by_slip)], rel=1e-12, abs=1e-14)


def check_radii(operation: Operation) -> None:
    """No value on the discs is farther from the centre, and one is at least a tenth as far where the disc is small."""
    rng = np.random.default_rng(2)
    for tree, exact in formulas(operation):
        for size in (0.3, 1e-3):
            disc = Disc((0.8, 0.6, 0.0), (size, 0.5 * size, 0.0))
            radius = radius_of(tree, disc)
            with mpmath.workdps(DIGITS):
                centre = exact(mpmath.mpf(0.8), mpmath.mpf(0.6))
                away = [
                    float(abs(exact(mpmath.mpmathify(complex(u)), mpmath.mpmathify(complex(v))) - centre))
                    for u, v, _ in disc.points(rng, 60).T
                ]
            assert max(away) <= radius * (1.0 + 1e-12)
            assert size > 0.1 or max(away) > 0.1 * radius


CHECKS = {
    "value": check_values,
    "step": check_steps_and_slopes,
    "slope": check_steps_and_slopes,
    "bounds": check_bounds,
    "order_zero": check_series,
    "derivative": check_written_slopes,
    "recurrence": check_series,
    "ball": check_radii,
}
"""What compares each rule; `test_discs` compares those on discs."""


@pytest.mark.sampled(every=14)
@pytest.mark.parametrize("name", OPERATIONS)
@pytest.mark.parametrize("check", list(dict.fromkeys(CHECKS.values())), ids=lambda check: check.__name__)
def test_every_rule_of_every_operation_agrees_with_mpmath(name: str, check: Callable[[Operation], None]) -> None:
    check(OPERATIONS[name])


@pytest.mark.parametrize("name", OPERATIONS)
def test_the_unit_of_a_value_is_that_by_which_it_grows(name: str) -> None:
    """A value in m^p is 2^p times as large if arguments in m are twice as large; other operations want pure numbers."""
    operation = OPERATIONS[name]
    many = 2 if operation.sign else 1
    second = as_expression(-1.5) if name == "pow" else SLIP
    node = Expression(name, (SLIP, second)[:many])
    units = [{"m": 1}, {} if name == "pow" else {"m": 1}][:many]
    once, twice = ([x * 1.7, -1.5 if name == "pow" else x * 0.6][:many] for x in (1.0, 2.0))
    growth = operation(*map(np.float64, twice)) / operation(*map(np.float64, once))
    try:
        found = operation.unit(node, *units)
    except InputError:
        assert abs(2.0 * np.log2(abs(growth)) - np.rint(2.0 * np.log2(abs(growth)))) > 1e-6
    else:
        assert growth == pytest.approx(2.0 ** float(found.get("m", 0)))
    assert operation.unit(Expression(name, (as_expression(2.0),) * many), *[{}] * many) == {}


@pytest.mark.parametrize("name", OPERATIONS)
def test_what_an_operation_says_of_zeros_and_of_large_arguments_is_true(name: str) -> None:
    operation, many = OPERATIONS[name], 2 if OPERATIONS[name].sign else 1
    large, ones = np.float64(np.exp(151.0)), [np.float64(1.5)] * many
    with np.errstate(all="ignore"):
        for place in range(many):

            def at(number: float, place: int = place) -> float:
                return float(operation(*(np.float64(number) if k == place else one for k, one in enumerate(ones))))

            assert (place in operation.zeros) == (at(0.0) == 0.0) or name == "pow"
            assert place not in operation.settles or abs(at(large * 2.0) - at(large)) < 1e-60 or np.isinf(at(large))
            assert place not in operation.carries or abs(at(large)) > np.exp(70.0)
        overflows = not operation.sign and np.isinf(operation(np.float64(800.0)))
    assert operation.overflows == overflows
    tree = as_expression(1.0) / operation(*[RATE] * many) if not operation.sign else SLIP
    assert bool(limited(tree)) == overflows


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_is_typed_traced_from_numpy_and_known_to_jax(name: str) -> None:
    jax = pytest.importorskip("jax.numpy")
    tree = OPERATIONS[name](2.0 + SLIP)
    assert parse(f"{name}(2 + u)", ()) == tree
    assert parse(to_text(tree), ()) == tree
    assert OPERATIONS[name].on_arrays(2.0 + SLIP) == tree
    found = getattr(jax, OPERATIONS[name].on_arrays.__name__)(0.5)
    assert float(found) == pytest.approx(float(OPERATIONS[name](0.5)), rel=1e-6)
