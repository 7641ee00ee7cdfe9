"""Evaluation of a run at any time: values, shocks and curves. A whole run and a window on it share this interface."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.arguments import NamesAttributes, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.names import TURNS
from stickslip.foundation.quantities import Quantity
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.engine import History, Positions, Side
    from stickslip.solution.observables.asked import AtDriver, Field, ObservablesOfKind

Curve = Literal[
    "slip",
    "slip_rate",
    "traction",
    "load",
    "state",
    "second_state",
    "event_slip",
    "normal_load",
    "drive_rate",
    "drive_traction",
    "surface_torque",
]
LONG_HISTORY = 100_000
"""With more pieces than this, fewer values of each are evaluated for a curve."""
HAIR = 1e-12
"""Relative distance of the two limits at a jump of the normal load from the jump, whose time may be rounded."""
TIME = Quantity("s", "time")
CURVES: tuple[Curve, ...] = ("slip", "slip_rate", "traction", "load")
"""Quantities that every run can draw against time."""
AT_DRIVE: tuple[Curve, ...] = ("drive_rate", "drive_traction", "surface_torque")
"""Quantities at the driver: rate, and load, which is called surface torque where it turns."""


def times_of(t: ArrayLike) -> Floats:
    """Return times in s, given as numbers or as texts with a unit such as "3 ms". Raises InputError for anything else."""
    if isinstance(t, str) or (isinstance(t, list | tuple) and any(isinstance(one, str) for one in t)):
        texts = [t] if isinstance(t, str) else t
        found = np.array([TIME.check("solution", "time", one) for one in texts])
        return found[0] if isinstance(t, str) else found
    try:
        return np.asarray(t, float)
    except OverflowError:  # a whole number larger than any float
        raise InputError("solution: times must be finite numbers in s") from None
    except (TypeError, ValueError):
        raise InputError(f"solution: times must be numbers in s or texts with a unit such as '3 ms', got {shown(t)}") from None


class Readings(NamesAttributes):
    """Values of a run at given times.

    Slip, slip rate, traction, load and state are methods of the same form: they take times (s since `history.epoch`), a scalar or
    an array of any shape, and the `side` of the limit at a shock, "right" or "left", and return an array of that shape. Without a
    time they return the last value: that at the end of the run or of its window. They raise InputError for times outside
    the run.
    """

    problem: Problem
    history: History
    if TYPE_CHECKING:

        @property
        def title(self) -> str:
            """Title of the scenario, for figures; empty for a problem from Python."""

    @property
    def shown(self) -> tuple[float, float]:
        """The first and the last time (s) that figures show by default."""
        return self.history.begun, self.history.span[1]

    @property
    def _observables(self) -> ObservablesOfKind:
        """What the kind of body makes of the run."""
        from stickslip.solution.observables.asked import observables_of

        return observables_of(self.problem)

    def _at(self, t: ArrayLike | None, side: Side) -> tuple[Positions, tuple[int, ...]]:
        time = self._times(t)
        return self.history.find(np.atleast_1d(time).ravel(), side), time.shape

    def _times(self, t: ArrayLike | None) -> Floats:
        """Return times in s; None is the last one that is shown."""
        return times_of(self.shown[1] if t is None else t)

    def slip(self, t: ArrayLike | None = None) -> Floats:
        """Return the slip u (m) at times t, or the last one. It is absolute: it starts at the initial slip."""
        at, shape = self._at(t, "right")
        return (self.problem.initial_slip + self.history.slipped(at)).reshape(shape)

    def slip_rate(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the slip rate v (m/s) at times t."""
        at, shape = self._at(t, side)
        return self.history.rate(at).reshape(shape)

    def traction(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the friction traction tau on the contact (Pa, N or N m) at times t; positive if it opposes forward slip."""
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.friction(at)).reshape(shape)

    def load(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the load on the contact at times t: beta of eqs (12)-(13) of a slab (Pa), the spring's force of a block (N).

        A dashpot beside the spring adds c V to it, at the pull rate V: what it gives while the block rests.
        """
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.excess(at)).reshape(shape)

    def drive_rate(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the velocity of the face that the (first) driver holds (m/s) at times t; of a string the speed of its drive.

        It is the pull rate if the driver is rigid, and the rate of the machine if it is one.
        """
        found, shape = self._at_driver(t, side)
        return found.rate.reshape(shape)

    def drive_traction(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the load at the (first) driver (Pa, N or N m) at times t, as a sensor there measures it.

        It is positive if the driver pulls forwards: the stress at the far face of a slab, the force of a block's spring and of a
        dashpot beside it.
        """
        found, shape = self._at_driver(t, side)
        return found.load.reshape(shape)

    def surface_torque(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the torque at the drive of a body that turns (N m) at times t: `drive_traction`. Raises InputError for others."""
        if self.problem.load_unit != TURNS:
            kind = type(self.problem.body).__name__
            raise InputError(f"surface_torque: a {kind} does not turn; the load at its driver is drive_traction")
        return self.drive_traction(t, side)

    def _at_driver(self, t: ArrayLike | None, side: Side) -> tuple[AtDriver, tuple[int, ...]]:
        time = self._times(t)
        self.history.check_begun(time)
        return self._observables.at_driver(self.history, np.atleast_1d(time).ravel(), side), time.shape

    def normal_load(self, t: ArrayLike | None = None, side: Side = "right") -> Floats:
        """Return the normal load S on the contact at times t, also where it varies, in the unit of loads (Pa, N or N m)."""
        time, history = self._times(t), self.problem.normal_load
        if history is None:
            return np.full(time.shape, self.problem.normal)
        trip, offset = self.history.epoch
        beside = 1.0 + (HAIR if side == "right" else -HAIR)
        return history.at((trip * self.history.round_trip_time + offset + time) * beside)

    def state(self, t: ArrayLike | None = None) -> Floats:
        """Return the state variable of the friction law, in the law's own unit (`FrictionLaw.state`), at times t.

        Raises InputError if the law has no state variable.
        """
        return self._state(t, 0)

    def second_state(self, t: ArrayLike | None = None) -> Floats:
        """Return the second state variable of a law with two, as `state` returns the first."""
        return self._state(t, 1)

    def _state(self, t: ArrayLike | None, number: int) -> Floats:
        law = self.problem.friction
        if number >= len(law.states):
            which = "second state" if number else "state"
            raise InputError(f"{STATE_NAMES[number]}: {type(law).__name__} has no {which} variable")
        at, shape = self._at(t, "right")
        states = self.history.states(at)[: len(law.states)]
        seen = law.outer_state(np.array(states)) if len(states) > 1 else law.outer_state(states[0])[None]
        return np.asarray(seen[number]).reshape(shape)

    def field(self, x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
        """Return displacement (m), velocity (m/s) and shear stress (Pa) in the slab, at distances from the contact and times.

        `x` (m) and `t` (s) are broadcast together: `field(x, t[:, None])` has one row per time. `side` is the limit in time to take
        at a wave front; at the end of a run on layers it is the left one. Raises InputError for a block, and for `x` outside the
        body. See also `stickslip.solution.observables.field`.
        """
        from stickslip.solution.observables.field import field

        return field(self.history, getattr(self, self.curves[0]), x, t, side)

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """The jumps of the slip rate as a table.

        Columns: time (s); cause (start, fold, echo, loading, healing); rate_before and rate_after (m/s); traction_before and
        traction_after (Pa); rule (the selection rule; empty if the slip rate is unique without one).
        """
        from stickslip.engine import shocks_table

        return shocks_table(self.history)

    @property
    def breaks(self) -> Floats:
        """The times (s) of the ends of recorded pieces, including 0 and the end of the run."""
        return self.history.breaks

    @property
    def curves(self) -> tuple[Curve, ...]:
        """The names of the quantities to draw: slip, slip rate, traction, load, the states of the law, and what a drive measures.

        The last are the rate of the drive and the surface torque of a string; `curve` has them of other bodies, too.
        """
        return (*CURVES, *STATE_NAMES[: len(self.problem.friction.states)], *self.at_drive)

    @property
    def at_drive(self) -> tuple[Curve, ...]:
        """The names of the quantities that the drive of a string measures, far from the contact; none for other bodies."""
        is_far = self.problem.body.time_to_driver > 0.0
        return ("drive_rate", "surface_torque") if self.problem.load_unit == TURNS and is_far else ()

    def curve(self, name: Curve, start: float | None = None, end: float | None = None, points: int = 2000) -> tuple[Floats, Floats]:
        """Return times (s, ascending) and values of one quantity, one of `curves`, for drawing.

        The interval is by default that of `shown`. To so many evenly spaced `points` more are added at the breaks and between them,
        where the solution varies. A shock appears twice, with its left limit first. Raises InputError if the name is neither one of
        `curves`, nor drive_rate, drive_traction or surface_torque.
        """
        if name not in (*self.curves, *AT_DRIVE):
            raise InputError(f"curve: unknown quantity '{name}'; {nearest(name, self.curves)}")
        time, (values,) = self.curves_together((name,), start, end, points)
        return time, values

    def curves_together(
        self, names: Sequence[Curve], start: float | None = None, end: float | None = None, points: int = 2000
    ) -> tuple[Floats, list[Floats]]:
        """Return the times of `curve`, and the values of several quantities there: their times are looked for once."""
        start, end = (limit if one is None else float(times_of(one)) for one, limit in zip((start, end), self.shown, strict=True))
        breaks = self.breaks[(self.breaks >= start) & (self.breaks <= end)]
        breaks = np.union1d(breaks, self.history.echo_edges(start, end, points))
        if set(names) <= set(AT_DRIVE):
            from stickslip.solution.observables.driver_of_waves import fronts_at_driver

            fronts = self._observables.fronts_drawn(fronts_at_driver(self.history))
            breaks = fronts[(fronts >= start) & (fronts <= end)]
        many = len(breaks) > points
        inside = np.linspace(breaks[:-1], breaks[1:], 8 if len(breaks) < LONG_HISTORY else 3).ravel() if len(breaks) else breaks
        right = np.unique(np.concatenate([np.linspace(start, end, points), breaks, inside]))
        time = np.concatenate([breaks, right])
        order = np.argsort(time, kind="stable")  # stable: puts the left limits first
        time, values = time[order], [self._drawn(name, breaks, right)[order] for name in names]
        if not many:
            return time, values
        kept = _extremes(time, values, points)  # too many pieces to draw each
        return time[kept], [one[kept] for one in values]

    def _drawn(self, name: Curve, breaks: Floats, right: Floats) -> Floats:
        """Return the left limits of a quantity at breaks (s), and its right limits at times (s)."""
        evaluate = getattr(self, name)
        if name in ("slip", "event_slip", *STATE_NAMES):  # continuous: both limits are the same
            found: Floats = evaluate(np.concatenate([breaks, right]))
            return found
        return np.concatenate([evaluate(breaks, side="left"), evaluate(right)])


def _extremes(time: Floats, values: Sequence[Floats], intervals: int) -> NDArray[np.intp]:
    """Return the indices of the first, last, smallest and largest value of each quantity in so many equal intervals of time (s).

    A line through these points covers the same pixels as one through all of them, if an interval is no wider than a pixel.
    Source: Jugel et al. 2014, Proc. VLDB Endow. 7, 797.
    """
    edges = np.linspace(time[0], time[-1], intervals + 1)[1:-1]
    first = np.unique(np.concatenate(([0], np.searchsorted(time, edges))))
    first = first[first < len(time)]
    last = np.append(first[1:], len(time)) - 1
    kept = [first, last]
    for one in values:
        for way in (1.0, -1.0):
            rank = np.lexsort(
                (way * np.nan_to_num(one, nan=np.inf * way), np.searchsorted(first, np.arange(len(time)), side="right"))
            )
            kept.append(rank[first])
    return np.unique(np.concatenate(kept))
