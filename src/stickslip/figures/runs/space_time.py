"""Figure of velocity and stress in the slab over time, with characteristics of events at the contact, and the contact below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D

from stickslip.figures.panels import letter_panels, set_title, zero_line
from stickslip.figures.runs.slab_panels import Scales, about, contact_variables, means, places
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREEN, INK, VERMILLION, Floats, label, narrow, quantity, styled, unit_shown
from stickslip.observables.field import slab_of
from stickslip.solution.fronts import fronts_of
from stickslip.solution.interval import choose_interval
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution.evaluation import Readings

TIMES, PLACES = 900, 300
"""Numbers of cells of the images, in time and across the slab."""


def data(readings: Readings, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Return field, contact and characteristics from `start` to `end` (s), in SI.

    The default interval is that of `choose_interval`. Each characteristic is a line of corners in time and x, padded with NaN.
    Raises InputError for a block, and for times outside the run.
    """
    readings, start, end = choose_interval(readings, start, end)
    body = slab_of(readings.problem)
    contents = means(readings, np.linspace(start, end, TIMES + 1), places(readings, PLACES + 1))
    contents |= contact_variables(readings, start, end, ("slip_rate", "traction"))
    lines = fronts_of(readings, start, end)
    points = max((len(line) for line in lines), default=0)
    across = np.array([np.pad(line, (0, points - len(line)), constant_values=np.nan) for line in lines]).reshape(len(lines), points)
    contents["front_time"] = quantity(("front", "corner"), across, "time of a characteristic", "t", "s")
    corners = np.where(np.arange(points) % 2, body.thickness, 0.0)
    contents["front_x"] = quantity("corner", corners, "place of a characteristic", "x", "m")
    return xr.Dataset(contents, attrs=about(readings))


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw velocity and stress as images with the contact at the bottom, and below them slip rate and traction of the contact."""
    scales = Scales(dataset)
    figure = sheet((7.2, 7.6), **place)
    axes: Any = figure.subplots(4, 1, sharex=True, height_ratios=(2.2, 2.2, 1.0, 1.0))
    unit, size = unit_shown(dataset.velocity, dataset.contact_slip_rate)
    velocity, stress = dataset.velocity.values / size, scales.stresses(dataset.stress.values)
    largest = float(np.abs(velocity).max()) or 1.0
    _draw_image(axes[0], dataset, velocity, f"velocity\n({unit})", cmap="RdBu_r", vmin=-largest, vmax=largest)
    _draw_image(axes[1], dataset, stress, narrow(scales.name_stress("shear stress")), cmap="viridis")
    time = dataset.contact_time.values / scales.time
    axes[2].plot(time, dataset.contact_slip_rate.values / size, color=GREEN)
    axes[2].set_ylabel(narrow(label(dataset.contact_slip_rate, (unit, size))))
    zero_line(axes[2])
    axes[3].plot(time, scales.stresses(dataset.contact_traction.values), color=VERMILLION)
    axes[3].set(ylabel=narrow(scales.name_stress(r"traction $\tau$")), xlabel=scales.clock, xlim=time[[0, -1]])
    if dataset.sizes["front"]:
        lines: Any = (Line2D([], [], color=INK, linewidth=0.6), Line2D([], [], color="white", linewidth=0.6, linestyle=(0, (4, 4))))
        text = "characteristic: a wave front from the contact"
        figure.legend([lines], [text], loc="outside lower center", handler_map={tuple: HandlerTuple(ndivide=1)}, handlelength=4)
    letter_panels(axes)
    set_title(figure, dataset.attrs["title"])
    figure.align_ylabels()
    return figure


def _draw_image(panel: Any, dataset: xr.Dataset, values: Floats, text: str, **colours: Any) -> None:
    """Draw values over time and x, with a scale of colours and the characteristics."""
    scales, time = Scales(dataset), dataset.time.values
    half, thickness = 0.5 * (time[1] - time[0]), dataset.attrs["thickness"]
    edges = (time[0] - half) / scales.time, (time[-1] + half) / scales.time, 0.0, thickness / scales.place
    image = panel.imshow(values.T, origin="lower", aspect="auto", extent=edges, **colours)
    panel.figure.colorbar(image, ax=panel, label=text, pad=0.01, aspect=12)
    # White dashes on a dark line can be seen on light and on dark parts of the image.
    for times in dataset.front_time.values:
        for look in ({"color": INK}, {"color": "white", "linestyle": (0, (4, 4))}):
            panel.plot(times / scales.time, dataset.front_x.values / scales.place, linewidth=0.6, **look)
    scales.set_places(panel, dataset)
