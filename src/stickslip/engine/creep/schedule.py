"""Decide when to try to leap over creep; how to leap is known to `stepper`, which is asked then."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from stickslip.engine.history.history import NO_LEAPS
from stickslip.engine.state.layout import Counts, Floats, Incoming
from stickslip.problem import EXACT_TRIPS, Problem, leaps_over

if TYPE_CHECKING:
    from stickslip.engine.creep.leaping_run import LeapingRun
    from stickslip.engine.creep.stepper import LeapStepper


@dataclass
class CreepLeaps:
    """Leaps of one run, with an error of slip of at most `tolerance` times the slip since the start.

    Whatever changes during a run is stored in its counts, and is restored with them: when to try next, and how many leaps there
    were.
    """

    problem: Problem
    tolerance: float
    patient: bool = False
    """If true, leap only after EXACT_TRIPS round trips with slip, so that a run that never creeps for long stays exact."""
    taken: list[tuple[float, ...]] = field(default_factory=list)
    """The rows of `History.creep`, one for each leap."""

    @cached_property
    def stepper(self) -> LeapStepper:
        """What leaps when the time has come; most runs end before that."""
        from stickslip.engine.creep.stepper import LeapStepper

        return LeapStepper(self.problem, self.tolerance, self.patient, self.taken)

    def begin(self, count: Counts) -> None:
        """Have the engine pause after the first round trip, or when slip has lasted."""
        if self.patient or leaps_over(self.problem) != "creep":
            count.creep_in, count.pause_for = EXACT_TRIPS if self.patient else 1, 1
            return
        count.pause_at = count.pause_for = 1

    def table(self, count: Counts) -> Floats:
        """Return the leaps so far, as in `History.creep`."""
        return np.array(self.taken[: count.creep_leaps]) if count.creep_leaps else NO_LEAPS.copy()

    def take_up(self, table: Floats) -> None:
        """Set the leaps of a run that is resumed."""
        self.taken[:] = [tuple(leap) for leap in table.tolist()]

    def are_due(self, count: Counts, last_trip: int) -> bool:
        """Return True if the engine has paused for an attempt to leap."""
        begins = count.source == 0 or (count.sparse == 1 and count.trip_from == count.length)
        return bool(count.pause_at <= count.trip <= last_trip and begins and count.ready == Incoming.NONE)

    def at_row_end(self, run: LeapingRun) -> None:
        """Leap if there is creep, and set when to try again: see `LeapStepper.at_row_end`."""
        self.stepper.at_row_end(run)
