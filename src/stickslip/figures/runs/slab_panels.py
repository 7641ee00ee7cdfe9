"""Shared by the figures of the inside of the slab: datasets of the field, and scales of the axes.

The slab is drawn as in the paper: the contact below, the driver above.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.figures.style import (
    Floats,
    clock,
    curve_quantity,
    nearly_flat,
    quantity,
    time_unit,
    title_of,
    unit_of,
)
from stickslip.observables.field import slab_of

if TYPE_CHECKING:
    from stickslip.solution.evaluation import Curve, Readings

ROUNDING = 64.0
"""Bound on the rounding error of a difference of two displacements, in units in their last place."""


def about(readings: Readings) -> dict[str, Any]:
    """Return attributes of a dataset: a title, the origin of its times, and the thickness (m) of the slab."""
    return {"title": title_of(readings), "clock": clock(readings), "thickness": slab_of(readings.problem).thickness}


def places(readings: Readings, count: int) -> Floats:
    """Return `count` evenly spaced distances from the contact (m), up to the driver."""
    return np.linspace(0.0, slab_of(readings.problem).thickness, count)


def snapshots(readings: Readings, time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return displacement, velocity and stress over time (s) and x (m), in SI.

    The displacement counts from the start of the run, or of the window's event.
    """
    found, start = readings.field(x, time[:, None]), readings.field(x, 0.0)
    since = "the event began" if "event_slip" in readings.curves else "$t=0$"
    dims = ("time", "x")
    return axes_variables(time, x) | {
        "displacement": quantity(dims, found.displacement - start.displacement, f"displacement since {since}", "u", "m"),
        "velocity": quantity(dims, found.velocity, "velocity", r"\dot u", "m/s"),
        "stress": quantity(dims, found.stress, "shear stress", r"\sigma", "Pa"),
    }


def means(readings: Readings, time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return velocity and stress in the cells between the given times (s) and distances (m), in SI.

    Velocity is the exact mean over the cell's time at its middle in x, stress the exact mean over its width at its middle in time.
    Both come from differences of the displacement, so that no pulse is lost between two times.
    """
    when, where = 0.5 * (time[1:] + time[:-1]), 0.5 * (x[1:] + x[:-1])
    body, middle = slab_of(readings.problem), readings.field(where, when[:, None])
    # Displacements are computed as differences from the slab sheared under its strength, and inherit the rounding of that shear.
    sheared = readings.problem.strength / body.stiffness
    velocity = _slope(readings.field(where, time[:, None]).displacement, np.diff(time)[:, None], 0, middle.velocity, sheared)
    strain = _slope(readings.field(x, when[:, None]).displacement, np.diff(x), 1, middle.stress / body.shear_modulus, sheared)
    dims = ("time", "x")
    return axes_variables(when, where) | {
        "velocity": quantity(dims, velocity, "velocity, mean over a step of time", r"\dot u", "m/s"),
        "stress": quantity(dims, body.shear_modulus * strain, "shear stress, mean over a step of x", r"\sigma", "Pa"),
    }


def _slope(displacement: Floats, step: Floats, axis: int, middle: Floats, size: float) -> Floats:
    """Return mean slopes along an axis, replaced by the slope in the `middle` wherever rounding could explain their difference."""
    mean = np.diff(displacement, axis=axis) / step
    rounding = ROUNDING * np.spacing(max(float(np.abs(displacement).max()), size)) / step
    return np.where(np.abs(mean - middle) <= rounding, middle, mean)


def axes_variables(time: Floats, x: Floats) -> dict[str, xr.Variable]:
    """Return the coordinates `time` (s) and `x` (m) of a dataset."""
    return {"time": curve_quantity("time", time, "time"), "x": quantity("x", x, "distance from the contact", "x", "m")}


def contact_variables(readings: Readings, start: float, end: float, names: Sequence[Curve]) -> dict[str, xr.Variable]:
    """Return the named curves of the contact against `contact_time` (s), in SI, with both limits at every shock."""
    contents: dict[str, xr.Variable] = {}
    for name in names:
        time, values = readings.curve(name, start, end)
        contents[f"contact_{name.removeprefix('event_')}"] = curve_quantity("contact_point", values, name)
    return contents | {"contact_time": curve_quantity("contact_point", time, "time")}


class Scales:
    """The units in which times, distances and stresses of a dataset are drawn.

    Stresses that hardly change are drawn as changes from the first one.
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        time, stress = dataset.time.values, dataset.stress.values
        self.time_unit, self.time = time_unit(float(np.ptp(time)))
        self.place_unit, self.place = unit_of("m", dataset.attrs["thickness"])
        self.offset = float(stress[0, 0]) if nearly_flat(stress.ravel()) else 0.0
        self.stress_unit, self.stress = unit_of("Pa", stress - self.offset)
        self.clock = f"{dataset.attrs['clock']} ({self.time_unit})"

    def name_stress(self, name: str) -> str:
        """Return the axis label of a stress."""
        what = "change of\n" if self.offset else ""
        return f"{what}{name} ({self.stress_unit})"

    def stresses(self, values: Any) -> Floats:
        """Return stresses (Pa) in the unit, and from the origin, in which they are drawn."""
        return np.asarray((np.asarray(values, float) - self.offset) / self.stress)

    def set_places(self, axes: Axes, dataset: xr.Dataset, *, named: bool = True) -> None:
        """Set limits, and a label if `named`, of the axis across the slab: the contact below, the driver above."""
        axes.set_ylim(0.0, dataset.attrs["thickness"] / self.place)
        if named:
            axes.set_ylabel(f"distance from\nthe contact $x$ ({self.place_unit})")
