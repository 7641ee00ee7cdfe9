"""Figure of chains beside the slab: slip of the contact, how the difference falls with the number of blocks, and a front."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, letter_panels, panels, set_log_ticks
from stickslip.figures.style import BLUE, GREY, INK, LINE_COLOURS, VERMILLION, Numbers, axis_text, label, shown, styled, time_unit
from stickslip.figures.style import unit_shown as unit_of
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.chains.beside_slab import ChainBesideSlab

POINTS_OF_MOTION = 1_001
MOST_LINES = 4
"""Draw the motion of at most so many chains."""


@styled
def draw_beside_slab(study: ChainBesideSlab, **place: Unpack[Place]) -> Figure:
    """Draw slip against time, the difference against the number of blocks, and the slip rate of the contact or of the middle."""
    figure, grid = panels(1, 3, (10.2, 3.6), place)
    slip, difference, rate = grid[0]
    _draw_slip(slip, study)
    _draw_differences(difference, study)
    in_the_middle = not math.isnan(study.table.front.iloc[-1])
    _draw_rate(rate, study, in_the_middle)
    where = "slip rate in the middle" if in_the_middle else "slip rate at the contact"
    letter_panels(grid[0], ["slip at the contact", "chain against slab", where])
    handles = {text: mark for panel in grid[0] for mark, text in zip(*panel.get_legend_handles_labels(), strict=True)}
    add_legend(slip, list(handles.values()))
    return figure


def _counts(study: ChainBesideSlab) -> list[int]:
    """Return the numbers of blocks whose motion is drawn: the first ones, since later ones cannot be told from the slab."""
    return sorted(set(study.table.blocks))[:MOST_LINES]


def _draw_slip(axes: Axes, study: ChainBesideSlab) -> None:
    times = np.linspace(0.0, study.duration, POINTS_OF_MOTION)
    clock, second = time_unit(study.duration)
    exact = Numbers(study.slab.slip(times) - study.problem.initial_slip, {"units": "m", "long_name": "slip", "symbol": "u"})
    unit = unit_of(exact)
    for count, colour in zip(_counts(study), LINE_COLOURS, strict=False):
        found = study.slip(count, "whole", times)
        axes.plot(times / second, found / unit[1], color=colour, linewidth=1.0, label=f"{count} equal blocks")
    axes.plot(times / second, shown(exact, unit), color=INK, linestyle="--", label="slab")
    axes.set_xlabel(axis_text("time", "t", clock))
    axes.set_ylabel(label(exact, unit))


def _draw_differences(axes: Axes, study: ChainBesideSlab) -> None:
    table = study.table
    looks = (
        ("half", "difference", BLUE, "o", "half a mass at the contact"),
        ("whole", "difference", VERMILLION, "s", "equal masses"),
        ("whole", "difference_with_mass", GREY, "^", "equal masses, beside a slab with contact mass"),
    )
    for first, column, colour, mark, text in looks:
        rows = table[table.first_block == first]
        axes.loglog(rows.blocks, rows[column], mark + "-", color=colour, markersize=4.0, linewidth=1.0, label=text)
    axes.set(xlabel="number of blocks", ylabel="largest difference of slip (m)")
    set_log_ticks(axes, "x")


def _draw_rate(axes: Axes, study: ChainBesideSlab, in_the_middle: bool) -> None:
    slab = study.problem.body
    way = 0.5 * slab.thickness if in_the_middle else 0.0  # type: ignore[attr-defined]
    begins, ends = 0.0, study.duration
    if in_the_middle:
        arrives = float(study.slab.shocks.time.iloc[0]) + way / slab.wave_speed  # type: ignore[attr-defined]
        reach = 2.0 * float(study.table.airy_front.max())
        begins, ends = max(arrives - reach, 0.0), min(arrives + 2.0 * reach, study.duration)
    times = np.linspace(begins, ends, POINTS_OF_MOTION)
    clock, second = time_unit(ends)
    for count, colour in zip(_counts(study), LINE_COLOURS, strict=False):
        block = count // 2 if in_the_middle else 0
        axes.plot(times / second, study.runs[count, "whole"].at(times).slip_rate[:, block], color=colour, linewidth=1.0)
    exact = study.slab.field(way, times).velocity if in_the_middle else study.slab.slip_rate(times)
    axes.plot(times / second, exact, color=INK, linestyle="--")
    axes.set_xlabel(axis_text("time", "t", clock))
    axes.set_ylabel("slip rate $v$ (m/s)" if not in_the_middle else "velocity $v$ (m/s)")
