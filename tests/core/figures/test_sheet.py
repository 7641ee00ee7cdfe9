"""Where figures are drawn, how large they are, and how often pyplot and a notebook show them."""

from __future__ import annotations

import struct
import sys
from functools import cache
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import matplotlib as mpl
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.figures import sheet
from stickslip.figures.sheet import StickslipFigure, read_size
from tests.core.figures.legible import SLAB_PROBLEM

ONE_PANEL = ["slip", "slip_rate", "traction", "load", "friction", "energy", "path"]
PANELS = ["__call__", "field", "snapshots", "catalogue"]


@cache
def run() -> ss.Solution:
    return ss.simulate(SLAB_PROBLEM, 7.0)


def plot(name: str, **place: Any) -> Any:
    return getattr(run().plot, name)(**place)


pytestmark = pytest.mark.usefixtures("coarse")


# ---- where ---------------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", ONE_PANEL + PANELS)
def test_a_new_figure_is_one_that_pyplot_shows(name: str) -> None:
    figure = plot(name)
    assert isinstance(figure, Figure)
    assert [pyplot.figure(number) for number in pyplot.get_fignums()] == [figure]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", ONE_PANEL)
def test_axes_of_the_user_are_drawn_in_and_returned(name: str) -> None:
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3))
    assert plot(name, ax=right) is right
    assert right.lines
    assert not left.lines
    assert right.get_title(loc="left") == ""
    assert figure.get_size_inches().tolist() == [9.0, 3.0]
    assert len(pyplot.get_fignums()) == 1


@pytest.mark.parametrize("name", PANELS)
def test_several_panels_do_not_fit_into_axes(name: str) -> None:
    with pytest.raises(ss.InputError, match="has several panels: give an empty figure"):
        plot(name, ax=pyplot.subplots()[1])
    assert len(pyplot.get_fignums()) == 1  # the user's own


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", ONE_PANEL + PANELS)
def test_a_figure_of_the_user_is_drawn_in_and_keeps_its_size(name: str) -> None:
    mine = pyplot.figure(figsize=(8, 9))
    assert plot(name, figure=mine) is mine
    assert mine.axes
    assert mine.get_size_inches().tolist() == [8.0, 9.0]
    left, _ = Figure(figsize=(12, 6)).subfigures(1, 2)
    plot(name, figure=left)
    assert left.axes
    assert len(pyplot.get_fignums()) == 1


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", ONE_PANEL + PANELS)
def test_size_and_dpi_are_those_asked_for(name: str, tmp_path: Path) -> None:
    figure = plot(name, size=(4.0, 5.0), dpi=150)
    assert figure.get_size_inches().tolist() == [4.0, 5.0]
    assert figure.dpi == 150
    figure.savefig(tmp_path / "figure.png")
    width, height = struct.unpack(">2I", (tmp_path / "figure.png").read_bytes()[16:24])  # of the image header, in dots
    assert (width, height) == (600, 750)
    assert plot(name, figure=Figure(), size="10 x 12.7 cm").get_size_inches() == pytest.approx([10 / 2.54, 5.0], rel=1e-15)


def test_drawing_leaves_the_settings_of_matplotlib_alone() -> None:
    pyplot.ion()
    before = dict(mpl.rcParams)
    plot("__call__")
    assert dict(mpl.rcParams) == before
    pyplot.ioff()


def test_a_figure_that_fails_is_not_left_with_pyplot() -> None:
    with pytest.raises(ss.InputError, match="times must lie between"):
        run().plot(0.0, 1e9)
    assert pyplot.get_fignums() == []


