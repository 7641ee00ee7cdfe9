"""Keys of figures: below the panels, in as many columns as fit, or inside the axes of a user."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes

LETTER, MARK = 0.062, 0.4
"""Widths (inches) of a letter of a key, and of the mark before it with the space around."""


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
