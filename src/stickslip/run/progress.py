"""Report the progress of a run to a callback."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self

from stickslip.foundation.formatting import about_time, in_unit, number

if TYPE_CHECKING:
    from stickslip.run.options import RunOptions
    from stickslip.run.solver import Solver

Doing = Literal["stuck", "creeping", "slipping"]


LONG_RUN = 200_000
"""Number of pieces of history from which a run is called long: some 0.1 GB in memory, and in a file."""


class Report(NamedTuple):
    """The progress of a run; as a text it is one line for people.

    Attributes
    ----------
    time, duration : float
        Simulated time so far and at the end of the run, s.
    events : int
        Number of slip events that are over.
    max_events : int or None
        Number of slip events after which the run stops, if there is one.
    pieces : int
        Number of pieces of history computed so far, including those that have been discarded.
    doing : {"stuck", "creeping", "slipping"}
        Present motion of the contact; it creeps while |v| does not exceed the slip rate that defines events.
    pace : float
        Simulated time per wall-clock time since the run was started or resumed; NaN while it is not known.
    left : float
        Wall-clock time left at this pace, s; NaN while it is not known.
    """

    time: float
    duration: float
    events: int
    max_events: int | None
    pieces: int
    doing: Doing
    pace: float
    left: float

    def __str__(self) -> str:
        length, unit = in_unit(self.duration)
        wanted = f" of {self.max_events}" if self.max_events else ""
        parts = [
            f"{number(self.time / length, 6)} of {number(self.duration / length, 6)} {unit}",
            f"{self.events}{wanted} slip event{'' if self.events == 1 and not wanted else 's'}",
            self.doing,
        ]
        if self.pieces >= LONG_RUN:
            parts.append(f"{number(self.pieces / 1e6, 3)} million pieces")
        if self.pace > 0.0:
            parts.append(f"{about_time(self.pace)} a second")
        if 1.0 <= self.left < math.inf:
            parts.append(f"{about_time(self.left)} left")
        return ", ".join(parts)


Progress = Callable[[Report], object]
"""A function that is called with a `Report` between two calls of the engine, some ten times a second."""


@dataclass
class Reporter:
    """Make reports on a run and pass them to a callback.

    `started` is the wall-clock time (s) at which the run was started or resumed; `from_share` and `from_time` (s) are the share
    of the run that was done, and the simulated time, at the first report.
    """

    tell: Progress
    duration: float
    max_events: int | None
    event_rate: float
    started: float = field(default_factory=time.monotonic)
    from_share: float | None = None
    from_time: float = 0.0

    @classmethod
    def of(cls, options: RunOptions, event_rate: float) -> Self | None:
        """Return a reporter, or None if there is no callback."""
        tell = options.progress
        return None if tell is None else cls(tell, options.duration, options.max_events, event_rate)

    def report(self, run: Solver[Any], events: int) -> None:
        """Call the callback with the progress of the run."""
        now = min(run.time, self.duration)
        share = max(now / self.duration, events / self.max_events if self.max_events else 0.0)
        if self.from_share is None:
            self.from_share, self.from_time = share, now
        took, done = time.monotonic() - self.started, share - self.from_share
        pace = (now - self.from_time) / took if took > 0 else float("nan")
        left = took * (1.0 - share) / done if done > 0 else float("nan")
        doing: Doing = "stuck" if run.fastest == 0.0 else "slipping" if run.fastest > self.event_rate else "creeping"
        self.tell(Report(now, self.duration, events, self.max_events, run.forgotten + run.length, doing, pace, left))
