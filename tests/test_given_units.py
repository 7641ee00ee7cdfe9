"""What was given in a unit of a trade is shown in it: in tables, sentences, figures, files of results and the explorer."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest

import stickslip as ss
from stickslip.cli.main import main
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.inference.inference import in_shown_unit
from stickslip.extensions.sweeps.figures import sweep
from stickslip.foundation.given import PLACE, Given, preferred, shown_in
from stickslip.foundation.names import readable_unit
from stickslip.foundation.show import brief, exactly, with_unit
from stickslip.foundation.units import si_factor
from stickslip.problem.given_units import units_given, units_shared
from stickslip.problem.scenarios.scenario import Scenario, read_scenario

LAW = ss.friction.Coulomb(0.3, 0.2)
BLOCK = {"mass": "90 kg", "stiffness": "800 kN/m", "normal_force": "1.3 kN"}
TURNED = {"inertia": "3 kg m^2", "stiffness": "2000 N m/rad", "normal_torque": "3000 N m"}


def block(law: object = LAW, *, body: dict[str, object] | None = None, **given: object) -> ss.Problem:
    start = {} if {"initial_load", "initial_excess"} & set(given) else {"initial_excess": 0.0}
    return ss.Problem(ss.SpringBlock(**(BLOCK | (body or {}))), law, **(start | given))


def turned(body: dict[str, object] | None = None, **given: object) -> ss.Problem:
    return ss.Problem(ss.RotatingBlock(**(TURNED | (body or {}))), LAW, initial_excess=0.0, **given)


def slab(thickness: str, normal_stress: str) -> ss.Problem:
    body = ss.ElasticSlab(thickness=thickness, density=2700.0, wave_speed="3 km/s", normal_stress=normal_stress)
    return ss.Problem(body, LAW, pull_rate="1 mm/s", initial_excess=0.0)


STRIBECK = {"static": 0.3, "dynamic": 0.1}
KINDS = {
    "rpm": (turned(pull_rate="120 rpm"), "rad/s", "rpm"),
    "turns a minute": (turned(pull_rate="120 1/min"), "rad/s", "rpm"),
    "deg/s": (turned(pull_rate="720 deg/s"), "rad/s", "deg/s"),
    "kN m": (turned({"normal_torque": "3 kN.m"}, pull_rate="1 rad/s"), "N m", "kN m"),
    "ft lbf": (turned({"normal_torque": "2200 ft-lbf"}, pull_rate="1 rad/s"), "N m", "ft-lbf"),
    "inch/min": (block(pull_rate="2 inch/min"), "m/s", "inch/min"),
    "inch by the rate": (block(pull_rate="2 inch/min"), "m", "inch"),
    "inch of slip": (block(pull_rate="1 mm/s", initial_slip="0.1 inch"), "m", "inch"),
    "lbf": (block(body={"normal_force": "300 lbf"}, pull_rate="1 mm/s"), "N", "lbf"),
    "lbf of the start": (block(pull_rate="1 mm/s", initial_load="20 lbf"), "N", "lbf"),
    "lbf/inch": (block(body={"stiffness": "4500 lbf/inch"}, pull_rate="1 mm/s"), "N/m", "lbf/inch"),
    "bar": (slab("100 m", "80 bar"), "Pa", "bar"),
    "feet inside": (slab("300 ft", "8 MPa"), PLACE, "ft"),
    "g": (block(pull_rate=0.0, ground_acceleration=ss.loading.PiecewiseLinear([0, 1], ["0 g", "0.3 g"])), "m/s^2", "g"),
    "gal": (block(pull_rate=0.0, ground_acceleration=ss.loading.Steps([0, 1], [0.0, "300 Gal"])), "m/s^2", "Gal"),
    "steps in rpm": (turned(pull_rate=ss.loading.Steps([0, 1], ["60 rpm", "120 rpm"])), "rad/s", "rpm"),
}


@pytest.mark.parametrize(("problem", "si", "unit"), KINDS.values(), ids=KINDS)
def test_a_problem_knows_the_units_in_which_it_was_given(problem: ss.Problem, si: str, unit: str) -> None:
    size = float(si_factor(unit, "m" if si == PLACE else si))
    assert units_given(problem)[si] == (unit, pytest.approx(size, rel=1e-15))
    for other in (pickle.loads(pickle.dumps(problem)), copy.deepcopy(problem), replace(problem, one_way=True)):
        assert units_given(other) == units_given(problem)


@pytest.mark.parametrize(("problem", "si", "unit"), KINDS.values(), ids=KINDS)
def test_a_scenario_keeps_the_units_and_every_bit(problem: ss.Problem, si: str, unit: str) -> None:
    scenario = Scenario(problem, 1.0)
    again = read_scenario(scenario.to_toml(), "again")
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()
    assert units_given(again.problem)[si][0] == unit
    assert units_given(scenario.with_values({"friction.static": 0.31}).problem) == units_given(problem)


NOT_SHOWN = {
    "SI": block(pull_rate="1 mm/s"),
    "prefixes": block(body={"normal_force": "1.3 kN"}, pull_rate="0.1 cm/s", initial_load="0.2 kN"),
    "rates per year": block(pull_rate="3 cm/year"),
    "plain numbers": block(pull_rate=1e-3),
}


@pytest.mark.parametrize("problem", NOT_SHOWN.values(), ids=NOT_SHOWN)
def test_what_differs_from_si_by_a_prefix_is_shown_as_ever(problem: ss.Problem) -> None:
    assert units_given(problem) == {}
    assert not any(unit in Scenario(problem, 1.0).to_toml() for unit in ("year", "cm", "kN"))


def test_what_is_nearest_decides_and_a_mixture_is_si() -> None:
    law = ss.friction.ExponentialStribeck(**STRIBECK, rate="0.2 inch/min")
    assert units_given(block(law, pull_rate="1 ft/min"))["m/s"][0] == "ft/min"
    assert "m/s" not in units_given(block(law, pull_rate="1 mm/s"))
    assert units_given(block(law, pull_rate=0.0))["m/s"][0] == "inch/min"
    mixed = ss.loading.Steps([0, 1], ["1 inch/min", "0.2 ft/min"])
    assert "m/s" not in units_given(block(law, pull_rate=mixed))
    both = block(body={"normal_force": "300 lbf"}, pull_rate=0.0, initial_load="9 kgf")
    assert units_given(both)["N"][0] == "kgf"


def test_numbers_remember_their_unit_and_are_floats_to_the_last_bit() -> None:
    rate = turned(pull_rate="123.4 rpm").pull_rate
    assert isinstance(rate, Given)
    assert rate == pytest.approx(float(Fraction(1234, 10) * si_factor("rpm", "rad/s")), rel=1e-15)
    assert (rate.amount, rate.unit, rate.text) == (123.4, "rpm", "123.4 rpm")
    assert (type(rate * 2.0), type(float(rate)), hash(rate), repr(rate)) == (float, float, hash(float(rate)), repr(float(rate)))
    assert turned(pull_rate=pint.UnitRegistry().Quantity(123.4, "rpm")).pull_rate == rate
    assert np.asarray([rate, 1.0]).dtype == float


def test_histories_do_not_depend_on_the_unit() -> None:
    given, plain = (ss.simulate(turned(pull_rate=rate), 2.0) for rate in ("120 rpm", float(turned(pull_rate="120 rpm").pull_rate)))
    assert given.problem == plain.problem
    assert all(np.array_equal(getattr(given.history.store, name), getattr(plain.history.store, name)) for name in ("load", "rate"))


def test_a_unit_is_taken_where_numbers_can_be_read_in_it() -> None:
    with shown_in({"rad/s": ("rpm", float(si_factor("rpm", "rad/s"))), PLACE: ("ft", 0.3048)}):
        assert readable_unit("rad/s", 3.0, 12.0)[0] == readable_unit("rad/s", 12.0, plain=True)[0] == "rpm"
        assert readable_unit("rad/s", 1e-9)[0] == "rad/s"
        assert readable_unit("rad/s", [1e-9, 10.0], log=True)[0] == "rpm"
        assert (brief(2.0 * np.pi, "rad/s"), exactly(np.pi, "rad/s"), with_unit(np.pi, "rad/s")) == ("60 rpm", "30 rpm", "30 rpm")
        assert (readable_unit("m", 100.0)[0], readable_unit("m", 100.0, of=PLACE)) == ("m", ("ft", 0.3048))
    assert readable_unit("rad/s", 12.0)[0] == "rad/s"
    assert preferred("rad/s") is None
    assert with_unit(block(body={"mass": "200 lb"}).body.mass, "kg") == "200 lb", "a number that was given is shown as it was"


def test_tables_and_sentences_of_the_command_line_have_the_unit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With --set, from a file of results, and not of the command before."""

    def told(*arguments: str) -> str:
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert ended.value.code == 0
        return capsys.readouterr().out

    file = str(tmp_path / "run.nc")
    text = told(
        "run", "direct-shear-block", "--set", "pull_rate=9 inch/min", "--set", "body.normal_force=300000 lbf", "--out", file
    )
    assert [unit in text for unit in ("inch/min", "lbf", "inch")] == [True] * 3
    stored = told("show", file)
    table = text[text.index("slip event") : text.index("recurrence")]
    assert table in stored
    assert "inch" not in told("run", "direct-shear-block")
    check = told("check", "direct-shear-block", "--set", "pull_rate=9 inch/min", "--no-runs")
    assert "9 inch/min" in check


