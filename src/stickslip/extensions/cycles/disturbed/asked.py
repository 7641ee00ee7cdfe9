"""What is asked each kind of body whose runs are compared: where they can stand, and what waves and loads they carry there."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from stickslip.extensions.cycles.short_runs import PASSES_AT_ONCE
from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import BODY_KINDS, Problem, Stop

if TYPE_CHECKING:
    from stickslip.run import ExactRun

MOST_COMPARISONS = 2048
"""Two runs are compared no more often than this (1)."""


class ComparedKind(ABC):
    """The questions to a kind of body."""

    @abstractmethod
    def interval(self, run: ExactRun, duration: float) -> float:
        """Return the time (s) from one comparison to the next, in a run that lasts so long (s)."""

    @abstractmethod
    def lead(self, run: ExactRun, mark: int, interval: float) -> None:
        """Lead a run to a mark, the number of a place where it can stand, or to the first one behind. Raises InputError."""

    @abstractmethod
    def marks(self, run: ExactRun, interval: float) -> int:
        """Return the number of marks in an interval (s)."""

    @abstractmethod
    def where(self, run: ExactRun) -> tuple[int, ...]:
        """Return numbers that two runs must share to be compared, besides the way they slip; the first one is a mark, if any."""

    @abstractmethod
    def time(self, run: ExactRun) -> float:
        """Return the time (s) where a run stands."""

    @abstractmethod
    def standing(self, run: ExactRun) -> slice:
        """Return the pieces of the history whose waves are still to come back."""

    @abstractmethod
    def needed(self, run: ExactRun) -> int:
        """Return the first piece of the history that is still needed."""

    @abstractmethod
    def series(self, run: ExactRun) -> Floats:
        """Return these waves as polynomials: (waves, pieces, terms)."""

    @abstractmethod
    def add_waves(self, run: ExactRun, series: Floats) -> None:
        """Add polynomials of a lower degree to these waves."""

    def load(self, run: ExactRun) -> float:
        """Return the load of a rigid body; that of another one is among its waves."""
        return 0.0

    @abstractmethod
    def add_load(self, run: ExactRun, load: float, slip: float) -> None:
        """Add to the load of a rigid body, and what goes with it where its slip is another one (m)."""

    def borne(self, run: ExactRun, load: float, slip: float) -> float:
        """Return how much of a difference of loads the spring has where slip differs (m): without what rounding adds to it."""
        return load

    def has_load(self) -> bool:
        """Return True if the load of a rigid body counts."""
        return False

    def has_place(self, problem: Problem) -> bool:
        """Return True if it matters where the body is, beside its load."""
        return False


class KindWithWaves(ComparedKind):
    """Answers of all bodies with waves, whose runs stand at the ends of round trips."""

    def interval(self, run: ExactRun, duration: float) -> float:
        """Return a round trip, or several in a long run."""
        trip = run.problem.round_trip_time
        return trip * max(1, math.ceil(duration / trip / MOST_COMPARISONS))

    def lead(self, run: ExactRun, mark: int, interval: float) -> None:
        """Lead a run to the end of so many round trips; rest may be passed over."""
        while run.count.trip < mark:
            run.count.pause_at = mark
            advance(run)

    def marks(self, run: ExactRun, interval: float) -> int:
        """Return the number of round trips."""
        return round(interval / run.problem.round_trip_time)

    def where(self, run: ExactRun) -> tuple[int, ...]:
        """Return the number of round trips, and the last one that was not passed over."""
        return int(run.count.trip), int(run.store.trip[run.count.previous_to - 1])

    def time(self, run: ExactRun) -> float:
        """Return the time (s) of so many round trips."""
        return float(run.count.trip * run.problem.round_trip_time)

    def standing(self, run: ExactRun) -> slice:
        """Return the pieces of the last round trip."""
        return slice(int(run.count.previous_from), int(run.count.previous_to))

    def needed(self, run: ExactRun) -> int:
        """Return the first piece of the last round trip."""
        return int(run.count.previous_from)

    def add_load(self, run: ExactRun, load: float, slip: float) -> None:
        """Add nothing."""


def advance(run: ExactRun) -> Stop:
    """Let a run go on for a while. Raises InputError if it cannot, or if it rests for ever."""
    code = Stop(run.advance(PASSES_AT_ONCE))
    if code not in (Stop.NONE, Stop.END_AHEAD, Stop.LOCKED, Stop.FINISHED) and not (code == Stop.FULL and run.grow()):
        raise InputError(f"lyapunov: the run ended at {brief(run.time, 's', 4)}: {run.solution(code).status}")
    if run.count.sparse == 1:
        raise InputError("lyapunov: of slabs without mass or states, under a law of slip, no disturbances are followed")
    if run.count.is_locked == 1:
        raise InputError("lyapunov: the contact comes to rest for ever, where disturbances neither grow nor tell anything")
    return code


COMPARED: ByKind[ComparedKind] = ByKind("stickslip.extensions.cycles.disturbed.kinds", BODY_KINDS)
"""What each kind of body answers."""
NO_SERIES = np.zeros((0, 0, 1))
"""The waves of a body without waves."""
