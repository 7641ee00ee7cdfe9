"""The figure of a planar slab: slip rate over the contact and time, and the motion in the middle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.colors import LogNorm

from stickslip.figures.panels import letter_panels
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREEN, INK, axis_text, styled, unit_of
from stickslip.solution.place import Place
from stickslip.solution.planar import PlanarSolution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DECADES = 4.0
"""Decades of slip rate that the colours show, below the largest."""


@styled
def draw(solution: PlanarSolution, **place: Unpack[Place]) -> Figure:
    """Draw the slip rate over y and time (for a plane at the middle of z), and below it slip and slip rate in the middle."""
    figure = sheet((7.2, 6.4), **place)
    axes: Any = figure.subplots(3, 1, sharex=True, height_ratios=(2.6, 1.0, 1.0))
    time_name, time_size = unit_of("s", solution.times)
    place_name, place_size = unit_of("m", solution.slab.y)
    times, size = solution.times / time_size, np.abs(solution.middle_line(solution.slip_rate))
    largest = float(size.max()) or 1.0
    image = axes[0].pcolormesh(
        times,
        solution.slab.y / place_size,
        np.ma.masked_less_equal(size.T, 0.0),
        norm=LogNorm(largest * 10.0**-DECADES, largest),
        cmap="magma",
        shading="nearest",
        rasterized=True,
    )
    figure.colorbar(image, ax=axes[0], label="slip rate (m/s)", extend="min")
    _mark_echoes(axes[0], solution, time_size)
    at = " at z = 0" if solution.slab.is_plane else ""
    axes[0].set_ylabel(axis_text(f"along the contact{at}", "y", place_name))
    axes[0].set_facecolor("0.93")  # the contact rests
    for axis, name, field, color in zip(
        axes[1:], ("slip", "slip rate"), (solution.slip, solution.slip_rate), (INK, GREEN), strict=True
    ):
        history = solution.middle_line(field)[:, solution.slab.shape[0] // 2]
        unit, scale = unit_of("m" if name == "slip" else "m/s", history)
        axis.plot(times, history / scale, color=color)
        axis.set_ylabel(f"{name} in the\nmiddle ({unit})")
        _mark_echoes(axis, solution, time_size)
    axes[-1].set_xlabel(axis_text("time", "t", time_name))
    letter_panels(axes)
    return figure


def _mark_echoes(axis: Any, solution: PlanarSolution, size: float) -> None:
    """Draw a thin line at each whole two-way travel time."""
    trip = solution.slab.body.two_way_time
    for n in range(1, int(solution.times[-1] / trip) + 1):
        axis.axvline(n * trip / size, color="0.6", linewidth=0.6, linestyle=":")
