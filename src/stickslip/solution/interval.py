"""Choose the times of a run whose waves are shown, all or those around its last large slip event, and find its wave fronts."""

from __future__ import annotations

import numpy as np

from stickslip.engine import shocks_table
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.account import last_large_event
from stickslip.solution.evaluation import Readings
from stickslip.solution.observables.asked import observables_of
from stickslip.solution.solution import Solution
from stickslip.solution.window import Window

FAINT = 0.1
"""A characteristic ends when reflections at the driver leave less than this share of the wave: a fainter one cannot be seen."""
MOST_FRONTS = 60
"""If more fronts than this leave the contact none is returned: they could not be told apart."""


def fronts_of(readings: Readings, start: float, end: float) -> list[Floats]:
    """Return for each front between two times (s) the times when it is at the contact, at the driver, and so on in turn.

    It is empty for layers, where fronts split, and over so many round trips that their ways could not be told apart. Raises
    InputError for a block.
    """
    fronts = observables_of(readings.problem).fronts(readings.problem)
    if end - start > fronts.trips * fronts.two_way_time:
        return []
    origins = origins_of(readings, start, end, fronts.two_way_time)
    return [bounces_of(time, end, fronts.two_way_time, fronts.share) for time in origins]


def origins_of(readings: Readings, start: float, end: float, round_trip: float) -> Floats:
    """Return the times (s) of shocks, starts and ends of slip at the contact, from one round trip before `start` on.

    A time that is a whole number of round trips after an earlier one is left out: it is taken for an echo, on the same
    characteristic. The result is empty if more than `MOST_FRONTS` remain, which could not be told apart.
    """
    history = readings.history
    run = readings.solution if isinstance(readings, Window) else readings
    assert isinstance(run, Solution)
    events = run.events
    begin = history.seconds(events.start_row.to_numpy(), events.start_offset.to_numpy(float))
    shocks = shocks_table(history, start - round_trip, end).time.to_numpy(float)
    times = np.sort(np.concatenate([shocks, begin, begin + events.duration.to_numpy(float)]))
    times = times[(times >= start - round_trip) & (times <= end)]
    kept: list[float] = []
    for time in times:
        phases = (time - np.array(kept)) / round_trip
        if not (np.abs(phases - np.round(phases)) < 1e-6).any():
            kept.append(float(time))
    return np.array(kept if len(kept) <= MOST_FRONTS else [])


def bounces_of(time: float, end: float, round_trip: float, reflection: float) -> Floats:
    """Return the times (s) when a wave that leaves the contact at `time` is at the contact, at the driver, and so on in turn.

    The last is the first that is not before `end`, or earlier the last arrival at the driver of a wave not fainter than `FAINT`.
    """
    count = 1 + int(np.ceil(2.0 * (end - time) / round_trip))
    share = abs(reflection)
    if share < 1.0:
        trips = 0 if share == 0.0 else int(np.log(FAINT) / np.log(share))
        count = min(count, 2 + 2 * trips)
    return np.asarray(time + 0.5 * round_trip * np.arange(max(count, 2)))


LONG_VIEW = 50
"""Of a run over more round trips than this, only the time around one slip event is shown: waves could not be seen otherwise."""


def choose_interval(readings: Readings, start: float | None, end: float | None) -> tuple[Readings, float, float]:
    """Return the run or a window on it, and the start and end (s) of the interval to be drawn.

    The interval is the one that is asked for. By default it is the whole run, or for a run of more than `LONG_VIEW` round trips (of
    a slab, through all its layers; periods of a block) the last event whose slip is at least 99 % of the largest, in local time.
    Raises InputError if the interval is empty.
    """
    round_trip = readings.problem.body.longest_way
    if isinstance(readings, Solution) and start is None and end is None and readings.duration > LONG_VIEW * round_trip:
        slips = readings.events.slip.to_numpy(float)
        if len(slips):
            readings = readings.window(last_large_event(slips), before=0.25 * round_trip)
            end = min(readings.shown[1] + round_trip, readings.history.span[1])
    start, end = readings.shown[0] if start is None else start, readings.shown[1] if end is None else end
    if not start < end:
        raise InputError(f"figure: must end after it starts, at {start:g} s; got {end:g} s")
    return readings, start, end
