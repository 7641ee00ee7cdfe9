"""Python functions as friction laws: traced once, exact derivatives, one line for what cannot be traced."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import InputError
from stickslip.friction import FromFunction, HyperbolicRate
from stickslip.friction.formula.expression import RATE, SLIP


def hyperbolic(u: Any, v: Any, static: float, dynamic: float, alpha: float = 1.0) -> Any:
    return dynamic + (static - dynamic) / (1.0 + alpha * v)


def test_a_function_is_the_built_in_law() -> None:
    law = ss.friction.FromFunction(hyperbolic, static=0.8, dynamic=0.3)
    rate = np.geomspace(1e-9, 1e3, 50)
    assert (law.coefficient(0.0, rate) == HyperbolicRate(0.8, 0.3, 1.0).coefficient(0.0, rate)).all()
    assert law.expression == "dynamic + (static - dynamic) / (1.0 + alpha * v)"
    assert pickle.loads(pickle.dumps(law)) == law


def test_from_function_is_a_decorator() -> None:
    @FromFunction(mu_s=0.8, alpha="1 s/m", counts="path")
    def law(u: Any, v: Any, mu_s: float, alpha: float) -> Any:
        return mu_s / (1 + alpha * v)

    @FromFunction
    def plain(u: Any, v: Any) -> Any:
        return 0.5 + 0.1 * np.sin(u)

    assert law.numbers() == {"mu_s": 0.8, "alpha": 1.0}
    assert law.counts == "path"
    assert float(plain.coefficient(1.0)) == pytest.approx(0.5 + 0.1 * math.sin(1.0), rel=1e-15)


NUMPY: dict[str, Callable[[Any, Any], Any]] = {
    "functions": lambda u, v: 3 + np.sin(u) + np.cos(v) * np.exp(-v) + np.log(1 + v) + np.sqrt(1 + v) + np.tanh(u) + np.arcsinh(v),
    "others": lambda u, v: 9 + np.log1p(v) + np.expm1(-v) + np.square(v) + np.tan(0.01 * u) + np.log10(1 + v) + np.log2(1 + v),
    "hyperbolic": lambda u, v: 1 + np.cosh(0.1 * v) + np.sinh(0.1 * v) + np.exp2(-v) + np.reciprocal(1 + v),
    "operators": lambda u, v: np.add(1.0, v) + np.subtract(9.0, np.multiply(0.1, v)) + np.divide(1, 1 + v) + np.power(1 + v, 1.5),
    "numbers of numpy": lambda u, v: np.float64(0.5) * v + np.float64(3) - np.float64(0.1) / (1 + v) + np.abs(v) + abs(v),
    "powers": lambda u, v: 1 + v**2 + 2**np.float64(0.5) + (1 + v) ** -3 + (u**2) ** 2 + v**0,
}  # fmt: skip


@pytest.mark.parametrize("name", NUMPY)
def test_numpy_functions_can_be_traced(name: str) -> None:
    function = NUMPY[name]
    law = FromFunction(function)
    for u, v in ((0.0, 0.0), (0.7, 0.3), (-2.0, 4.0)):
        assert float(law.coefficient(u, v)) == pytest.approx(float(function(np.float64(u), np.float64(v))), rel=1e-14)


def branches(u: Any, v: Any) -> Any:
    return 0.6 if v < 0.1 else 0.5


def equal(u: Any, v: Any) -> Any:
    return 0.6 if v == 0 else 0.5


def doubling(u: Any, v: Any) -> Any:
    x = 1 + v
    for _ in range(60):
        x = x * x
    return x


REFUSED: list[tuple[Callable[..., Any], dict[str, Any], str]] = [
    (branches, {}, "branches: a branch on the value of u, v or a parameter cannot be traced; use a smooth function"),
    (equal, {}, "a branch on the value"),
    (doubling, {}, "longer than 10000 operations"),
    (lambda u, v: max(v, 0.1), {}, "a branch on the value"),
    (lambda u, v: np.where(v > 1, 1, 2), {}, "a branch on the value"),
    (lambda u, v: np.maximum(v, 1), {}, "np.maximum cannot be traced; allowed: np.sin"),
    (lambda u, v: np.arctan(v), {}, "np.arctan cannot be traced"),
    (lambda u, v: math.exp(-v), {}, "use numpy's: np.exp instead of math.exp"),
    (lambda u, v: abs(u), {}, "abs has a kink"),
    (lambda u, v: np.array([1.0, 2.0]) * v, {}, "an array cannot be traced"),
    (lambda u, v: np.interp(v, [0, 1], [1, 0]), {}, "cannot be traced"),
    (lambda u, v: v.mean(), {}, "cannot be traced (AttributeError"),
    (lambda u, v: [v], {}, "cannot be traced"),
    (lambda u, v: None, {}, "cannot be traced"),
    (lambda u, v: v**u, {}, "the exponent"),
    (lambda u, v: math.inf + v, {}, "inf"),
    (lambda u, v: 0.5 - v, {}, "friction must be a number >= 0, but at u = 0 m, v = 10 m/s it is -9.5"),
    (lambda u: 0.5, {}, "must be a function of u and v, then named parameters"),
    (lambda u, v, *a: 0.5, {}, "must be a function of u and v, then named parameters"),
    (lambda u, v, a: a, {}, "parameter a has no value"),
    (lambda u, v, width: width, {"widht": 1.0}, "has no parameter widht; did you mean 'width'?"),
    (lambda u, v, a: a + v, {"a": "1 parsnip"}, "'parsnip' is not a unit"),
    (3, {}, "is not a Python function"),  # type: ignore[list-item] # on purpose
]


@pytest.mark.parametrize(("function", "values", "message"), REFUSED)
def test_one_line_says_what_cannot_be_traced(function: Callable[..., Any], values: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        FromFunction(function, **values)
    assert message in str(caught.value)
    assert str(caught.value).startswith("FromFunction: ")
    assert str(caught.value).isprintable()


def test_symbols_are_values_of_sets_and_dictionaries_but_of_no_branch() -> None:
    assert {SLIP: 1, RATE: 2}[RATE] == 2
    assert SLIP != RATE
    assert (1.0 + SLIP) == (1.0 + SLIP)
    assert pickle.loads(pickle.dumps(1.0 + SLIP)) == 1.0 + SLIP
    with pytest.raises(InputError, match="a branch"):
        bool(SLIP)
