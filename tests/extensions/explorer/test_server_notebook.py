"""The explorer in a notebook, and what the command says before it serves."""

from __future__ import annotations

import asyncio
import importlib.util
import threading
from collections import deque
from types import SimpleNamespace
from typing import Any

import pytest

import stickslip as ss
from stickslip.extensions.explorer.page.components import Markup
from stickslip.extensions.explorer.server import start
from stickslip.foundation.errors import InputError


async def answered(page: Any, regime: str) -> str:
    """Wait, as a kernel does between two cells, until the answer of a regime is shown; return its sentence."""
    for _ in range(1000):
        if page.explorer.answer is not None and page.explorer.answer.regime == regime:
            return str(page.explorer.answer.sentence)
        await asyncio.sleep(0.01)
    raise AssertionError(page.explorer.fault or "it was never answered")


def test_a_problem_is_shown_in_a_notebook_and_answers() -> None:
    async def cells() -> None:
        page = ss.explore(ss.scenarios["fig6-slab"].problem, "12 s")
        assert "23.44 m" in page.explorer.answer.sentence  # within the cell: a browser that loads scripts hears of nothing
        page.explorer.change(page.explorer.setting.with_value("friction.alpha", 0.1))
        assert "alpha = 0.1 s/m" in await answered(page, "regular")
        assert page.explorer.setting.value("run.duration") == 12.0
        assert callable(page._repr_mimebundle_)  # what a notebook calls; it needs IPython

    asyncio.run(cells())


@pytest.mark.slow
def test_scripts_and_style_sheets_come_from_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    """A notebook may have no internet: scripts are brought along, and no style sheet is named anew when a text changes."""
    brought = []
    monkeypatch.setattr("panel.extension", lambda **given: brought.append(given))

    async def cells() -> None:
        page = ss.explore("fig6-slab")
        ss.explore("fig6-slab")  # its page may have been loaded again meanwhile
        root = page.get_root()
        heading = page.select(Markup)[0]
        model = heading._models[root.ref["id"]][0]
        before = list(model.stylesheets)
        heading.object = "another title"
        assert "another title" in model.text
        assert all(one is other for one, other in zip(model.stylesheets, before, strict=True))

    asyncio.run(cells())
    assert brought == [{"inline": True}] * 2


def test_of_many_explorers_the_oldest_ends_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """A cell that is run again and again must not leave a thread each time."""
    monkeypatch.setattr(start, "MOST_EXPLORERS", 1)
    monkeypatch.setattr("stickslip.extensions.explorer.page.page.build_for_notebook", lambda explorer: SimpleNamespace())

    monkeypatch.setattr(start, "_AT_WORK", deque())

    async def cells() -> None:
        before = desk_threads()
        first = ss.explore("fig6-slab").explorer
        (thread,) = desk_threads() - before
        second = ss.explore("fig6-slab").explorer
        thread.join(20.0)
        assert not thread.is_alive()
        assert (first.fault, second.fault) == (start.ENDED, "")
        assert len(desk_threads() - before) == 1
        for desk in start._AT_WORK[0][1]:
            desk.close()

    asyncio.run(cells())


def desk_threads() -> set[threading.Thread]:
    """Return the threads in which explorers work."""
    return {one for one in threading.enumerate() if one.name == "explorer-desk"}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("fig6-slap", "did you mean 'fig6-slab'"),
        (3, "^explore"),
        ("fig6-slab", "^explore: there is no notebook here; `stickslip explore` opens"),
    ],
)
def test_a_wrong_problem_is_one_line(wrong: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ss.explore(wrong)


def test_without_its_libraries_the_explorer_says_how_to_install_them(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr("stickslip.extensions.explorer.notebook.find_spec", lambda name: None if name == "panel" else found(name))
    message = 'explore: the explorer needs panel: install them with pip install "stickslip[explorer]"'
    with pytest.raises(InputError) as caught:
        ss.explore("fig6-slab")
    assert str(caught.value) == message
