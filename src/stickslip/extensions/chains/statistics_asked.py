"""What `gutenberg_richter` is asked: checked numbers, magnitudes on the grid of their bins, and those that count."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.extensions.chains.statistics_likelihood import EQUAL
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

ON_GRID = 1e-6
"""Magnitudes in bins may lie beside the grid by this share of a bin: texts of decimals do."""
SMALLEST_BIN = 1e-9
"""Width of the smallest bin, of the largest magnitude if that is above 1: places in smaller ones are lost to rounding."""


def between(ordered: Floats, least: float, most: float, width: float) -> Floats:
    """Return the ascending magnitudes from the smallest to the largest that are given, the middles of bins."""
    first = np.searchsorted(ordered, least - 0.5 * width, side="left")
    end = np.searchsorted(ordered, most + 0.5 * width, side="right")
    return ordered[first:end]


def on_grid(ordered: Floats, width: float) -> Floats:
    """Return magnitudes at the middles of their bins. Raises InputError if they are not rounded to a grid."""
    if not width:
        return ordered
    middle = ordered[len(ordered) // 2]
    place = (ordered - middle) / width
    off = np.abs(place - np.round(place))
    if float(off.max()) > max(ON_GRID, 1e-12 * float(np.abs(ordered).max()) / width):
        worst = ordered[int(off.argmax())]
        raise InputError(
            f"gutenberg_richter: magnitudes must lie {width:g} or multiples of it apart, as those rounded to bins do, but "
            f"{middle:.9g} and {worst:.9g} do not; give bin=0 for magnitudes that were not rounded"
        )
    return np.asarray(middle + np.round(place) * width)


def check_enough(excess: Floats, least: float, most: float, *, told: bool) -> None:
    """Raise InputError if magnitudes from `least` to `most` say nothing of a slope."""
    where = f"from magnitude {least:.6g} on" if math.isinf(most) else f"from magnitude {least:.6g} to {most:.6g}"
    how = "found by the largest curvature: give a completeness" if told else "as given: give a smaller completeness"
    if len(excess) < 2:
        raise InputError(
            f"gutenberg_richter: needs two events, and there {'is one' if len(excess) else 'are none'} {where} ({how})"
        )
    if excess[-1] - excess[0] <= EQUAL and (excess[0] <= EQUAL or abs(excess[0] - (most - least)) <= EQUAL):
        raise InputError(f"gutenberg_richter: all {len(excess)} events {where} have one magnitude, which says nothing of a slope")


def checked_bin(given: Any, magnitudes: Floats) -> float:
    """Return the width of bins, 0 of magnitudes that were not rounded. Raises InputError."""
    width = checked_number("gutenberg_richter", "bin", given)
    smallest = SMALLEST_BIN * max(1.0, float(np.abs(magnitudes).max()))
    if width < 0.0 or 0.0 < width < smallest:
        allowed = "0 or more" if width < 0.0 else f"0, for magnitudes that were not rounded, or {smallest:.2g} or more"
        raise InputError(f"gutenberg_richter: bin must be {allowed}, got {width:.6g}")
    return width


def checked_number(who: str, name: str, value: Any) -> float:
    """Return a finite number. Raises InputError, which begins with `who`."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{who}: {name} must be a number, got {shown(value)}") from None
    if not math.isfinite(found):
        raise InputError(f"{who}: {name} must be finite, got {found:g}")
    return found