# ---- size and dpi --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "inches"),
    [
        ("16 x 10 cm", (16 / 2.54, 10 / 2.54)),
        ("3.5x5in", (3.5, 5.0)),
        ("89 mm x 4 inches", (89 / 25.4, 4.0)),
        ("12×8 CM", (12 / 2.54, 8 / 2.54)),
        ("single column", (3.5, 3.0)),
        ("Double Column", (7.2, 3.0)),
        ((4, 5.5), (4.0, 5.5)),
    ],
)
def test_a_size_is_read_as_it_is_written(text: Any, inches: tuple[float, float]) -> None:
    assert read_size(text, (6.4, 3.0)) == pytest.approx(inches, rel=1e-15)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ({"figsize": (4, 3)}, "plot: there is no figsize=; did you mean 'size'"),
        ({"size": "16 x 10"}, "size: must be two lengths in inches, a text such as"),
        ({"size": "16 cm"}, "size: must be two lengths"),
        ({"size": "1.2.3 x 4 cm"}, "size: must be two lengths"),
        ({"size": (4.0,)}, "size: must be two lengths"),
        ({"size": (4.0, float("nan"))}, "size: must be two lengths"),
        ({"size": 4.0}, "size: must be two lengths"),
        ({"size": "1 x 10 cm"}, "each side must be from 2 cm to 2 m, got 1 cm x 10 cm"),
        ({"dpi": 0}, "dpi: must be a number of dots per inch from 10 to 2400, got 0"),
        ({"dpi": "300"}, "dpi: must be a number"),
        ({"dpi": True}, "dpi: must be a number"),
        ({"size": (40.0, 40.0), "dpi": 1200}, "1200 dots per inch make a side of 48000 dots, at most 30000 are allowed"),
        ({"ax": 3}, "ax must be a matplotlib axes, got 3"),
        ({"figure": "mine"}, "figure must be a matplotlib figure, got 'mine'"),
    ],
)
def test_a_place_that_cannot_be_is_refused_in_one_line(place: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as raised:
        plot("slip", **place)
    assert "\n" not in str(raised.value)
    assert pyplot.get_fignums() == []


def test_keywords_that_are_none_are_as_if_not_given() -> None:
    figure = plot("slip", ax=None, figure=None, size=None, dpi=None)
    assert figure.get_size_inches().tolist() == [6.4, 3.0]
    assert plot("slip", figure=None, size=figure.get_size_inches()).get_size_inches().tolist() == [6.4, 3.0]
    axes = pyplot.subplots()[1]
    assert plot("slip", ax=axes, size=None) is axes


def test_axes_bring_their_own_size() -> None:
    with pytest.raises(ss.InputError, match="leave out figure, size and dpi"):
        plot("slip", ax=pyplot.subplots()[1], dpi=300)


# ---- notebooks -----------------------------------------------------------------------------------------------------------------


class Notebook:
    """The part of IPython that shows the result of a cell; `formats` are the pictures that its backend makes of figures."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **formats: Any) -> None:
        self.shown: list[dict[str, Any]] = []
        formatters = {f"image/{kind}": lambda figure, picture=picture: picture for kind, picture in formats.items()}
        shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/plain": repr, **formatters}))
        ipython, display = ModuleType("IPython"), ModuleType("IPython.display")
        ipython.get_ipython = lambda: shell  # type: ignore[attr-defined]
        display.display = lambda data, **_: self.shown.append(data)  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, "IPython", ipython)
        monkeypatch.setitem(sys.modules, "IPython.display", display)

    def end_cell(self, result: object) -> int:
        """Show the result of a cell, then all figures that pyplot still knows, as the inline backend does; return their number."""
        if isinstance(result, StickslipFigure):
            result._ipython_display_()
        pictures = sum("image/png" in data or "image/svg+xml" in data for data in self.shown) + len(pyplot.get_fignums())
        pyplot.close("all")
        self.shown.clear()
        return pictures


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("formats", [{}, {"png": b"P"}, {"png": (b"P", {"width": 3})}, {"png": None, "svg+xml": "<svg>"}])
def test_a_notebook_shows_the_result_of_a_cell_once(formats: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    notebook = Notebook(monkeypatch, **formats)
    assert notebook.end_cell(plot("slip")) == 1
    figure = plot("load")
    assert notebook.end_cell(None) == 1  # fig = solution.plot()
    assert notebook.end_cell(figure) == 1  # asked for again in a later cell
    plot("traction")
    assert notebook.end_cell(plot("slip")) == 2


def test_the_formats_of_the_notebook_win(monkeypatch: pytest.MonkeyPatch) -> None:
    notebook = Notebook(monkeypatch, **{"png": None, "svg+xml": "<svg>"})
    plot("slip")._ipython_display_()
    assert {key for data in notebook.shown for key in data} == {"text/plain", "image/svg+xml"}


def test_without_a_backend_for_notebooks_the_picture_is_png(monkeypatch: pytest.MonkeyPatch) -> None:
    notebook = Notebook(monkeypatch)
    plot("slip", dpi=50)._ipython_display_()
    (data,) = notebook.shown
    assert data["image/png"].startswith(b"\x89PNG")


def test_a_window_shows_its_figure_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    notebook, figure = Notebook(monkeypatch, png=b"P"), plot("slip")
    monkeypatch.setattr(sheet.mpl, "get_backend", lambda: "QtAgg")
    figure._ipython_display_()
    assert [set(data) for data in notebook.shown] == [{"text/plain"}]
    assert pyplot.fignum_exists(figure.number)


@pytest.mark.parametrize(
    ("backend", "windows"),
    [
        ("agg", False),
        ("svg", False),
        ("inline", False),
        ("module://matplotlib_inline.backend_inline", False),
        ("QtAgg", True),
        ("TkAgg", True),
        ("nbAgg", True),
        ("module://ipympl.backend_nbagg", True),
    ],
)
def test_backends_with_windows_are_known(backend: str, windows: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheet.mpl, "get_backend", lambda: backend)
    assert sheet._has_windows() is windows
