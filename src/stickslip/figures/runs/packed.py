"""Lines with many swings: thin where single ones can be seen, and their range or their peaks where they cannot."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

MANY, CYCLES, PACKED, SWING = 60, 250, 30, 0.05
"""Where more than MANY swings to and fro follow each other, each shorter than the time that is shown over PACKED, the line is thin.
More than CYCLES of them could not be seen singly, and a line through them would show teeth of its own: their range is drawn, or
their peaks. A swing has at least the share SWING of the range of all values."""
THIN = 0.7
"""Width (points) of such a thin line."""
RANGE, PEAKS = "range of swings too close together to draw", "peaks of bursts too close together to draw"
"""What a key says of this range, and of such peaks."""
BURSTS = 0.1
"""Swings that spend less than this share of the time in their upper half are bursts, as slip events are between long rests."""


def draw_line(axes: Axes, across: Floats, values: Floats, *, log: bool = False, **look: Any) -> None:
    """Draw a line over ascending numbers, and the range of its swings where they lie too close together to be seen.

    `log` says that the values will have a logarithmic axis. The look is that of the line, and the colour that of the range.
    """
    known = np.isfinite(values)
    place, height = across[known], np.log(values[known]) if log else values[known]
    longest = (float(np.ptp(place)) if place.size else 0.0) / PACKED
    turns = _turns(height, SWING * float(np.ptp(height))) if height.size else np.zeros(0, int)
    rest = np.array(values, float)
    for first, last in _packed(place[turns], longest):
        if last - first <= 2 * CYCLES:
            look = look | {"linewidth": THIN} | ({"zorder": 1.9} if "linestyle" in look else {})  # dashes on top would flicker
            continue
        begin, end = turns[first], turns[last]
        # What is left at the ends of the curve is a part of a swing.
        begin = 0 if place[begin] - place[0] < longest else begin
        end = len(place) - 1 if place[-1] - place[end] < longest else end
        _draw_packed(axes, place[begin : end + 1], height[begin : end + 1], turns[first : last + 1] - begin, look, log=log)
        rest[(across > place[begin]) & (across < place[end])] = np.nan
    axes.plot(across, rest, **look)


def _draw_packed(axes: Axes, place: Floats, height: Floats, turns: NDArray[np.intp], look: dict[str, Any], *, log: bool) -> None:
    """Draw the range between the turns of a part of a curve, or their peaks if they are bursts; `height` is that on the axis."""
    corners = np.unique(np.concatenate(([0], turns, [len(place) - 1])))
    lower, upper = sorted((turns[::2], turns[1::2]), key=lambda some: float(height[some].mean()))
    edges = [np.interp(place[corners], place[some], height[some]) for some in (lower, upper)]
    shown = [np.exp(edge) if log else edge for edge in edges]
    above = height > np.interp(place, place[corners], 0.5 * (edges[0] + edges[1]))
    if np.diff(place)[above[1:] & above[:-1]].sum() < BURSTS * np.ptp(place) and "linestyle" not in look:
        peaks = np.exp(height[upper]) if log else height[upper]
        axes.plot(place[upper], peaks, **(look | {"linestyle": "none", "marker": ".", "markersize": 2.0, "label": PEAKS}))
        return
    if "linestyle" not in look:  # of two ranges in one panel one is filled
        axes.fill_between(place[corners], *shown, color=look["color"], alpha=0.3, linewidth=0.0, label=RANGE)
    for edge in shown:
        axes.plot(place[corners], edge, **(look | {"linewidth": 0.8, "label": None}))


def _turns(values: Floats, least: float) -> NDArray[np.intp]:
    """Return the places where values turn between swings of at least `least`."""
    found, way, end = list[int](), 0, 0
    low = high = 0
    numbers = values.tolist()
    for k, value in enumerate(numbers):
        low, high = k if value < numbers[low] else low, k if value > numbers[high] else high
        if way >= 0 and numbers[high] - value > least:
            end, way, low = high, -1, k
        elif way <= 0 and value - numbers[low] > least:
            end, way, high = low, 1, k
        else:
            continue
        found.append(end)
    return np.array(found, np.intp)


def _packed(times: Floats, longest: float) -> Iterator[tuple[int, int]]:
    """Yield the first and the last place of each stretch of turns with more than MANY swings to and fro, none of them longer."""
    breaks = np.flatnonzero(np.diff(times) > longest)
    edges = zip([0, *(breaks + 1).tolist()], [*breaks.tolist(), len(times) - 1], strict=True)
    return ((first, last) for first, last in edges if last - first > 2 * MANY)
