"""Figure of rupture along a chain: which blocks slip when, and by how much."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from stickslip.extensions.chains.changes_between import Slips, changes_between, slips_of, window_of
from stickslip.figures.panels import letter_panels, set_title
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, Numbers, axis_text, label, shown, styled, time_unit, unit_shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun

THINNEST = 2e-3
"""Draw a slip at least so long, as a share of the time that is drawn: a short one would not be seen."""


@styled
def draw_rupture(
    run: ChainRun, event: int | None = None, start: float | None = None, end: float | None = None, **place: Unpack[Place]
) -> Figure:
    """Draw the slip of each block as a bar from its onset to its arrest, and beside it how far each block slipped.

    Of a lattice the blocks are counted row after row.
    """
    first, last, one = window_of(run, event, start, end)
    slips = slips_of(changes_between(run, first, last), run.at(last).slip[0])
    figure = sheet((7.2, 4.2), **place)
    axes: Any = figure.subplots(1, 2, sharey=True, width_ratios=(2.6, 1.0))
    origin = first if one is not None else 0.0
    clock, second = time_unit(last - origin)
    bars = _draw_bars(axes[0], slips, origin, last, second)
    axes[0].set_xlim((first - origin) / second, (last - origin) / second)
    axes[0].set_xlabel(axis_text("time since the event began" if one is not None else "time $t$", "", clock))
    axes[0].set_ylabel("block")
    axes[0].yaxis.set_major_locator(MaxNLocator(integer=True))
    total = np.zeros(run.chain.count)
    np.add.at(total, slips.block, slips.slip)
    _draw_slip(axes[1], total)
    figure.colorbar(bars, ax=axes[1], label=label(_slip(slips.slip), unit_shown(_slip(slips.slip))))
    word = f"event {one} at {run.events['time'][one]:.6g} s" if one is not None else "slip of blocks"
    letter_panels(axes, [word, "slip"])
    set_title(figure, run.title)
    return figure


def _slip(values: Floats) -> Numbers:
    return Numbers(values if len(values) else np.zeros(1), {"units": "m", "long_name": "slip", "symbol": "u"})


def _draw_bars(axes: Axes, slips: Slips, origin: float, last: float, second: float) -> PolyCollection:
    """Draw a bar for each slip, coloured by how far it went."""
    begin = (slips.onset - origin) / second
    end = (np.where(np.isnan(slips.arrest), last, slips.arrest) - origin) / second
    end = np.maximum(end, begin + THINNEST * (last - origin) / second)
    low, high = slips.block - 0.5, slips.block + 0.5
    corners = np.stack([np.stack(pair, axis=-1) for pair in ((begin, low), (end, low), (end, high), (begin, high))], axis=1)
    bars = PolyCollection(list(corners), array=shown(_slip(slips.slip))[: len(begin)], cmap="viridis", linewidth=0.0)
    axes.add_collection(bars)
    return bars


def _draw_slip(axes: Axes, total: Floats) -> None:
    """Draw how far each block slipped."""
    axes.barh(np.arange(len(total)), shown(_slip(total)), height=1.0, color=BLUE, linewidth=0.0)
    axes.set_ylim(-0.5, len(total) - 0.5)
    axes.set_xlabel(label(_slip(total), unit_shown(_slip(total))))
