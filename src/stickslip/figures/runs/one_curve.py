"""One quantity of a run against time, in a figure of one panel."""

from __future__ import annotations

from matplotlib import pyplot
from matplotlib.figure import Figure

from stickslip.figures.style import BLUE, letter, readable, styled, time_unit
from stickslip.io.netcdf import LONG_NAMES, units
from stickslip.solution.evaluation import Curve, Readings


@styled
def plot(readings: Readings, name: Curve, start: float | None = None, end: float | None = None) -> Figure:
    """Draw one of `readings.curves` from `start` to `end` (s) in a new pyplot figure."""
    first, last = readings.shown
    start, end = first if start is None else start, last if end is None else end
    time, values = readings.curve(name, start, end)
    unit, size = time_unit(end - start)
    value_unit, value_size = units(readings)[name].replace("m s-1", "m/s"), 1.0
    if name in ("traction", "load"):
        value_unit, value_size = readable(float(abs(values).max()), value_unit)
    figure = pyplot.figure(figsize=(6.4, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(time / size, values / value_size, color=BLUE)
    axes.set_ylabel(f"{name.replace('event_slip', 'slip in the event').replace('_', ' ')} ({value_unit})")
    axes.set_xlabel(f"time since the event began ({unit})" if "event_slip" in readings.curves else f"time $t$ ({unit})")
    letter(axes, LONG_NAMES[name])
    return figure
