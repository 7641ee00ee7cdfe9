"""Figure of a Gutenberg-Richter slope: the number of events against magnitude, with the law that fits and its interval."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, finish
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import BLUE, GREY, INK, SKY, VERMILLION, styled
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.chains.statistics import GutenbergRichter

POINTS_OF_LAW = 400
"""Number of points of the curve of the law."""


@styled
def draw_frequency(found: GutenbergRichter, **place: Unpack[Place]) -> Figure | Axes:
    """Draw how many events have a magnitude or a larger one, and how many lie in each bin, with the law and its interval."""
    axes = one_panel((5.6, 4.2), **place)
    table, all_of_them = found.table, found.magnitudes
    at_least = np.arange(len(all_of_them), 0, -1)
    values, first = np.unique(all_of_them, return_index=True)
    axes.plot(values - 0.5 * found.bin, at_least[first], "o", color=BLUE, markersize=2.5, label="this magnitude or larger")
    middle = table.magnitude + (0.0 if found.bin else 0.5 * float(np.diff(table.magnitude).min()) if len(table) > 1 else 0.0)
    axes.plot(middle, table.events, "s", color=GREY, markersize=3.0, markerfacecolor="none", label="in a bin")
    begins = found.completeness - 0.5 * found.bin
    ends = min(float(all_of_them[-1]), found.largest) + 0.5 * found.bin
    magnitude = np.linspace(begins, ends, POINTS_OF_LAW)
    law, low, high = (_law(found, magnitude, slope * math.log(10.0)) for slope in (found.b, found.low, found.high))
    share = f"{100.0 * found.confidence:g} %"
    axes.fill_between(
        magnitude, low, high, color=SKY, alpha=0.4, linewidth=0.0, label=f"{found.low:.3g} to {found.high:.3g} ({share})"
    )
    axes.plot(magnitude, law, color=VERMILLION, linewidth=1.2, label=f"$b$ = {found.b:.3g}")
    axes.axvline(begins, color=INK, linewidth=0.8, linestyle=":", label="complete from here on")
    axes.set(yscale="log", xlabel="magnitude", ylabel="number of events", ylim=(0.5, 2.0 * len(all_of_them)))
    own = place.get("ax") is not None
    add_legend(axes, axes.get_legend_handles_labels()[0], own=own)
    return finish(axes, "", **place)


def _law(found: GutenbergRichter, magnitude: Floats, beta: float) -> Floats:
    """Return how many events above magnitudes a slope expects; nothing where it expects less than half of one."""
    law = found.at_edges(magnitude, beta)
    return np.where(law >= 0.5, law, np.nan)
