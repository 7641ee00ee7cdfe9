"""Numbers as people write them in Python: texts with units, quantities of pint, and every kind of number give what TOML gives."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields, replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stickslip as ss
from stickslip.foundation.quantities import NumberSeries, Quantity
from stickslip.problem.loading import HISTORIES, VARYING, HoldAndSlide, PiecewiseLinear, Sinusoidal, Steps, Waypoints
from stickslip.problem.scenarios import read_scenario

UREG: Any = pint.UnitRegistry()
EXACT: Any = pint.UnitRegistry(None, non_int_type=Decimal)
"""Units of numbers that are decimal, few of them, because to read all of pint's takes a second."""
EXACT.define("meter = [length] = m")
EXACT.define("kilo- = 1000 = k-")
LENGTH = Quantity("m", "length")
SLAB: dict[str, Any] = {"density": "2800 kg/m^3", "wave_speed": "3.5 km/s", "thickness": "10 km", "normal_stress": "100 MPa"}
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha="1 s/m")
TOML = """
[body]
kind = "elastic-slab"
density = "2800 kg/m^3"
wave_speed = "3.5 km/s"
thickness = "10 km"
normal_stress = "100 MPa"
driver_impedance = "30 MPa s/m"
[friction]
kind = "hyperbolic-rate"
static = 0.8
dynamic = 0.3
alpha = "1 s/m"
[loading]
pull_rate = "0.05 m/year"
far_stress = "79.9 MPa"
far_stress_rate = "0.1 bar/year"
[initial]
slip = "3 cm"
load = "799 bar"
[run]
duration = "480 year"
shortest_event = 0
"""


def as_pint(text: str) -> Any:
    number, unit = text.split(" ", 1)
    return float(number) * UREG(unit)


@pytest.mark.parametrize("form", [str, as_pint])
def test_texts_and_pint_give_every_bit_of_the_same_text_in_toml(form: Callable[[str], Any]) -> None:
    slab = ss.ElasticSlab(**{name: form(text) for name, text in SLAB.items()}, driver_impedance=form("30 MPa s/m"))
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=form("1 s/m"))
    problem = ss.Problem(
        slab,
        law,
        pull_rate=form("0.05 m/year"),
        far_stress=form("79.9 MPa"),
        far_stress_rate=form("0.1 bar/year"),
        initial_slip=form("3 cm"),
        initial_load=form("799 bar"),
    )
    from_toml = read_scenario(TOML, "mine.toml")
    for owner, other in ((problem, from_toml.problem), (slab, from_toml.problem.body), (law, from_toml.problem.friction)):
        for field in fields(owner):
            ours, theirs = getattr(owner, field.name), getattr(other, field.name)
            assert ours == theirs
            assert type(ours) is type(theirs)
    assert problem.pull_rate == 0.05 / ss.YEAR
    assert replace(from_toml, duration=form("480 year")) == from_toml


@pytest.mark.sampled(every=2)
@given(number=st.floats(-1e20, 1e20).filter(lambda one: one == 0.0 or abs(one) > 1e-20))
@pytest.mark.parametrize("unit", ["km", "inch", "km / 3.0", "s * km / hour"])
def test_pint_rounds_as_the_text_does(unit: str, number: float) -> None:
    if unit == "km / 3.0":  # a number in the unit becomes part of the magnitude
        assert LENGTH.check("Owner", "field", number * UREG(unit)) == (number * UREG(unit)).magnitude * 1000.0
    else:
        assert LENGTH.check("Owner", "field", number * UREG(unit)) == LENGTH.check("Owner", "field", f"{number!r} {unit}")


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (3, 3.0),
        (Fraction(1, 3), 1 / 3),
        (Decimal("0.1"), 0.1),
        (np.float32(0.5), 0.5),
        (np.uint64(2**60), 2.0**60),
        (np.array(0.1), 0.1),
        ("1.5 km", 1500.0),
        (" -2e3mm ", -2.0),
        (Fraction(1, 3) * UREG.km, 1000 / 3),
        (Decimal("1.5") * EXACT.km, 1500.0),
        (np.array(2.0) * UREG.km, 2000.0),
    ],
)
def test_every_kind_of_real_number_is_read_as_a_float(given: Any, expected: float) -> None:
    found = LENGTH.check("Owner", "field", given)
    assert type(found) is float
    assert found == expected


