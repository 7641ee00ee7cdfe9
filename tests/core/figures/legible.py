"""Texts of a figure: its labels, and whether they can be read: none is cut by the edge, and none covers another."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import Any

from matplotlib.figure import Figure

import stickslip as ss

SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
BLOCK = ss.SpringBlock(mass=2.8e12, stiffness=3.43e13, normal_force=1e14)
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
SLAB_PROBLEM = ss.Problem(SLAB, LAW, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
BLOCK_PROBLEM = ss.Problem(BLOCK, LAW, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
LOOP = ss.Problem(replace(SLAB, driver_impedance=0.0), LAW, pull_rate=2.6, initial_load=60e6)


SIZES = {"year": ss.YEAR, "day": 86_400.0, "s/m": 1.0} | {
    prefix + unit: size
    for unit in ("s", "m", "m/s", "Pa", "N", "J", "J/m²")
    for prefix, size in {"": 1.0, "T": 1e12, "G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9}.items()
}
"""Size in SI units of each unit that a label may name."""
UNIT = re.compile(rf"\(({'|'.join(map(re.escape, SIZES))})\)$")


def labels(figure: Figure) -> list[str]:
    """Return the axis labels that are shown."""
    return [text for axes in figure.axes if axes.axison for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def has_unit(text: str) -> bool:
    """Return True if a label ends with a unit, or names a number without one."""
    return bool(UNIT.search(text)) or text.startswith("friction coefficient")


def size_of(text: str) -> float:
    """Return the size, in SI units, of the unit that a label names."""
    found = UNIT.search(text)
    assert found is not None, text
    return SIZES[found.group(1)]


SLACK = 1.5
"""Points by which the boxes around two texts may overlap, and by which one may pass the edge: they are wider than the letters."""


def texts_drawn(figure: Figure) -> Iterator[Any]:
    """Yield the texts of a figure that has been drawn: titles, labels, numbers at ticks, other texts, and the key."""
    for axes in figure.axes:
        yield from (axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label, *axes.texts)
        for axis in (axes.xaxis, axes.yaxis):
            scale = axis.get_transform().transform  # logarithmic axes have ticks at powers of ten outside, too
            low, high = sorted(scale(axis.get_view_interval()))
            room = 1e-9 * (high - low)
            ticks = zip(scale(axis.get_majorticklocs()), axis.get_major_ticks(), strict=False)
            yield from (tick.label1 for place, tick in ticks if low - room <= place <= high + room)
            yield axis.get_offset_text()
    for legend in figure.legends:
        yield from legend.get_texts()
    if figure._suptitle is not None:
        yield figure._suptitle


def illegible(figure: Figure) -> list[str]:
    """Return a line for each text that is cut by the edge of the figure, and for each two that cover each other."""
    figure.draw_without_rendering()
    slack = SLACK * figure.dpi / 72.0
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts_drawn(figure) if text.get_text() and text.get_visible()]
    edge = figure.bbox
    cut = [
        f"{text!r} is cut"
        for text, box in boxes
        if min(box.x0 - edge.x0, box.y0 - edge.y0, edge.x1 - box.x1, edge.y1 - box.y1) < -slack
    ]
    covered = [
        f"{one!r} and {other!r} cover each other"
        for (one, first), (other, second) in combinations(boxes, 2)
        if min(first.x1, second.x1) - max(first.x0, second.x0) > slack
        and min(first.y1, second.y1) - max(first.y0, second.y0) > slack
    ]
    return cut + covered
