"""Every script of examples/ is run, and what it computes is compared with closed forms and with the numbers of the paper."""

from __future__ import annotations

import ast
import math
import re
import runpy
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

from tests.core.problem.loading.sliding_by_hand import by_hand

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))
TRIP = 2 * 10e3 / 3500
"""Two-way travel time of the paper's slab (s)."""

Names = dict[str, Any]
CHECKS: dict[str, Callable[[Names], None]] = {}


def check(function: Callable[[Names], None]) -> Callable[[Names], None]:
    CHECKS[function.__name__] = function
    return function


def close(value: Any, expected: Any, rtol: float = 1e-9) -> None:
    np.testing.assert_allclose(value, expected, rtol=rtol, atol=0.0)


@check
def first_event(names: Names) -> None:
    event = names["run"].events.iloc[0]
    close([event.end, event.slip, event.peak_rate], [TRIP, 23.4402332474, 4.10204081633])


@check
def block_and_slab(names: Names) -> None:
    table = names["both"].table
    close(table.slip, [0.273505101, 0.376105283], 2e-9)
    assert table.pulses.tolist() == [1, 3]
    assert table.shocks.tolist() == [0, 2]


@check
def scenario_with_other_numbers(names: Names) -> None:
    """The last driver has 1/4 of the slab's impedance: each round trip changes the load by 0.6 times the wave that left."""
    run = names["run"]
    rates = [float(run.slip_rate((k + 0.5) * TRIP)) for k in range(4)]
    law, slab = run.problem.friction, run.problem.body
    load = run.problem.strength + 1e3
    far = (2 * slab.impedance / (slab.impedance + slab.driver_impedance)) * load
    for rate in rates:
        close(slab.impedance * rate + slab.normal_stress * float(law.coefficient(0.0, rate)), load, 1e-8)
        load = 0.6 * (2 * slab.impedance * rate - load) + far


@check
def is_it_unique(names: Names) -> None:
    ratio = math.sqrt(1.0 / 0.196)
    close(names["contact"].critical_value, 0.196, 1e-12)
    close([names["fold"].rate, names["fold"].load], [ratio - 1, 30e6 + 9.8e6 * (2 * ratio - 1)])


@check
def four_selection_rules(names: Names) -> None:
    assert list(names["waits"]) == ["perfect-delay", "minimal", "maxwell", "maximal"]
    close(list(names["waits"].values()), [468.80466, 468.80466, 394.25768, 378.2617], 1e-6)


@check
def own_selection_rule(names: Names) -> None:
    """The rule jumps where the load is halfway between the folds, both ways: by Z times the change of the rate."""
    shocks, middle = names["run"].shocks, 0.5 * (80e6 + 64471887.2424)
    close(names["run"].load(shocks.time), [middle, middle])


@check
def own_friction_law(names: Names) -> None:
    u, v = 2e-6, 0.1
    close(names["law"].coefficient(u, v), 0.6 + 0.2 * math.exp(-u / 9e-6) + 0.5 * v, 1e-14)
    run = names["run"]
    residual = run.load(2e-4) - run.traction(2e-4) - run.problem.body.impedance * run.slip_rate(2e-4)
    assert abs(residual) < 1e-9 * run.problem.strength


@check
def measured_friction(names: Names) -> None:
    assert abs(names["peaks"]["true law"] - 4.10204081633) < 1e-8
    for name in ("fitted", "smoothed"):
        assert abs(names["peaks"][name] - 4.102) < 0.15, name


@check
def pulses_and_echoes(names: Names) -> None:
    starts = names["pulses"].start
    close(starts.iloc[2] - starts.iloc[1], names["period"], 1e-4)
    close(names["pulses"].slip.iloc[1], 2 * math.pi / 50, 1e-3)


@check
def figure_for_teaching(names: Names) -> None:
    for (time, place), (rate, stress) in zip(names["places"].values(), ((0, 80e6), (30e6 / 9.8e6, 50e6), (0, 20e6)), strict=True):
        at = names["run"].field(place, time)
        assert abs(at.velocity - rate) < 1e-8
        assert abs(at.stress - stress) < 10.0


@check
def energy_of_an_event(names: Names) -> None:
    assert abs(names["event"].balance) < 1e-9 * names["event"].heat
    close(names["run"].pulses().fracture.iloc[1], 100e6 * 0.5 * math.pi / 50, 1e-6)


