"""The figure of a planar slab: slip rate over the contact and time, and the motion in the middle; and a film of the contact."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from numpy.typing import NDArray

from stickslip.extensions.planar.solution import PlanarSolution
from stickslip.figures.panels import add_legend, letter_panels, set_title, zero_line
from stickslip.figures.runs.animation import FRAMES, Stage, Told, film
from stickslip.figures.runs.curves import marks_in
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREEN, INK, axis_text, styled
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import PLACE
from stickslip.foundation.names import readable_unit
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

DECADES = 4.0
"""Decades of slip rate that the colours show, below the largest."""
RESTS = "0.93"
"""Colour of places at rest in maps of the slip rate."""


@styled
def draw_planar(solution: PlanarSolution, **place: Unpack[Place]) -> Figure:
    """Draw the slip rate over y and time (for a plane at the middle of z), and below it slip and slip rate in the middle."""
    figure = sheet((7.2, 6.4), **place)
    axes: Any = figure.subplots(3, 1, sharex=True, height_ratios=(2.6, 1.0, 1.0))
    time_name, time_size = readable_unit("s", solution.times)
    place_name, place_size = readable_unit("m", solution.slab.y, of=PLACE)
    times, size = solution.times / time_size, np.abs(solution.middle_line(solution.slip_rate))
    rate_name, rate_size = readable_unit("m/s", size, log=True)
    size = size / rate_size
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
    figure.colorbar(image, ax=axes[0], label=f"slip rate ({rate_name})", extend="min")
    _mark_echoes(axes[0], solution, time_size)
    at = " at z = 0" if solution.slab.is_plane else ""
    axes[0].set_ylabel(axis_text(f"along the contact{at}", "y", place_name))
    axes[0].set_facecolor(RESTS)
    for axis, name, field, color in zip(
        axes[1:], ("slip", "slip rate"), (solution.slip, solution.slip_rate), (INK, GREEN), strict=True
    ):
        history = solution.middle_line(field)[:, solution.slab.shape[0] // 2]
        unit, scale = readable_unit("m" if name == "slip" else "m/s", history)
        axis.plot(times, history / scale, color=color)
        axis.set_ylabel(f"{name} in the\nmiddle ({unit})")
        _mark_echoes(axis, solution, time_size)
    axes[-1].set_xlabel(axis_text("time", "t", time_name))
    letter_panels(axes)
    add_legend(axes[-1], marks_in(axes[-1]))
    set_title(figure, solution.title)
    return figure


def _mark_echoes(axis: Any, solution: PlanarSolution, size: float) -> None:
    """Draw a thin line at each whole two-way travel time."""
    trip = solution.slab.body.two_way_time
    for n in range(1, int(solution.times[-1] / trip) + 1):
        name = "waves from the contact are back from the driver (every two-way travel time)" if n == 1 else None
        axis.axvline(n * trip / size, color="0.6", linewidth=0.6, linestyle=":", label=name)


def animate(
    solution: PlanarSolution,
    path: str | Path,
    start: float | None = None,
    end: float | None = None,
    *,
    frames: int | None = None,
    progress: Told | None = None,
) -> Path:
    """Write a film of slip rate and slip: profiles along a line, maps of a plane. See `PlanarPlots.animation`."""
    times = solution.times
    begin, past = times[0] if start is None else start, times[-1] if end is None else end
    inside = np.flatnonzero((times >= begin) & (times <= past))
    wanted = FRAMES if frames is None else frames
    if len(inside) < 2 or wanted < 2:
        raise InputError(
            f"animation: needs at least 2 frames, of a run from {times[0]:g} to {times[-1]:g} s; got {wanted} frames from"
            f" {begin:g} to {past:g} s, where the run has {len(inside)}"
        )
    shown = inside[np.linspace(0, len(inside) - 1, min(wanted, len(inside))).round().astype(int)]
    return film(stage(solution, shown), len(shown), Path(path), progress=progress)


def stage(solution: PlanarSolution, shown: NDArray[np.intp]) -> Stage:
    """Return the `Stage` of a film of some frames, which are given by their numbers."""
    plane, (name, size) = solution.slab.is_plane, readable_unit("s", solution.times)

    def draw_stage(figure: Figure) -> tuple[Callable[[int], None], list[Artist]]:
        axes: Any = figure.subplots(*((1, 2) if plane else (2, 1)), sharex=True, sharey=plane)
        set_title(figure, solution.title)
        show, moving = (_draw_maps if plane else _draw_profiles)(figure, axes, solution, shown)
        clock = axes[0].set_title(" ", loc="left")

        def move(n: int) -> None:
            show(shown[n])
            clock.set_text(f"{solution.times[shown[n]] / size:.3f} {name}")

        return move, [*moving, clock]

    return draw_stage


def _draw_profiles(
    _: Figure, axes: Any, solution: PlanarSolution, shown: NDArray[np.intp]
) -> tuple[Callable[[int], None], list[Artist]]:
    """Draw slip rate and slip along a line in axes whose limits hold every frame."""
    place_name, place_size = readable_unit("m", solution.slab.y, of=PLACE)
    drawn = []
    fields = (("slip rate", solution.slip_rate, GREEN), ("slip", solution.slip, INK))
    for axis, (name, field, color) in zip(axes, fields, strict=True):
        unit, scale = readable_unit("m/s" if name == "slip rate" else "m", field[shown])
        (line,) = axis.plot(solution.slab.y / place_size, field[shown[0]] / scale, color=color)
        low, high = float(field[shown].min()) / scale, float(field[shown].max()) / scale
        margin = 0.05 * (high - low) or 1.0
        axis.set(ylim=(low - margin, high + margin), ylabel=f"{name} ({unit})", xlim=solution.slab.y[[0, -1]] / place_size)
        zero_line(axis)
        drawn.append((line, field, scale))
    axes[-1].set_xlabel(axis_text("along the contact", "y", place_name))

    def show(frame: int) -> None:
        for line, field, scale in drawn:
            line.set_ydata(field[frame] / scale)

    return show, [line for line, _, _ in drawn]


def _draw_maps(
    figure: Figure, axes: Any, solution: PlanarSolution, shown: NDArray[np.intp]
) -> tuple[Callable[[int], None], list[Artist]]:
    """Draw slip rate and slip over a plane in colours that hold for every frame."""
    place_name, place_size = readable_unit("m", solution.slab.y, of=PLACE)
    edges = [0.5 * sign * size / place_size for size in solution.slab.extent for sign in (-1.0, 1.0)]
    extent = np.array(edges) - np.repeat(solution.slab.spacing, 2) / (2.0 * place_size)
    rates, slips = np.abs(solution.slip_rate[shown]), solution.slip[shown]
    units = readable_unit("m/s", rates, log=True), readable_unit("m", slips)
    fields = np.abs(solution.slip_rate) / units[0][1], solution.slip / units[1][1]
    fastest = float(rates.max()) / units[0][1] or 1.0
    colours = (LogNorm(fastest * 10.0**-DECADES, fastest), Normalize(slips.min() / units[1][1], slips.max() / units[1][1]))
    labels = [f"{name} ({unit})" for name, (unit, _) in zip(("slip rate", "slip"), units, strict=True)]
    drawn = []
    for axis, field, norm, label in zip(axes, fields, colours, labels, strict=True):
        image = axis.imshow(np.zeros(solution.slab.shape).T, origin="lower", extent=tuple(extent), norm=norm, cmap="magma")
        figure.colorbar(image, ax=axis, label=label, location="bottom", extend="min" if axis is axes[0] else "neither")
        axis.set(xlabel=axis_text("along the contact", "y", place_name), facecolor=RESTS)
        drawn.append((image, field))
    axes[0].set_ylabel(axis_text("along the contact", "z", place_name))

    def show(frame: int) -> None:
        for image, field in drawn:
            image.set_data(np.ma.masked_less_equal(field[frame].T, 0.0) if image is drawn[0][0] else field[frame].T)

    return show, [image for image, _ in drawn]
