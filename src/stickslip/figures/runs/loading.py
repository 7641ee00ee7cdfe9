"""Panel below the curves of a run that shows the pull rate or far stress of the driver, if it varies."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from stickslip.figures.panels import set_scale, zero_line
from stickslip.figures.runs.curves import fit_height
from stickslip.figures.style import GREY, INK, PALE, Floats, time_unit, unit_of
from stickslip.loading import LoadingHistory
from stickslip.problem.problem import MAY_VARY
from stickslip.solution.evaluation import Readings

PERIODS = 60.0
"""A tone with more periods than this is drawn as a band of its amplitude: single periods could not be seen."""
POINTS = 32
"""Points in a period of a tone, enough for a smooth line."""


def draw_loading(panel: Axes, readings: Readings, start: float, end: float) -> None:
    """Draw the varying field from `start` to `end` (s since the epoch of the readings).

    The axis is logarithmic if the field is positive and spans a factor of ten or more, as steps of the pull rate do.
    """
    size = time_unit(end - start)[1]
    fields = {name: getattr(readings.problem, name) for name in MAY_VARY}
    name, history = next((name, field) for name, field in fields.items() if isinstance(field, LoadingHistory))
    row, offset = readings.history.epoch
    begun = row * readings.history.round_trip_time + offset
    tone, swing = history.tone, abs(history.tone.amplitude)
    turns = (end - start) * tone.frequency / (2.0 * np.pi) if swing > 0.0 else 0.0
    is_band = turns > PERIODS
    time, values = _straight(history, start + begun, end + begun, 0.0 if is_band else turns)
    if not is_band:
        values = values + tone.amplitude * np.sin(tone.frequency * time + tone.phase)
    spread, what = swing if is_band else 0.0, name.replace("_", " ")
    unit, scale = unit_of("m/s" if name == "pull_rate" else "Pa", np.abs(values) + spread)
    time = (time - begun) / size
    if is_band:
        panel.fill_between(
            time, (values - swing) / scale, (values + swing) / scale, facecolor=PALE, edgecolor=GREY, label="range of the tone"
        )
    panel.plot(time, values / scale, color=INK, label=f"{what} without its tone" if is_band else None)
    low, high = float((values - spread).min()), float((values + spread).max())
    if low > 0.0 and high >= 10.0 * low:
        set_scale(panel, "y", log=True)
        fit_height(panel, [values / scale])
    elif low < 0.0 < high:
        zero_line(panel)
    panel.set_ylabel(f"{what}\n({unit})")


def _straight(history: LoadingHistory, start: float, end: float, turns: float) -> tuple[Floats, Floats]:
    """Return times (s since t = 0) and values of the straight segments between two times, with both limits at jumps.

    The points are dense enough to add a tone that makes the given number of `turns` between the two times.
    """
    segments = history.segments
    edges = [start, *(one.start for one in segments[1:] if start < one.start < end), end]
    first = sum(one.start <= start for one in segments[1:])
    parts = list(zip(segments[first:], pairwise(edges), strict=False))
    dense = [np.linspace(low, high, 2 + int(POINTS * turns * (high - low) / (end - start))) for _, (low, high) in parts]
    values = [one.at(time) for (one, _), time in zip(parts, dense, strict=True)]  # type: ignore[arg-type]
    return np.concatenate(dense), np.concatenate(values)
