"""Figure of sliding: displacement against yield coefficient, with the scatter over records and polarities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.extensions.strong_motion.asked import read_length
from stickslip.figures.panels import add_legend, letter_panels, panels, set_log_ticks
from stickslip.figures.style import BLUE, GREY, SKY, VERMILLION, quantity, styled
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.strong_motion.displacements import SlidingDisplacements

BANDS = (0.16, 0.5, 0.84)
"""Quantiles that are drawn: the median, and one standard deviation to each side of it."""
MOST_LEVELS = 4
"""Largest number of scales, or of peak accelerations, that get a panel each."""
SMALLEST = 1e-4
"""Displacements below this share of the largest are left out of the logarithmic axis."""


def displacements_data(study: SlidingDisplacements) -> xr.Dataset:
    """Return displacements (m) by level, case (a record in one polarity) and yield coefficient, with the names of the cases."""
    asked = study.asked
    signs, levels, yields = len(asked.polarities), len(asked.levels.values), len(asked.forward)
    grid = study.table.displacement.to_numpy(float).reshape(len(study.motions), levels, signs, yields)
    cases = grid.transpose(1, 0, 2, 3).reshape(levels, len(study.motions) * signs, yields)
    order = np.argsort(asked.forward, kind="stable")
    contents = {"displacement": quantity(("level", "case", "yield"), cases[..., order], "permanent displacement", "D", "m")}
    coordinates: dict[str, Any] = {
        "yield": quantity("yield", asked.forward[order], "yield coefficient", "k_y", "1"),
        "level": ("level", list(asked.levels.values)),
        "record": ("case", np.repeat([one.name for one in study.motions], signs)),
        "polarity": ("case", np.tile(asked.polarities, len(study.motions))),
    }
    about = {"analysis": asked.analysis, "is_pga": int(asked.levels.is_pga), "unit": study.unit}
    return xr.Dataset(contents, coords=coordinates, attrs=about)


@styled
def draw_displacements(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw a panel for each level: every case in grey, the median, and the quantiles of 16 and 84 %."""
    drawn = min(dataset.sizes["level"], MOST_LEVELS)
    figure, axes = panels(1, drawn, (1.4 + 3.6 * drawn, 4.0), place, sharex=True, sharey=True)
    unit = str(dataset.attrs["unit"])
    values = np.abs(dataset["displacement"].values) / read_length("sliding", unit)
    for n, panel in enumerate(axes.flat):
        _draw_level(panel, dataset["yield"].values, values[n])
        panel.set_xlabel("yield coefficient $k_y$ (g)")
    first = axes.flat[0]
    first.set_ylabel(f"permanent displacement $D$ ({unit})")
    largest = float(np.nanmax(values, initial=0.0))
    if largest > 0.0:
        positive = values[values > SMALLEST * largest]
        first.set(yscale="log", ylim=(0.7 * float(positive.min()), 1.5 * largest))
        set_log_ticks(first, "y")
    else:
        first.set_ylim(0.0, 1.0)
    word = "PGA {:g} g" if dataset.attrs["is_pga"] else "scale {:g}"
    texts = [word.format(level) for level in dataset["level"].values[:drawn]]
    letter_panels(axes.flat, texts if drawn > 1 else [f"{dataset.attrs['analysis']} sliding, {texts[0]}"])
    handles, labels = first.get_legend_handles_labels()
    add_legend(first, list(dict(zip(labels, handles, strict=True)).values()))
    return figure


def _draw_level(axes: Axes, yields: Any, values: Any) -> None:
    sliding = np.where(values > 0.0, values, np.nan)
    look: dict[str, Any] = {"marker": "o", "markersize": 3.0} if len(yields) < 12 else {}
    for case in sliding:
        axes.plot(yields, case, color=GREY, linewidth=0.6, alpha=0.6, label="records and polarities", **look)
    low, middle, high = np.nanquantile(values, BANDS, axis=0)
    floor = np.where(low > 0.0, low, np.finfo(float).tiny)
    if len(yields) == 1:  # bars in place of a band
        axes.vlines(yields, floor, high, color=SKY, alpha=0.35, linewidth=12.0, label="16 to 84 %")
        look = {"marker": "_", "markersize": 16.0, "markeredgewidth": 2.0, "linestyle": "none"}
    elif len(values) > 1:
        axes.fill_between(yields, floor, high, color=SKY, alpha=0.35, linewidth=0.0, label="16 to 84 %")
    axes.plot(yields, np.where(middle > 0.0, middle, np.nan), color=BLUE, label="median", **look)
    none = ~(values > 0.0).any(axis=0)
    if none.any():
        axes.axvspan(yields[none].min(), yields.max(), color=VERMILLION, alpha=0.08, linewidth=0.0, label="none slides")