class Masked(np.ndarray):
    """A kind of array that may carry a unit of its own, as those of other libraries do."""


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        (np.bool_(True), "bool"),
        (1j, "complex"),
        (np.array([1.0]), "ndarray"),
        (np.array(1.0).view(Masked), "Masked"),
        (np.ma.masked, "MaskedConstant"),
        (Decimal("sNaN"), "Decimal"),
        ([1.0], "[1.0]"),
        ("", "''"),
        ("10,5 km", "'10,5 km': write '10.5 km', with a decimal point"),
        (np.timedelta64(3, "s"), "timedelta64"),
        ("10", "'10': write a number without quotes"),
        ("10 " + "m" * 70, f"'10 {'m' * 53}...: longer than 64 characters"),
        ("10 kg", "'10 kg': 'kg' does not convert to m"),
        ("10 kmm", "'10 kmm': 'kmm' is not a unit; did you mean 'mm'?"),
        (UREG.Quantity(20.0, "delta_degC"), "20.0 delta_degree_Celsius: 'delta_degree_Celsius' does not convert to m"),
        (10 * UREG.kg, "10.0 kilogram: 'kilogram' does not convert to m"),
        (np.array([1.0, 2.0]) * UREG.km, "Quantity"),
        (UREG.km, "Unit"),
        (pint.UnitRegistry, "the class UnitRegistry, not an instance of it: call it"),
    ],
)
def test_anything_else_is_refused_in_one_line(given: Any, shown: str) -> None:
    with pytest.raises(ss.InputError) as caught:
        LENGTH.check("Owner", "field", given)
    text = str(caught.value)
    known = 'Owner: field must be a number in m or a text with a unit such as "10 m", got '
    assert text.startswith(known)
    assert text.removeprefix(known) == shown


def test_messages_show_a_text_that_is_accepted() -> None:
    for unit in ("m", "1/m", "Pa s/m", "Pa or N", "kg/m^2"):
        declared = Quantity(unit, "")
        assert declared.check("Owner", "field", declared.allowed.split('"')[1]) == 10.0


def test_a_registry_counts_with_its_own_definitions() -> None:
    own: Any = pint.UnitRegistry()
    own.define("year = 365 * day")
    own.define("fathom_of_mine = 1.8288 * meter")
    assert Quantity("s", "").check("Owner", "field", 2.0 * own.year) == 2 * 365 * 86_400.0
    assert LENGTH.check("Owner", "field", 10.0 * own.fathom_of_mine) == pytest.approx(18.288, rel=1e-15)


def test_pure_numbers_take_no_text_but_pint_without_dimension() -> None:
    law = ss.friction.Coulomb(static=0.7 * UREG.dimensionless, dynamic=30 * UREG.percent)
    assert (law.static, law.dynamic) == (0.7, 0.3)
    law = ss.friction.Coulomb(static=(7 * UREG.mm) / (10 * UREG.mm), dynamic=(30 * UREG.cm) / (1 * UREG.m))
    assert (law.static, law.dynamic) == (0.7, 0.3)
    for text in ("0.7", "0.7 mm/mm", "70 percent"):
        with pytest.raises(ss.InputError, match=r"^Coulomb: static must be a number, got '"):
            ss.friction.Coulomb(static=text, dynamic=0.3)  # type: ignore[arg-type]
    with pytest.raises(
        ss.InputError, match=r"^Coulomb: static must be a number, got 1.0 meter: 'meter' does not convert to dimensionless$"
    ):
        ss.friction.Coulomb(static=1 * UREG.m, dynamic=0.3)


