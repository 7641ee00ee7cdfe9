"""Choose the times of a run whose waves are shown: all of it, or those around its last large slip event."""

from __future__ import annotations

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.evaluation import Readings
from stickslip.solution.solution import Solution

LONG = 50
"""Of a run over more round trips than this, only the time around one slip event is shown: waves could not be seen otherwise."""


def choose_interval(readings: Readings, start: float | None, end: float | None) -> tuple[Readings, float, float]:
    """Return the run or a window on it, and the start and end (s) of the interval to be drawn.

    The interval is the one that is asked for. By default it is the whole run, or for a run of more than `LONG` round trips (of a
    slab; periods of a block) the last event whose slip is at least 99 % of the largest, in local time. Raises InputError if the
    interval is empty.
    """
    round_trip = readings.history.round_trip_time
    if isinstance(readings, Solution) and start is None and end is None and readings.duration > LONG * round_trip:
        slips = readings.events.slip.to_numpy(float)
        if len(slips):
            readings = readings.window(last_large_event(slips), before=0.25 * round_trip)
            end = min(readings.shown[1] + round_trip, readings.history.span[1])
    start, end = readings.shown[0] if start is None else start, readings.shown[1] if end is None else end
    if not start < end:
        raise InputError(f"figure: must end after it starts, at {start:g} s; got {end:g} s")
    return readings, start, end


def last_large_event(slips: Floats) -> int:
    """Return the row number of the last event whose slip is at least 99 % of the largest."""
    return int(np.flatnonzero(slips >= 0.99 * slips.max())[-1])
