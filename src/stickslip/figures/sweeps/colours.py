"""Colours of the numbers of a map: a key of few values or a continuous scale, and marks for members without a number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stickslip.figures.style import BLUE, GREY, LIGHT_BLUE, ORANGE, PALE, Floats
from stickslip.figures.sweeps.varied import Shown

FEW = 10
"""Up to this number of different whole numbers, each has its own colour in a key; more are drawn with a scale."""
TWO = (LIGHT_BLUE, ORANGE)
"""Colours of no and yes, or of the numbers of a quantity that takes only two."""
FAILED, HATCH = "#EDEDED", "////"
"""Background of a map, and its hatch, where members failed."""


@dataclass(frozen=True)
class Colours:
    """The colours of numbers; `key` holds the numbers with an entry in the key and their texts, none if there is a scale."""

    cmap: Any
    norm: Any
    key: tuple[tuple[float, str], ...]

    @property
    def options(self) -> dict[str, Any]:
        """The colour arguments of `pcolormesh` and `scatter`."""
        return {"cmap": self.cmap, "norm": self.norm}

    def of(self, value: float) -> Any:
        """Return the colour of a number."""
        return self.cmap(self.norm(value))


def colours_of(quantity: Shown, drawn: Floats | None = None) -> Colours:
    """Return colours, the same in all panels, for the numbers of a quantity, or for the numbers `drawn` if they are given."""
    known = quantity.known if drawn is None else drawn[np.isfinite(drawn)]
    if quantity.is_flag:
        return _key(np.array([0.0, 1.0]), ("no", "yes"))
    different = np.unique(known)
    if known.size and quantity.is_whole and different.size <= FEW:
        return _key(different, [f"{value:.0f}" for value in different])
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    if low == high:
        low, high = low - abs(low or 1.0), high + abs(high or 1.0)
    return Colours(mpl.colormaps["viridis"], LogNorm(low, high) if quantity.is_wide else Normalize(low, high), ())


def _key(different: Floats, texts: Sequence[str]) -> Colours:
    count = len(different)
    shades = TWO if count == 2 else [BLUE] if count == 1 else mpl.colormaps["viridis"](np.linspace(0.05, 0.95, count))
    between = 0.5 * (different[1:] + different[:-1])
    edges = np.concatenate([[different[0] - 1.0], between, [different[-1] + 1.0]])
    return Colours(ListedColormap(list(shades)), BoundaryNorm(edges, count), tuple(zip(different.tolist(), texts, strict=True)))


def prepare(axes: Axes, quantity: Shown) -> None:
    """Give the axes a hatched background if members failed: it shows wherever nothing is drawn over it."""
    axes.set_facecolor(FAILED if quantity.has(2) else "white")
    if quantity.has(2):
        axes.patch.set(hatch=HATCH, edgecolor=GREY, linewidth=0.0)


def explain(figure: Figure, panels: Sequence[Axes], colours: Colours, quantity: Shown, *more: Artist) -> None:
    """Add the key or the scale with the name of the quantity, and entries for areas without a number and for `more` artists."""
    marks: list[Artist] = [Patch(facecolor=colours.of(value), label=text) for value, text in colours.key]
    marks += [Patch(facecolor=PALE, label="undefined for this run")] if quantity.has(1) else []
    marks += [Patch(facecolor="white", edgecolor=GREY, linewidth=0.5, label="not run")] if quantity.has(3) else []
    marks += more
    scale = not colours.key and quantity.known.size > 0
    if scale:
        figure.colorbar(ScalarMappable(**colours.options), ax=list(panels), label=quantity.title, pad=0.02, aspect=25)
    if marks:
        heading = None if scale else quantity.title
        narrow = {"handlelength": 1.3, "columnspacing": 1.2, "handletextpad": 0.5}
        figure.legend(
            handles=marks, title=heading, loc="outside lower center", ncols=min(len(marks), 12), title_fontsize=9.0, **narrow
        )


def failed_area(quantity: Shown) -> list[Artist]:
    """Return the key's entry for the background that `prepare` sets, or nothing if no member failed."""
    return [Patch(facecolor=FAILED, edgecolor=GREY, hatch=HATCH, linewidth=0.0, label="failed")] if quantity.has(2) else []