def test_infinity_has_a_word_where_it_is_allowed() -> None:
    assert ss.ElasticSlab(**SLAB, driver_impedance="rigid").driver_impedance == math.inf
    assert ss.ElasticSlab(**SLAB, driver_impedance="inf").driver_impedance == math.inf
    with pytest.raises(ss.InputError, match=r'^ElasticSlab: driver_impedance must be .* such as "10 Pa s/m" \(or "rigid"\), got '):
        ss.ElasticSlab(**SLAB, driver_impedance="infinite")
    with pytest.raises(ss.InputError, match=r"^ElasticSlab: thickness must be a number in m .*, got 'rigid'$"):
        ss.ElasticSlab(**(SLAB | {"thickness": "rigid"}))


@pytest.mark.parametrize(
    "given",
    [
        ["1 mm", "0.2 cm", 0.003],
        ("1 mm", 0.002, 3 * UREG.mm),
        np.array([1.0, 2.0, 3.0]) * UREG.mm,
        [1.0, 2.0, 3.0] * UREG.mm,
        [1 * UREG.mm, 2 * UREG.mm, 3 * UREG.mm],
        np.array([0.001, 0.002, 0.003]),
        np.array([Fraction(1, 1000), Fraction(2, 1000), Fraction(3, 1000)]),
        np.array(["1 mm", "2 mm", "3 mm"]),
    ],
)
def test_series_take_units_one_by_one_or_together(given: Any) -> None:
    found = NumberSeries(LENGTH, ascending=True).check("Owner", "field", given)
    assert found == (0.001, 0.002, 0.003)
    assert all(type(one) is float for one in found)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["1 m", "2 kg"], r"field\[1\] must be a number in m .*, got '2 kg': 'kg' does not convert to m"),
        (np.array([1.0, 2.0]) * UREG.s, r"field\[0\] must be a number in m .*, got 1.0 second: 'second' does not convert to m"),
        (3 * UREG.m, "field must be a list of numbers in m, got Quantity"),
        ([[1.0], [2.0]] * UREG.m, "field must be a list of numbers in m, got Quantity"),
        ("1 m, 2 m", "field must be a list of numbers in m, got str"),
        (["3 km", "2000 m"], r"field must ascend, but \[1\] = 2000 follows 3000; sort the points"),
    ],
)
def test_mistakes_in_series_name_the_index(given: Any, message: str) -> None:
    with pytest.raises(ss.InputError, match=f"^Owner: {message}$"):
        NumberSeries(LENGTH, ascending=True).check("Owner", "field", given)


def test_parameters_of_an_expression_may_be_quantities_of_pint() -> None:
    text = "mu_d + (mu_s - mu_d) / (1 + alpha*v) + u/d"
    plain = {"mu_s": 0.8, "mu_d": 0.3, "alpha": "2.5 s/mm", "d": "3 km"}
    ours = plain | {"mu_s": 0.8 * UREG.dimensionless, "alpha": 2.5 * UREG.s / UREG.mm, "d": 3 * UREG.km}
    with_one = {"alpha": "5 /m", "beta": 5.0 / UREG.m}
    assert ss.friction.FromExpression(text, ours, counts="path") == ss.friction.FromExpression(text, plain, counts="path")
    law = ss.friction.FromExpression("0.3 + 0.1*exp(-alpha*u) + 0.1*exp(-beta*u)", with_one, counts="path")
    assert [(one.value, one.unit) for one in law.values] == [(5.0, "m^-1")] * 2
    with pytest.raises(
        ss.InputError, match=r"^FromExpression: parameters 'd' must be a number or a text with a unit: Quantity of an array$"
    ):
        ss.friction.FromExpression(text, ours | {"d": [1.0, 2.0] * UREG.km}, counts="path")


# ---- loads are stresses on slabs and forces on blocks, and loading histories are of either kind ---------------------------------