@check
def earthquake_cycles(names: Names) -> None:
    assert len(names["table"]) == 214
    close(names["gaps"], names["wait"], 1e-6)  # the threshold of an event leaves out the slowest slip


@check
def velocity_steps(names: Names) -> None:
    close(names["measured"], 0.003 * math.log(10), 2e-3)


@check
def tides(names: Names) -> None:
    assert len(names["hours"]) == 7
    assert names["hours"].between(0.3, 1.6).all()


@check
def triggered_by_a_wave(names: Names) -> None:
    close(names["run"].events.duration, [1.0, 1.0], 1e-9)
    assert names["run"].events.slip.round(4).tolist() == [0.0754, 0.0705]


@check
def map_of_pulses(names: Names) -> None:
    assert (int(names["found"].pulses.min()), int(names["found"].pulses.max())) == (2, 12)
    assert ((names["product"] > 9.8e6 / (0.8 - 0.3)) == (names["regimes"].irregular == 1)).all()


@check
def sweep_on_a_cluster(names: Names) -> None:
    assert (names["found"].slip == names["here"].slip).all()
    assert ((names["found"].events == 1) == (names["found"]["friction.alpha"] > 0.196)).all()


@check
def seismograms(names: Names) -> None:
    """What passes a station is what the contact did x/c earlier, and the steady shear of the start, V x/h."""
    run, times = names["run"], np.array([0.5, 1.0, 1.5])
    for place in names["stations"][:2]:
        shear = run.problem.pull_rate * place / 10e3
        close(run.field(place, times + place / 3500).velocity, run.slip_rate(times) + shear, 1e-10)


@check
def bowed_string(names: Names) -> None:
    close(names["starts"].mean(), 1 / 146.8, 1e-3)


@check
def kolsky_bar(names: Names) -> None:
    close(names["event"].peak_rate, (68e6 - 25e6) / 8.7e6, 1e-4)


@check
def reversing_axis(names: Names) -> None:
    """The run, and the work of friction in a cycle, are those of an integrator that knows the equations only (1e-7)."""
    from scipy.integrate import solve_ivp

    def motion(t: float, y: Any) -> list[float]:
        u, v, z, _ = y
        pulled = 0.01 * 0.2 / (2 * math.pi) * (1 - math.cos(2 * math.pi * t / 0.2))
        rest = 0.10 + 0.05 * math.exp(-((v / 1e-3) ** 2))
        bent = v - abs(v) * 1e4 * z / rest
        force = 100.0 * (1e4 * z + 3.0 * bent + 0.04 * v)
        return [v, (2e5 * (pulled - u) - force) / 10.0, bent, force * v]

    found = solve_ivp(motion, (0.0, 0.4), [0.0] * 4, method="Radau", rtol=1e-10, atol=1e-14, t_eval=[0.2, 0.3, 0.4])
    close(names["run"].slip([0.3]), found.y[0, 1:2], 1e-7)
    close(names["work"], found.y[3, 2] - found.y[3, 0], 1e-6)  # a sum over 20001 places


@check
def fit_velocity_steps(names: Names) -> None:
    """The numbers with which the record was made are within 4 standard uncertainties, and the memory of its noise is 2 s."""
    table = names["found"].table
    truth = np.array([0.008, 0.0125, 15e-6, 60e6, 0.62])
    assert (np.abs(table.value - truth) < 4.0 * table.uncertainty).all()
    close(names["found"].model.memory["friction"].time, 1.95, 0.35)


@check
def fit_slide_hold_slide(names: Names) -> None:
    """The ageing law, which made the record, predicts the third hold to the noise; the slip law does not."""
    ageing, slip = names["tried"]
    close(ageing.prediction, 1.0, 0.15)
    assert slip.prediction > 2.0


@check
def fit_stick_slip(names: Names) -> None:
    """Both frictions, stiffness and mass of the record come out."""
    values = names["found"].values
    close([values["friction.static"], values["friction.dynamic"], values["body.stiffness"]], [0.65, 0.5, 4e6], 2e-3)
    close(values["body.mass"], 2.0, 0.03)


