"""Film of a chain: slip and slip rate of its blocks, with those that move marked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from stickslip.extensions.chains.changes_between import window_of
from stickslip.figures.panels import add_legend, set_title, zero_line
from stickslip.figures.runs.animation import FRAMES, Stage, Told, check_animation, film
from stickslip.figures.style import BLUE, GREEN, GREY, VERMILLION, Numbers, label, shown, time_unit, unit_shown
from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.extensions.chains.run import ChainMotion, ChainRun

MOST_FRAMES = 100_000
MARGIN = 0.05
"""Room above and below all values, as a share of their range."""


def write_film(
    run: ChainRun, path: str | Path, window: tuple[Any, Any, Any], frames: int | None = None, progress: Told | None = None
) -> Path:
    """Write a film of an event, or between times (s); `window` is event, start and end. See `ChainPlots.animation`."""
    check_animation(Path(path), "animation:")
    wanted = FRAMES if frames is None else check_whole("plot.animation: frames", frames, 2, MOST_FRAMES)
    first, last, event = window_of(run, *window, where="plot.animation")
    motion = run.at(np.linspace(first, last, wanted))
    return film(stage(run, motion, event), wanted, Path(path), progress=progress)


def stage(run: ChainRun, motion: ChainMotion, event: int | None) -> Stage:
    """Return the `Stage` of a film of a motion, in an event or (None) in any part of the run."""

    def draw_stage(figure: Figure) -> tuple[Callable[[int], None], list[Artist]]:
        axes: Any = figure.subplots(2, 1, sharex=True)
        set_title(figure, run.title)
        moves = motion.slip_rate != 0.0
        slip = Numbers(motion.slip - motion.slip[0], {"units": "m", "long_name": "slip", "symbol": "u"})
        rate = Numbers(motion.slip_rate, {"units": "m/s", "long_name": "slip rate", "symbol": "v"})
        drawn = [_draw_profile(axes[0], slip, moves, BLUE), _draw_profile(axes[1], rate, moves, GREEN)]
        axes[0].plot(shown(slip)[-1], color=GREY, linewidth=0.8, linestyle=":", label="last frame")
        axes[1].set_xlabel("block")
        axes[1].xaxis.set_major_locator(MaxNLocator(integer=True))
        add_legend(axes[0], axes[0].get_legend_handles_labels()[0])
        unit, size = time_unit(float(motion.times[-1]))
        passed, second = time_unit(float(motion.times[-1] - motion.times[0]))
        clock = axes[0].set_title(" ", loc="left")

        def move(n: int) -> None:
            for show, _ in drawn:
                show(n)
            since = f", {(motion.times[n] - motion.times[0]) / second:.3f} {passed} in event {event}" if event is not None else ""
            clock.set_text(f"{motion.times[n] / size:.3f} {unit}{since}")

        return move, [*(artist for _, artists in drawn for artist in artists), clock]

    return draw_stage


def _draw_profile(axes: Axes, numbers: Numbers, moves: Any, colour: str) -> tuple[Callable[[int], None], list[Artist]]:
    """Draw the numbers of all blocks, in axes whose limits hold every frame, with marks on the blocks that move."""
    values: Floats = shown(numbers)
    marked = np.where(moves, values, np.nan)
    low, high = float(values.min()), float(values.max())
    margin = MARGIN * (high - low) or 1.0
    axes.set_ylim(low - margin, high + margin)
    axes.set_xlim(-0.5, values.shape[1] - 0.5)
    axes.set_ylabel(label(numbers, unit_shown(numbers)))
    zero_line(axes)
    (line,) = axes.plot(values[0], color=colour)
    (marks,) = axes.plot(marked[0], color=VERMILLION, linestyle="none", marker="o", markersize=3.5, label="blocks that move")

    def show(n: int) -> None:
        line.set_ydata(values[n])
        marks.set_ydata(marked[n])

    return show, [line, marks]
