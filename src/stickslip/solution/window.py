"""A window on a run around one slip event, in local time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.quantities import Quantity
from stickslip.problem import Problem
from stickslip.solution.accessors import Exports
from stickslip.solution.evaluation import Curve

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from stickslip.engine import Epoch, History

MARGIN_OF_EVENT = 0.1
"""Default time shown on either side of an event, as a share of its duration."""


@dataclass(frozen=True, eq=False, repr=False)
class Window(Exports):
    """The run around a slip event.

    Times are in s since the event began. They are exact to their own rounding, however late in the run the event is, because the
    time since the start of the run is never stored as a single number. `event` is the event's row of the catalogue. `before` and
    `after` (s) are the times around its start that `curve` and `plot` show; values can be read at any time within the run.
    """

    solution: Exports
    """The whole run."""
    history: History
    event: pd.Series
    before: float
    after: float

    @property
    def problem(self) -> Problem:  # type: ignore[override]  # read only
        """The problem that was run."""
        return self.solution.problem

    @property
    def title(self) -> str:
        """The title of the run."""
        return self.solution.title

    @property
    def epoch(self) -> Epoch:
        """The start of the event: whole rows (round trips of a slab, periods of a block) since t = 0, and an offset in s."""
        return self.history.epoch

    @property
    def shown(self) -> tuple[float, float]:
        """The first and the last local time (s) that figures show."""
        return max(-self.before, self.history.begun), min(self.after, self.history.span[1])

    @property
    def curves(self) -> tuple[Curve, ...]:
        """The names of the quantities to draw, as for a run, but with the slip since the event began."""
        return ("event_slip", *super().curves[1:])

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """The shocks within the time that is shown: the table of `Solution.shocks`, in local time."""
        from stickslip.engine import shocks_table

        return shocks_table(self.history, *self.shown)

    def event_slip(self, t: ArrayLike | None = None) -> Floats:
        """Return the slip since the event began (m) at local times t, or the last one.

        It has full precision however large the slip before it is.
        """
        origin, _ = self._at(0.0, "right")
        at, shape = self._at(t, "right")
        return self.history.slipped_since(origin, at).reshape(shape)

    def energy(self, t: ArrayLike) -> xr.Dataset:
        """Return the energies at local times t (s), as differences from the start of the event: see `Solution.energy`."""
        from stickslip.solution.observables.energy.balance import energy

        return energy(self.history, t, origin=0.0)

    def __repr__(self) -> str:
        row, offset = self.epoch
        first, last = self.shown
        return f"stickslip Window: {first:g} to {last:g} s from the start of an event, which is {row} rows and {offset:.9g} s"


BEFORE = Quantity("s", "time to show before the start of an event", at_least=0)
AFTER = Quantity("s", "time to show after the start of an event", above=0)


def window_around(
    solution: Exports, event: pd.Series, before: float | str | WithUnit | None, after: float | str | WithUnit | None
) -> Window:
    """Return the window on an event; see `Solution.window`."""
    from stickslip.engine import Epoch

    lasts = float(event.duration)
    history = solution.history.seen_from(Epoch(int(event.start_row), float(event.start_offset)))
    if math.isnan(lasts):
        lasts = float(history.end[-1])
    first = BEFORE.check("window", "before", MARGIN_OF_EVENT * lasts if before is None else before)
    last = AFTER.check("window", "after", lasts + MARGIN_OF_EVENT * lasts if after is None else after)
    return Window(solution, history, event, first, last)