def test_a_file_of_results_shows_the_unit_in_python(tmp_path: Path) -> None:
    run = ss.simulate(block(pull_rate="2 inch/min"), "4 s")
    run.to_netcdf(tmp_path / "run.nc")
    for one in (run, ss.open_solution(tmp_path / "run.nc")):
        panels = one.plot().axes[:2]
        assert [axes.get_ylabel() for axes in panels] == ["slip $u$ (inch)", "slip rate $v$ (inch/min)"]
        slip, rate = (axes.lines[0].get_ydata() for axes in panels)
        assert np.nanmax(slip) == pytest.approx(one.slip(4.0) / 0.0254, rel=1e-9)
        assert np.nanmax(rate) == pytest.approx(one.events.peak_rate.max() / 0.0254 * 60.0, rel=1e-4), "points are drawn"
        assert "inch/min" in repr(one)
        assert one.to_dataset([1.0]).slip.attrs["units"] == "m", "files and datasets are in SI"


def test_the_explorer_shows_the_unit() -> None:
    view = view_of(solve(ss.load_scenario("sliding-block-shaken")))
    assert view.titles["given"] == "Ground acceleration (g)"
    view = view_of(solve(Scenario(block(pull_rate="2 inch/min"), 2.0)))
    assert [view.titles[name] for name in ("slip", "rate")] == ["Slip u (inch)", "Slip rate v (inch/min)"]


