"""One quantity of a run against time, in a figure of one panel."""

from __future__ import annotations

from matplotlib import pyplot
from matplotlib.figure import Figure

from stickslip.figures.panels import letter
from stickslip.figures.style import BLUE, clock, curve_label, readable, styled, system_title, time_unit
from stickslip.solution.evaluation import Curve, Readings


@styled
def plot(readings: Readings, name: Curve, start: float | None = None, end: float | None = None) -> Figure:
    """Draw one of `readings.curves` from `start` to `end` (s) in a new pyplot figure."""
    first, last = readings.shown
    start, end = first if start is None else start, last if end is None else end
    time, values = readings.curve(name, start, end)
    unit, size = time_unit(end - start)
    figure = pyplot.figure(figsize=(6.4, 3.0), layout="constrained")
    axes = figure.subplots()
    text, value_size = _label(readings, name, float(abs(values).max()))
    axes.plot(time / size, values / value_size, color=BLUE)
    axes.set_ylabel(text)
    axes.set_xlabel(f"{clock(readings)} ({unit})")
    letter(axes, system_title(readings.problem))
    return figure


def _label(readings: Readings, name: Curve, largest: float) -> tuple[str, float]:
    """Return the axis label of a curve and the size of its unit, which suits the largest value of a stress or force."""
    state = readings.problem.friction.state
    if name == "state" and state is not None:
        return f"state ({state.unit})", 1.0
    if name in ("traction", "load"):
        unit, size = readable(largest, readings.problem.load_unit)
        return curve_label(name, unit), size
    return curve_label(name), 1.0
