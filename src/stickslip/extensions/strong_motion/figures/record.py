"""Figure of one record: acceleration with the yield, relative velocity, and displacement below each other."""

from __future__ import annotations

import math
from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stickslip.extensions.strong_motion.analyses import CaseShaken, coupled_run, rigid_block
from stickslip.extensions.strong_motion.asked import SlidingAsked, read_length
from stickslip.extensions.strong_motion.motion import GroundMotion
from stickslip.figures.panels import add_legend, letter_panels, panels, zero_line
from stickslip.figures.style import BLUE, INK, VERMILLION, quantity, styled
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.place import Place

SHARE_AFTER = 0.05
"""Share of the length of a record that is drawn after it, if the block has stopped."""
POINTS = 20_000
"""Least number of points of the curves of velocity and displacement."""
OF_POLARITY = {1: BLUE, -1: VERMILLION}
"""Colours of the two polarities."""


def shaken_data(asked: SlidingAsked, motion: GroundMotion, factors: list[float], n: int) -> xr.Dataset:
    """Return the scaled acceleration (m/s^2), and relative velocity (m/s) and displacement (m) at the yield coefficient n."""
    scale = abs(factors[0])
    sample = motion.interval * np.arange(len(motion.acceleration))
    curves = [_motion(asked, CaseShaken(motion, factor), n) for factor in factors]
    end = max([(1.0 + SHARE_AFTER) * motion.lasts, *(stop for _, stop in curves)])
    time = np.linspace(0.0, end, max(POINTS, 2 * len(sample)))
    found = [curve(time) for curve, _ in curves]
    contents = {
        "acceleration": quantity("sample", scale * motion.acceleration, "acceleration of the ground", "a", "m/s^2"),
        "velocity": quantity(("polarity", "time"), [one[0] for one in found], "relative velocity", "v", "m/s"),
        "displacement": quantity(("polarity", "time"), [one[1] for one in found], "displacement", "D", "m"),
    }
    coordinates: dict[str, Any] = {
        "sample": quantity("sample", sample, "time", "t", "s"),
        "time": quantity("time", time, "time", "t", "s"),
        "polarity": ("polarity", [1 if factor > 0.0 else -1 for factor in factors]),
    }
    about = {"record": motion.name, "forward": float(asked.forward[n]), "backward": float(asked.backward[n])}
    return xr.Dataset(contents, coords=coordinates, attrs=about | {"analysis": asked.analysis})


def _motion(asked: SlidingAsked, case: CaseShaken, n: int) -> tuple[Any, float]:
    """Return a function of times that returns velocity and displacement, and the time (s) until which it is worth drawing."""
    if asked.analysis == "coupled":
        run = coupled_run(asked, case, n)
        last = run.history.span[1]

        def of_run(time: Floats) -> tuple[Floats, Floats]:
            inside = np.minimum(time, last)
            return run.slip_rate(inside), run.slip(inside)

        return of_run, 0.0
    block, _ = rigid_block(asked, case)
    moved = block.motion(GRAVITY * float(asked.forward[n]), GRAVITY * float(asked.backward[n]))
    return (lambda time: (moved.velocity(time), moved.displacement(time))), float(moved.pieces[-1, 0])


@styled
def draw_shaken(dataset: xr.Dataset, unit: str = "m", **place: Unpack[Place]) -> Figure:
    """Draw acceleration with the yield, relative velocity and displacement below each other."""
    figure, grid = panels(3, 1, (6.6, 6.0), place, sharex=True)
    shaking, moving, moved = grid[:, 0]
    size = read_length("sliding", unit)
    shaking.plot(dataset["sample"], dataset["acceleration"] / GRAVITY, color=INK, linewidth=0.7)
    forward, backward = dataset.attrs["forward"], dataset.attrs["backward"]
    for k, sign in enumerate(dataset["polarity"].values.tolist()):
        colour, name = OF_POLARITY[sign], "as it comes: slides while $-a$ exceeds the yield"
        name = name if sign > 0 else "opposite: slides while $a$ exceeds the yield"
        shaking.axhline(-sign * forward, color=colour, linewidth=1.0, linestyle="--", label=f"yield {forward:g} g, {name}")
        if math.isfinite(backward):
            shaking.axhline(sign * backward, color=colour, linewidth=1.0, linestyle=":", label=f"backward yield {backward:g} g")
        moving.plot(dataset["time"], dataset["velocity"][k] / size, color=colour, linewidth=1.0)
        moved.plot(dataset["time"], dataset["displacement"][k] / size, color=colour)
    for panel in (shaking, moving, moved):
        zero_line(panel)
    shaking.set_ylabel("acceleration $a$ (g)")
    moving.set_ylabel(f"relative velocity ({unit}/s)")
    moved.set_ylabel(f"displacement ({unit})")
    moved.set_xlabel("time $t$ (s)")
    letter_panels([shaking, moving, moved], [f"{dataset.attrs['record']}", f"{dataset.attrs['analysis']} sliding", "displacement"])
    add_legend(shaking, shaking.get_legend_handles_labels()[0])
    return figure
