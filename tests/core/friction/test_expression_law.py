"""Expressions from scenarios and from Python: what is read, and one line for everything that is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip import InputError
from stickslip.friction import FromExpression, HyperbolicRate
from stickslip.friction.formula.expression import RATE, SLIP, Expression, Parameter, as_expression
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS
from stickslip.friction.formula.text import parse, to_text
from tests.limits import examples
from tests.messages import refused

HYPERBOLIC = "mu_d + (mu_s - mu_d)/(1 + alpha*v)"


def test_an_expression_is_the_built_in_law_to_the_last_digit() -> None:
    law, built_in = FromExpression(HYPERBOLIC, {"mu_s": 0.8, "mu_d": 0.3, "alpha": 1.7}), HyperbolicRate(0.8, 0.3, 1.7)
    rate = np.geomspace(1e-9, 1e3, 50)
    assert (law.coefficient(0.0, rate) == built_in.coefficient(0.0, rate)).all()
    assert law.range() == built_in.range()
    assert law.variation == built_in.variation
    assert law.depends_on_rate
    assert not law.depends_on_slip


@pytest.mark.parametrize(
    ("text", "u", "v", "value"),
    [
        ("0.5", 0, 0, 0.5),
        ("  0.5 ", 0, 0, 0.5),
        ("1 - 2 - 3 + 9", 0, 0, 5.0),
        ("-2**2 + 5", 0, 0, 1.0),
        ("2**-1", 0, 0, 0.5),
        ("+v + -(-u)", 2, 3, 5.0),
        ("8/4/2 * 3e-1", 0, 0, 0.3),
        ("sin(pi/2) + cos(0) + exp(0) + log(1) + sqrt(4) + tanh(0) + arcsinh(0)", 0, 0, 5.0),
        ("(1 + u)**0.5", 3, 0, 2.0),
        ("v**3 / v", 0, 2, 4.0),
        ("1_000.5", 0, 0, 1000.5),
        ("0x10", 0, 0, 16.0),
    ],
)
def test_an_expression_is_read_with_its_value(text: str, u: float, v: float, value: float) -> None:
    from stickslip.friction.formula.functions import evaluate

    assert float(evaluate(parse(text, ()), {}, np.float64(u), np.float64(v))) == pytest.approx(value, rel=1e-15)


HOSTILE = [
    ("", "is not an expression"),
    ("mu_d +", "is not an expression: mistake;"),
    ("__import__('os')", "the function '__import__' is unknown; allowed: cos, exp, log, sin, sqrt, tan and 1"),
    ("__import__('os').system('x')", "is not allowed; allowed are numbers"),
    ("v.real", "'v.real' is not allowed"),
    ("mu_d[0]", "'mu_d[0]' is not allowed"),
    ("(v, u)", "is not allowed"),
    ("[x for x in (1,)]", "is not allowed"),
    ("lambda: 1", "'lambda: 1' is not allowed"),
    ("v if v else 1", "'v if v else 1' is not allowed"),
    ("v > 1", "'v > 1' is not allowed, because it is a branch; for a kink or a jump use a law such as piecewise-linear-rate"),
    ("0,5 + v", "'0,5 + v' is not allowed, because of its comma; a decimal point is written as in 0.5"),
    ("mu = 0.5", "'mu = 0.5' is not an expression, because of its sign =; write only what comes after it"),
    ("0.5 + np.exp(-v)", "'np.exp' is written exp, without the name of a library"),
    ("0.5 + min(v, 1)", "the function 'min' has a kink or a jump; for a kink or a jump use a law such as piecewise-linear-rate"),
    ("0.5 + abs(u)", "the function 'abs' has a kink or a jump"),
    ("v % 2", "the operator in 'v % 2' is not allowed"),
    ("v ^ 2", "a power is written **"),
    ("'text'", "is not allowed"),
    ("f'{v}'", "is not allowed"),
    ("True", "'True' is not allowed"),
    ("2j", "'2j' is not allowed"),
    ("1e999", "the number '1e999' is too large"),
    ("9" * 400, "is too large"),
    ("mu_dd", "'mu_dd' is neither u, v, pi nor a declared parameter; did you mean 'mu_d'?"),
    ("z", "'z' is neither u, v, pi nor a declared parameter; allowed: "),
    ("inf", "'inf' is neither"),
    ("sin", "'sin' is a function: write sin(...)"),
    ("sinn(v)", "the function 'sinn' is unknown; did you mean 'sin'?"),
    ("v(1)", "the function 'v' is unknown"),
    ("sin()", "sin takes one number"),
    ("sin(x=v)", "sin takes one number"),
    ("sin(**v)", "sin takes one number"),
    ("v**u", "the exponent of 'v**u' must not contain u or v"),
    ("v**1000", "the exponent of 'v**1000' must be within 100"),
    ("(((v+1)**16)**16)**16 + ((v+1)**16)**16", "operations"),
    ("1\n+1", "the character '\\n' is not allowed"),
    ("v\x00", "the character '\\x00' is not allowed"),
    ("µ", "the character '\\xb5' is not allowed"),
    ("v\u2212 1", "the character '\\u2212' is not allowed"),
    ("1; 2", "is not an expression"),
    ("(" * 300 + "v" + ")" * 300, "is not an expression|nested too deeply"),
    ("-" * 500 + "v", "nested"),
    ("+".join(["v"] * 300), "nested more than 100 deep"),
    ("v" * 1001, "longer than 1000 characters"),
    ("2 (", "is not an expression: mistake at character 3"),
    ("*v", "is not"),
    ("05", "is not an expression"),
]


@pytest.mark.parametrize(
    ("name", "typed", "ours"),
    [
        ("ln", "0.6 + 0.01*ln(1 + v/v_c)", "0.6 + 0.01*log(1 + v/v_c)"),
        ("lg", "0.6 - 0.02*lg(1 + v/v_c)", "0.6 - 0.02*log10(1 + v/v_c)"),
        ("asinh", "0.6 + 0.01*asinh(v/v_c)", "0.6 + 0.01*arcsinh(v/v_c)"),
    ],
)
def test_a_function_has_the_names_that_people_give_it(name: str, typed: str, ours: str) -> None:
    law, same = (FromExpression(text, {"v_c": 1e-3}) for text in (typed, ours))
    rate = np.geomspace(1e-9, 1e3, 50)
    assert (law.coefficient(0.0, rate) == same.coefficient(0.0, rate)).all()
    x = rate / 1e-3
    known = {"ln": 0.01 * np.log1p(x), "lg": -0.02 * np.log1p(x) / math.log(10.0), "asinh": 0.01 * np.arcsinh(x)}
    np.testing.assert_allclose(law.coefficient(0.0, rate), 0.6 + known[name], rtol=1e-14)


@pytest.mark.parametrize(("text", "message"), HOSTILE)
def test_everything_else_is_refused_in_one_line(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        parse(text, ("mu_s", "mu_d"))
    said = str(caught.value)
    assert said.isprintable()
    assert len(said) < 300
    assert any(part in said for part in message.split("|"))


@settings(max_examples=examples(40))
@given(st.text(max_size=60))
def test_no_text_does_anything_but_give_a_tree_or_one_line(text: str) -> None:
    _, refusal = tried(text, ("a",))
    assert refusal.isprintable()


LEAVES = st.one_of(
    st.sampled_from([SLIP, RATE, Parameter("a"), Parameter("mu_s")]),
    st.floats(-1e6, 1e6, allow_nan=False).map(as_expression),
)


def _grown(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    pair = st.tuples(st.sampled_from(["add", "sub", "mul", "div"]), inner, inner).map(lambda x: OPERATIONS[x[0]](x[1], x[2]))
    power = st.tuples(inner, st.floats(-5, 5).map(lambda x: round(x, 2))).map(lambda x: x[0] ** x[1])
    function = st.tuples(st.sampled_from(FUNCTIONS), inner).map(lambda x: OPERATIONS[x[0]](x[1]))
    return st.one_of(pair, power, function, inner.map(lambda x: -x), inner.map(lambda x: x ** Parameter("a")))


@given(st.recursive(LEAVES, _grown, max_leaves=12))
def test_a_tree_written_as_text_is_read_back(tree: Expression) -> None:
    text = to_text(tree)
    again, refusal = tried(text, ("a", "mu_s"))
    if again is None:
        assert any(limit in refusal for limit in ("operations", "longer", "exponent", "nested"))
        return
    assert again == tree
    assert to_text(again) == text


@pytest.mark.parametrize(
    "typed", ["a + v / (1 + (v / mu_s)**4)**0.25", "v**2 * a", "(v * a)**3", "v**7 - u**6 / 3", "0.5 * v**5", "v**a", "1 + 0 * v"]
)
def test_a_formula_is_shown_as_it_was_typed(typed: str) -> None:
    assert to_text(parse(typed, ("a", "mu_s"))) == typed


def tried(text: str, names: tuple[str, ...]) -> tuple[Expression | None, str]:
    """The tree, or what was said against the text."""
    try:
        return parse(text, names), ""
    except InputError as error:
        return None, str(error)


REFUSED = [
    ("a", {}, "'a' is neither u, v, pi nor a declared parameter"),
    ("0.5", {"a": 1.0}, "parameters: a does not occur in the expression; the expression has no parameters"),
    ("mu_d", {"mu_d": 0.5, "mu_b": 1.0}, "parameters: mu_b does not occur in the expression; did you mean 'mu_d'?"),
    ("sin(u)+1", {"sin": 1.0}, "parameters: the name sin is reserved or used twice"),
    ("0.5", {"a b": 1.0}, "parameters: 'a b' is not a name"),
    ("0.5", {"x" * 41: 1.0}, "is not a name"),
    ("a", {"a": math.nan}, "parameters 'a' must be finite, got nan"),
    ("a", {"a": True}, "parameters 'a' must be a number"),
    ("a", {"a": "1 K"}, "'K' is not made of whole powers of m, kg and s"),
    ("a", {"a": "eval(1)"}, "is not a number with a unit"),
    ("1/v", {}, "at u = 0 m, v = 0 m/s it is not a finite number"),
    ("sqrt(v) + 1", {}, "the argument of sqrt, 'v', must stay above 0 to have derivatives, but at u = 0 m, v = 0 m/s it is 0"),
    ("v**1.5 + 1", {}, "the base of a power, 'v', must stay above 0"),
    ("(1 + v)**n", {"n": 1e3}, "an exponent is 1000, it must be within 100"),
    ("0.5 + 9**9**9**9", {}, "an exponent is"),
    ("exp(v * 1e6)", {}, "it is not a finite number"),
]  # fmt: skip


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(("text", "values", "message"), REFUSED)
def test_expressions_that_are_no_friction_are_refused(text: str, values: dict[str, float | str], message: str) -> None:
    with refused(message):
        FromExpression(text, values)


def starting(text: str, slip: float = 0.0, evolution: str = "", **rest: Any) -> ss.Problem:
    law = FromExpression(text, evolution=evolution, counts=rest.pop("counts", "net"))
    return ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), law, initial_excess=1e5, initial_slip=slip, **rest)


@pytest.mark.parametrize(
    ("text", "slip", "evolution", "message"),
    [
        ("0.5 - 0.1*u", 10.0, "", "friction must be a number >= 0, but at u = 10 m, v = 0 m/s it is -0.5"),
        ("0.5 + u", -10.0, "", 'at u = -10 m, v = 0 m/s it is -9.5; with counts="path" u is the length of the slip path'),
        ("1/(u - 1)**2", 1.0, "", "it is not a finite number"),
        ("0.6 + 0.1*log(u - 1e6)", 0.0, "", "it is not a finite number"),
        ("sqrt(u) + 0.1", 0.0, "", "the argument of sqrt, 'u', must stay above 0 to have derivatives, but at u = 0 m"),
        ("0.5 + u - v", 0.0, "", "at u = 0 m, v = 10 m/s it is -9.5"),
        ("0.6 + 0.01*tanh(z/u)", 0.0, "dz/dt = -v*z", "at u = 0, v = 0 and z = 0 friction must be a finite number"),
        ("0.6 + 0.01*z + v/u", 0.0, "dz/dt = -v*z", "at u = 0, v = 0 and z = 0 friction must be a finite number"),
        (
            "0.6 + 0.01*z",
            0.0,
            "dz/dt = -v*z + 1/u",
            "evolution: the rate of change must be a finite number, but",
        ),
    ],
)
def test_a_run_begins_only_where_the_formula_is_friction(text: str, slip: float, evolution: str, message: str) -> None:
    with pytest.raises(InputError, match=r"^Problem: friction: FromExpression: ") as error:
        starting(text, slip, evolution)
    assert message in str(error.value)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("text", ["0.6 - 0.01*u*u", "0.6 + 0.2*exp(-u/1e-4)", "0.2 + 0.4/(1 - u)"])
def test_a_law_that_ends_beyond_what_a_run_reaches_is_a_law(text: str) -> None:
    run = ss.simulate(starting(text), 6.0)
    assert run.status.ok
    assert run.slip(run.duration) > 0.0


def test_a_law_that_holds_at_a_million_metres_only_is_the_same_law_there() -> None:
    far, near = (
        ss.simulate(starting(text, slip), 6.0) for text, slip in ((("0.6 + 0.1*log(u - 1e6)"), 1e6 + 5), ("0.6 + 0.1*log(u)", 5))
    )
    assert far.status == near.status
    assert far.slip(6.0) - 1e6 == pytest.approx(near.slip(6.0), rel=1e-8)  # slips of 1e6 m are rounded to 1e-10 m


def test_a_run_ends_at_the_slip_at_which_friction_would_fall_below_zero() -> None:
    run = ss.simulate(starting("0.5 - 0.1*u"), 60.0)
    assert run.status.name == "negative friction"
    assert run.slip(run.duration) == pytest.approx(5.0, rel=1e-6)


UNITS = [
    ("0.3 + 0.5/(1 + alpha*v)", {"alpha": "1 s/m"}, None),
    ("0.3 + 0.2*exp(-u/d) + 0.1*sqrt(1 + (v/w)**2)", {"w": "1 mm/s", "d": "2 cm"}, None),
    ("0.3 + (1 + v/w)**n", {"w": "1 mm/s", "n": -0.5}, None),
    ("0.3 + 0.1*sin(k*u + phase)", {"k": "5 / m", "phase": "30 deg"}, None),
    ("0.3 + (E/r)**0.5/c", {"E": "1 GPa", "r": "1000 kg/m^3", "c": "1 km/s"}, None),
    ("0.3 + 0.5/(1 + alpha*v)", {"alpha": "1 kg"}, "'1 + alpha * v': a pure number and"),
    ("0.3 + 0.2*exp(-u/d) + v/w", {"d": 1.0, "w": "1 m/s"}, "exp(-u / d)': its argument must be a pure number, but is in m"),
    ("v/w + u", {"w": "1 m/s"}, "a pure number and m cannot be added"),
    ("u*w", {"w": "1 m"}, "the friction coefficient must be a pure number, but 'u * w' is in m^2"),
    ("0.3 + (1 + 0*v)**w", {"w": "1 m"}, "a pure number and m s^-1 cannot be added"),
    ("0.3 + 2**w", {"w": "1 m"}, "its exponent must be a pure number"),
    ("0.3 + (v + w)**n/w", {"w": "1 m/s", "n": 1.0}, "to a power that is a parameter has no fixed unit"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "values", "message"), UNITS)
def test_units_of_an_expression_must_fit(text: str, values: dict[str, float | str], message: str | None) -> None:
    counts = "path"
    if message is None:
        assert FromExpression(text, values, counts=counts).coefficient(0.0) >= 0
        return
    with refused(message):
        FromExpression(text, values, counts=counts)


def test_units_become_si() -> None:
    law = FromExpression("0.3 + 0.5/(1 + v/w)", {"w": "1 mm/s"})
    assert law.numbers() == {"w": 1e-3}
    assert law.rate_scales == (1e-3,)


def test_static_friction_is_added_at_rest() -> None:
    law = FromExpression("0.4 + 0.1*v", static=0.6)
    assert law.static_excess == pytest.approx(0.2, rel=1e-15)
    assert float(law.static_coefficient(0.0)) == pytest.approx(0.6, rel=1e-15)
    assert law.range() == (0.4, math.inf)
    assert law.variation == pytest.approx(1.0, rel=1e-12)
    with pytest.raises(InputError, match=r"static must be at least the expression at v = 0, got 0.3 < 0.4"):
        FromExpression("0.4 + 0.1*v", static=0.3)
    with pytest.raises(InputError, match="static needs an expression without u"):
        FromExpression("0.4 + 0.1*sin(u)", static=0.6)


def test_counts_is_path_or_net() -> None:
    assert FromExpression("0.5 + 0.01*u", counts="path").counts == "path"
    with pytest.raises(InputError, match=r"counts 'nett' is unknown; did you mean 'net'\?"):
        FromExpression("0.5", counts="nett")  # type: ignore[arg-type]


AGEING = "dtheta/dt = 1 - theta*v/D_c"


@pytest.mark.parametrize(
    ("text", "evolution", "said"),
    [
        ("0.6 + a*z", "", """; a state: give evolution = "dz/dt = ...\""""),
        ("0.6 + z + y", "dz/dt = -v*z/D_c, dy/dt = -v*y/D_c", "evolution: two equations are separated by a semicolon, as in"),
        ("0.6 + z", "-z", "FromExpression: evolution: '-z' must be an equation such as"),
        ("0.6 + a*log(1 + theta*v_0/D_c)", AGEING, """; with state_unit = "s" the units agree"""),
        (
            "0.6 + a*log(theta*v_0/D_c)",
            AGEING,
            "it is -inf at theta = 0, the healed state, in which friction must be finite: write",
        ),
    ],
)
def test_what_a_law_with_a_state_lacks_is_said(text: str, evolution: str, said: str) -> None:
    values = {"a": "0.01", "D_c": "10 um", "v_0": "1 um/s"} if "theta" in text else {"a": 0.01, "D_c": 1e-5}
    values = {name: 0.01 if name == "a" else value for name, value in values.items() if name in f"{text} {evolution}"}
    with pytest.raises(InputError) as error:
        FromExpression(text, values, evolution=evolution, state_unit="s" if "log(theta" in text else "")
    assert said in str(error.value)
    assert str(error.value).count("FromExpression: ") == 1


def test_functions_of_formulas_are_found_where_laws_of_users_have_imported_them_from() -> None:
    from stickslip.friction.formula import expression, functions

    assert all(getattr(expression, name) is getattr(functions, name) for name in FUNCTIONS)
    with pytest.raises(AttributeError, match="has no attribute 'cot'"):
        expression.cot  # noqa: B018
