"""The centre of a page: what is asked for and shown, also beside an answer, and a laboratory record behind the runs."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.strip import strip_range
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.inference.beside import RecordBeside
from stickslip.extensions.inference.record.record import Record
from stickslip.problem.scenarios.scenario import Scenario
from tests.extensions.explorer.desk_at_once import DeskAtOnce
from tests.extensions.inference.laboratory import RateAndStateBlock, load_point
from tests.problems import Floats

SLAB = Setting.bundled("fig6-slab")


class HeldDesk(DeskAtOnce):
    """A desk that keeps what it is asked, until it is told to do it."""

    def __init__(self) -> None:
        super().__init__()
        self.tasks: list[tuple[Callable[..., Any], Callable[[Any], None], Callable[[Exception], None]]] = []

    def ask(self, work: Callable[..., Any], done: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
        self.tasks.append((work, done, failed))

    def do_next(self) -> None:
        super().ask(*self.tasks.pop(0))


@pytest.fixture
def desk() -> HeldDesk:
    return HeldDesk()


@pytest.fixture
def explorer(desk: HeldDesk) -> Explorer:
    return Explorer(SLAB, desk, lambda scenario, told: f"answer to {scenario.problem.parameters['alpha'].value:g}")


def test_what_is_worked_out_beside_an_answer_never_takes_the_place_of_a_newer_setting(explorer: Explorer, desk: HeldDesk) -> None:
    found: list[str] = []
    explorer.listen("answer", lambda: explorer.beside(lambda told: f"strip of the {explorer.answer}", found.append))
    explorer.change(SLAB.with_value("friction.alpha", 2.0))
    explorer.change(SLAB.with_value("friction.alpha", 3.0))
    desk.do_next()
    assert len(desk.tasks) == 1  # the newer setting; no strip of the older one
    desk.do_next()
    desk.do_next()
    assert found == ["strip of the answer to 3"]
    assert desk.tasks == []


def test_a_step_of_the_tour_brings_its_strip_at_once_and_its_cursor_with_the_answer(explorer: Explorer, desk: HeldDesk) -> None:
    told: list[str] = []
    for news in ("tour", "strip", "setting", "answer", "cursor"):
        explorer.listen(news, lambda news=news: told.append(news))  # type: ignore[arg-type, misc]
    strip = strip_range("friction.alpha", 0.1, 2.0)
    explorer.show_step(3, SLAB.with_value("friction.alpha", 2.0), strip, 4.5)
    assert (explorer.tour, explorer.strip, explorer.cursor) == (3, strip, 0.0)
    desk.do_next()
    assert explorer.cursor == 4.5
    assert told == ["tour", "setting", "strip", "answer", "cursor"]
    explorer.show_step(0, None, None, 0.0)
    assert (explorer.tour, explorer.strip, desk.tasks) == (0, strip, [])


TIMES, RATES = [0.0, 20.0], [1e-6, 1e-5]
CLOCK = np.linspace(0.0, 60.0, 601)
TRUE = RateAndStateBlock()
SCENARIO = Setting.of(
    Scenario(
        ss.Problem(
            ss.SpringBlock(TRUE.mass, TRUE.stiffness, TRUE.normal),
            ss.friction.RateAndState(TRUE.reference, TRUE.a, TRUE.b, TRUE.distance),
            pull_rate=ss.loading.Steps(TIMES, RATES),
        ),
        60.0,
        name="steps",
    )
)


@cache
def clean() -> Floats:
    """Return friction at the samples of the record, without noise."""
    return TRUE.friction(CLOCK, TIMES, RATES)


def behind(**measured: Any) -> RecordBeside:
    return RecordBeside.of(Record.read({"time (s)": CLOCK + 7.0, **measured}), "contact", SCENARIO.scenario().problem, "explore")


def test_the_misfit_is_the_distance_from_what_another_integrator_made() -> None:
    slip = load_point(CLOCK, TIMES, RATES) - TRUE.normal * (clean() - clean()[0]) / TRUE.stiffness
    record = behind(**{"mu": clean() + 3e-4 * np.where(np.arange(601) % 2, 1.0, -1.0), "slip (m)": slip + 5e-4})
    answer = solve(SCENARIO.scenario(), behind=record)
    assert answer.measured is not None
    (friction, moved) = answer.measured.misfits
    assert friction.value == pytest.approx(3e-4, rel=1e-4)
    assert moved.value < 1e-10  # a sensor of slip has a zero of its own
    drawn_slip = answer.measured.curves["slip"]  # without that zero
    assert drawn_slip == pytest.approx(answer.solution.slip(CLOCK), rel=0.0, abs=1e-9)
    assert answer.numbers[-2:] == (friction, moved)
    assert "It differs from record by friction 0.0003, slip" in answer.sentence
    view = view_of(answer)
    assert [key.text for key in view.keys["traction"]][1] == "measured, misfit 0.0003"
    assert view.titles["traction"] == view_of(solve(SCENARIO.scenario())).titles["traction"]
    assert len(view.columns["measured"]["time"]) == 601
    low, high = view.limits["traction"]
    drawn = view.columns["measured"]["traction"]
    assert low <= drawn.min() < drawn.max() <= high
    away = answer.measured.residuals["traction"] / TRUE.normal  # measured minus run: the noise that was added
    assert np.abs(away - 3e-4 * np.where(np.arange(601) % 2, 1.0, -1.0)).max() < 1e-6
    assert view.titles["residual"].startswith("Measured minus run: traction")
    assert "residual" not in view.hidden


def test_a_run_without_a_record_has_no_samples_and_says_nothing_of_it() -> None:
    assert "residual" in view_of(solve(SCENARIO.scenario())).hidden
    answer = solve(SCENARIO.scenario())
    assert answer.measured is None
    assert "differs from" not in answer.sentence
    assert view_of(answer).columns["measured"]["time"] == []


def test_what_cannot_be_drawn_is_refused() -> None:
    with pytest.raises(
        ss.InputError, match="nothing to draw behind a spring-block; allowed: friction, shear_force, slip and slip_rate"
    ):
        behind(**{"tau (Pa)": 1e6 * clean()})
    with pytest.raises(ss.InputError, match="did you mean 'spring'"):
        RecordBeside.of(Record.read({"time (s)": CLOCK, "mu": clean()}), "sprnig", SCENARIO.scenario().problem, "explore")
