"""What a run gives: histories to evaluate, tables, energy, and what ended it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.solution.evaluation import Readings, check_size
from stickslip.solution.window import Window, window_around
from stickslip.trajectory.checkpoint import Checkpoint
from stickslip.trajectory.history import History
from stickslip.trajectory.status import Status
from stickslip.trajectory.tables import creep_note, creep_table, default_event_rate, events_table

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Readings):
    """A finished run. Times in s from the start of the run; arrays in, arrays of the same shape out.

    `side` ("left" or "right") picks the limit at a shock; the left limit at t = 0 is the initial state at rest.
    Times outside the run raise InputError. Tables are built when they are asked for.
    """

    problem: Problem
    duration: float
    rtol: float
    status: Status
    history: History
    checkpoint: Checkpoint | None = None
    """From where the run, or a longer one, can go on (`stickslip.resume`)."""
    events_wanted: int | None = None
    """Slip events after which the run was to stop."""
    creep_rtol: float | None = None
    """Tolerance of leaps over creep as it was asked for: None is automatic, 0 runs every round trip."""
    shortest_event: float | None = None
    """Events shorter than this (s) are lumped, as it was asked for: None is automatic, 0 lumps none."""
    lumping_note: str = ""
    """One line on automatic lumping; empty where it did not begin."""
    rounding_note: str = ""
    """One line on steps in which rounding in the law's formula is larger than the tolerance; empty where there are none."""

    @cached_property
    def events(self) -> pd.DataFrame:
        """Slip events, one row each: maximal intervals in which |v| exceeds the default event rate (see `catalogue`)."""
        return self.catalogue()

    def catalogue(self, event_rate: float | None = None, *, energies: bool = False) -> pd.DataFrame:
        """Slip events, one row each; columns and units in `stickslip.trajectory.tables`: EVENT_COLUMNS, and ENERGY_COLUMNS (J/m^2;
        block: J) with `energies`, which take their time.

        An event is a maximal interval with |v| above event_rate (m/s; default 1e-6 S (range of mu) / Z, for the block
        / sqrt(K m); 0 takes every slip).
        """
        rate = default_event_rate(self.problem) if event_rate is None else event_rate
        return events_table(self.history, rate, energies)

    def energetics(self, event_rate: float | None = None) -> pd.DataFrame:
        """Slip events, one row each, as seismologists account for them: parts of the energy (J/m^2; block: J), static and dynamic
        drop, overshoot, apparent stress, efficiencies.

        Columns and units in `stickslip.observables.energy.energetics.ENERGETICS_COLUMNS`; rows and event_rate (m/s) as in
        `catalogue`.
        """
        from stickslip.observables.energy.energetics import energetics_table

        return energetics_table(self.history, default_event_rate(self.problem) if event_rate is None else event_rate)

    def pulses(self, event_rate: float | None = None) -> pd.DataFrame:
        """Pulses of the slip events, one row each: times, slip, largest slip rate, smallest traction, fracture energy.

        Columns and units in `stickslip.observables.energy.pulses.PULSE_COLUMNS`; event_rate (m/s) as in `catalogue`.
        """
        from stickslip.observables.energy.pulses import pulses_table

        return pulses_table(self.history, default_event_rate(self.problem) if event_rate is None else event_rate)

    @cached_property
    def creep(self) -> pd.DataFrame:
        """Leaps over creep (`simulate(..., creep_rtol=...)`), one row each: start and end (s), start_row (whole round trips before
        it, without rounding), round_trips in it, error (bound, of the slip where it lands, m), time_error (the same in s: over the
        slip rate there, by how much what comes next may be early or late).

        Within a leap slip is an average over round trips: right to the error, true slip weaves around it by half of what it grows
        in a round trip. Slip rate, traction and load are averages too.
        """
        return creep_table(self.history)

    @property
    def creep_note(self) -> str:
        """One line on the leaps over creep; empty where there are none."""
        return creep_note(self.history.creep)

    def window(self, event: int | pd.Series = 0, before: float | None = None, after: float | None = None) -> Window:
        """The run around one slip event, in local time: seconds since the event began, sharp however late that is.

        event: a row number of `events` (negative ones count from the last), or a row of any `catalogue`.
        It shows the time from `before` the event to `after` its start (s; default: a tenth of its duration on either side).
        Raises InputError where there is no such event.
        """
        return window_around(self, self._row(event), before, after)

    def _row(self, event: int | pd.Series) -> pd.Series:
        if not isinstance(event, int | np.integer):
            return event
        count = len(self.events)
        if not -count <= event < count:
            raise InputError(f"window: no event {event}: the run has {count}" + (f", 0 to {count - 1}" if count else ""))
        return self.events.iloc[event]

    def energy(self, t: ArrayLike) -> xr.Dataset:
        """Energies at times t (s), as differences from the start: see `stickslip.observables.energy.balance`."""
        from stickslip.observables.energy.balance import energy

        return energy(self, t)

    def dataset(self, t: ArrayLike, x: ArrayLike | None = None) -> xr.Dataset:
        """Slip, slip rate, traction and load at times t (s, one-dimensional) as an xarray Dataset with units and provenance.

        With x (m from the contact, one-dimensional) also displacement, velocity and stress inside the slab, over time and x.
        Raises InputError for more than 2e7 values of a quantity.
        """
        from stickslip.io.netcdf import solution_dataset

        check_size(t, x)
        return solution_dataset(self, t, x)

    def save(self, path: str | Path) -> Path:
        """Write everything to a netCDF file, from which `stickslip.load` gives this solution back bit for bit."""
        from stickslip.io.netcdf import save

        return save(self, path)

    def plot(self, start: float | None = None, end: float | None = None) -> Figure:
        """Slip, slip rate, traction and load against time."""
        from stickslip.figures.runs.run import plot_run

        return plot_run(self, start, end)

    def _lines(self) -> list[tuple[str, str]]:
        problem, events = self.problem, self.events
        loading = ", ".join(f"{name.replace('_', ' ')} {text}" for name, text in problem.loading_texts.items())
        largest = f", largest slip {events.slip.max():.6g} m, peak rate {events.peak_rate.max():.6g} m/s" if len(events) else ""
        return [
            ("body", repr(problem.body)),
            ("friction", repr(problem.friction)),
            ("loading", f"{loading}, initial load {problem.load:.9g} {problem.load_unit}"),
            ("run", f"{self.duration:.6g} s, rtol {self.rtol:g}, {len(self.history)} pieces"),
            ("status", str(self.status)),
            ("events", f"{len(events)}{largest}"),
            ("shocks", f"{len(self.shocks)}"),
            ("selection", self.selection_note),
            *([("creep", self.creep_note)] if self.creep_note else []),
            *([("lumping", self.lumping_note)] if self.lumping_note else []),
            *([("rounding", self.rounding_note)] if self.rounding_note else []),
            *([("trapped", self.trapped_note)] if self.trapped_note else []),
            *([("horizon", self.horizon_note)] if self.horizon_note else []),
        ]

    @cached_property
    def trapped_note(self) -> str:
        """How much energy bounces in the slab in waves at the end of the run; empty for a block."""
        from stickslip.observables.energy.balance import trapped_note

        return trapped_note(self)

    @cached_property
    def horizon_note(self) -> str:
        """How long single events are predictable; empty where it is not known what becomes of an error (see `predictability`)."""
        from stickslip.observables.predictability import is_followed, predictability

        return predictability(self).text if is_followed(self.problem) else ""

    @cached_property
    def selection_note(self) -> str:
        """Whether the answer rests on the selection rule."""
        from stickslip.observables.rule_influence import selection_note

        return selection_note(self)

    def __repr__(self) -> str:
        return "\n".join(["stickslip Solution", *(f"  {name:<10}{text}" for name, text in self._lines())])

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{escape(text)}</td></tr>" for name, text in self._lines())
        return f"<table><caption>stickslip Solution</caption>{rows}</table>"
