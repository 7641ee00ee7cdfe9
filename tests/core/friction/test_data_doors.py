"""Measured friction that is noisy, or hardly means what it says, is told; notes and units of instruments are understood."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputError, InputWarning
from stickslip.friction import LAWS, FromTable, PiecewiseLinearRate, PiecewiseLinearSlip, Points
from stickslip.friction.piecewise import noise_in, reversals
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from stickslip.problem.scenarios.templates import template
from stickslip.run.check.examine import examine
from tests.messages import refused
from tests.problems import RATE_LAW, SLAB, measured

SMOOTH = [kind for kind, law in LAWS.items() if law.state is None and kind != "table"]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("kind", SMOOTH)
@pytest.mark.parametrize("count", [9, 300, 3000])
@pytest.mark.parametrize("decades", [False, True])
def test_no_smooth_law_looks_noisy(kind: str, count: int, decades: bool) -> None:
    law = read_scenario(template("slab", kind), "starter").problem.friction
    places = np.append(0.0, np.geomspace(1e-6, 2.0, count)) if decades else np.linspace(0.0, 2.0, count)
    for values in (law.coefficient(places, 0.0), law.coefficient(0.1, places), law.coefficient(places, places)):
        assert noise_in(places, values) is None
        assert noise_in(places, np.round(values, 4)) is None  # the digits of a file


@pytest.mark.parametrize("points_per_wave", [5.3, 6, 9, 20])
def test_a_wave_with_five_points_or_more_is_not_noise(points_per_wave: float) -> None:
    x = np.arange(400.0)
    assert noise_in(x, 0.5 + 0.1 * np.sin(2 * np.pi * x / points_per_wave)) is None


@pytest.mark.parametrize("size", [1e-4, 1e-2])
def test_noise_is_found_and_its_size_is_right(size: float) -> None:
    """Of 300 draws of 50 points none is missed; the sizes are right on average, to 5 standard errors of this experiment."""
    sizes = []
    for seed in range(300):
        points = measured(RATE_LAW, None, np.linspace(1.0, 1.0 + 20.0 * size, 50), size, seed)
        found = noise_in(points.places.tolist(), points.friction.tolist())
        assert found is not None
        sizes.append(found.size)
    assert np.sqrt(np.mean(np.square(sizes))) == pytest.approx(size, rel=5 * 0.13 / np.sqrt(300) + 0.01)


def test_reversals_are_those_of_the_sequence_without_plateaus() -> None:
    assert reversals([1.0, 2.0, 2.0, 1.0, 1.0, 3.0]) == 2
    assert reversals([1.0, 2.0, 2.0, 3.0]) == 0


NOISY: dict[str, Any] = {"friction": measured(RATE_LAW, None, np.linspace(0.0, 2.0, 200), 0.01).friction.tolist()}


@pytest.mark.parametrize(
    ("law", "fields"),
    [
        (FromTable, {"rate": np.linspace(0, 2, 200), "friction": NOISY["friction"]}),
        (FromTable, {"slip": np.linspace(0, 2, 200), "friction": NOISY["friction"]}),
        (PiecewiseLinearRate, {"rates": np.linspace(0, 2, 200), "coefficients": NOISY["friction"]}),
        (PiecewiseLinearSlip, {"slips": np.linspace(0, 2, 200), "coefficients": NOISY["friction"]}),
    ],
)
def test_a_law_through_noisy_points_warns_at_the_users_line(law: Any, fields: dict[str, Any]) -> None:
    with pytest.warns(InputWarning, match=r"the points look noisy \(about 0.01 in friction\): interpolated exactly") as caught:
        law(**fields)
    assert [one.filename for one in caught] == [__file__]


@pytest.mark.slow
def test_an_examination_says_how_many_folds_noise_makes() -> None:
    with warnings.catch_warnings(action="ignore", category=InputWarning):
        law = FromTable(rate=np.linspace(0, 2, 200), **NOISY)
        problem = ss.Problem(SLAB, law, initial_excess=0.0)
        few = FromTable(rate=np.linspace(0, 0.4, 40), friction=NOISY["friction"][:40])  # the examination looks along all slips
        part = ss.friction.SlipPlusRate(ss.friction.ExponentialSlipWeakening(0.2, 0.1, 1.0), few)
        mixed = ss.Problem(SLAB, part, initial_excess=0.0)
    folds = len(ss.uniqueness(problem).folds)
    assert folds > 40
    said = examine(Scenario(problem, 12.0)).warnings[0]
    assert said.startswith("the points look noisy (about 0.01 in friction)")
    assert f"they make {folds} folds; smooth them or fit a law with `stickslip fit`" in said
    assert examine(Scenario(mixed, 12.0)).warnings[0].startswith("the points look noisy")


SCENARIO = (
    '[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 1.0\nnormal_force = 1.0\n'
    '[friction]\nkind = "table"\nfile = "points.csv"\n{more}\n[initial]\nexcess = 0.0\n[run]\nduration = 1.0\n'
)


def read(tmp_path: Path, text: str) -> Points:
    path = tmp_path / "points.csv"
    path.write_text(text)
    return Points.read(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("u (mm),v,mu\n0,1,0.6\n1,2,0.5\n", r"line 1: column 2, slip_rate, has no unit and is read in m/s.*slip_rate \(mm/s\)"),
        ("v,mu\n0.1,0.6\n3000,0.5\n", r"line 1: column 1, slip_rate, has no unit and is read in m/s"),
        ("u,mu\n0,0.6\n500,0.5\n", r"line 1: column 1, slip, has no unit and is read in m; .*slip \(mm\)"),
        ("v (m/s),mu\n0.1,60\n1,50\n", "friction reaches 60: .*divide a percentage by 100"),
    ],
)
def test_numbers_that_hardly_mean_what_they_say_are_noted_once(tmp_path: Path, text: str, message: str) -> None:
    with pytest.warns(InputWarning, match=message) as noted:
        read(tmp_path, text)
    assert len(noted) == 1


@pytest.mark.parametrize(
    "text", ["v (m/s),mu\n0.1,0.6\n3,0.5\n", "v (mm/s),mu\n1,0.6\n3000,0.5\n", "v (m/s),tau,sigma\n1,6,9\n2,5,9\n"]
)
def test_columns_with_units_and_ratios_are_not_noted(tmp_path: Path, text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(tmp_path, text)


@pytest.mark.parametrize("given", [{"friction": [60.0, 50.0], "rate": [0.0, 1.0]}])
def test_percentages_in_lists_are_noted(given: dict[str, Any]) -> None:
    with pytest.warns(InputWarning, match="FromTable: friction reaches 60"):
        FromTable(**given)


def test_arrays_in_other_units_are_noted() -> None:
    with pytest.warns(InputWarning, match="points: column 1, slip_rate, has no unit"):
        Points.read({"v": [1.0, 2000.0], "mu": [0.6, 0.5]})


PREAMBLE = "Direct shear, 12 May\nOperator: N. N., sample 7\n\nRun;Normal load;5 kN\n"


def test_notes_of_the_instrument_before_the_headings_are_passed_over(tmp_path: Path) -> None:
    points = read(tmp_path, PREAMBLE + "v (mm/s),mu\n1,0.6\n2,0.5\n")
    assert points.slip_rate == pytest.approx([1e-3, 2e-3], rel=1e-15, abs=0.0)
    (tmp_path / "s.toml").write_text(SCENARIO.format(more=""))
    law = ss.load_scenario(tmp_path / "s.toml").problem.friction
    assert law == FromTable(rate=[1e-3, 2e-3], friction=[0.6, 0.5])
    with pytest.raises(InputError, match="line 7: friction must be a number, got text"):  # lines count from the top of the file
        read(tmp_path, PREAMBLE + "v (mm/s),mu\n1,0.6\n2,x\n")


def test_headings_that_come_twice_are_read_once_and_the_second_part_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 4: slip_rate must be a number, got text"):
        read(tmp_path, "Part A\nv,mu\n1,0.6\nPart B\nv,mu\n1,0.5\n")


def test_shear_over_normal_stress_is_friction(tmp_path: Path) -> None:
    points = read(tmp_path, "v (mm/s),tau (kPa),normal stress (MPa)\n1,600,1\n2,1000,2\n")
    assert points.friction == pytest.approx([0.6, 0.5], rel=1e-15, abs=0.0)
    assert read(tmp_path, "v (m/s),shear,normal\n1,6,10\n2,5,10\n").friction.tolist() == [0.6, 0.5]
    assert read(tmp_path, "v (m/s),mu,tau,sigma\n1,0.4,6,10\n2,0.3,5,10\n").friction.tolist() == [0.4, 0.3]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v (m/s),tau (Pa)\n1,6\n2,5\n", "no column 'friction'; friction is shear stress over normal stress, both in one unit"),
        ("v (m/s),tau,sigma\n1,6,10\n2,5,0\n", "line 3: normal_stress must be above 0, got 0"),
        ("v (m/s),tau,sigma\n1,6,10\n2,-5,10\n", "line 3: shear_stress must not be negative, got -5"),
        ("log10(V),mu\n-3,0.6\n-2,0.5\n", "logarithms are not read: write the numbers themselves, as in a column slip_rate"),
        ("log V,mu\n-3,0.6\n-2,0.5\n", "logarithms are not read"),
        ("mu,lambda V (mm/s)\n0.6,1\n0.5,2\n", "column 2 is not the slip_rate itself, by its heading; if it is, write slip_rate"),
        ("v (m/s),shear stress (MPa)\n1,6\n2,5\n", "friction is shear stress over normal stress"),
    ],
)
def test_mistakes_have_a_cure(tmp_path: Path, text: str, message: str) -> None:
    with refused(message):
        read(tmp_path, text)


BOTH = "u (m),v (m/s),mu\n0,1,0.6\n2,2,0.5\n"


@pytest.mark.parametrize(("along", "wanted"), [("slip", {"slip": [0, 2]}), ("slip_rate", {"rate": [1, 2]})])
def test_along_chooses_the_variable_of_a_table(tmp_path: Path, along: Any, wanted: dict[str, Any]) -> None:
    law = FromTable(friction=[0.6, 0.5], **wanted)
    points = read(tmp_path, BOTH)
    for source in (points, tmp_path / "points.csv", {"u": [0, 2], "v": [1, 2], "mu": [0.6, 0.5]}):
        assert FromTable(source, along=along) == law
    (tmp_path / "s.toml").write_text(SCENARIO.format(more=f'along = "{along}"'))
    assert ss.load_scenario(tmp_path / "s.toml").problem.friction == law


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("", 'the header needs a column slip or slip_rate, got both; choose one with along = "slip"'),
        ('along = "time"', "[friction] along: 'time' is no column to go along; allowed: slip, slip_rate"),
        ("along = 3", "[friction] along: 3 is no column to go along"),
    ],
)
def test_a_table_with_two_variables_needs_along(tmp_path: Path, more: str, message: str) -> None:
    (tmp_path / "points.csv").write_text(BOTH)
    (tmp_path / "s.toml").write_text(SCENARIO.format(more=more))
    with refused(message):
        ss.load_scenario(tmp_path / "s.toml")


@pytest.mark.parametrize(
    ("source", "options", "message"),
    [
        ({"u": [0, 2], "v": [1, 2], "mu": [0.6, 0.5]}, {}, 'choose one with along="slip" or along="slip_rate"'),
        ({"v": [1, 2], "mu": [0.6, 0.5]}, {"along": "slip"}, "the points have no 'slip' to go along"),
        (None, {"rate": [1, 2], "friction": [0.6, 0.5], "along": "slip"}, "along chooses a column of a source"),
        (None, {"rate": [2, 1], "friction": [0.6, 0.5]}, "rate must ascend, but [1] = 1 follows 2; sort the points"),
        (None, {"rate": [1, 1], "friction": [0.6, 0.5]}, "follows 1; keep one point of each, or their mean"),
    ],
)
def test_mistakes_in_python_have_a_cure(source: Any, options: dict[str, Any], message: str) -> None:
    with refused(message):
        FromTable(source, **{name: np.asarray(x) if isinstance(x, list) else x for name, x in options.items()})
