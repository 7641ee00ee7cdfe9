"""Figures of the inside of the slab: velocity and stress over time, and the field across the slab at given times.

The datasets of the field and the scales of the axes serve the film, too. The slab is drawn as in the paper: the contact below, the
driver above. Thin lines are where layers meet. A second side of the contact is below it, with its driver at the bottom.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from stickslip.figures.panels import add_legend, letter_panels, set_title, zero_line
from stickslip.figures.runs.asked import DRAWN_KINDS
from stickslip.figures.sheet import sheet
from stickslip.figures.style import (
    GREEN,
    GREY,
    INK,
    VERMILLION,
    clock,
    curve_quantity,
    label,
    narrow,
    nearly_flat,
    quantity,
    shown,
    styled,
    time_unit,
    title_of,
    unit_shown,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.given import PLACE
from stickslip.foundation.names import QUANTITIES, name_of, readable_unit, si_unit
from stickslip.foundation.place import Place
from stickslip.solution import choose_interval, fronts_of
from stickslip.solution.observables import extent_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution import Curve, Readings

DISPLACEMENT_ROUNDING = 64.0
"""Bound on the rounding error of a difference of two displacements, in units in their last place."""
TIMES, CELLS = 900, 300
"""Numbers of cells of the images, in time and across the slab."""
COUNT, PLACES = 6, 1500
"""Default number of times, and number of points across the slab, enough for fronts to look sharp."""
MOST_CROSSINGS = 200
"""Characteristics that cross the body more often than this, all together, are left out: they would cover the image."""


def space_time_data(readings: Readings, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Return field, contact and characteristics from `start` to `end` (s), in SI.

    The default interval is that of `choose_interval`. Each characteristic is a line of corners in time and x, padded with NaN.
    Raises InputError for a block, and for times outside the run.
    """
    readings, start, end = choose_interval(readings, start, end)
    highest = extent_of(readings.problem).highest
    coarser = DRAWN_KINDS[readings.problem.body.structure].coarser
    contents = means(readings, np.linspace(start, end, TIMES // coarser + 1), places(readings, CELLS // coarser + 1))
    contents |= contact_variables(readings, start, end, ("slip_rate", "traction"))
    lines = fronts_of(readings, start, end)
    points = max((len(line) for line in lines), default=0)
    across = np.array([np.pad(line, (0, points - len(line)), constant_values=np.nan) for line in lines]).reshape(len(lines), points)
    contents["front_time"] = quantity(("front", "corner"), across, "time of a characteristic", "t", "s")
    corners = np.where(np.arange(points) % 2, highest, 0.0)
    contents["front_x"] = quantity("corner", corners, "place of a characteristic", "x", "m")
    return xr.Dataset(contents, attrs=about(readings))


@styled
def draw_space_time(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw velocity and stress as images with the contact at the bottom, and below them slip rate and traction of the contact."""
    scales = Scales(dataset)
    figure = sheet((7.2, 7.6), **place)
    axes: Any = figure.subplots(4, 1, sharex=True, height_ratios=(2.2, 2.2, 1.0, 1.0))
    unit, size = unit_shown(dataset.velocity, dataset.contact_slip_rate)
    velocity, stress = dataset.velocity.values / size, scales.stresses(dataset.stress.values)
    largest = float(np.abs(velocity).max()) or 1.0
    _draw_image(axes[0], dataset, velocity, f"{scales.name('velocity')}\n({unit})", cmap="RdBu_r", vmin=-largest, vmax=largest)
    _draw_image(axes[1], dataset, stress, narrow(scales.name_stress(scales.name("stress"))), cmap="viridis")
    time = dataset.contact_time.values / scales.time
    axes[2].plot(time, dataset.contact_slip_rate.values / size, color=GREEN)
    axes[2].set_ylabel(narrow(label(dataset.contact_slip_rate, (unit, size))))
    zero_line(axes[2])
    axes[3].plot(time, scales.stresses(dataset.contact_traction.values), color=VERMILLION)
    axes[3].set(ylabel=narrow(scales.name_stress(rf"{scales.name('traction')} $\tau$")), xlabel=scales.clock, xlim=time[[0, -1]])
    if _shows_fronts(dataset):
        lines: Any = (Line2D([], [], color=INK, linewidth=0.6), Line2D([], [], color="white", linewidth=0.6, linestyle=(0, (4, 4))))
        text = "characteristic: a wave front from the contact"
        figure.legend([lines], [text], loc="outside lower center", handler_map={tuple: HandlerTuple(ndivide=1)}, handlelength=4)
    letter_panels(axes)
    set_title(figure, dataset.attrs["title"])
    figure.align_ylabels()
    return figure


def _shows_fronts(dataset: xr.Dataset) -> bool:
    """Return True if there are characteristics, and not so many that they would cover the image."""
    return 0 < int(np.isfinite(dataset.front_time.values[:, 1:]).sum()) <= MOST_CROSSINGS


def _draw_image(panel: Any, dataset: xr.Dataset, values: Floats, text: str, **colours: Any) -> None:
    scales, time = Scales(dataset), dataset.time.values
    half, (lowest, highest) = 0.5 * (time[1] - time[0]), scales.places
    edges = (time[0] - half) / scales.time, (time[-1] + half) / scales.time, lowest, highest
    image = panel.imshow(values.T, origin="lower", aspect="auto", extent=edges, **colours)
    panel.figure.colorbar(image, ax=panel, label=text, pad=0.01, aspect=12)
    # White dashes on a dark line can be seen on light and on dark parts of the image.
    for times in dataset.front_time.values if _shows_fronts(dataset) else ():
        for look in ({"color": INK}, {"color": "white", "linestyle": (0, (4, 4))}):
            panel.plot(times / scales.time, dataset.front_x.values / scales.place, linewidth=0.6, **look)
    scales.set_places(panel)


def snapshots_data(readings: Readings, times: ArrayLike | None = None) -> xr.Dataset:
    """Return the field at the given times (s), in SI.

    The default is six times over the first round trip of the interval of `choose_interval`, or from the start of the event if that
    is a window. Raises InputError for a block, and for times outside the run.
    """
    if times is None:
        readings, start, end = choose_interval(readings, None, None)
        start = max(start, 0.0) if "event_slip" in readings.curves else start
        # 0.35, and not 0.5: fronts on their way back would else lie where others were on their way out.
        shares = (np.arange(COUNT) + 0.35) / COUNT
        times = start + shares * min(extent_of(readings.problem).two_way_time, end - start)
    moments = np.atleast_1d(np.asarray(times, float))
    return xr.Dataset(field_variables(readings, moments, places(readings, PLACES)), attrs=about(readings))


@styled
def draw_snapshots(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw three panels with the contact below and a line for each time, later ones darker."""
    scales = Scales(dataset)
    figure = sheet((7.2, 3.9), **place)
    axes: Any = figure.subplots(1, 3, sharey=True)
    unit, size = unit_shown(dataset.displacement)
    name = scales.name("displacement")
    since = dataset.displacement.attrs["long_name"].replace(f"{name} ", f"{name} $u$ ({unit})\n", 1)
    drawn = (
        (since, dataset.displacement.values / size),
        (label(dataset.velocity), shown(dataset.velocity)),
        (scales.name_stress(rf"{scales.name('stress')} $\sigma$"), scales.stresses(dataset.stress.values)),
    )
    colours = colormaps["viridis_r"](np.linspace(0.15, 1.0, dataset.sizes["time"]))
    for panel, (text, values) in zip(axes, drawn, strict=True):
        for time, line, colour in zip(dataset.time.values, values, colours, strict=True):
            panel.plot(line, dataset.x.values / scales.place, color=colour, linewidth=1.2, label=f"{time / scales.time:.3g}")
        panel.set_xlabel(text)
        scales.set_places(panel, named=panel is axes[0])
    letter_panels(axes)
    set_title(figure, dataset.attrs["title"])
    add_legend(axes[0], axes[0].get_legend_handles_labels()[0], scales.clock)
    return figure


def about(readings: Readings) -> dict[str, Any]:
    """Return attributes of a dataset: a title, the origin of its times, and where drivers are and layers meet (m)."""
    extent = extent_of(readings.problem)
    of_layers = {"lowest": extent.lowest, "boundaries": list(extent.boundaries)} if extent.boundaries or extent.lowest else {}
    return {"title": title_of(readings), "clock": clock(readings), "thickness": extent.highest, **of_layers}


def places(readings: Readings, count: int) -> Floats:
    """Return `count` evenly spaced distances from the contact (m), up to the driver; below 0 on the other side, if there is one."""
    extent = extent_of(readings.problem)
    return np.linspace(extent.lowest, extent.highest, count)


def field_variables(readings: Readings, time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return displacement, velocity and stress over time (s) and x (m), in SI.

    The displacement counts from the start of the run, or of the window's event.
    """
    found, start = readings.field(x, time[:, None]), readings.field(x, 0.0)
    since = "the event began" if "event_slip" in readings.curves else "$t=0$"
    unit = readings.problem.load_unit
    return axes_variables(time, x) | {
        "displacement": _inside("displacement", found.displacement - start.displacement, unit, f" since {since}"),
        "velocity": _inside("velocity", found.velocity, unit),
        "stress": _inside("stress", found.stress, unit),
    }


def _inside(name: str, values: Floats, load_unit: str, added: str = "") -> xr.Variable:
    """Return a quantity of the field over time and x, under its name with `added` behind it."""
    named = f"{name_of(name, load_unit)}{added}"
    return quantity(("time", "x"), values, named, QUANTITIES[name].symbol, si_unit(name, load_unit))


def means(readings: Readings, time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return velocity and stress in the cells between the given times (s) and distances (m), in SI.

    Velocity is the exact mean over the cell's time at its middle in x, stress the exact mean over its width at its middle in time.
    Both come from differences of the displacement, so that no pulse is lost between two times. The stress in layers is that at the
    middle, in place and in time.
    """
    when, where = 0.5 * (time[1:] + time[:-1]), 0.5 * (x[1:] + x[:-1])
    body, middle = readings.problem.body, readings.field(where, when[:, None])
    # Displacements are computed as differences from the slab sheared under its strength, and inherit the rounding of that shear.
    sheared = readings.problem.strength / body.stiffness
    velocity = _slope(readings.field(where, time[:, None]).displacement, np.diff(time)[:, None], 0, middle.velocity, sheared)
    stress, of_stress, modulus = middle.stress, "", DRAWN_KINDS[body.structure].stress_per_strain(body)
    if modulus is not None:
        of_stress = ", mean over a step of x"
        stress = modulus * _slope(readings.field(x, when[:, None]).displacement, np.diff(x), 1, stress / modulus, sheared)
    unit = readings.problem.load_unit
    return axes_variables(when, where) | {
        "velocity": _inside("velocity", velocity, unit, ", mean over a step of time"),
        "stress": _inside("stress", stress, unit, of_stress),
    }


def _slope(displacement: Floats, step: Floats, axis: int, middle: Floats, size: float) -> Floats:
    """Return mean slopes along an axis, replaced by the slope in the `middle` wherever rounding could explain their difference."""
    mean = np.diff(displacement, axis=axis) / step
    rounding = DISPLACEMENT_ROUNDING * np.spacing(max(float(np.abs(displacement).max()), size)) / step
    return np.where(np.abs(mean - middle) <= rounding, middle, mean)


def axes_variables(time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return the coordinates `time` (s) and `x` (m) of a dataset."""
    return {"time": curve_quantity("time", time, "time"), "x": quantity("x", x, "distance from the contact", "x", "m")}


def contact_variables(readings: Readings, start: float, end: float, names: Sequence[Curve]) -> dict[str, xr.Variable]:
    """Return the named curves of the contact against `contact_time` (s), in SI, with both limits at every shock."""
    time, curves = readings.curves_together(names, start, end)
    contents = {"contact_time": curve_quantity("contact_point", time, "time")}
    unit = readings.problem.load_unit
    for name, values in zip(names, curves, strict=True):
        contents[f"contact_{name.removeprefix('event_')}"] = curve_quantity("contact_point", values, name, unit)
    return contents


class Scales:
    """The units of the drawn times, distances and stresses of a dataset.

    Stresses that hardly change are drawn as changes from the first one.
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        time, stress, self.load_unit = dataset.time.values, dataset.stress.values, dataset.stress.attrs["units"]
        self.time_unit, self.time = time_unit(float(np.ptp(time)))
        lowest, highest = dataset.attrs.get("lowest", 0.0), dataset.attrs["thickness"]
        self.place_unit, self.place = readable_unit("m", max(highest, -lowest), of=PLACE)
        self.places = lowest / self.place, highest / self.place
        self.boundaries = np.array(dataset.attrs.get("boundaries", [])) / self.place
        self.offset = float(stress[0, 0]) if nearly_flat(stress.ravel()) else 0.0
        self.stress_unit, self.stress = readable_unit(self.load_unit, stress - self.offset)
        self.clock = f"{dataset.attrs['clock']} ({self.time_unit})"

    def name(self, quantity: str) -> str:
        """Return the name of a quantity for the body of the dataset."""
        return name_of(quantity, self.load_unit)

    def name_stress(self, name: str) -> str:
        """Return the axis label of a stress."""
        what = "change of\n" if self.offset else ""
        return f"{what}{name} ({self.stress_unit})"

    def stresses(self, values: Any) -> Floats:
        """Return stresses (Pa) in the unit, and from the origin, of the drawing."""
        return np.asarray((np.asarray(values, float) - self.offset) / self.stress)

    def set_places(self, axes: Axes, *, named: bool = True) -> None:
        """Set limits, and a label if `named`, of the axis across the slab, and draw where layers and sides meet."""
        axes.set_ylim(*self.places)
        for place in self.boundaries:
            axes.axhline(place, color=GREY, linewidth=0.7)
        if self.places[0] < 0.0:
            axes.axhline(0.0, color=INK, linewidth=1.2)
        if named:
            axes.set_ylabel(f"distance from\nthe contact $x$ ({self.place_unit})")