def test_loads_have_the_unit_of_the_body() -> None:
    slab, block = ss.ElasticSlab(**SLAB), ss.SpringBlock(mass="2 tonne", stiffness="1 MN/m", normal_force="10 kN")
    assert ss.Problem(slab, LAW, initial_load="60 MPa").initial_load == 60e6
    assert ss.Problem(block, LAW, initial_excess=-1 * UREG.kN).initial_excess == -1000.0
    with pytest.raises(
        ss.InputError, match=r"^Problem: initial_load must be a number in Pa .*, got '60 kN': 'kN' does not convert to Pa$"
    ):
        ss.Problem(slab, LAW, initial_load="60 kN")
    with pytest.raises(
        ss.InputError, match=r"^Problem: initial_load must be a number in N .*, got '60 kPa': 'kPa' does not convert to N$"
    ):
        ss.Problem(block, LAW, initial_load="60 kPa")


def test_a_state_has_the_unit_of_the_law() -> None:
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um", rate="1 um/s")
    problem = ss.Problem(ss.ElasticSlab(**SLAB), law, initial_load="60 MPa", initial_state="2 hour")
    assert problem.initial_state == 7200.0
    assert (law.distance, law.rate) == (1e-5, 1e-6)
    with pytest.raises(
        ss.InputError, match=r"^Problem: initial_state must be a number in s .*, got '2 m': 'm' does not convert to s$"
    ):
        replace(problem, initial_state="2 m")


RATES = {
    "steps": (Steps(["0 s", "1 min"], ["1 um/s", "10 um/s"]), Steps([0, 60], [1e-6, 1e-5])),
    "piecewise-linear": (
        PiecewiseLinear([1, 2] * UREG.hour, [1, 2] * UREG.mm / UREG.s),
        PiecewiseLinear([3600, 7200], [1e-3, 2e-3]),
    ),
    "sinusoidal": (Sinusoidal(1e-9, "0.05 m/year", "12.42 h", "180 degree"), Sinusoidal(1e-9, 0.05 / ss.YEAR, 44_712, math.pi)),
    "waypoints": (Waypoints(["0 s", "1 min"], ["1 mm", "2 mm"]), Waypoints([0, 60], [1e-3, 2e-3])),
    "hold-and-slide": (HoldAndSlide("1 um/s", "100 s", ["10 s", "1 min"], 0), HoldAndSlide(1e-6, 100, [10, 60])),
}


@pytest.mark.parametrize("kind", HISTORIES)
def test_loading_histories_take_units_and_know_which(kind: str) -> None:
    with_units, plain = RATES[kind]
    slab = ss.ElasticSlab(**SLAB, driver_impedance="1 MPa s/m")
    assert with_units == plain
    assert (with_units.unit, plain.unit) == ("m/s", "m/s or rad/s" if kind == "waypoints" else VARYING)
    assert ss.Problem(slab, LAW, pull_rate=with_units, initial_excess=0) == ss.Problem(slab, LAW, pull_rate=plain, initial_excess=0)
    if kind != "waypoints":
        assert ss.Problem(slab, LAW, far_stress=plain, initial_excess=0).far_stress == plain
    with pytest.raises(ss.InputError, match=r"^Problem: far_stress must be in Pa, got a history of values in m/s$"):
        ss.Problem(slab, LAW, far_stress=with_units, initial_excess=0)


def test_a_history_is_of_one_kind() -> None:
    with pytest.raises(
        ss.InputError, match=r"^Steps: values\[1\] must be a number in m/s .*, got '2 MPa': 'MPa' does not convert to m/s$"
    ):
        Steps([0, 1], ["1 m/s", "2 MPa"])
    with pytest.raises(
        ss.InputError, match=r"^Sinusoidal: amplitude must be a number in Pa .*, got '1 m/s': 'm/s' does not convert to Pa$"
    ):
        Sinusoidal("1 MPa", "1 m/s", "1 s")
    with pytest.raises(
        ss.InputError,
        match=r"^Steps: values\[0\] must be a number in m/s .* N or N m, .*, got '1 kg': 'kg' does not convert to N m$",
    ):
        Steps([0, 1], ["1 kg", "2 kg"])
    assert Steps([0, 1], ["1 MPa", 2]).unit == "Pa"


# ---- times and rates that functions take -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def problem() -> ss.Problem:
    return ss.Problem(ss.ElasticSlab(**SLAB), LAW, pull_rate="1 m/s", initial_excess="0 Pa")


