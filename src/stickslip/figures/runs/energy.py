"""Figure of the energy of a run, stacked against time: energy stored in the body, and energy lost from it since the start."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr

from stickslip.figures.panels import add_legend, finish
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import (
    BLUE,
    GREEN,
    INK,
    PURPLE,
    SKY,
    VERMILLION,
    clock,
    curve_quantity,
    quantity,
    styled,
    time_unit,
    title_of,
)
from stickslip.foundation.names import for_readers, name_of, readable_unit
from stickslip.foundation.place import Place
from stickslip.solution import choose_interval
from stickslip.solution.observables import energies

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.solution import Readings

TIMES = 800
"""Number of evenly spaced times; breakpoints of the run are added, up to as many."""

PARTS_OF_ENERGY = {
    "elastic": ("elastic, above its minimum", BLUE),
    "kinetic": ("kinetic", GREEN),
    "radiated": ("radiated through the driver", SKY),
    "damped": ("damped", PURPLE),
    "heat": (name_of("heat"), VERMILLION),
}
"""The parts that are stacked, from below: name of the variable, text and colour."""


def energy_data(readings: Readings, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Return the parts of the energy against `time` (s), and their total, as a dataset (J/m^2 for a slab, J for a block).

    The interval from `start` to `end` (s) is by default that of `choose_interval`. Heat, radiated and damped energy count from
    `start`; elastic energy is the excess over its minimum in the interval; kinetic energy is absolute. `total` is the elastic and
    kinetic energy at `start` plus the work of the driver since then, radiated energy included: for an exact run it is the sum of
    the parts. Raises InputError for times outside the run, and if the waves inside the slab are not known (a leap over creep).
    """
    readings, start, end = choose_interval(readings, start, end)
    breaks = readings.breaks[(readings.breaks > start) & (readings.breaks < end)]
    time = np.union1d(np.linspace(start, end, TIMES), breaks if len(breaks) <= TIMES else [])
    found = energies(readings.history, readings.history.find(time, "right"))
    unit = for_readers(readings.problem.unit_of("energy"))
    parts = {name: found[name] - found[name][0] for name in ("radiated", "damped", "heat")}
    parts |= {"elastic": found["elastic"] - found["elastic"].min(), "kinetic": found["kinetic"]}
    work = found["work"] - found["work"][0]
    total = parts["elastic"][0] + parts["kinetic"][0] + work + parts["radiated"]
    contents = {name: quantity("time", parts[name], text, "", unit) for name, (text, _) in PARTS_OF_ENERGY.items()}
    contents["total"] = quantity("time", total, "initial energy plus work of the driver", "", unit)
    attributes = {"title": title_of(readings), "clock": clock(readings)}
    return xr.Dataset(contents, {"time": curve_quantity("time", time, "time")}, attributes)


@styled
def draw_energy(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure | Axes:
    """Draw the parts stacked, without those that are zero throughout, and the total as a dashed line."""
    axes = one_panel((6.4, 3.8), **place)
    unit, size = readable_unit(dataset.total.attrs["units"], dataset.total.values)
    time_name, second = time_unit(float(np.ptp(dataset.time.values)))
    time = dataset.time.values / second
    drawn = {name: look for name, look in PARTS_OF_ENERGY.items() if dataset[name].values.any()}
    if drawn:
        texts, colours = zip(*drawn.values(), strict=True)
        axes.stackplot(time, *(dataset[name].values / size for name in drawn), labels=texts, colors=colours, linewidth=0.0)
    dashed: Any = {"color": INK, "linewidth": 1.0, "linestyle": (0, (4, 2))}
    axes.plot(time, dataset.total.values / size, label=dataset.total.attrs["long_name"], **dashed)
    axes.set(xlabel=f"{dataset.attrs['clock']} ({time_name})", ylabel=f"energy ({unit})", xlim=time[[0, -1]], ylim=(0.0, None))
    # Reversed, the legend has the order of the stack.
    add_legend(axes, axes.get_legend_handles_labels()[0][::-1], own=place.get("ax") is not None)
    return finish(axes, dataset.attrs["title"], **place)