@check
def fit_rocks(names: Names) -> None:
    """Basalt is neutral to the rate and sepiolite strengthens, as published; a and b of basalt go together."""
    basalt, sepiolite = (names["found"][rock] for rock in ("basalt", "sepiolite"))
    assert abs(basalt.values["friction.a"] - basalt.values["friction.b"]) < 1e-3
    assert basalt.certainty.correlation[0, 1] > 0.9
    close(sepiolite.values["friction.a"] - sepiolite.values["friction.b"], 0.006, 0.2)
    close(sepiolite.values["friction.distance"], 170e-6, 0.2)


@check
def trust_a_scheme(names: Names) -> None:
    """Characteristics follow the minimal rule; backward Euler stops where its effective impedance says, on every mesh."""
    table = names["study"].table
    assert table.rule[table.scheme == "characteristics"].tolist() == ["minimal"] * 3
    assert table.rule[table.scheme == "backward-euler"].tolist() == ["none"] * 3
    run = names["study"].own
    time = np.linspace(2.5, 5.2, 20_001)
    inertia = (math.sqrt(1.0 + 1.0 / 3.0) - 1.0) * 9.8e6  # Courant number 1/2
    expected = time[run.load(time) + inertia * run.slip_rate(time) < 80e6][0]
    late = table.arrest[table.scheme == "backward-euler"].to_numpy(float) - expected
    assert (np.abs(late) < 2.0 * table.step[table.scheme == "backward-euler"]).all()


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    mpl.use("agg")
    yield
    pyplot.close("all")


@check
def own_scheme(names: Names) -> None:
    """The upwind scheme is of first order, and its formula of what it dissipates closes the balance to rounding."""
    close(names["order"].slip_order.iloc[1:], [1.0, 1.0], 0.02)
    assert (names["order"].energy_drift.abs() < 1e-13).all()
    assert names["rules"] == {"stick-first": "minimal", "continue": "perfect-delay"}


@check
def judge_another_code(names: Names) -> None:
    """The file is what the other program writes; the folds give the exact times, 4.102 m/s the exact jump of the first."""
    other = runpy.run_path(str(names["file"].with_suffix(".py")))["run"]()[::4]
    np.testing.assert_allclose(np.loadtxt(names["file"], delimiter=",", skiprows=1), other, rtol=1e-6, atol=1e-6)
    shocks = names["study"].shocks
    close(shocks.exact_time, [2.242655, 5.212841], 1e-6)
    close(shocks.exact_after.iloc[0], 4.10204081633)
    assert abs(shocks.delay.iloc[0]) < names["study"].table.step.iloc[0]
    assert -1.0 < shocks.delay.iloc[1] < -0.8
    assert names["study"].verdicts == {"staggered_grid": "none"}


@check
def fault_in_2d(names: Names) -> None:
    """A front that is fed more than it consumes runs at the wave speed; the ends are the last to rest."""
    run = names["run"]
    assert abs(np.median(run.rupture_speed[names["outside"]]) / run.slab.body.wave_speed - 1.0) < 0.02
    assert not run.slip_rate[-1].any()
    assert run.slip[:, np.abs(run.slab.y) > 18e3].max() == 0.0


@check
def sliding_block(names: Names) -> None:
    """The rigid block slips as cubics between the points of its record say."""
    problem, table = names["runs"]["rigid"].problem, names["table"]
    strength, mass = problem.strength, problem.body.mass
    slip = by_hand(problem.ground_acceleration, problem.load, 8.0, one_way=True, mass=mass, limits=(strength, strength))
    close(table.loc["permanent displacement (m)", "rigid"], slip, 3e-5)  # the spring takes 1e-5 of it
    close(table.loc["yield acceleration (g)"], (strength - problem.load) / mass / 9.80665)
    assert table.loc["permanent displacement (m)", "deformable"] > 2.0 * slip


@check
def drill_string(names: Names) -> None:
    """Turning goes on where torque no longer falls with the rate; runs below the edge stick, and runs above it do not."""
    law = names["problem"].friction
    fall = (law.static - law.dynamic) / law.rate
    close(names["turning"], law.rate * math.log(fall / law.viscosity), 1e-8)
    apart = names["speeds"] / np.array(names["edges"])[:, None]
    assert names["severities"][apart < 0.97].min() > 1.0
    assert names["severities"][apart > 1.03].max() < 0.4
    assert (np.diff(names["edges"]) < 0.0).all()