def test_a_varied_number_is_shown_as_it_was_typed() -> None:
    varied = {"pull_rate": ["60 rpm", "90 rpm", "120 rpm", "150 rpm"]}
    found = ss.sweep(turned(pull_rate=1.0), varied, duration="1 s", quantities=["slip"])
    axes = sweep.plot_sweep(found).axes[0]
    assert axes.get_xlabel() == "pull rate $V$ of the driver (rpm)"
    assert axes.lines[0].get_xdata() == pytest.approx([60.0, 90.0, 120.0, 150.0], rel=1e-12)


def test_numbers_of_a_fit_are_shown_in_the_unit_of_their_kind() -> None:
    numbers = {"value": 2.54e-4, "uncertainty": 2.54e-6, "low": 2.5e-4, "high": 2.6e-4, "start": 1e-4}
    row = pd.Series(numbers | {"unit": "m", "source": "curvature"})
    with shown_in({"m": ("inch", 0.0254), PLACE: ("ft", 0.3048)}):
        distance, thickness = (in_shown_unit(name, row) for name in ("friction.distance", "body.thickness"))
    assert (distance.value, distance.uncertainty, distance.unit) == (pytest.approx(0.01), pytest.approx(1e-4), "inch")
    assert thickness.unit == "m", "a thickness of 0.01 inch is not read in feet"
    assert (distance.low, distance.high, distance.start) == pytest.approx([2.5e-4 / 0.0254, 2.6e-4 / 0.0254, 1e-4 / 0.0254])
    assert in_shown_unit("friction.distance", row) is row


