"""Figure of the energy of a run, stacked against time: energy stored in the body, and energy lost from it since the start."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

from stickslip.figures.runs.slab_panels import seen, sheet
from stickslip.figures.style import BLUE, GREEN, INK, PURPLE, SKY, VERMILLION, letter, quantity, readable, styled, time_unit
from stickslip.observables.energy.balance import energies

if TYPE_CHECKING:
    from stickslip.solution.evaluation import Readings

TIMES = 800
"""Number of evenly spaced times; breakpoints of the run are added, up to as many."""

PARTS = {
    "elastic": ("elastic, above its minimum", BLUE),
    "kinetic": ("kinetic", GREEN),
    "radiated": ("radiated through the driver", SKY),
    "damped": ("damped", PURPLE),
    "heat": ("friction heat", VERMILLION),
}
"""The parts that are stacked, from below: name of the variable, text and colour."""


def data(readings: Readings, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Return the parts of the energy against time, and their total.

    Parameters
    ----------
    readings : Readings
        A run, or a window on one.
    start, end : float, optional
        The interval (s); by default the one that `figures.runs.slab_panels.seen` chooses.

    Returns
    -------
    xarray.Dataset
        The variables of `PARTS` and `total`, all in J/m^2 for a slab and in J for a block, along `time` (s). Heat, radiated and
        damped energy count from `start`; elastic energy is the excess over its minimum in the interval; kinetic energy is
        absolute. `total` is the elastic and kinetic energy at `start` plus the work of the driver since then, radiated energy
        included: for an exact run it is the sum of the parts.

    Raises
    ------
    InputError
        For times outside the run, and if the waves inside the slab are not known (a leap over creep).
    """
    readings, start, end = seen(readings, start, end)
    breaks = readings.breaks[(readings.breaks > start) & (readings.breaks < end)]
    time = np.union1d(np.linspace(start, end, TIMES), breaks if len(breaks) <= TIMES else [])
    found = energies(readings.history, readings.history.find(time, "right"))
    body = readings.problem.body
    unit = "J/m²" if body.has_waves else "J"
    parts = {name: values - values[0] for name, values in found.items() if name in ("radiated", "damped", "heat", "work")}
    parts |= {"elastic": found["elastic"] - found["elastic"].min(), "kinetic": found["kinetic"]}
    total = parts["elastic"][0] + parts["kinetic"][0] + parts["work"] + parts["radiated"]
    contents = {name: quantity("time", parts[name], text, "", unit) for name, (text, _) in PARTS.items()}
    contents["total"] = quantity("time", total, "initial energy plus work of the driver", "", unit)
    clock = "time since the event began" if "event_slip" in readings.curves else "time $t$"
    title = f"{type(body).kind.replace('-', ' ').capitalize()}, {type(readings.problem.friction).kind} friction"
    return xr.Dataset(contents, {"time": quantity("time", time, "time", "t", "s")}, {"title": title, "clock": clock})


@styled
def plot(readings: Readings, start: float | None = None, end: float | None = None) -> Figure:
    """Draw what `data` returns in a new pyplot figure, which a notebook or `pyplot.show()` displays."""
    return draw(data(readings, start, end), pyplot.figure())


@styled
def draw(dataset: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw the parts stacked, without those that are zero throughout, and the total as a dashed line."""
    figure = sheet(figure, (6.4, 3.8))
    axes: Any = figure.subplots()
    unit, size = readable(float(dataset.total.max()), dataset.total.attrs["units"])
    clock, second = time_unit(float(np.ptp(dataset.time.values)))
    time = dataset.time.values / second
    drawn = [name for name in PARTS if dataset[name].values.any()]
    areas = [dataset[name].values / size for name in drawn]
    axes.stackplot(
        time, *areas, labels=[PARTS[name][0] for name in drawn], colors=[PARTS[name][1] for name in drawn], linewidth=0.0
    )
    axes.plot(
        time, dataset.total.values / size, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), label=dataset.total.attrs["long_name"]
    )
    axes.set(xlabel=f"{dataset.attrs['clock']} ({clock})", ylabel=f"energy ({unit})", xlim=(time[0], time[-1]), ylim=(0.0, None))
    handles, names = axes.get_legend_handles_labels()
    # Reversed, the legend has the order of the stack.
    figure.legend(handles[::-1], names[::-1], loc="outside lower center", ncols=2)
    letter(axes, dataset.attrs["title"])
    return figure
