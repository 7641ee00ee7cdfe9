"""Numbers of a problem by their names: every one is found, read and put back."""

from __future__ import annotations

from dataclasses import replace

import pytest

import stickslip as ss
from stickslip.friction import LAWS
from stickslip.problem.loading import HISTORIES, Steps
from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template
from tests.messages import refused

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)


def problem(law: ss.friction.FrictionLaw) -> ss.Problem:
    return ss.Problem(SLAB, law, initial_slip=0.25, initial_excess=0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", LAWS)
def test_every_number_of_every_law_can_be_put_back_and_changed(kind: str) -> None:
    given = read_scenario(template("slab", kind), "new").problem
    found = given.parameters
    assert {"body.density", "body.normal_stress", "initial.slip"} <= set(found)
    assert any(name.startswith("friction.") for name in found)
    for name, one in found.items():
        assert one.put(one.value) == given, name
        if not one.declared.whole and one.value:
            changed = one.put(one.value * (1.0 + 1e-9))
            assert changed.parameters[name].value == one.value * (1.0 + 1e-9), name
            assert {n: p.value for n, p in changed.parameters.items() if n != name} == {
                n: p.value for n, p in found.items() if n != name
            }


@pytest.mark.parametrize("field", ["pull_rate", "far_stress"])
@pytest.mark.parametrize("kind", HISTORIES)
def test_every_number_of_every_loading_history_can_be_changed_alone(kind: str, field: str) -> None:
    if kind == "waypoints" and field == "far_stress":
        pytest.skip("positions are those of a driver")
    history = HISTORIES[kind](**HISTORIES[kind].example)
    body = replace(SLAB, driver_impedance=1e7)
    given = ss.Problem(body, ss.friction.Coulomb(0.6, 0.5), initial_excess=0.0, **{field: history})
    found = {name: one for name, one in given.parameters.items() if name.startswith(f"loading.{field}.")}
    assert len(found) >= 3
    for name, one in found.items():
        factor = 0.0 if name.endswith("times[0]") and kind == "steps" else 1e-9
        changed = one.put(one.value * (1.0 + factor))
        assert changed.parameters[name].value == one.value * (1.0 + factor), name
        rest = {n: p.value for n, p in changed.parameters.items() if n != name}
        assert rest == {n: p.value for n, p in given.parameters.items() if n != name}
        assert one.unit == (
            "s"
            if "time" in name or "period" in name
            else "rad"
            if "phase" in name
            else "m"
            if "positions" in name
            else {"pull_rate": "m/s", "far_stress": "Pa"}[field]
        )


@pytest.mark.parametrize("start", ["initial_load", "initial_excess"])
def test_pressing_keeps_the_ratio_of_all_loads_to_the_normal_load(start: str) -> None:
    history = Steps([0.0, 10.0], [4e7, 5e7])
    driven = replace(SLAB, driver_impedance=1e7)
    given = ss.Problem(driven, ss.friction.Coulomb(0.6, 0.5), far_stress=history, far_stress_rate=30.0, **{start: 5e7})
    pressed = given.parameters["pressing"].put(3e8)
    assert given.parameters["pressing"].value == 1e8
    assert pressed.normal == pressed.body.normal_load == 3e8
    assert pressed.load / given.load == pytest.approx(3.0, rel=1e-15, abs=0.0)
    assert pressed.strength / given.strength == pytest.approx(3.0, rel=1e-15, abs=0.0)
    assert (pressed.far_stress.values, pressed.far_stress.times) == ((1.2e8, 1.5e8), (0.0, 10.0))
    assert (pressed.far_stress_rate, pressed.body.density) == (90.0, 2800.0)
    block = ss.Problem(ss.SpringBlock(1.0, 1.0, 10.0), ss.friction.Coulomb(0.6, 0.5), initial_load=5.0)
    assert (block.parameters["pressing"].put(20.0).load, block.parameters["pressing"].unit) == (10.0, "N")


def test_a_load_and_an_excess_replace_each_other() -> None:
    given = problem(ss.friction.Coulomb(0.6, 0.5))
    assert not {"initial.load", "pressing"} & set(given.parameters)  # what is given is listed
    loaded = given.parameters["initial.load"].put(5e7)
    assert (loaded.initial_load, loaded.initial_excess) == (5e7, None)
    assert loaded.parameters["initial.excess"].put(1.0).initial_load is None


def test_parameters_are_found_with_name_unit_and_value() -> None:
    law = ss.friction.SlipTimesRate(ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), ss.friction.HyperbolicRate(1.0, 0.5, 1.5))
    for name, full, value, unit in (
        ("alpha", "friction.rate.alpha", 1.5, "s/m"),
        ("rate.static", "friction.rate.static", 1.0, "1"),
        ("distance", "friction.slip.distance", 0.4, "m"),
        ("normal_stress", "body.normal_stress", 1e8, "Pa"),
        ("initial.slip", "initial.slip", 0.25, "m"),
    ):
        found = problem(law).parameters[name]
        assert (found.name, found.value, found.unit) == (full, value, unit)
    users = ss.friction.FromExpression("a + 0.1*sin(b * u)", {"a": 0.5, "b": "2 / m"})
    assert (problem(users).parameters["b"].name, problem(users).parameters["b"].unit) == ("friction.parameters.b", "m^-1")
    polyline = ss.friction.PiecewiseLinearRate((0.0, 1.0), (0.6, 0.3))
    changed = problem(polyline).parameters["coefficients[1]"].put(0.4)
    assert changed.friction == ss.friction.PiecewiseLinearRate((0.0, 1.0), (0.6, 0.4))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("static", "is ambiguous: give one of friction.slip.static, friction.rate.static"),
        ("alfa", "parameter 'alfa' is unknown; did you mean 'alpha'?"),
        ("friction.alpha", "did you mean 'friction.rate.alpha'?"),
        ("", "parameter '' is unknown; allowed: body.contact_damping, body.contact_mass"),
    ],
)
def test_names_that_fit_none_or_several_are_refused(name: str, message: str) -> None:
    law = ss.friction.SlipTimesRate(ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), ss.friction.HyperbolicRate(1.0, 0.5, 1.5))
    with refused(message):
        problem(law).parameters[name]


def test_what_the_problem_refuses_is_refused_here_too() -> None:
    with pytest.raises(ss.InputError, match="static must be at least dynamic"):
        problem(ss.friction.Coulomb(0.6, 0.5)).parameters["static"].put(0.4)
    with pytest.raises(ss.InputError, match="density must be greater than 0"):
        problem(ss.friction.Coulomb(0.6, 0.5)).parameters["density"].put(-1.0)


def test_parameters_are_a_table_of_names_values_and_units() -> None:
    found = problem(ss.friction.Coulomb(0.6, 0.5)).parameters
    assert list(found)[:3] == ["friction.static", "friction.dynamic", "body.density"]
    assert len(found) == len(list(found))
    assert ("friction.static" in found, "static" in found, 3 in found) == (True, False, False)
    assert repr(found).splitlines()[1:4] == ["friction.dynamic = 0.5", "body.density = 2800 kg/m^3", "body.wave_speed = 3.5 km/s"]
    with pytest.raises(ss.InputError, match=r'a name must be text such as "friction.alpha", got 3'):
        found[3]  # type: ignore[index] # on purpose
