"""Python functions as friction laws: traced once, exact derivatives, one line for what cannot be traced."""

from __future__ import annotations

import functools
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import InputError
from stickslip.friction import FromFunction, HyperbolicRate
from stickslip.friction.formula.expression import RATE, SLIP
from tests.limits import mypy_on
from tests.messages import refused


def hyperbolic(u: Any, v: Any, static: float, dynamic: float, alpha: float = 1.0) -> Any:
    return dynamic + (static - dynamic) / (1.0 + alpha * v)


def test_a_function_is_the_built_in_law() -> None:
    law = ss.friction.FromFunction(hyperbolic, static=0.8, dynamic=0.3)
    rate = np.geomspace(1e-9, 1e3, 50)
    assert (law.coefficient(0.0, rate) == HyperbolicRate(0.8, 0.3, 1.0).coefficient(0.0, rate)).all()
    assert law.expression == "dynamic + (static - dynamic) / (1 + alpha * v)"  # a number is shown without its .0
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


def doubling(u: Any, v: Any) -> Any:
    x = 1 + v
    for _ in range(60):
        x = x * x
    return x


def returns_nothing(v: Any) -> Any:
    0.5 + v


def swapped(v: Any, u: Any) -> Any:
    return 0.5 + 0.1 * np.sin(u) + 0.2 * np.tanh(v)


class Sliding:
    """An object that can be called, and that has a method: both are functions of slip and slip rate."""

    def __call__(self, u: Any, v: Any, mu_s: float = 0.6) -> Any:
        return mu_s + 0.01 * u * u + 0.1 * np.tanh(v)

    def of_rate(self, v: Any) -> Any:
        return 0.6 + 0.1 * np.tanh(v)


KINK_IN_RATE = "for a kink or a jump in v use PiecewiseLinearRate or FromTable(rate=..., friction=...)"
KINK_IN_SLIP = "for a kink or a jump in u use PiecewiseLinearSlip, LinearSlipWeakening or FromTable(slip=..., friction=...)"
NO_VARIABLE = "it must have an argument named u (slip, m) or v (slip rate, m/s), or both; its arguments are: "
REFUSED: list[tuple[Any, dict[str, Any], str]] = [
    (
        branches,
        {},
        f"branches: a branch on the value of u, v or a parameter cannot be traced; {KINK_IN_RATE}; for a smooth step np",
    ),
    (doubling, {}, "longer than 10000 operations"),
    (lambda u, v: max(v, 0.1), {}, KINK_IN_RATE),
    (lambda u: 0.5 if u < 1 else 0.3, {}, KINK_IN_SLIP),
    (lambda u, v: np.where(v > 1, 1, 2), {}, KINK_IN_RATE),
    (lambda u, v: np.where(u, 1, 2), {}, f"np.where cannot be traced; {KINK_IN_SLIP}"),
    (lambda u, v: np.maximum(v, 1), {}, f"np.maximum has a kink or a jump and cannot be traced; {KINK_IN_RATE}"),
    (lambda v: np.clip(v, 0.1, 0.5), {}, f"np.clip cannot be traced; {KINK_IN_RATE}"),
    (lambda u, v: np.arctan(v), {}, "np.arctan cannot be traced; allowed: np.sin"),
    (lambda u, v: math.exp(-v), {}, "use numpy's: np.exp instead of math.exp"),
    (lambda u, v: abs(u), {}, 'abs has a kink and cannot be traced; counts="path" makes u a length that is never negative'),
    (lambda u, v: abs(v - 1), {}, "abs has a kink and cannot be traced; v is a magnitude already, np.sqrt(x**2 + small) is smooth"),
    (lambda u, v: np.array([1.0, 2.0]), {}, "it must return one number, the friction coefficient, and returns an array"),
    (lambda u, v: np.interp(v, [0, 1], [1, 0]), {}, f"np.interp cannot be traced; {KINK_IN_RATE}"),
    (lambda u, v: v.mean(), {}, "cannot be traced (AttributeError"),
    (lambda u, v: "0.5", {}, "and returns '0.5'"),
    (lambda u, v: 1j, {}, "and returns complex"),
    (returns_nothing, {}, "it returns nothing: end it with return and the friction coefficient"),
    (lambda u, v: v**u, {}, "the exponent"),
    (lambda u, v: math.inf + v, {}, "inf"),
    (lambda u, v: 0.5 - v, {}, ">: friction must be a number >= 0, but at u = 0 m, v = 10 m/s it is -9.5"),
    (lambda v: 0.6 + np.log(v), {}, "it is not a finite number; slip begins at v = 0, and friction there is the static strength"),
    (lambda x, y: 0.5, {}, NO_VARIABLE + "x, y"),
    (lambda: 0.5, {}, NO_VARIABLE + "none"),
    (np.exp, {}, "exp: it "),
    (lambda u, v, *a: 0.5, {}, "it must name each of its arguments: u, v and parameters, without *args and **named"),
    (lambda u, v, a: a, {}, "parameter a has no value: give it a default, or FromFunction(..., a=...)"),
    (lambda u, v, width: width, {"widht": 1.0}, "has no parameter widht; did you mean 'width'?"),
    (lambda u, a=0.5: a, {"v": 1.0}, "v is the slip rate, not a parameter: it takes no value"),
    (lambda u, v, a: a + v, {"a": None}, "'a' must be a number"),
    (lambda u, v, a: a + v, {"a": "0.7"}, "'0.7' is not a number with a unit: write a number without quotes"),
    (3, {}, "it is not a Python function"),
    ("0.3 + v", {}, "it is a text: a formula as text makes a law with FromExpression"),
    (HyperbolicRate, {}, "HyperbolicRate: it is a class: a law is made with its parameters, HyperbolicRate(...)"),
]


