"""What a run gives: histories to evaluate, tables, energy, and what ended it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.errors import InputError, nearest
from stickslip.evolution.history import History, Moments, Side
from stickslip.evolution.status import Status
from stickslip.evolution.tables import creep_table, default_event_rate, events_table, shocks_table
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
Curve = Literal["slip", "slip_rate", "traction", "load", "state"]
CURVES: tuple[Curve, ...] = ("slip", "slip_rate", "traction", "load")


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """A finished run. Times in s from the start of the run; arrays in, arrays of the same shape out.

    `side` ("left" or "right") picks the limit at a shock; the left limit at t = 0 is the initial state at rest.
    Times outside the run raise InputError. Tables are built when they are asked for.
    """

    problem: Problem
    duration: float
    rtol: float
    status: Status
    history: History

    def _at(self, t: ArrayLike, side: Side) -> tuple[Moments, tuple[int, ...]]:
        time = np.asarray(t, float)
        return self.history.find(np.atleast_1d(time).ravel(), side), time.shape

    def slip(self, t: ArrayLike) -> Floats:
        """Slip u (m) at times t (s). Absolute: it starts at the initial slip."""
        at, shape = self._at(t, "right")
        return (self.problem.initial_slip + self.history.slipped(at)).reshape(shape)

    def slip_rate(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Slip rate v (m/s) at times t (s)."""
        at, shape = self._at(t, side)
        return self.history.rate(at).reshape(shape)

    def traction(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Friction on the contact tau (slab: Pa, block: N) at times t (s), positive where it opposes forward slip."""
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.friction(at)).reshape(shape)

    def load(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Load at times t (s): beta of eqs (12)-(13) for the slab (Pa), the spring's force for the block (N)."""
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.excess(at)).reshape(shape)

    def state(self, t: ArrayLike) -> Floats:
        """State of the friction law at times t (s), in the law's own unit (`FrictionLaw.state`).

        Raises InputError for a law without one.
        """
        if self.problem.friction.state is None:
            raise InputError(f"state: {type(self.problem.friction).__name__} has no state variable")
        at, shape = self._at(t, "right")
        return self.problem.friction.outer_state(self.history.state(at)).reshape(shape)

    @cached_property
    def events(self) -> pd.DataFrame:
        """Slip events, one row each: maximal intervals in which |v| exceeds the default event rate (see `catalogue`)."""
        return self.catalogue()

    def catalogue(self, event_rate: float | None = None) -> pd.DataFrame:
        """Slip events: start, end (s; NaN if unfinished), slip (m), peak_rate (m/s), peak_time (s), traction_drop and static_drop
        (Pa or N: friction before minus after, at rest if the rate falls on to zero, and the stiffness times the slip: G slip / h
        is the slab's mean over a round trip), pulses (maxima of |v| separated by minima below half the lower one).

        An event is a maximal interval with |v| above event_rate (m/s; default 1e-6 S (range of mu) / Z, for the block
        / sqrt(K m); 0 takes every slip).
        """
        return events_table(self.history, default_event_rate(self.problem) if event_rate is None else event_rate)

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """Jumps of the slip rate: time (s), cause (start, fold, echo, loading), rate_before and rate_after (m/s),
        traction_before and traction_after (Pa)."""
        return shocks_table(self.history)

    @cached_property
    def creep(self) -> pd.DataFrame:
        """Leaps over creep (`simulate(..., creep_rtol=...)`): start, end (s), round_trips, error (of slip where it lands, m).

        There the slip is an average over round trips, right to the error where one begins and to half a round trip's slip within
        it; slip rate, traction and load are averages too.
        """
        return creep_table(self.history)

    @cached_property
    def breaks(self) -> Floats:
        """Times (s) at which pieces of the history meet, 0 and the end included."""
        return np.append(self.history.start, self.history.end[-1:])

    def energy(self, t: ArrayLike) -> xr.Dataset:
        """Energies at times t (s), as differences from the start: see `stickslip.observables.energy`."""
        from stickslip.observables.energy import energy

        return energy(self, t)

    @property
    def curves(self) -> tuple[Curve, ...]:
        """What there is to draw: slip, slip rate, traction, load, and the state of a law that has one."""
        return CURVES if self.problem.friction.state is None else (*CURVES, "state")

    def curve(self, name: Curve, start: float = 0.0, end: float | None = None, points: int = 2000) -> tuple[Floats, Floats]:
        """Times (s) and values for drawing: dense where the solution varies, with both limits at every shock."""
        if name not in self.curves:
            raise InputError(f"curve: unknown quantity '{name}'; {nearest(name, self.curves)}")
        end = float(self.breaks[-1]) if end is None else end
        breaks = self.breaks[(self.breaks >= start) & (self.breaks <= end)]
        if len(breaks) > points:  # too many pieces to draw each: keep the shocks, and in every stretch where it is fastest
            shocks = np.asarray(self.shocks.time[self.shocks.time.between(start, end)])
            breaks = np.union1d(shocks, self._fastest(breaks, points)) if len(shocks) <= points else self._fastest(breaks, points)
        inside = [np.linspace(a, b, 8) for a, b in pairwise(breaks)]
        right = np.unique(np.concatenate([np.linspace(start, end, points), breaks, *inside]))
        time = np.concatenate([breaks, right])
        order = np.argsort(time, kind="stable")  # left limits first
        if name in ("slip", "state"):  # continuous
            return time[order], getattr(self, name)(time)[order]
        evaluate = getattr(self, name)
        values = np.concatenate([evaluate(breaks, side="left"), evaluate(right)])
        return time[order], values[order]

    def _fastest(self, times: Floats, groups: int) -> Floats:
        """Of so many groups of times the one of each at which the slip rate is largest."""
        speed = np.abs(self.slip_rate(times))
        starts = np.unique(np.linspace(0, len(times) - 1, groups).astype(int))
        return np.array([times[a + int(np.argmax(speed[a:b]))] for a, b in pairwise([*starts.tolist(), len(times)])])

    def dataset(self, t: ArrayLike) -> xr.Dataset:
        """Slip, slip rate, traction and load at times t (s, one-dimensional) as an xarray Dataset with units and provenance."""
        from stickslip.storage import solution_dataset

        return solution_dataset(self, np.atleast_1d(np.asarray(t, float)))

    def save(self, path: str | Path) -> Path:
        """Write everything to a netCDF file, from which `stickslip.load` gives this solution back bit for bit."""
        from stickslip.storage import save

        return save(self, path)

    def plot(self, start: float = 0.0, end: float | None = None) -> Figure:
        """Slip, slip rate, traction and load against time."""
        from stickslip.figures.run import plot_run

        return plot_run(self, start, end)

    def _lines(self) -> list[tuple[str, str]]:
        problem, events = self.problem, self.events
        largest = f", largest slip {events.slip.max():.6g} m, peak rate {events.peak_rate.max():.6g} m/s" if len(events) else ""
        return [
            ("body", repr(problem.body)),
            ("friction", repr(problem.friction)),
            ("loading", f"pull rate {problem.pull_rate:.6g} m/s, initial load {problem.load:.9g} {problem.load_unit}"),
            ("run", f"{self.duration:.6g} s, rtol {self.rtol:g}, {len(self.history)} pieces"),
            ("status", str(self.status)),
            ("events", f"{len(events)}{largest}"),
            ("shocks", f"{len(self.shocks)}"),
            ("selection", self.selection_note),
            *([("creep", self._creep_note)] if len(self.creep) else []),
        ]

    @property
    def _creep_note(self) -> str:
        leaps, trips = len(self.creep), self.creep.round_trips.sum()
        return f"{leaps} leap{'s' * (leaps > 1)} over {trips} round trips, error of slip up to {self.creep.error.max():.1e} m"

    @cached_property
    def selection_note(self) -> str:
        """Whether the answer rests on the selection rule."""
        from stickslip.observables.choices import selection_note

        return selection_note(self)

    def __repr__(self) -> str:
        return "\n".join(["stickslip Solution", *(f"  {name:<10}{text}" for name, text in self._lines())])

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{escape(text)}</td></tr>" for name, text in self._lines())
        return f"<table><caption>stickslip Solution</caption>{rows}</table>"
