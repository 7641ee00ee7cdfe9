"""A window on a run around one slip event, in local time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.solution.evaluation import Curve, Floats, Readings, check_size
from stickslip.trajectory.history import Epoch, History
from stickslip.trajectory.tables import shocks_table

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from stickslip.solution.solution import Solution

MARGIN = 0.1
"""Time shown on either side of an event, as a share of its duration."""


@dataclass(frozen=True, eq=False, repr=False)
class Window(Readings):
    """The run around a slip event. Times in s since the event began: exact to the rounding of these times, however late it is.

    No time since the start of the run enters in one number. `event` is the event's row of the catalogue; `before` and `after` (s)
    are what `curve` and `plot` show. Values can be read at any time within the run.
    """

    solution: Solution
    history: History
    event: pd.Series
    before: float
    after: float

    @property
    def problem(self) -> Problem:  # type: ignore[override]  # read only
        """The problem that was run."""
        return self.solution.problem

    @property
    def epoch(self) -> Epoch:
        """When the event begins: whole rows (round trips of a slab, periods of a block) since t = 0, and an offset in s."""
        return self.history.epoch

    @property
    def shown(self) -> tuple[float, float]:
        """Local times (s) from which and up to which it is drawn."""
        first, last = self.history.span
        return max(-self.before, first), min(self.after, last)

    @property
    def curves(self) -> tuple[Curve, ...]:
        """What there is to draw: that of a run, with the slip since the event began."""
        return ("event_slip", *super().curves[1:])

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """Shocks in the time that is shown: as `Solution.shocks`, in local time."""
        return shocks_table(self.history, *self.shown)

    def event_slip(self, t: ArrayLike) -> Floats:
        """Slip (m) since the event began, at local times t (s): with all its digits, however much has slipped before."""
        origin, _ = self._at(0.0, "right")
        at, shape = self._at(t, "right")
        return self.history.slipped_since(origin, at).reshape(shape)

    def energy(self, t: ArrayLike) -> xr.Dataset:
        """Energies at local times t (s), as differences from the start of the event: see `stickslip.observables.energy.balance`."""
        from stickslip.observables.energy.balance import energy

        return energy(self, t, origin=0.0)

    def dataset(self, t: ArrayLike, x: ArrayLike | None = None) -> xr.Dataset:
        """Slip since the event began, slip rate, traction and load at local times t (s), with units, provenance and the epoch.

        With x (m) also what is inside the slab: see `Solution.dataset`.
        """
        from stickslip.io.netcdf import window_dataset

        check_size(t, x)
        return window_dataset(self, t, x)

    def plot(self) -> Figure:
        """Slip since the event began, slip rate, traction and load against local time."""
        from stickslip.figures.runs.run import plot_run

        return plot_run(self)

    def __repr__(self) -> str:
        row, offset = self.epoch
        first, last = self.shown
        return f"stickslip Window: {first:g} to {last:g} s from the start of an event, which is {row} rows and {offset:.9g} s"


def window_around(solution: Solution, event: pd.Series, before: float | None, after: float | None) -> Window:
    """The window on an event; see `Solution.window`."""
    lasts = float(event.duration)
    history = solution.history.seen_from(Epoch(int(event.start_row), float(event.start_offset)))
    if math.isnan(lasts):
        lasts = float(history.end[-1])
    before = MARGIN * lasts if before is None else before
    after = lasts + MARGIN * lasts if after is None else after
    if not (0.0 <= before < math.inf and 0.0 < after < math.inf):
        raise InputError(f"window: before and after must be finite times in s, not negative, after positive; got {before}, {after}")
    return Window(solution, history, event, before, after)
