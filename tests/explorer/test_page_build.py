"""The page and its centre: parts in their places, entries that go to the setting, and faults that leave the picture alone."""

from __future__ import annotations

import panel as pn
import pytest

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.model.solve import solve
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.page import Panels, build, build_for_notebook
from stickslip.explorer.page.panels import view_of
from stickslip.explorer.page.view import view_bytes
from stickslip.explorer.page.words import Words
from tests.explorer.desk_at_once import DeskAtOnce


@pytest.fixture
def explorer() -> Explorer:
    setting = Setting.bundled("fig5-slab-reconstructed")
    made = Explorer(setting, DeskAtOnce(), solve)
    made.change(setting)
    return made


def test_the_page_has_all_its_parts(explorer: Explorer) -> None:
    document = build(explorer)._init_doc()
    roots = {root.name for root in document.roots} | {root.tags[0] for root in document.roots if root.tags}
    assert {"law", "contact", "shape", "slip", "rate", "traction", "field", "energy", "player", "words", "controls"} <= roots


def test_a_new_answer_is_shown_in_place(explorer: Explorer) -> None:
    panels = Panels(explorer)
    plots, before = dict(panels.plots), panels.player.shown
    explorer.change(explorer.setting.with_value("friction.amplitude", 0.4))
    assert panels.plots == plots
    assert panels.player.shown != before
    assert panels.player.shown == view_bytes(view_of(explorer.answer), panels.headings)


def test_a_fault_leaves_the_last_picture(explorer: Explorer) -> None:
    panels, words = Panels(explorer), Words(explorer)
    before = panels.player.shown
    explorer.change(explorer.setting.with_value("friction.amplitude", "much"))
    assert panels.player.shown == before
    assert "amplitude" in words.view.texts["fault"]
    explorer.change(explorer.setting.with_value("friction.amplitude", 0.4))
    assert words.view.texts["fault"] == ""


def test_a_run_can_be_stopped_from_the_page(explorer: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    stopped: list[bool] = []
    monkeypatch.setattr(explorer, "stop", lambda: stopped.append(True))
    view = Words(explorer).view
    view._handle_msg("nonsense")
    view._handle_msg("stop")
    assert stopped == [True]


def test_the_cursor_of_the_browser_is_told(explorer: Explorer) -> None:
    panels, heard = Panels(explorer), []
    explorer.listen("cursor", lambda: heard.append(explorer.cursor))
    panels.player._handle_msg({"cursor": 2.5})
    panels.player._handle_msg({"cursor": "soon"})
    panels.player._handle_msg("nonsense")
    assert heard == [2.5]


def test_a_move_of_the_browser_is_not_sent_back(explorer: Explorer) -> None:
    panels = Panels(explorer)
    panels.player._handle_msg({"cursor": 2.5})
    assert panels.player.cursor["seconds"] == 0.0
    for seconds in (4.0, 4.0):
        before = dict(panels.player.cursor)
        explorer.cursor = seconds
        explorer.tell("cursor")
        assert panels.player.cursor["seconds"] == seconds
        assert panels.player.cursor != before


def test_a_cell_of_a_notebook_hides_what_has_nothing_to_show(explorer: Explorer) -> None:
    cell = build_for_notebook(explorer)
    cell.explorer = explorer
    cards = {card[1].object.name: card for card in cell.select(pn.Column) if len(card) == 2 and isinstance(card[1], pn.pane.Bokeh)}
    assert len(cards) == 12  # eight panels, and four of the strip
    assert cards["plot:field"].visible
    explorer.change(Setting.bundled("fig6-block-reconstructed"))
    assert not cards["plot:field"].visible
    assert cards["plot:slip"].visible
