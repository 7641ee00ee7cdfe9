"""Where the energy of a run is, stacked against time: what is in the body, and what has become of the rest since the start."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

from stickslip.bodies import ElasticSlab
from stickslip.figures.runs.slab_panels import seen, sheet
from stickslip.figures.style import BLUE, GREEN, INK, PURPLE, SKY, VERMILLION, letter, quantity, readable, styled, time_unit
from stickslip.observables.energy.balance import energies

if TYPE_CHECKING:
    from stickslip.solution.evaluation import Readings

TIMES = 800

PARTS = {
    "elastic": ("elastic, above its least here", BLUE),
    "kinetic": ("kinetic", GREEN),
    "radiated": ("radiated through the driver", SKY),
    "damped": ("damped", PURPLE),
    "heat": ("friction heat", VERMILLION),
}
"""What is stacked, from below: text and colour."""


def data(readings: Readings, start: float | None = None, end: float | None = None) -> xr.Dataset:
    """Parts of the energy from `start` to `end` (s), by default as `figures.runs.slab_panels.seen`; J/m^2, block: J.

    Heat, radiated and damped count from the start; elastic energy is shown above its least, kinetic as it is. `total` is what was
    there at the start and the work of the driver since, what is radiated included: for an exact run the sum of the parts.
    Raises InputError for times outside the run, and where the waves inside the slab are not known (a leap over creep).
    """
    readings, start, end = seen(readings, start, end)
    breaks = readings.breaks[(readings.breaks > start) & (readings.breaks < end)]
    time = np.union1d(np.linspace(start, end, TIMES), breaks if len(breaks) <= TIMES else [])
    found = energies(readings.history, readings.history.find(time, "right"))
    body = readings.problem.body
    slab = isinstance(body, ElasticSlab)
    unit = "J/m²" if slab else "J"
    parts = {name: values - values[0] for name, values in found.items() if name in ("radiated", "damped", "heat", "work")}
    parts |= {"elastic": found["elastic"] - found["elastic"].min(), "kinetic": found["kinetic"]}
    total = parts["elastic"][0] + parts["kinetic"][0] + parts["work"] + parts["radiated"]
    contents = {name: quantity("time", parts[name], text, "", unit) for name, (text, _) in PARTS.items()}
    contents["total"] = quantity("time", total, "at the start, and work of the driver", "", unit)
    clock = "time since the event began" if "event_slip" in readings.curves else "time $t$"
    title = f"{type(body).kind.replace('-', ' ').capitalize()}, {type(readings.problem.friction).kind} friction"
    return xr.Dataset(contents, {"time": quantity("time", time, "time", "t", "s")}, {"title": title, "clock": clock})


@styled
def plot(readings: Readings, start: float | None = None, end: float | None = None) -> Figure:
    """Draw that in a new pyplot figure: a notebook or `pyplot.show()` shows it."""
    return draw(data(readings, start, end), pyplot.figure())


@styled
def draw(dataset: xr.Dataset, figure: Figure | None = None) -> Figure:
    """The parts one above the other, those that are nothing left out; the total dashed."""
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
    figure.legend(handles[::-1], names[::-1], loc="outside lower center", ncols=2)  # as they lie above each other
    letter(axes, dataset.attrs["title"])
    return figure
