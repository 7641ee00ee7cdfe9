"""Parts of figures that many of them share: sheets with panels, titles, keys, marks, scales, and panels of one kind."""

from __future__ import annotations

import string
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from itertools import zip_longest
from typing import Any, Unpack, cast

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from stickslip.figures.names import parameter_name
from stickslip.figures.sheet import sheet
from stickslip.figures.style import PALE, Numbers, folded, label, shown
from stickslip.foundation.axis import Axis
from stickslip.foundation.given import Given
from stickslip.foundation.place import Place
from stickslip.problem import Problem

LETTER, MARK = 0.062, 0.4
"""Widths (inches) of a letter of a key, and of the mark before it with the space around."""
LETTERS = 13.0
"""Number of letters of a title in an inch; longer titles are broken into lines."""
WIDTH_OF_LABELS = 0.7
"""Width (inches) of the labels beside the axis of a panel."""
NARROW_AXIS = 500.0
"""Logarithmic axes that span less than this factor have ticks at 1, 2, 5, 10, ...: powers of ten alone would be too few."""


def panels(
    rows: int, columns: int, size: tuple[float, float], place: Place | None = None, **options: Any
) -> tuple[Figure, NDArray[Any]]:
    """Return a figure of the usual `size` (inches) and its grid of axes, always as a 2-D array; `place` says where to draw."""
    figure = sheet(size, **(place or {}))
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def letter_panels(axes: Iterable[Axes], texts: Iterable[str] = ()) -> None:
    """Set the titles of panels: a letter, "(a)", "(b)", ..., and what each shows, if `texts` say it. One panel has no letter."""
    found = list(axes)
    for k, (panel, text) in enumerate(zip_longest(found, texts, fillvalue="")):
        mark = f"({string.ascii_lowercase[k]})" if len(found) > 1 else ""
        panel.set_title("  ".join(part for part in (mark, text) if part), pad=5)  # type: ignore[union-attr]


def set_title(where: Any, title: str) -> None:
    """Set the title of a whole figure, or of the only panel of one, above its left end. No title, "", takes no room.

    Titles are users' texts: they are never read as formulas.
    """
    if not title:
        return
    figure = where.figure
    line = "".join(letter if letter.isprintable() else " " for letter in title)
    # The title of a panel begins beside its axis, that of a figure at the edge.
    room = figure.get_figure(root=True).get_size_inches()[0] - (WIDTH_OF_LABELS if isinstance(where, Axes) else 0.0)
    text = textwrap.fill(" ".join(line.split()), max(int(LETTERS * room), 20))
    if isinstance(where, Axes):
        where.set_title(text, parse_math=False)
    else:
        look = {"fontsize": mpl.rcParams["axes.titlesize"], "fontweight": "bold", "parse_math": False}
        where.suptitle(text, x=0.012, ha="left", **look)


def add_legend(axes: Axes, marks: Sequence[Artist], heading: str = "", *, own: bool = False) -> None:
    """Add a key for `marks`, which have labels; without any there is none.

    It is placed below all panels of the figure in as many columns as fit, or inside the axes if they are the user's `own`.
    """
    if not marks:
        return
    figure: Any = axes.figure
    widths = [LETTER * len(str(mark.get_label()).replace("$", "")) + MARK for mark in marks]
    width = figure.bbox.width / figure.get_figure(root=True).dpi
    columns = len(marks) if sum(widths) < width else max(int(width / max(widths)), 1)
    look: dict[str, Any] = {"handlelength": 1.5, "columnspacing": 1.2, "handletextpad": 0.5, "title_fontsize": 9.0}
    look |= {"handles": marks, "title": heading or None}
    if own:
        axes.legend(**look)
    else:
        figure.legend(loc="outside lower center", ncols=columns, **look)


def finish(axes: Axes, title: str, **place: Unpack[Place]) -> Figure | Axes:
    """End a figure of one panel: give it its title and return it, or return the axes of a user as they are."""
    if place.get("ax") is not None:
        return axes
    set_title(axes, title)
    return cast("Figure", axes.figure)


def zero_line(axes: Axes) -> None:
    """Draw a faint horizontal line at zero, for quantities whose zero has a meaning."""
    axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)


def set_scale(axes: Axes, which: str, log: bool) -> None:
    """Make the axes "x", "y" or both ("xy") logarithmic, or linear."""
    for name in which:
        getattr(axes, f"set_{name}scale")("log" if log else "linear")


def set_log_ticks(axes: Axes, which: str) -> None:
    """Give the logarithmic axis "x" or "y" ticks that can be read, once its limits are set: plain 1, 2, 5, ... if it is short."""
    axis = getattr(axes, f"{which}axis")
    low, high = sorted(axis.get_view_interval())
    if high < NARROW_AXIS * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_locator(NullLocator())


def count_ticks(axes: Axes, count: int = 4) -> None:
    """Give the vertical axis at most `count` intervals between ticks at whole numbers."""
    axes.yaxis.set_major_locator(MaxNLocator(count, integer=True))


def parameter_numbers(problem: Problem, **axes: Axis) -> dict[str, Numbers]:
    """Return the coordinates `x` and `y` of a map over two parameters of a problem."""
    found = {}
    for name, axis in axes.items():
        one = problem.parameters[axis.parameter]
        text = parameter_name(one.name, one.declared.meaning)
        shown_in = {"shown_in": axis.low.unit} if isinstance(axis.low, Given) else {}
        found[name] = Numbers(axis.values, {"long_name": text, "units": one.unit or "1", "log": int(axis.log)} | shown_in)
    return found


def draw_parameters(axes: Axes, dataset: Mapping[Any, Any]) -> None:
    """Set labels and scales of a map over the two parameters `x` and `y` of a dataset or of `parameter_numbers`."""
    axes.set(xlabel=folded(label(dataset["x"])), ylabel=folded(label(dataset["y"])))
    for name in ("x", "y"):
        set_scale(axes, name, bool(dataset[name].attrs["log"]))
        if dataset[name].attrs["log"]:
            set_log_ticks(axes, name)


def cell_edges(values: NDArray[Any], *, log: bool) -> NDArray[Any]:
    """Return the edges of the cells of a map around ascending values: halfway between them, on a logarithmic axis in the logarithm.

    A map ends at its first and its last value: nobody asked for the half cells beyond, where a thickness may be below zero.
    """
    middle = np.sqrt(values[1:] * values[:-1]) if log else 0.5 * (values[1:] + values[:-1])
    return np.concatenate([values[:1], middle, values[-1:]])


def draw_map(axes: Axes, dataset: Mapping[Any, Any], values: Any, **colours: Any) -> Any:
    """Draw values over the two parameters `x` and `y` as an image, pale where they are not finite, and return the image."""
    axes.set_facecolor(PALE)
    edges = (cell_edges(shown(dataset[name]), log=bool(dataset[name].attrs["log"])) for name in ("x", "y"))
    return axes.pcolormesh(*edges, np.ma.masked_invalid(values), rasterized=True, **colours)
