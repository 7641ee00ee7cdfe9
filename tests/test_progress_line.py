"""One line of progress: on a terminal, in a notebook, and nothing at all elsewhere."""

from __future__ import annotations

import io
import signal
import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

import stickslip as ss
from stickslip.foundation.axis import Axis
from stickslip.run.progress import LONG_RUN, Report, progress_line

PROBLEM = ss.load_scenario("fig6-slab").problem
CYCLES = ss.load_scenario("cycles-block")
CALLS: dict[str, Callable[..., Any]] = {
    "simulate": lambda **how: ss.simulate(PROBLEM, 12.0, **how),
    "catalogue": lambda **how: ss.catalogue(PROBLEM, 12.0, **how),
    "sweep": lambda **how: ss.sweep(PROBLEM, {"alpha": [0.1, 1.0]}, duration=1.0, quantities=["slip"], **how),
    "ensemble": lambda **how: ss.studies.ensemble(PROBLEM, 12.0, members=1, **how),
    "compare": lambda **how: ss.studies.compare("fig6-slab", "fig6-slab", **how),
    "schemes": lambda **how: ss.studies.schemes(PROBLEM, 1.0, "theta", [20, 40], **how),
    "analogy": lambda **how: ss.studies.analogy(
        PROBLEM, 12.0, Axis("friction.alpha", 0.1, 1.0, 2), Axis("body.thickness", 1e4, 2e4, 2), **how
    ),
}
SAYS = {
    "simulate": "simulate: 12 of 12 s, 1 slip event, stuck",
    "catalogue": "catalogue: 12 of 12 s, 1 slip event, stuck",
    "sweep": "sweep: 2 of 2 members",
    "ensemble": "ensemble: member 1 of 1",
    "compare": "compare: fig6-slab (2)",
    "schemes": "schemes: theta, 40 cells",
    "analogy": "analogy: 4 of 4 points",
}


class Notebook:
    """A stand-in for IPython in a notebook: it keeps every text that its displays have shown."""

    def __init__(self) -> None:
        self.shown: list[list[str]] = []

    def display(self, content: dict[str, str], *, raw: bool, display_id: bool) -> Any:
        assert raw
        assert display_id
        texts = [content["text/plain"]]
        self.shown.append(texts)
        return SimpleNamespace(update=lambda content, raw: texts.append(content["text/plain"]))


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> Notebook:
    found = Notebook()
    package, display = ModuleType("IPython"), ModuleType("IPython.display")
    package.get_ipython = lambda: SimpleNamespace(kernel=object())  # type: ignore[attr-defined]
    display.display = found.display  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "IPython", package)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    return found


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("name", CALLS)
def test_progress_is_shown_in_notebooks_and_removed(name: str, notebook: Notebook, capsys: pytest.CaptureFixture[str]) -> None:
    CALLS[name](progress=True)
    (texts,) = notebook.shown
    assert any(text.startswith(SAYS[name]) for text in texts), texts
    assert texts[-1] == ""
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["simulate", "sweep"])
def test_progress_is_shown_on_terminals(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "132")
    CALLS[name](progress=True)
    assert f"{name}:" in screen.getvalue()
    assert screen.getvalue().rstrip().endswith("\x1b[2K")  # the line is erased


@pytest.mark.parametrize(("name", "progress"), [*((name, True) for name in CALLS), ("simulate", False), ("simulate", None)])
def test_nothing_is_shown_elsewhere(name: str, progress: bool | None, capsys: pytest.CaptureFixture[str]) -> None:
    CALLS[name](progress=progress)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("name", CALLS)
def test_other_values_of_progress_are_refused(name: str) -> None:
    with pytest.raises(ss.InputError, match=rf"^{name}: progress must be True or a function, got 'loud'$"):
        CALLS[name](progress="loud")


def test_a_shell_in_a_terminal_is_no_notebook(notebook: Notebook) -> None:
    sys.modules["IPython"].get_ipython = lambda: SimpleNamespace()
    with progress_line("what:") as report:
        report("news")
    assert notebook.shown == []


def test_texts_cannot_move_the_cursor(notebook: Notebook) -> None:
    with progress_line("what:") as report:
        report("\x1b[2J\nnews", 3)
    assert notebook.shown == [["", "what:  [2J news 3", ""]]


def test_a_run_can_be_resumed_with_progress(notebook: Notebook, tmp_path: Any) -> None:
    ss.simulate(CYCLES, progress=True, checkpoint=tmp_path / "run.nc")
    ss.resume(tmp_path / "run.nc", "40 years", progress=True)
    assert [texts[-2].split(",")[0] for texts in notebook.shown] == ["simulate: 30 of 30 years", "resume: 40 of 40 years"]


def test_ctrl_c_ends_a_run_that_shows_its_progress(notebook: Notebook, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.run.run_loop.LARGEST_BUDGET", 100)
    monkeypatch.setattr("stickslip.run.run_loop.FIRST_BUDGET", 100)
    show = notebook.display

    def display(*content: Any, **how: Any) -> Any:
        handle = show(*content, **how)
        update = handle.update

        def interrupted(content: dict[str, str], raw: bool) -> None:
            update(content, raw)
            if " 3 slip events" in content["text/plain"]:
                signal.raise_signal(signal.SIGINT)

        handle.update = interrupted
        return handle

    sys.modules["IPython.display"].display = display
    run = ss.simulate(CYCLES, progress=True)
    assert run.status.name == "interrupted"
    assert 3 <= len(run.events) < 7
    assert notebook.shown[0][-1] == ""


def test_no_library_of_notebooks_is_imported_for_a_progress_line() -> None:
    with progress_line("what:"):
        assert "IPython" not in sys.modules


def test_progress_counts_pieces_when_they_are_many() -> None:
    few, many = (str(Report(1.0, 1000.0, 0, None, pieces, "creeping", 1.0, 1.0)) for pieces in (LONG_RUN - 1, 1_500_000))
    assert "million" not in few
    assert "1.5 million pieces" in many
