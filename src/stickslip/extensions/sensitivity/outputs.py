"""What a sensitivity may be of: a curve of a run or an energy at given times, or a number of one of its slip events."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stickslip.engine import SlipEvents
from stickslip.extensions.sensitivity.changes import Changes, changes_of, place_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import ENERGY_NAMES, QUANTITIES, TURNS, si_unit
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import Problem
from stickslip.solution import CURVES, Solution
from stickslip.solution.observables import EVENT_COLUMNS, event_columns

TIMED_ENERGIES = tuple(name for name in ENERGY_NAMES if not name.endswith("_in_layer") and name != "balance")
"""Energies of a run that are numbers at each time."""
DRIVE_CURVES = ("drive_rate", "drive_traction")
"""What is measured at the driver of any body."""
EVENT_ENERGIES = ("released", "work", "damped", "trapped", "heat")
"""Energies of a slip event."""
WITHOUT_SLOPE = ("pulses", "phase", "amplification", "start_row", "start_offset", "balance")
"""Columns of events that have no derivative: whole numbers, rests of a division, and what is zero or follows another rule."""
AT_BEGIN = ("start", "recurrence", "traction_before")
"""Columns of events that are known when an event begins, and do not change with what follows."""
EVENT_NUMBERS = tuple(name for name in (*EVENT_COLUMNS, *EVENT_ENERGIES) if name not in WITHOUT_SLOPE)
"""The numbers of an event."""


class Reading(NamedTuple):
    """What a run gives: values (SI), the number of changes of the contact up to each, and all changes."""

    values: Floats
    before: Floats
    changes: Changes


@dataclass(frozen=True)
class CurveAtTimes:
    """A curve or an energy of a run at times (s)."""

    name: str
    times: Floats
    most_events: int | None = None
    """Runs do not stop because of events."""

    @property
    def last(self) -> float:
        """The time (s) that runs must reach."""
        return float(self.times.max())

    @property
    def words(self) -> str:
        """What it is called."""
        energy = " energy" if self.name in TIMED_ENERGIES and self.name not in ("work", "heat") else ""
        return self.name.replace("_", " ") + energy

    def unit(self, problem: Problem) -> str:
        """Return its SI unit."""
        if self.name in STATE_NAMES:
            return problem.friction.states[STATE_NAMES.index(self.name)].unit
        return si_unit("energy" if self.name in TIMED_ENERGIES else QUANTITIES[self.name].unit, problem.load_unit)

    def of(self, run: Solution) -> Reading | None:
        """Return the values of a run, or None if it does not last as long."""
        if run.history.span[1] < self.last:
            return None
        energies = self.name in TIMED_ENERGIES
        values = run.energy(self.times)[self.name].to_numpy() if energies else getattr(run, self.name)(self.times)
        changes = changes_of(run.history)
        return Reading(np.asarray(values, float), changes.until(place_of(run.history.find(self.times, "right"))), changes)


@dataclass(frozen=True)
class NumberOfEvent:
    """A number of one slip event of a run, that above a slip rate (m/s)."""

    name: str
    event: int
    rate: float
    last: float
    """The time (s) that runs reach."""
    most_events: int | None
    """The number of events after which they stop before."""

    @property
    def words(self) -> str:
        """What it is called."""
        return f"{self.name.replace('_', ' ')} of event {self.event}"

    def unit(self, problem: Problem) -> str:
        """Return its SI unit."""
        return si_unit("energy" if self.name in EVENT_ENERGIES else EVENT_COLUMNS[self.name].unit, problem.load_unit)

    def of(self, run: Solution) -> Reading | None:
        """Return the value of a run, or None if it has no such event."""
        events = SlipEvents.of(run.history, self.rate)
        if self.event >= len(events.pulses):
            return None
        one = events.some(slice(self.event - 1 if self.event else 0, self.event + 1))
        value = float(np.asarray(event_columns(run.history, one, energies=self.name in EVENT_ENERGIES)[self.name])[-1])
        if not (np.isfinite(value) and (one.is_over[-1] or self.name in AT_BEGIN)):
            return None
        piece = int(one.begin.piece[-1] if self.name in AT_BEGIN else one.end.piece[-1])
        changes = changes_of(run.history)
        return Reading(np.array([value]), changes.until(np.array([float(piece)])), changes)


Output = CurveAtTimes | NumberOfEvent


def curves_of(problem: Problem) -> tuple[str, ...]:
    """Return the names of all that has a value at each time of a run."""
    turns = ("surface_torque",) if problem.load_unit == TURNS else ()
    return (*CURVES, *STATE_NAMES[: len(problem.friction.states)], *DRIVE_CURVES, *turns, *TIMED_ENERGIES)