def test_a_record_of_the_ground_in_g_is_shown_in_g(tmp_path: Path) -> None:
    rows = [f"{0.01 * k:.2f},{0.3 * np.sin(0.3 * k):.4f}" for k in range(200)]
    (tmp_path / "quake.csv").write_text("\n".join(["time (s),acceleration (g)", *rows]))
    text = ss.load_scenario("sliding-block-shaken").source
    table = text[text.index("[loading.ground_acceleration]") : text.index("[initial]")]
    shaken = '[loading.ground_acceleration]\nkind = "piecewise-linear"\nfile = "quake.csv"\n\n'
    (tmp_path / "mine.toml").write_text(text.replace(table, shaken))
    scenario = ss.load_scenario(tmp_path / "mine.toml")
    assert units_given(scenario.problem)["m/s^2"] == ("g", 9.80665)
    again = read_scenario(scenario.to_toml(), "again")
    assert again.problem == scenario.problem
    assert units_given(again.problem) == units_given(scenario.problem)
    values = scenario.problem.ground_acceleration.values
    assert values == pytest.approx([9.80665 * float(row.split(",")[1]) for row in rows], rel=1e-12)


@pytest.mark.parametrize("head", ["slip (in),friction (-)", "slip,friction\nin,-", "slip,friction\nin,[-]"])
def test_points_of_a_law_in_inches_are_shown_in_inches(head: str, tmp_path: Path) -> None:
    """By their heading or by a row of units; a sign in place of a unit of friction, which has none, is none."""
    (tmp_path / "points.csv").write_text(f"{head}\n0,0.7\n0.1,0.65\n1,0.6\n")
    text = Scenario(block(pull_rate=0.0), 1.0).to_toml()
    table = text[text.index("[friction]") : text.index("[loading]")]
    (tmp_path / "mine.toml").write_text(text.replace(table, '[friction]\nkind = "table"\nfile = "points.csv"\n\n'))
    scenario = ss.load_scenario(tmp_path / "mine.toml")
    assert units_given(scenario.problem)["m"] == ("in", 0.0254)
    assert scenario.problem.friction.slip == pytest.approx([0.0, 0.00254, 0.0254], rel=1e-15)
    again = read_scenario(scenario.to_toml(), "again")
    assert again.problem == scenario.problem
    assert units_given(again.problem) == units_given(scenario.problem)


SLIDER = ss.Problem(
    ss.SpringBlock(mass="210 lb", stiffness="4500 lbf/inch", normal_force="300 lbf"), LAW, pull_rate="2 inch/min", initial_load=0.0
)
DRIVE = turned(pull_rate="120 rpm")


def test_several_problems_are_shown_in_the_units_that_all_of_them_have() -> None:
    metric = replace(SLIDER, pull_rate=8e-4)
    assert units_shared([SLIDER, SLIDER]) == units_given(SLIDER)
    assert set(units_shared([SLIDER, metric])) == {"N", "N/m"}  # of slips and slip rates one is in SI
    assert units_shared([SLIDER, DRIVE]) == {**units_given(SLIDER), **units_given(DRIVE)}  # nothing of them is of one kind


def test_compare_shows_slips_in_inches_beside_turns_in_rpm(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    problems = {"slider": SLIDER, "quicker": replace(SLIDER, pull_rate="3 inch/min"), "drive": DRIVE}
    files = {name: tmp_path / f"{name}.toml" for name in problems}
    for name, path in files.items():
        path.write_text(Scenario(problems[name], 10.0).to_toml(), encoding="utf-8")
    run = ss.simulate(problems["quicker"], 10.0)
    event = run.events.loc[run.events.slip.idxmax()]

    def sizes(*names: str, of: str) -> list[str]:
        """Return the words of the row with the sizes of a run."""
        with pytest.raises(SystemExit, match="0"):
            main(["compare", *(str(files[name]) for name in names)])
        return next(line for line in reversed(capsys.readouterr().out.splitlines()) if line.startswith(of)).split()

    _, _, slip, _, rate, drop, unit, *_ = sizes("slider", "quicker", of="quicker")
    assert float(slip) == pytest.approx(event.slip / 0.0254, rel=1e-5)
    assert float(rate) == pytest.approx(run.events.peak_rate.max() / (0.0254 / 60.0), rel=1e-5)
    assert float(drop) == pytest.approx(event.static_drop / 4.4482216152605, rel=1e-4)
    assert unit == "lbf"
    assert {"inch", "inch/min", "lbf"} <= set(sizes("slider", "drive", of="slider"))
    assert {"rad", "rpm"} <= set(sizes("slider", "drive", of="drive"))
    figure = ss.studies.compare(files["slider"], files["quicker"]).plot()
    assert [axes.get_ylabel() for axes in figure.axes[:2]] == ["slip $u-u_0$ (inch)", "slip rate $v$ (inch/min)"]
