"""Numbers of a problem by their names: every one is found, read and put back."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.friction import LAWS
from stickslip.problem.parameters import parameter, parameters
from stickslip.scenarios.scenario import read_scenario
from stickslip.scenarios.templates import template

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)


def problem(law: ss.friction.FrictionLaw) -> ss.Problem:
    return ss.Problem(SLAB, law, initial_slip=0.25, initial_excess=0.0)


@pytest.mark.parametrize("kind", LAWS)
def test_every_number_of_every_law_can_be_put_back_and_changed(kind: str) -> None:
    given = read_scenario(template("slab", kind), "new").problem
    found = {one.name: one for one in parameters(given)}
    assert {"body.density", "body.normal_stress", "initial.slip"} <= set(found)
    assert any(name.startswith("friction.") for name in found)
    for name, one in found.items():
        assert one.put(one.value) == given, name
        if not one.declared.whole and one.value:
            changed = one.put(one.value * (1.0 + 1e-9))
            assert parameter(changed, name).value == one.value * (1.0 + 1e-9), name
            assert {n: p.value for n, p in ((q.name, q) for q in parameters(changed)) if n != name} == {
                n: p.value for n, p in found.items() if n != name
            }


def test_parameters_are_found_with_name_unit_and_value() -> None:
    law = ss.friction.SlipTimesRate(ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), ss.friction.HyperbolicRate(1.0, 0.5, 1.5))
    for name, full, value, unit in (
        ("alpha", "friction.rate.alpha", 1.5, "s/m"),
        ("rate.static", "friction.rate.static", 1.0, "1"),
        ("distance", "friction.slip.distance", 0.4, "m"),
        ("normal_stress", "body.normal_stress", 1e8, "Pa"),
        ("initial.slip", "initial.slip", 0.25, "m"),
    ):
        found = parameter(problem(law), name)
        assert (found.name, found.value, found.unit) == (full, value, unit)
    users = ss.friction.FromExpression("a + 0.1*sin(b * u)", {"a": 0.5, "b": "2 / m"})
    assert (parameter(problem(users), "b").name, parameter(problem(users), "b").unit) == ("friction.parameters.b", "m^-1")
    polyline = ss.friction.PiecewiseLinearRate((0.0, 1.0), (0.6, 0.3))
    changed = parameter(problem(polyline), "coefficients[1]").put(0.4)
    assert changed.friction == ss.friction.PiecewiseLinearRate((0.0, 1.0), (0.6, 0.4))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("static", "is ambiguous: give one of friction.slip.static, friction.rate.static"),
        ("alfa", "parameter 'alfa' is unknown; did you mean 'alpha'?"),
        ("friction.alpha", "did you mean 'friction.rate.alpha'?"),
        ("", "parameter '' is unknown; allowed: body.contact_mass, body.density"),
    ],
)
def test_names_that_fit_none_or_several_are_refused(name: str, message: str) -> None:
    law = ss.friction.SlipTimesRate(ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), ss.friction.HyperbolicRate(1.0, 0.5, 1.5))
    with pytest.raises(ss.InputError) as error:
        parameter(problem(law), name)
    assert message in str(error.value)


def test_what_the_problem_refuses_is_refused_here_too() -> None:
    with pytest.raises(ss.InputError, match="static must be at least dynamic"):
        parameter(problem(ss.friction.Coulomb(0.6, 0.5)), "static").put(0.4)
    with pytest.raises(ss.InputError, match="density must be greater than 0"):
        parameter(problem(ss.friction.Coulomb(0.6, 0.5)), "density").put(-1.0)
