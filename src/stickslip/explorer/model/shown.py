"""The times that the pictures of slab and energy show: the whole run, or those around the last large slip event of a long one."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.solution.evaluation import Readings
from stickslip.solution.interval import choose_interval
from stickslip.solution.solution import Solution
from stickslip.solution.window import Window


class Shown(NamedTuple):
    """An interval of a run from `start` to `end` (s), in the time of `readings`, which counts from `begin` (s after the start)."""

    readings: Readings
    start: float
    end: float
    begin: float

    @classmethod
    def of(cls, solution: Solution) -> Shown:
        """Return the interval to show of a run."""
        readings, start, end = choose_interval(solution, None, None)
        epoch = readings.history.epoch
        begin = epoch.trip * readings.history.round_trip_time + epoch.offset if isinstance(readings, Window) else 0.0
        return cls(readings, start, end, begin)
