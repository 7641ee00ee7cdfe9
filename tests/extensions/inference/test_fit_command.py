"""`stickslip fit`: what it prints, the scenarios that it writes, and its mistakes in one line."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.cli.options import complete_table
from stickslip.extensions.inference.commands.fit import complete_fitted
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import load_scenario
from stickslip.problem.scenarios.templates import with_law
from tests.problems import RATE_LAW, measured


@pytest.fixture
def points(command, tmp_path: Path) -> Path:
    """A file of 300 noisy points under the headings of a laboratory."""
    drawn = measured(RATE_LAW, None, np.linspace(0.0, 10.0, 300), 0.01)
    rows = "".join(f"{v:.6f};{mu:.5f};rig 2\n" for v, mu in zip(1e3 * drawn.places, drawn.friction, strict=True))
    path = tmp_path / "data.csv"
    path.write_text("# run 7\nv (mm/s);mu;note\n" + rows)
    return path


def test_laws_are_compared_and_the_best_comes_first(command, points):
    shown = command("fit", "data.csv")
    assert shown.code == 0
    assert shown.err == ""
    listed = re.findall(r"^([a-z-]+) +\d +0\.\d+ +([\d.]+)", shown.out, re.MULTILINE)
    assert next(name for name, _ in listed) == "hyperbolic-rate"
    assert "coulomb" in dict(listed)
    assert "linear-slip-weakening" not in dict(listed)
    assert [float(above) for _, above in listed] == sorted(float(above) for _, above in listed)
    assert "(and 0 more)" not in " ".join(shown.out.split())


def test_parameters_are_shown_with_uncertainty_and_unit(command, points):
    shown = command("fit", "data.csv", "--law", "hyperbolic-rate")
    assert re.search(r"^alpha +\d\.\d+ ± 0\.0\d+ +s/m", shown.out, re.MULTILINE)
    assert re.search(r"^residual +0\.01", shown.out, re.MULTILINE)
    held = command("fit", "data.csv", "--law", "hyperbolic-rate", "--fix", "alpha=1 s/m", "--start", "static=0.5")
    assert re.search(r"^alpha +1 +s/m \(fixed\)", held.out, re.MULTILINE)


def test_a_row_of_units_and_decimal_commas_are_repeated(command):
    Path("rig.csv").write_text("v;mu\nmm/s;-\n0,1;0,7\n0,5;0,65\n1;0,6\n")
    shown = command("fit", "rig.csv", "--law", "coulomb")
    assert "Slip_rate (column 1) is in mm/s, as the row of units in line 2 says.\nDecimal commas are read as points." in shown.out


def test_the_block_of_a_fit_takes_the_numbers_of_a_machine(command, points):
    machine = [f"--set={one}" for one in ("normal_force=50 kN", "mass=20 kg", "stiffness=1 MN/m", "pull_rate=1 mm/s")]
    fitting = ["fit", "data.csv", "--law", "hyperbolic-rate", "--body", "block", *machine]
    assert command(*fitting, "--out", "mine.toml").code == 0
    body, rate = load_scenario("mine.toml").problem.body, load_scenario("mine.toml").problem.pull_rate
    assert (body.normal_force, body.mass, body.stiffness, rate) == (5e4, 20.0, 1e6, 1e-3)
    for given, said in (
        (["--out=b.toml", "--set=friction.static=0.5"], "block: friction.static belongs to the law, which comes from the points"),
        (["--out=b.toml", "--set=stifness=1"], "'stifness' is not a parameter of this scenario; did you mean 'stiffness'?"),
        (["--out=b.toml", "--set=pressing=1"], "block: pressing and body.normal_force exclude each other"),
        ([], "fit: --set belongs to --out"),
    ):
        shown = command(*fitting, *given)
        assert (shown.code, said in shown.err, Path("b.toml").exists()) == (2, True, False), shown.err


@pytest.mark.parametrize("name", library.STARTERS)
def test_a_starter_lends_a_fit_no_title_and_no_duration_of_its_example(name):
    example = load_scenario(library.STARTERS[name].example)
    made = load_scenario_text(with_law(name, RATE_LAW, ["data.csv"]))
    assert made.title == f"{library.STARTERS[name].meaning.capitalize()}, under a law of the kind hyperbolic-rate"
    if not made.problem.body.is_driven_rigidly:  # as the drive of a string gives way, its contact is loaded by what it lags behind
        assert made.duration == example.duration
        return
    trips = made.duration / made.problem.body.round_trip_time
    assert trips >= 18.0
    assert trips <= 105.0 or not made.problem.body.has_waves


def test_a_fit_for_a_machine_lasts_some_loads_of_its_contact():
    """Static friction over the rate at which the pull loads the spring, by hand: 0.4 x 50 kN / (1 MN/m x 1 mm/s) = 20 s."""
    values = {"normal_force": "50 kN", "mass": "20 kg", "stiffness": "1 MN/m", "pull_rate": "1 mm/s"}
    law = ss.friction.HyperbolicRate(static=0.4, dynamic=0.2, alpha=1.0)
    made = load_scenario_text(with_law("block", law, ["data.csv"], values))
    assert (made.title, made.duration) == ("A block on a spring, under a law of the kind hyperbolic-rate", 60.0)
    assert len(ss.simulate(made).events) >= 2
    assert load_scenario_text(with_law("block", law, ["data.csv"], values | {"duration": "7 s"})).duration == 7.0


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("how", [["--law", "hyperbolic-rate"], ["--smooth", "auto"], ["--smooth", "1e-4", "--monotone"], []])
def test_the_scenario_is_checked_and_run_as_it_is(command, points, how):
    shown = command("fit", "data.csv", *how, "--out", "mine.toml", "--figure", "fit.png")
    assert shown.code == 0
    assert "written: mine.toml" in shown.out
    assert Path("fit.png").stat().st_size > 5000
    joined, folds = map(int, re.search(r"(\d+) with the points joined exactly, (\d+) with this law", shown.out).groups())
    assert joined > 50
    assert folds in (1, 2, 3)
    checked = command("check", "mine.toml")
    assert checked.code == 0
    assert "noisy" not in checked.out
    assert command("run", "mine.toml").code == 0
    assert Path("mine.toml").read_text().startswith("# data.csv: ")


@pytest.mark.parametrize("name", [*library.STARTERS, *library.in_1d()])
def test_every_body_takes_the_law_and_keeps_all_else(name):
    scenario = load_scenario_text(with_law(name, RATE_LAW, ["a\x1b title", "more"]))
    assert scenario.problem.friction == RATE_LAW
    assert scenario.title.endswith(", under a law of the kind hyperbolic-rate")
    if name in library.names():
        former = load_scenario(name)
        assert scenario.title.startswith(former.title), "the title of the run, not of the file of the law"
        assert scenario.problem.body == former.problem.body
        assert (scenario.duration, scenario.max_events, scenario.rtol) == (former.duration, former.max_events, former.rtol)
        assert scenario.problem.rule == former.problem.rule
        assert scenario.problem.pull_rate == former.problem.pull_rate


def load_scenario_text(text):
    from stickslip.problem.scenarios.scenario import read_scenario

    return read_scenario(text, "mine.toml")


@pytest.mark.slow
def test_noisy_points_are_announced_in_one_line_by_run_and_once_by_check(command, points):
    text = with_law("slab", RATE_LAW, ["x"])
    start, end = text.index("[friction]"), text.index("# The motion")
    Path("noisy.toml").write_text(f'{text[:start]}[friction]\nkind = "table"\nfile = "data.csv"\n{text[end:]}')
    run = command("run", "noisy.toml", "--duration", "1 s")
    assert run.code == 0
    (line,) = run.err.splitlines()
    assert line.startswith(
        "stickslip: note: FromTable: the points look noisy (about 0.01 in friction): interpolated exactly, friction turns"
    )
    checked = command("check", "noisy.toml")
    assert checked.err == ""
    assert len(re.findall("look noisy", checked.out)) == 1
    assert re.search(r"they make \d{2,3} folds", checked.out)


def test_names_are_completed(points):
    assert "hyperbolic-rate" in complete_fitted("hyper")
    assert not {"table", "rate-and-state", "sum", "expression"} & set(complete_fitted(""))
    assert complete_table("dat") == ["data.csv"]


CASES = [
    (["fit"], "fit: DATA is missing; `stickslip fit --help` explains it"),
    (["fit", "no.csv"], "no.csv: no such file"),
    (["fit", "data.csv", "--law", "hyperbolic"], "fit: law 'hyperbolic' is unknown; did you mean 'hyperbolic-rate'?"),
    (["fit", "data.csv", "--law", "linear-slip-weakening"], "fit: linear-slip-weakening depends on slip, but the points"),
    (["fit", "data.csv", "--law", "coulomb", "--smooth", "auto"], "fit: --law and --smooth exclude each other"),
    (["fit", "data.csv", "--monotone"], "fit: --monotone belongs to --smooth"),
    (["fit", "data.csv", "--smooth", "auto", "--along", "slip"], "data.csv: the points have no 'slip'"),
    (["fit", "data.csv", "--fix", "alpha=1"], "fit: --fix belongs to --law"),
    (["fit", "data.csv", "--law", "coulomb", "--fix", "static"], "fit: --fix must be NAME=VALUE, as static=0.6, got 'static'"),
    (["fit", "data.csv", "--smooth", "much"], "fit: --smooth must be auto or a number such as 1e-5, got 'much'"),
    (["fit", "data.csv", "--out", "mine.csv"], "--out mine.csv: the name must end in .toml"),
    (["fit", "data.csv", "--out", "mine.toml", "--body", "slap"], "no scenario 'slap'; did you mean 'slab'?"),
    (["fit", "data.csv", "--out", "mine.toml", "--body", "planar-patch"], "planar-patch has a [contact] of many nodes"),
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_mistakes_are_one_line_and_nothing_is_written(command, points, arguments, message):
    before = set(Path().iterdir())
    assert message in command(*arguments).refusal
    assert set(Path().iterdir()) == before