@pytest.mark.parametrize(("function", "values", "message"), REFUSED)
def test_one_line_says_what_cannot_be_traced(function: Any, values: dict[str, Any], message: str) -> None:
    with refused(message, begins="FromFunction: "):
        FromFunction(function, **values)


def test_arguments_named_u_and_v_are_slip_and_slip_rate_in_any_order() -> None:
    law = FromFunction(swapped)
    assert float(law.coefficient(0.4, 2.0)) == pytest.approx(0.5 + 0.1 * math.sin(0.4) + 0.2 * math.tanh(2.0), rel=1e-15)
    of_rate, of_slip = FromFunction(lambda v: 0.5 + 0.1 * np.tanh(v)), FromFunction(lambda u: 0.5 + 0.1 * np.tanh(u))
    assert (of_rate.depends_on_slip, of_rate.depends_on_rate) == (False, True)
    assert (of_slip.depends_on_slip, of_slip.depends_on_rate) == (True, False)
    assert float(of_rate.coefficient(7.0, 2.0)) == float(of_slip.coefficient(2.0, 7.0)) == 0.5 + 0.1 * math.tanh(2.0)


FORMS: dict[str, tuple[Any, float]] = {
    "positional only": (lambda u, v, /: 0.6 + 0.1 * np.tanh(v), 0.6),
    "keywords only": (lambda *, v, mu_s=0.6: mu_s + 0.1 * np.tanh(v), 0.6),
    "keyword before v": (lambda mu_s=0.6, *, v: mu_s + 0.1 * np.tanh(v), 0.6),
    "object": (Sliding(), 0.6),
    "method": (Sliding().of_rate, 0.6),
    "partial": (functools.partial(Sliding(), mu_s=0.55), 0.55),
    "constant": (lambda v: 0.6, 0.6),
    "constant of numpy": (lambda v: np.array(0.6), 0.6),
    "default with a unit": (lambda v, v_c="1 mm/s": 0.6 + 0.1 * np.tanh(v / v_c), 0.6),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_a_function_makes_a_law_in_a_problem(form: str) -> None:
    """Its static coefficient is its value at v = 0, and the law is the one that FromFunction makes."""
    function, static = FORMS[form]
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
    problem = ss.Problem(slab, function, initial_excess=0.0)
    assert problem.friction == FromFunction(function)
    assert problem.strength == pytest.approx(static * 1e8, rel=1e-15, abs=0)


@pytest.mark.parametrize(
    ("formula", "said"),
    [
        (lambda u: 0.6 if abs(u - 0.5) < 1 else 0.5, "a branch on the value of u, v or a parameter cannot be traced; for a kink"),
        (lambda u: 0.6 + abs(u - 0.5), "abs has a kink and cannot be traced; v is a magnitude already, np.sqrt(x**2 + small)"),
        (lambda u: np.exp(abs(u)), 'abs has a kink and cannot be traced; counts="path" makes u a length'),
        (lambda u: np.abs(u - 1.0), "abs has a kink and cannot be traced"),
        (lambda u: 0.6 + max(abs(u - 1.0), 0.1), "a branch on the value of u"),
    ],
)
def test_a_magnitude_is_refused_as_what_it_is_used_for(formula: Any, said: str) -> None:
    with refused(said):
        FromFunction(formula)


TEXTS = [
    ("coulomb", "'coulomb' is not a formula; the laws of the package are classes, such as ss.friction.Coulomb(...)"),
    ("data/points.csv", "'data/points.csv' is not a formula; measured points make a law with ss.friction.FromTable(file)"),
    (
        "mu_d + 0.5/(1 + v)",
        "'mu_d' is neither u, v, pi nor a declared parameter; allowed: u, v; a state: give evolution =",
    ),
    ("0.3 + v^2", "the operator in '0.3 + v^2' is not allowed; a power is written **"),
    ("0.5 - v", "friction must be a number >= 0, but at u = 0 m, v = 10 m/s it is -9.5"),
    ("__import__('os').system('ls')", "is not allowed; allowed are numbers"),
    ("", "'' is not an expression"),
]


@pytest.mark.parametrize(("text", "message"), TEXTS)
def test_a_text_that_is_no_formula_is_refused_in_one_line(text: str, message: str) -> None:
    with refused(message, begins="Problem: friction: "):
        ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), text, initial_excess=0.0)


