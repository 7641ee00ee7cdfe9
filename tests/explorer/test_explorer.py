"""The centre of a page: what is asked for, what is shown, and what is worked out beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.model.strip import StripRange
from stickslip.explorer.page.explorer import Explorer
from stickslip.foundation.errors import InputError

SLAB = Setting.bundled("fig6-slab")


class HeldDesk:
    """A desk that keeps what it is asked, until it is told to do it."""

    def __init__(self) -> None:
        self.tasks: list[tuple[Callable[..., Any], Callable[[Any], None], Callable[[Exception], None]]] = []

    def ask(self, work: Callable[..., Any], done: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
        self.tasks.append((work, done, failed))

    def stop(self) -> None:
        pass

    def do_next(self) -> None:
        work, done, failed = self.tasks.pop(0)
        try:
            result = work(lambda text: None)
        except InputError as error:
            failed(error)
        else:
            done(result)


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
    strip = StripRange("friction.alpha", 0.1, 2.0)
    explorer.show_step(3, SLAB.with_value("friction.alpha", 2.0), strip, 4.5)
    assert (explorer.tour, explorer.strip, explorer.cursor) == (3, strip, 0.0)
    desk.do_next()
    assert explorer.cursor == 4.5
    assert told == ["tour", "setting", "strip", "answer", "cursor"]
    explorer.show_step(0, None, None, 0.0)
    assert (explorer.tour, explorer.strip, desk.tasks) == (0, strip, [])


def test_a_setting_that_cannot_be_read_leaves_the_last_one(explorer: Explorer, desk: HeldDesk) -> None:
    explorer.change(SLAB.with_value("friction.alpha", -1.0))
    assert explorer.fault == "fig6-slab: [friction] alpha must be at least 0 s/m, got -1"
    assert (explorer.setting, desk.tasks) == (SLAB, [])