@check
def low_velocity_zone(names: Names) -> None:
    """Beside the uniform slab, the soft layer whose two slips Goupillaud's recursion gave outside the package."""
    close([names["total"][0, -1], names["total"][3, 2]], [23.4402332474, 26.479553652])
    assert (names["slips"][0, -1], names["slips"][3, 2]) == (1, 2)


def name_of(path: Path) -> str:
    return path.stem.partition("_")[2]


@check
def schelleng(names: Names) -> None:
    """The bow slips once in each period below Schelleng's largest force, and loses that above 1.2 times this force."""
    share, forces, largest = (np.asarray(names[name]) for name in ("share", "forces", "largest"))
    assert share.shape == (13, 7)
    above = forces[:, None] > 1.2 * largest
    assert share[above].max() < 0.1
    best = forces[share.argmax(axis=0)]
    assert share.max(axis=0).min() > 0.8
    assert ((best > 0.4 * largest) & (best < 1.05 * largest)).all()
    assert (best > 2.0 * np.asarray(names["smallest"])).all()


@check
def two_plates(names: Names) -> None:
    """With equal travel times events slip at the stress drop over Z for one round trip; elsewhere they are many and small."""
    impedance = 1.0 / (1.0 / (7850.0 * 3200.0) + 1.0 / (2650.0 * 3000.0))
    at = dict(zip(names["thicknesses"].tolist(), names["slips"], strict=True))
    close(at[45], 0.1 * 5e6 / impedance * 0.096 / 3200.0 * 1e6, 0.02)
    assert np.median(at[135]) > np.median(at[90]) > np.median(at[45])
    for ratio, near in ((45, (39, 42, 48, 51)), (90, (84, 87, 93, 96)), (135, (129, 132, 138, 141))):
        assert all(len(at[one]) > 2 * len(at[ratio]) and np.median(at[one]) < 0.5 * np.median(at[ratio]) for one in near)


QUICK = {
    "scenario_with_other_numbers", "is_it_unique", "four_selection_rules", "own_selection_rule", "figure_for_teaching", "tides",
    "seismograms",
}  # fmt: skip
"""Examples that take about a second each or less; the others, up to a minute long, are run with the slow tests."""


@pytest.mark.parametrize(
    "path", [path if name_of(path) in QUICK else pytest.param(path, marks=pytest.mark.slow) for path in EXAMPLES], ids=name_of
)
def test_example_computes_what_its_check_says_and_draws_a_figure(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names, figures = run_by_blocks(path)
    assert figures, "an example has a picture in the gallery"
    assert not any(figure.stale for figure in figures), "the gallery takes a figure at the end of the block that makes it"
    assert list(Path().iterdir()) == [], "an example leaves no files"
    assert capsys.readouterr().out, "an example says something"
    CHECKS[name_of(path)](names)


def run_by_blocks(path: Path) -> tuple[Names, list[Figure]]:
    """Run the blocks between lines `# %%` as the gallery does, which tells a script its path by `sys.argv` alone.

    At the end of each block the gallery draws the figures, and closes them.
    """
    names: Names = {"__name__": "__main__"}
    figures = []
    with warnings.catch_warnings(), patch.object(sys, "argv", [str(path)]):
        warnings.simplefilter("error")
        for block in path.read_text(encoding="utf-8").split("\n# %%\n"):
            exec(compile(block, path.name, "exec"), names)
            for number in pyplot.get_fignums():
                figures.append(pyplot.figure(number))
                figures[-1].canvas.draw()
            pyplot.close("all")
    return names, figures


def test_no_example_needs_a_name_that_the_gallery_does_not_define() -> None:
    names = {
        path.name: {node.id for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Name)}
        for path in EXAMPLES
    }
    assert {
        name: own for name, used in names.items() if (own := {one for one in used if one.startswith("__")} - {"__name__"})
    } == {}


def test_every_check_belongs_to_an_example() -> None:
    assert list(CHECKS) == [name_of(path) for path in EXAMPLES]


@pytest.mark.parametrize("path", EXAMPLES, ids=name_of)
def test_example_begins_with_a_title_and_what_one_learns(path: Path) -> None:
    title, line, blank, *rest = re.match(r'"""\n(.*?)"""', path.read_text(encoding="utf-8"), re.DOTALL)[1].splitlines()
    assert set(line) == {"="}
    assert len(line) == len(title)
    assert blank == ""
    assert any(one.startswith("You learn ") for one in rest)