def test_a_part_that_is_a_function_is_refused_with_what_makes_it_a_law() -> None:
    part = r"must be a friction law, got function; FromFunction makes one of a function"
    for make in (
        lambda rate: ss.friction.SlipPlusRate(FromFunction(lambda u: 0.1), rate),
        lambda rate: ss.friction.LaggedFriction(rate, 1),
    ):
        with pytest.raises(InputError, match=part):
            make(lambda v: 0.5)


def test_the_type_of_the_law_is_known(tmp_path: Path) -> None:
    """FromFunction gives the law, or a decorator; Problem takes functions and texts, and keeps a law; wrong types are errors."""
    printed = mypy_on(
        tmp_path / "user_of_laws.py",
        "import stickslip as ss\n"
        "slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)\n"
        "reveal_type(ss.friction.FromFunction(lambda v: 0.5, counts='path', a=1.0))\n"
        "@ss.friction.FromFunction(a='1 m')\n"
        "def law(u: float, a: float) -> float: return 0.5 + u / a\n"
        "reveal_type(law)\n"
        "reveal_type(ss.Problem(slab, lambda u, v: 0.5, initial_excess=0.0).friction)\n"
        "ss.Problem(slab, '0.3 + 0.5/(1 + v)', initial_excess=0.0)\n"
        "ss.friction.FromExpression('a + b*v', {'a': 0.5, 'b': '1 s/m'})\n"
        "ss.Problem(slab, 3, initial_excess=0.0)\n"
        "ss.friction.FromFunction(lambda v: 0.5, counts='pth')\n"
        "ss.friction.FromExpression('a', {'a': [0.5]})\n",
    )
    said = [line.partition("user_of_laws.py:")[2] for line in printed.splitlines() if "user_of_laws.py:" in line]
    assert [(line.partition(":")[0], line.partition(": ")[2].partition(":")[0]) for line in said] == [
        ("3", "note"), ("6", "note"), ("7", "note"), ("10", "error"), ("11", "error"), ("11", "note"), ("11", "note"),
        ("11", "note"), ("12", "error"),
    ], printed  # fmt: skip
    assert "FromExpression" in said[0]
    assert "FromExpression" in said[1]
    assert "FrictionLaw" in said[2]


def test_symbols_are_values_of_sets_and_dictionaries_but_of_no_branch() -> None:
    assert {SLIP: 1, RATE: 2}[RATE] == 2
    assert SLIP != RATE
    assert (1.0 + SLIP) == (1.0 + SLIP)
    assert pickle.loads(pickle.dumps(1.0 + SLIP)) == 1.0 + SLIP
    with pytest.raises(InputError, match="a branch"):
        bool(SLIP)
