"""What a sensitivity may be asked for, what is refused in one line, and the command with its table and figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.sensitivity.changes import changes_of
from stickslip.extensions.sensitivity.stencil import SIDES, slope_of
from stickslip.figures.style import image
from stickslip.foundation.errors import InputError
from stickslip.problem import default_event_rate
from tests.command_line import Command

pytestmark = pytest.mark.usefixtures("closed_figures")

BLOCK = """
[body]
kind = "spring-block"
mass = 1.0
stiffness = 1000.0
normal_force = 10.0

[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.4

[loading]
pull_rate = "0.1 m/s"

[initial]
load = 0.0

[run]
duration = "0.5 s"
"""


@pytest.fixture
def block(tmp_path: Path) -> Path:
    path = tmp_path / "block.toml"
    path.write_text(BLOCK)
    return path


def test_all_runs_of_a_derivative_keep_the_slip_rate_that_defines_an_event() -> None:
    """The default one goes with mass^-1/2, and would halve the derivative: the creep before a slip, beside plain differences."""
    law = ss.friction.LuGre(static=0.6, dynamic=0.4, rate="10 mm/s", stiffness=1e4, damping=10.0)

    def run(mass: float) -> ss.Solution:
        return ss.simulate(ss.Problem(ss.SpringBlock(mass, 1e3, 10.0), law, pull_rate=0.1, initial_load=0.0), 0.002, 1e-14)

    middle, below, above = run(1.0), run(0.999), run(1.001)
    slope = ss.studies.sensitivity(middle, "mass", "start").derivatives[0, 0]
    rate = default_event_rate(middle.problem)
    kept, own = ((above.catalogue(r).start[0] - below.catalogue(r).start[0]) / 0.002 for r in (rate, None))
    assert slope == pytest.approx(kept, rel=1e-5)
    assert own == pytest.approx(0.5 * slope, rel=0.01)


@pytest.mark.parametrize("side", SIDES)
def test_the_weights_differentiate_polynomials_of_degree_six(side: str) -> None:
    places, step = np.array(SIDES[side]), 0.1
    values = np.array([[(1.0 + step * place) ** power for power in range(8)] for place in places])
    found = slope_of(values, side, step)
    assert found.slope[:7] == pytest.approx(np.arange(7.0), abs=1e-12)
    assert abs(found.slope[7] - 7.0) > 1e-7
    assert np.all(np.abs(found.slope - np.arange(8.0)) <= found.error)


def test_a_kink_in_the_middle_is_no_derivative() -> None:
    found = slope_of(np.abs(np.array(SIDES["both"], float))[:, None], "both", 1.0)
    assert abs(found.slope[0]) < 1e-12
    assert found.error[0] > 0.5


def test_the_difference_of_two_orders_covers_what_the_noise_does_not_see() -> None:
    found = slope_of(np.array(SIDES["both"], float)[:, None] ** 7, "both", 1.0)  # odd: its sixth difference is 0
    assert found.slope[0] == pytest.approx(36.0)
    assert found.noise[0] < 1e-9
    assert found.error[0] > 36.0


def test_a_rest_that_is_not_recorded_is_a_change_of_the_contact() -> None:
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=10e3, normal_stress=1e8)
    run = ss.simulate(ss.Problem(slab, ss.friction.Coulomb(0.6, 0.5), pull_rate=0.1, initial_excess=0.0), 2000.0)
    found = changes_of(run.history)
    assert run.history.rests.any()
    assert found.mode.tolist() == [1.0, 0.0] * (len(found) // 2) + [1.0] * (len(found) % 2)
    assert np.all(np.diff(found.time) >= 0.0)
    assert len(found) > 4


def test_a_number_at_its_limit_is_varied_to_one_side(block: Path) -> None:
    found = ss.studies.sensitivity(block, "damping", at=[0.1, 0.3], duration=0.3)
    beside = [ss.simulate(ss.load_scenario(block).with_values({"damping": c}), 0.3, 1e-13).slip([0.1, 0.3]) for c in (1e-3, 0.0)]
    assert found.derivatives[0] == pytest.approx((beside[0] - beside[1]) / 1e-3, rel=1e-3)
    assert found.notes == ("the derivative with respect to body.damping is that from above: it has no values on the other side",)
    assert "the derivative is" in found.texts[0]


def test_a_time_that_an_event_moves_across_has_no_derivative_of_the_slip_rate() -> None:
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=10e3, normal_stress=1e8)
    problem = ss.Problem(slab, ss.friction.Coulomb(0.6, 0.5), pull_rate=1e-3, initial_load=0.599e8)
    onset = ss.simulate(problem, 600.0, 1e-13, max_events=1).events.start[0]
    times = [0.5 * onset, onset, onset + 1.0]
    found = ss.studies.sensitivity(problem, ["static", "dynamic"], "slip_rate", at=times, duration=times[-1])
    assert found.by("static")[0] == 0.0
    assert np.isnan(found.by("static")[1])
    assert found.by("static")[2] == pytest.approx(0.0, abs=1e-7)  # the drop grows, and slip begins so much later
    assert found.by("dynamic")[1:] == pytest.approx(-1e8 / (2800.0 * 3500.0), rel=1e-9)
    assert "moves across this time" in found.notes[0]


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"to": "stifness"}, "'stifness' is unknown; did you mean 'stiffness'?"),
        ({"to": []}, 'to: give the name of a number, such as "stiffness", or several in a list'),
        ({"to": 3}, "to: give the name of a number"),
        ({"to": ["static", "friction.static"]}, "friction.static is given twice"),
        ({"of": "slop"}, "of: 'slop' is unknown; did you mean 'slip'?"),
        ({"of": "state"}, "state: Coulomb has no state variable"),
        ({"of": "pulses"}, "of: 'pulses' has no derivative, because it counts"),
        ({"of": "load", "event": 0}, "of: 'load' is no number of a slip event"),
        ({"of": "end", "at": 1.0}, "at: 'end' is a number of a slip event, which event= chooses: leave at out"),
        ({"of": "end", "event": 9}, "event: the run of 0.5 s has no slip event 9: it has 3, 0 to 2"),
        ({"of": "end", "event": -1}, "event 2 of the run has no 'end': an event that is not over has none"),
        ({"of": "slip", "event": -1}, "event 2 of the run has no 'slip': an event that is not over has none"),
        ({"of": "recurrence", "event": 0}, "event 0 of the run has no 'recurrence': the first has none"),
        ({"at": "3 s"}, "at: times must lie between 0 s and the end of the run, 0.5 s"),
        ({"at": 0.0}, "at: give a time after the start of the run"),
        ({"rtol": 1e-3}, "rtol must be at most 1e-08"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_one_line(block: Path, asked: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=r"^(sensitivity|state)") as refused:
        ss.studies.sensitivity(block, **asked)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_problem_needs_a_duration_and_a_chain_is_refused(block: Path) -> None:
    with pytest.raises(InputError, match="a problem has no duration: give one"):
        ss.studies.sensitivity(ss.load_scenario(block).problem)
    with pytest.raises(InputError, match=r"carlson-langer has a \[chain\]"):
        ss.studies.sensitivity("carlson-langer")


def test_a_run_is_differentiated_as_its_problem_and_the_table_has_all(block: Path) -> None:
    run = ss.simulate(block)
    found = ss.studies.sensitivity(run, ["static", "stiffness"], "heat", at=["0.2 s", "0.4 s"])
    assert found.numbers == ("friction.static", "body.stiffness")
    assert found.values == pytest.approx(run.energy([0.2, 0.4]).heat.to_numpy(), rel=1e-9)
    assert list(found.table) == ["number", "value", "time", "heat", "derivative", "error", "scaled"]
    assert found.table.scaled.to_numpy() == pytest.approx((found.table.value * found.table.derivative).to_numpy())
    near = [ss.simulate(run.scenario().with_values({"static": s}), rtol=1e-13).energy([0.2, 0.4]).heat for s in (0.6001, 0.5999)]
    assert found.by("static") == pytest.approx((near[0] - near[1]).to_numpy() / 2e-4, rel=1e-5)
    with pytest.raises(InputError, match=r"friction\.dynamic is none of its numbers"):
        found.by("dynamic")


def test_the_command_tells_the_numbers_in_their_order_and_writes_table_and_figure(
    command: Command, block: Path, tmp_path: Path
) -> None:
    table, figure = tmp_path / "a.csv", tmp_path / "a.png"
    given = "--of", "recurrence", "--to", "static,stiffness", "--out", str(table), "--figure", str(figure)
    shown = command("sensitivity", str(block), *given)
    assert shown.code == 0
    first, second = (shown.out.index(one) for one in ("body.stiffness = 1 kN/m: 1 % more makes 1.07227 ms less", "friction.static"))
    assert first < second
    assert pd.read_csv(table, comment="#").event.tolist() == [1, 1]
    assert figure.stat().st_size > 1000
    timed = command("sensitivity", str(block), "--to", "static,mass", "--at", "100 ms,0.2").out
    assert "derivatives in SI" in timed
    assert "0.1 s    0.002382238" in timed
    assert command("sensitivity", str(block), "--at", "soon").refusal.startswith("sensitivity: at must be a number in s")


def test_the_figure_has_a_curve_for_each_number_that_is_not_zero(block: Path) -> None:
    found = ss.studies.sensitivity(block, ["static", "mass", "damping"], "slip_rate", duration=0.2)
    figure = found.plot()
    curves = [line for line in figure.axes[0].lines if len(line.get_xdata()) == len(found.times)]
    assert [line.get_label() for line in curves] == [found.numbers[n] for n in found.order[:2]]
    assert image(figure, "png", 50.0)


def test_a_number_without_effect_makes_no_difference_and_is_not_said_to_have_values_on_one_side() -> None:
    """A play delays all slips alike, by half of it over the pull rate: what lies between them does not depend on it, to 1e-11."""
    played = ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0, backlash=4e-3)
    problem = ss.Problem(played, ss.friction.Coulomb(0.6, 0.4), pull_rate=0.02, initial_load=0.0)
    between = ss.studies.sensitivity(problem, "backlash", "recurrence", event=2, duration=3.0)
    assert between.derivatives[0, 0] == pytest.approx(0.0, abs=1e-11)
    assert between.notes == ()
    assert "1 % more makes no difference (derivative 0 within " in between.texts[0]
    first = ss.studies.sensitivity(problem, "backlash", "start", event=0, duration=1.0)
    assert first.derivatives[0, 0] == pytest.approx(0.5 / 0.02, rel=1e-10)


def test_values_to_one_side_do_not_count_where_smaller_steps_have_both() -> None:
    """Static friction is barely above the dynamic one: the first steps lead below that. The start is S mu / (K V), to 1e-9."""
    law = ss.friction.Coulomb(0.402, 0.4)
    problem = ss.Problem(ss.SpringBlock(1.0, 1e3, 10.0), law, pull_rate=0.1, initial_load=0.0)
    found = ss.studies.sensitivity(problem, "static", "start", event=0, duration=0.06)
    assert found.derivatives[0, 0] == pytest.approx(10.0 / (1e3 * 0.1), rel=1e-9)
    assert found.found[0].side == "both"
    assert found.found[0].step[0] < 0.002 / 3.0
