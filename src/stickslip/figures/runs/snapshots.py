"""Figure of displacement, velocity and stress across the slab at given times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib import colormaps
from numpy.typing import ArrayLike

from stickslip.figures.legends import add_legend
from stickslip.figures.panels import letter_panels, set_title
from stickslip.figures.runs.slab_panels import Scales, about, places, snapshots
from stickslip.figures.sheet import sheet
from stickslip.figures.style import label, shown, styled, unit_shown
from stickslip.observables.field import slab_of
from stickslip.solution.interval import choose_interval
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution.evaluation import Readings

COUNT, PLACES = 6, 1500
"""Default number of times, and number of points across the slab, enough for fronts to look sharp."""


def data(readings: Readings, times: ArrayLike | None = None) -> xr.Dataset:
    """Return the field at the given times (s), in SI.

    The default is six times over the first round trip of the interval of `choose_interval`, or from the start of the event if that
    is a window. Raises InputError for a block, and for times outside the run.
    """
    if times is None:
        readings, start, end = choose_interval(readings, None, None)
        start = max(start, 0.0) if "event_slip" in readings.curves else start
        # 0.35, and not 0.5: fronts on their way back would else lie where others were on their way out.
        shares = (np.arange(COUNT) + 0.35) / COUNT
        times = start + shares * min(slab_of(readings.problem).two_way_time, end - start)
    moments = np.atleast_1d(np.asarray(times, float))
    return xr.Dataset(snapshots(readings, moments, places(readings, PLACES)), attrs=about(readings))


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw three panels with the contact below and a line for each time, later ones darker."""
    scales = Scales(dataset)
    figure = sheet((7.2, 3.9), **place)
    axes: Any = figure.subplots(1, 3, sharey=True)
    unit, size = unit_shown(dataset.displacement)
    since = dataset.displacement.attrs["long_name"].replace("displacement ", f"displacement $u$ ({unit})\n", 1)
    drawn = (
        (since, dataset.displacement.values / size),
        (label(dataset.velocity), shown(dataset.velocity)),
        (scales.name_stress(r"shear stress $\sigma$"), scales.stresses(dataset.stress.values)),
    )
    colours = colormaps["viridis_r"](np.linspace(0.15, 1.0, dataset.sizes["time"]))
    for panel, (text, values) in zip(axes, drawn, strict=True):
        for time, line, colour in zip(dataset.time.values, values, colours, strict=True):
            panel.plot(line, dataset.x.values / scales.place, color=colour, linewidth=1.2, label=f"{time / scales.time:.3g}")
        panel.set_xlabel(text)
        scales.set_places(panel, dataset, named=panel is axes[0])
    letter_panels(axes)
    set_title(figure, dataset.attrs["title"])
    add_legend(axes[0], axes[0].get_legend_handles_labels()[0], scales.clock)
    return figure
