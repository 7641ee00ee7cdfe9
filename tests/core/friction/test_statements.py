"""What a user's class states about its law is compared with its formula: lies are one line, honest laws are never refused."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.foundation.quantities import quantity
from stickslip.friction import LAWS, FrictionLaw
from stickslip.friction.contract import StateVariable
from stickslip.friction.formula.functions import exp, sin, tanh
from stickslip.friction.statements import check_statements
from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template
from tests.limits import examples
from tests.messages import refused

F = ss.friction


@dataclass(frozen=True)
class Own(FrictionLaw):
    """mu = dynamic + (static - dynamic) / (1 + v / rate), as a user writes it; every statement of it is true."""

    kind = "own-hyperbolic"
    critical = "rate"

    static: float = quantity("1", "at rest", default=0.8)
    dynamic: float = quantity("1", "fast", default=0.3)
    rate: float = quantity("m/s", "scale", above=0, default=0.1)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + v / law.rate)

    def range(self) -> Any:
        return min(self.static, self.dynamic), max(self.static, self.dynamic)


def lying(**statements: Any) -> type[Own]:
    """Return the class with other statements, and with the name Lying."""
    return dataclass(frozen=True)(type("Lying", (Own,), {"__module__": __name__, "__doc__": "A law that lies.", **statements}))


@dataclass(frozen=True)
class Bell(Own):
    """mu falls around a slip, and knows its range."""

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) * exp(-(((u - 0.3) / 0.05) ** 2)) + 0.0 * v


LIES: dict[str, tuple[dict[str, Any], str]] = {
    "range too low": ({"range": lambda law: (0.3, 0.7)}, "range() says that mu is at most 0.7, but it is 0.8 at slip rate 0 m/s;"),
    "range too high": ({"range": lambda law: (0.4, 0.8)}, "range() says that mu is at least 0.4, but it is 0.3"),
    "range turned round": (
        {"range": lambda law: (0.8, 0.3)},
        "range() must return two numbers, a lower and an upper bound of mu, got",
    ),
    "range of one number": ({"range": lambda law: (0.3,)}, "range() must return two numbers"),
    "range that is no number": ({"range": lambda law: (0.3, math.nan)}, "range() must return two numbers"),
    "range that is none": ({"range": lambda law: None}, "range() must return two numbers"),
    "range at rest": (
        {"static_excess": property(lambda law: 0.1)},
        "range() says that mu is at most 0.8, but at rest it is 0.9 at slip rate 0 m/s",
    ),
    "range at rest of a constant": (
        {
            "formula": staticmethod(lambda law, u, v: law.dynamic + 0.0 * v),
            "static_excess": property(lambda law: 0.6),
        },
        "range() says that mu is at most 0.8, but at rest it is 0.9 at slip rate 0 m/s",
    ),
    "negative step at rest": (
        {"static_excess": property(lambda law: -0.1)},
        "static_excess must be a number of at least 0, got -0.1",
    ),
    "friction below zero": (
        {
            "formula": staticmethod(lambda law, u, v: law.static - law.static * v / (v + law.rate) - 0.1 * v / (v + 1.0)),
            "range": lambda law: (0.0, 0.8),
        },
        "range() says that mu is at least 0, but it is -0.0998201 at slip rate 1000 m/s;",
    ),
    "too many knots": ({"knots": property(lambda law: (1.0,))}, "knots must be one fewer than pieces, got 1 knots and 1 pieces"),
    "knots that descend": (
        {
            "pieces": property(lambda law: (Own.formula,) * 3),
            "knots": property(lambda law: (2.0, 1.0)),
            "knot_variable": "rate",
        },
        "knots must be finite and ascending, got 2, 1",
    ),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_statement_that_the_formula_contradicts_is_one_line(lie: str) -> None:
    statements, message = LIES[lie]
    with refused(begins=f"Lying: {message}"):
        lying(**statements)()


def test_a_range_is_compared_at_slips_too() -> None:
    narrow = type("Narrow", (Bell,), {"__module__": __name__, "__doc__": "Lies.", "range": lambda law: (0.5, 0.8)})
    with pytest.raises(ss.InputError, match=r"^Narrow: range\(\) says that mu is at least 0.5, but it is 0\.3\d* at slip 0\.\d+ m"):
        dataclass(frozen=True)(narrow)()


def unstated(formula: Any, **statements: Any) -> type[FrictionLaw]:
    """Return a class that states no range."""
    fields = {"a": quantity("1", "a number", default=0.8), "b": quantity("m/s", "a scale", default=0.1)}
    given = {"__module__": __name__, "__doc__": "A law.", "kind": "unstated", "formula": staticmethod(formula), **statements}
    return dataclass(frozen=True)(
        type("Unstated", (FrictionLaw,), given | fields | {"__annotations__": dict.fromkeys(fields, float)})
    )


UNSTATED: dict[str, tuple[type[FrictionLaw], tuple[float, float], bool]] = {
    "falls": (unstated(lambda law, u, v: 0.3 + law.a / (1.0 + v / law.b)), (0.3, 1.1), False),
    "rises for ever": (unstated(lambda law, u, v: law.a + v / law.b), (0.8, math.inf), False),
    "steps at rest": (unstated(lambda law, u, v: law.a + 0.0 * v, static_excess=property(lambda law: 0.1)), (0.8, 0.9), False),
    "waves": (unstated(lambda law, u, v: law.a + 0.5 * sin(7.0 * u)), (0.3, 1.3), False),
    "waves below zero": (unstated(lambda law, u, v: 0.4 + law.a * sin(7.0 * u)), (0.0, 1.2), True),
    "even power of net slip": (unstated(lambda law, u, v: law.a / (1.0 + u**2) + 0.1), (0.1, 0.9), False),
    "odd power of net slip": (unstated(lambda law, u, v: law.a + tanh(u**3)), (0.0, 1.8), True),
    "power of a path": (unstated(lambda law, u, v: law.a * (1.0 + u) ** -0.5, counts="path"), (0.0, 0.8), False),
    "pieces": (
        unstated(
            None,
            pieces=property(lambda law: (lambda law, u, v: law.a - v, lambda law, u, v: law.a - 0.5 + 0.0 * v)),
            knots=property(lambda law: (0.5,)),
            knot_variable="rate",
        ),
        (0.3, 0.8),
        False,
    ),
    "a variable that occurs twice": (unstated(lambda law, u, v: 0.2 + v / law.b * exp(-v / law.b)), (0.2, math.inf), False),
}


@pytest.mark.parametrize("name", UNSTATED)
def test_a_class_need_not_state_its_range(name: str) -> None:
    """It is found from the formula, and holds at many slips and slip rates."""
    kind, wanted, can_be_negative = UNSTATED[name]
    law = kind()
    low, high = law.range()
    assert (low, high) == pytest.approx(wanted, rel=1e-15)
    assert law.can_be_negative == can_be_negative
    slips, rates = np.append(0.0, np.geomspace(1e-3, 30.0, 60))[:, None], np.append(0.0, np.geomspace(1e-4, 30.0, 60))
    values = law.coefficient(np.concatenate((slips, -slips)) if law.counts == "net" else slips, rates)
    assert (np.maximum(values, 0.0) >= low).all()
    assert values.max() <= high
    assert (values.min() < 0.0) == can_be_negative


@pytest.mark.parametrize("reverses", [False, True])
def test_friction_of_a_state_that_reverses_may_be_below_zero(reverses: bool) -> None:
    """Nothing is known of a state; bristles that spring back drive slip for a while."""
    state = StateVariable("z", "m", "bending", reverses=reverses)
    law = unstated(lambda law, u, v, z: z / law.b, state=state, state_rate=property(lambda law: lambda law, u, v, z: v - z))()
    assert law.range() == (0.0, math.inf)
    assert law.can_be_negative != reverses


def test_a_run_ends_where_friction_of_a_class_without_a_range_falls_below_zero() -> None:
    law = UNSTATED["waves below zero"][0]()
    run = ss.simulate(ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), law, initial_excess=1e6, initial_slip=0.3), duration=6.0)
    assert run.status.name == "negative friction"


def test_friction_below_zero_is_allowed_where_the_law_says_so() -> None:
    falls = staticmethod(lambda law, u, v: law.static - law.static * v / (v + law.rate) - 0.1 * v / (v + 1.0))
    law = lying(
        formula=falls,
        range=lambda law: (0.0, 0.8),
        can_be_negative=property(lambda law: True),
    )()
    assert float(law.coefficient(0.0, 1e3)) < 0.0


@given(
    static=st.floats(0.01, 2.0),
    dynamic=st.floats(0.0, 2.0),
    rate=st.floats(-12.0, 4.0).map(lambda power: 10.0**power),
)
@settings(max_examples=examples(300), deadline=None)
def test_an_honest_class_is_never_refused(static: float, dynamic: float, rate: float) -> None:
    law = Own(static, dynamic, rate)
    Bell(static, dynamic, rate)
    ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), law, initial_excess=0.0)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("body", ["slab", "block"])
def test_the_example_of_every_law_is_honest(name: str, body: str) -> None:
    law = read_scenario(template(body, name), "example").problem.friction
    check_statements(law)
    assert law.kind == name
    assert law.source
    assert (type(law).__doc__ or "").splitlines()[0].endswith((".", ","))


SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)


@pytest.mark.parametrize("rate", [1e-4, 1.0, 5.0, 6.0, 1e3])
def test_the_critical_value_of_an_own_law_is_that_of_the_parameter_it_names(rate: float) -> None:
    """Z v + S mu(v) first falls where rate = S (static - dynamic) / Z = 5.1 m/s."""
    found = ss.uniqueness(ss.Problem(SLAB, Own(rate=rate), initial_excess=0.0))
    assert (found.critical_parameter, found.critical_value) == ("rate", pytest.approx(0.5 * 1e8 / 9.8e6, rel=1e-12))


def test_laws_of_the_package_pay_nothing() -> None:
    """The check is that of the class, so that a subclass that a user writes is checked again."""
    assert replace(F.HyperbolicRate(0.8, 0.3, 1.0), alpha=2.0).alpha == 2.0
    with pytest.raises(ss.InputError, match=r"^Sub: range"):
        dataclass(frozen=True)(type("Sub", (F.HyperbolicRate,), {"__doc__": "Lies.", "range": lambda law: (0.3, 0.4)}))(
            0.8, 0.3, 1.0
        )
