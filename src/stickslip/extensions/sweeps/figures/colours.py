"""Colours of the numbers of a map: a key of few values or a scale, and marks for members without a number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, ListedColormap, LogNorm, Normalize, to_hex
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from stickslip.extensions.sweeps.figures.varied import ShownQuantity
from stickslip.figures.panels import add_legend, set_log_ticks
from stickslip.figures.style import GREY, PALE, ROOM, TWO, folded
from stickslip.foundation.arrays import Floats

COLOURS_IN_KEY = 10
"""Up to this number of different whole numbers, each has its own colour in a key; more are drawn with a scale."""
STEPS_OF_SCALE = 40
"""Up to this range, each whole number has its own step in the scale."""
WARM = LinearSegmentedColormap.from_list("warm", ("#FFF4B2", "#FBD150", "#EBAF2F", "#D88D06", "#C06F05", "#A75203", "#8E3501"))
COOL = LinearSegmentedColormap.from_list("cool", ("#DCF7FF", "#97E2FF", "#5AC8FE", "#31A9F4", "#3389DC", "#346AC2", "#344BA7"))
"""Colours of whole numbers. They darken evenly, and alternate between warm and cool.

Neighbouring numbers therefore differ in lightness and in the one contrast that colour-blind readers see best; in grey the order
stays. Their distances are twice those of matplotlib's "viridis".
"""
FAILED, HATCH = "#EDEDED", "////"
"""Background of a map, and its hatch, where members failed."""


SLIDES, NOTHING = "#FFF4B2", 1e-6
"""Colour of a share of 0 beside other shares, and the share below which it counts as 0."""
SHARES = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0.2, 1.0, 256))).with_extremes(under=SLIDES)
"""Colours of shares: the brightest yellow of "viridis" is left out, which some readers cannot tell from the colour of 0."""


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


def shades(count: int) -> list[str]:
    """Return colours for so many whole numbers, which every reader can tell apart."""
    if count <= 2:
        return list(TWO[:count])
    return [to_hex((WARM, COOL)[k % 2](k / (count - 1))) for k in range(count)]


def colours_of(quantity: ShownQuantity) -> Colours:
    """Return colours, the same in all panels, for the numbers of a quantity."""
    known = quantity.known
    if quantity.is_flag:
        return _key(np.array([0.0, 1.0]), ("no", "yes"))
    if quantity.ends:
        return _share(known, quantity.ends)
    different = np.unique(known)
    if known.size and quantity.is_whole and different.size <= COLOURS_IN_KEY:
        return _key(different, [f"{value:.0f}" for value in different])
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    if known.size and quantity.is_whole and high - low <= STEPS_OF_SCALE:
        return _steps(int(low), int(high))
    if low == high:
        low, high = low - abs(low or 1.0), high + abs(high or 1.0)
    return Colours(mpl.colormaps["viridis"], LogNorm(low, high) if quantity.is_wide else Normalize(low, high), ())


def _share(known: Floats, ends: Sequence[str]) -> Colours:
    """Return two colours for shares that are 0 or 1; for others a scale, on which 0 has a colour that is not next to it."""
    both = np.array([0.0, 1.0])
    if np.isin(known, both).all():
        return _key(both, ends)
    return Colours(SHARES, Normalize(NOTHING, 1.0), ())


def _key(different: Floats, texts: Sequence[str]) -> Colours:
    count = len(different)
    between = 0.5 * (different[1:] + different[:-1])
    edges = np.concatenate([[different[0] - 1.0], between, [different[-1] + 1.0]])
    return Colours(ListedColormap(shades(count)), BoundaryNorm(edges, count), tuple(zip(different.tolist(), texts, strict=True)))


def _steps(low: int, high: int) -> Colours:
    count = high - low + 1
    cmap = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.0, 1.0, count)))
    return Colours(cmap, BoundaryNorm(np.arange(low, high + 2) - 0.5, count), ())


def prepare(axes: Axes, quantity: ShownQuantity) -> None:
    """Give the axes a hatched background if members failed: it shows wherever nothing is drawn over it."""
    axes.set_facecolor(FAILED if quantity.has(2) else "white")
    if quantity.has(2):
        axes.patch.set(hatch=HATCH, edgecolor=GREY, linewidth=0.0)


def explain(
    all_axes: Sequence[Axes], colours: Colours, quantity: ShownQuantity, *more: Artist, own: bool = False, room: int = ROOM
) -> None:
    """Add the key or the scale with the name of the quantity, and entries for areas without a number and for `more` artists.

    `own` says that the axes are the user's: then the key stays inside them. `room` is the number of letters along the scale.
    """
    marks: list[Artist] = [Patch(facecolor=colours.of(value), label=text) for value, text in colours.key]
    marks += [Patch(facecolor=PALE, label="undefined for this run")] if quantity.has(1) else []
    marks += [Patch(facecolor="white", edgecolor=GREY, linewidth=0.5, label="not run")] if quantity.has(3) else []
    marks += more
    scale = not colours.key and quantity.known.size > 0
    if scale:
        _add_scale(all_axes, colours, folded(quantity.title, room), quantity.ends)
    add_legend(all_axes[0], marks, "" if scale else folded(quantity.title, 2 * ROOM), own=own)


def _add_scale(all_axes: Sequence[Axes], colours: Colours, title: str, ends: Sequence[str]) -> None:
    figure: Any = all_axes[0].figure
    beyond = "min" if ends else "neither"
    bar = figure.colorbar(ScalarMappable(**colours.options), ax=list(all_axes), label=title, pad=0.02, aspect=25, extend=beyond)
    if ends:
        bar.set_ticks([NOTHING, 0.25, 0.5, 0.75, 1.0], labels=[f"0: {ends[0]}", "0.25", "0.5", "0.75", f"1: {ends[1]}"])
        bar.minorticks_off()
    elif isinstance(colours.norm, BoundaryNorm):
        bar.set_ticks(MaxNLocator(8, integer=True))
        bar.minorticks_off()
    elif isinstance(colours.norm, LogNorm):
        set_log_ticks(bar.ax, "y")
    bar.ax.tick_params(which="both", labelsize=mpl.rcParams["ytick.labelsize"])


def failed_area(quantity: ShownQuantity) -> list[Artist]:
    """Return the key's entry for the background that `prepare` sets, or nothing if no member failed."""
    return [Patch(facecolor=FAILED, edgecolor=GREY, hatch=HATCH, linewidth=0.0, label="failed")] if quantity.has(2) else []
