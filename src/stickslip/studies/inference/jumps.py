"""Jumps of a run between samples: a record tells their time only to the time between two samples."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.trajectory.history import Side

RAMP = 2
"""Number of samples over which a jump is spread at least, so that both samples beside it change as it moves."""
UNSURE = 1.0 / math.sqrt(24.0)
"""Standard deviation of these two samples, as a share of the height of the jump.

As a ramp over two samples moves by a share x of the time between them, one changes by x/2 and so does the other. With this standard
deviation they tell x with the standard deviation of a place that may be anywhere between them, 1/sqrt(12).
"""
REACH = 3
"""Number of samples beside the jump of a run among which the one of the data is looked for."""


class Jumps(NamedTuple):
    """Times of jumps (s), ascending, and their heights (after minus before)."""

    time: Floats
    height: Floats


def jumps_in(curve: Callable[[Floats, Side], Floats], breaks: Floats, least: float) -> Jumps:
    """Return the jumps of a curve that are higher than `least`; `curve` gives its values at times, from the left or the right."""
    height = curve(breaks, "right") - curve(breaks, "left")
    chosen = np.abs(height) > least
    return Jumps(breaks[chosen], height[chosen])


def spread(values: Floats, time: Floats, jumps: Jumps, width: int) -> Floats:
    """Return values at samples in which each jump is a ramp over `width` samples, with the jump in its middle.

    The values change steadily as a jump moves.
    """
    result = values.copy()
    for at, height in zip(jumps.time.tolist(), jumps.height.tolist(), strict=True):
        k = int(np.searchsorted(time, at)) - 1
        if not 0 <= k < len(time) - 1:
            continue
        near = slice(max(k - width // 2, 0), k + width // 2 + 2)
        away = (time[near] - at) / (width * (time[k + 1] - time[k]))
        share = np.maximum(0.5 - np.abs(away), 0.0)
        result[near] += np.where(away < 0.0, share, -share) * height
    return result


def unsure(time: Floats, data: Floats, jumps: Jumps) -> Floats:
    """Return the standard deviation that the unknown time of each jump adds at the two samples between which the data jump."""
    added = np.zeros(len(time))
    change = np.nan_to_num(np.diff(data))
    for at, height in zip(jumps.time.tolist(), jumps.height.tolist(), strict=True):
        k = int(np.searchsorted(time, at)) - 1
        if 0 <= k < len(change):
            first = max(k - REACH, 0)
            k = first + int(np.argmax(change[first : k + REACH + 1] * height))
            added[k : k + 2] += (UNSURE * height) ** 2
    return np.sqrt(added)