def test_runs_take_times_with_units(problem: ss.Problem, tmp_path: Any) -> None:
    run = ss.simulate(problem, "0.5 min", max_events=1, checkpoint=tmp_path / "run.nc", checkpoint_every="1 hour")
    assert run.asked_duration == 30.0
    assert run.slip(1.0) == ss.simulate(problem, 30 * UREG.s, max_events=1).slip(1.0)
    assert run.catalogue("1 mm/s").equals(run.catalogue(1e-3))
    assert run.window(0, before="0 s", after="500 ms").after == 0.5
    assert ss.resume(tmp_path / "run.nc", "1 min").duration == 60.0  # type: ignore[union-attr]
    assert ss.catalogue(problem, "0.5 min", event_rate="1 mm/s").equals(ss.catalogue(problem, 30, event_rate=1e-3))
    assert len(ss.catalogue(problem, 30, event_rate="1 mm/s")) > 0
    for call in (run.catalogue, run.energetics, run.pulses):
        with pytest.raises(
            ss.InputError, match=r"event_rate must be a number in m/s .*, got '1 mm': 'mm' does not convert to m/s$"
        ):
            call("1 mm")
    with pytest.raises(ss.InputError, match=r"^window: after must be greater than 0 s, got -1 \(from '-1 s'\)$"):
        run.window(0, after="-1 s")


def test_studies_take_times_with_units(problem: ss.Problem) -> None:
    found = ss.studies.ensemble(problem, "10 s", members=2, max_events=2, event_rate="1 mm/s")
    assert (found.reference.duration, found.event_rate) == (10.0, 1e-3)
    compared = ss.studies.compare("fig6-slab", "fig6-slab", duration="0.1 min")
    assert {run.duration for run in compared.runs.values()} == {6.0}
    softened = ss.studies.schemes(problem, "2 s", "contact-mass", 50)
    assert {run.duration for run in softened.exact.values()} == {2.0}
    for study in (ss.studies.ensemble, ss.studies.schemes):
        with pytest.raises(ss.InputError, match=rf"^{study.__name__}: duration must be a number in s .*, got '2 m': 'm' does not"):
            study(problem, "2 m")


def test_sweeps_take_texts_and_pint(problem: ss.Problem) -> None:
    kwargs: dict[str, Any] = {"duration": "5 s", "quantities": ["slip"]}
    of_texts = ss.sweep(problem, {"body.thickness": ["5 km", "10 km"], "initial.excess": ["0 Pa", "1 kPa"]}, **kwargs)
    of_pint = ss.sweep(problem, {"body.thickness": [10 * UREG.km, 5 * UREG.km], "initial.excess": [0, 1] * UREG.kPa}, **kwargs)
    plain = ss.sweep(problem, {"body.thickness": [5e3, 1e4], "initial.excess": [0.0, 1e3]}, **kwargs)
    assert of_texts.slip.equals(plain.slip)
    assert of_pint.slip.isel({"body.thickness": slice(None, None, -1)}).equals(plain.slip)


def test_arrays_of_other_libraries_do_not_lose_their_unit_in_a_sweep(problem: ss.Problem) -> None:
    with_a_unit = np.array([5.0, 10.0]).view(Masked)
    with pytest.raises(ss.InputError, match="thickness must be a number in m"):
        ss.sweep(problem, {"thickness": [with_a_unit[0:1].view(Masked)[..., 0][()], np.array(1.0).view(Masked)]}, duration=1)


def test_numbers_of_a_problem_can_be_replaced_by_texts(problem: ss.Problem) -> None:
    found = problem.parameters["thickness"].put("5 km")
    assert found == replace(problem, body=replace(problem.body, thickness=5e3))
    assert ss.uniqueness(problem, law_slip="1 mm") == ss.uniqueness(problem, law_slip=1e-3)


def test_pint_is_not_imported_for_plain_numbers() -> None:
    code = "import sys, stickslip as ss; ss.ElasticSlab(2800, 3500, 1e4, 1e8); sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
