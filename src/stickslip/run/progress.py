"""How far a run is, for whoever waits for it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, Self

from stickslip.run.session import RunInProgress

Doing = Literal["stuck", "creeping", "slipping"]


class Report(NamedTuple):
    """State of a run: simulated time and its end (s), slip events over and wanted, pieces of history, what the contact does.

    `pace` is simulated time per wall clock since the run was taken up, `left` the wall clock (s) that is left if it goes on like
    this; NaN where that is not known yet.
    """

    time: float
    duration: float
    events: int
    events_wanted: int | None
    pieces: int
    doing: Doing
    pace: float
    left: float


Progress = Callable[[Report], object]
"""Called now and then with a `Report`."""


@dataclass
class Reporter:
    """Makes reports of a run and hands them on."""

    tell: Progress
    duration: float
    events_wanted: int | None
    event_rate: float
    started: float = field(default_factory=time.monotonic)
    from_share: float | None = None
    from_time: float = 0.0

    @classmethod
    def of(cls, tell: Progress | None, duration: float, events_wanted: int | None, event_rate: float) -> Self | None:
        """None where nobody is to be told."""
        return None if tell is None else cls(tell, duration, events_wanted, event_rate)

    def report(self, run: RunInProgress, events: int) -> None:
        """Say how far the run is."""
        now = min(run.time, self.duration)
        share = max(now / self.duration, events / self.events_wanted if self.events_wanted else 0.0)
        if self.from_share is None:
            self.from_share, self.from_time = share, now
        took, done = time.monotonic() - self.started, share - self.from_share
        pace = (now - self.from_time) / took if took > 0 else float("nan")
        left = took * (1.0 - share) / done if done > 0 else float("nan")
        doing = self._doing(run)
        self.tell(Report(now, self.duration, events, self.events_wanted, run.forgotten + run.length, doing, pace, left))

    def _doing(self, run: RunInProgress) -> Doing:
        if run.count.mode == 0:
            return "stuck"
        return "slipping" if abs(run.state.rate_now) > self.event_rate else "creeping"
