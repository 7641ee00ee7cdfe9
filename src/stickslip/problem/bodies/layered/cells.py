"""Cut layers into cells of equal travel time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

MOST_CELLS = 4096
"""Largest number of cells (1) that layers are cut into."""
ROUNDING_OF_DIVISION = 1e-13
"""Errors (1) up to this size are those of the division, and count as none."""


class CellCut(NamedTuple):
    """Layers in cells of equal travel time: the number of cells of each layer, the time (s) of one, and the largest error (1).

    The error is that of the travel time of a layer, relative to this time.
    """

    counts: tuple[int, ...]
    time: float
    error: float


def cut_into_cells(times: ArrayLike, allowed: float, longest: float = math.inf) -> CellCut:
    """Cut layers with these travel times (s) into as few cells of equal time as the allowed relative error (1) permits.

    The travel time of all layers together stays what it is. A finite `longest` (s) is for layers with drag: every cell is then two
    halves, with a drag between them, that last at most so long together. Raises InputError if it takes more than MOST_CELLS cells.
    """
    if math.isinf(longest):
        return _cut(np.asarray(times, float), allowed, longest, MOST_CELLS)
    whole = _cut(np.asarray(times, float), allowed, longest, MOST_CELLS // 2)
    return CellCut(tuple(2 * count for count in whole.counts), 0.5 * whole.time, whole.error)


def _cut(given: Floats, allowed: float, longest: float, most: int) -> CellCut:
    total, best = float(given.sum()), CellCut((), 0.0, np.inf)
    if total > most * longest:
        raise InputError(
            f"drag needs more than {most} cells of two halves, each of at most {longest:.3g} s: allow more (drag_step)"
        )
    for number in range(len(given), most + 1):
        counts = np.maximum(np.rint(given * (number / total)), 1.0)
        time = total / float(counts.sum())
        error = float(np.max(np.abs(counts * time / given - 1.0)))
        if error < best.error and counts.sum() <= most and time <= longest:
            best = CellCut(tuple(counts.astype(int).tolist()), time, error if error > ROUNDING_OF_DIVISION else 0.0)
        if best.error <= allowed:
            return best
    if len(given) > most:
        raise InputError(f"{len(given)} layers are more than the {most} cells that there may be: join thin layers")
    raise InputError(
        f"travel times from {given.min():.3g} to {given.max():.3g} s: {most} cells of equal time give them with"
        f" a relative error of {best.error:.2g}, and {allowed:g} is asked for: allow more (travel_time_error), or join thin layers"
    )
