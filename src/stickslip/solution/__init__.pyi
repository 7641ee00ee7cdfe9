# What others take from solution. Each name is imported when it is first used; all else is the room's own.

from stickslip.solution.accessors import (
    known_to_pyplot,  # Return what was drawn; if it is a figure of its own, pyplot knows and shows it from now on.
)
from stickslip.solution.account import (
    Account,  # What is said of a run of a scenario when it is over.
    last_large_event,  # Return the row number of the last event whose slip, in either direction, is at least 99 % of the largest.
)
from stickslip.solution.evaluation import (
    CURVES,  # Quantities that every run can draw against time.
    Curve,  # The names of curves, as types.
    Readings,  # Values of a run at given times.
    times_of,  # Return times in s, given as numbers or as texts with a unit such as "3 ms".
)
from stickslip.solution.interval import (
    choose_interval,  # Return the run or a window on it, and the start and end (s) of the interval to be drawn.
    fronts_of,  # Return for each front between two times (s) the times when it is at the contact, at the driver, and so on in turn.
)
from stickslip.solution.solution import (
    Solution,  # A finished run.
)
from stickslip.solution.window import (
    Window,  # The run around a slip event.
)

__all__ = [
    "CURVES",
    "Account",
    "Curve",
    "Readings",
    "Solution",
    "Window",
    "choose_interval",
    "fronts_of",
    "known_to_pyplot",
    "last_large_event",
    "times_of",
]
