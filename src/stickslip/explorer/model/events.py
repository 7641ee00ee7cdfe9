"""The slip events and pulses of a run, found once for marks, numbers and sentence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from stickslip.observables.energy.pulses import PULSE_COLUMNS
from stickslip.solution.interval import last_large_event
from stickslip.solution.solution import Solution

MOST_EVENTS = 500
"""Number of slip events up to which pulses are looked for: each takes a millisecond, and single ones of more would not be seen."""


@dataclass(frozen=True)
class Found:
    """What was found in a run, as the solution gives it: slip events, shocks and, if there are few events, their pulses."""

    solution: Solution
    events: pd.DataFrame
    shocks: pd.DataFrame
    pulses: pd.DataFrame

    @classmethod
    def of(cls, solution: Solution) -> Found:
        """Look for events, shocks and pulses."""
        few = len(solution.events) <= MOST_EVENTS
        pulses = solution.pulses() if few else pd.DataFrame(columns=list(PULSE_COLUMNS), dtype=float)
        return cls(solution, solution.events, solution.shocks, pulses)

    @property
    def largest(self) -> pd.Series | None:
        """The row of the last event whose slip is at least 99 % of the largest; None if there is none."""
        return self.events.iloc[last_large_event(self.events.slip.to_numpy(float))] if len(self.events) else None

    @property
    def arrest(self) -> float:
        """The time at which the largest event ends, s; NaN if it does not end within the run, or if there is none."""
        return float("nan") if self.largest is None else float(self.largest.end)

    @property
    def total_slip(self) -> float:
        """The slip from the start to the end of the run, m."""
        first, last = self.solution.slip(np.array(self.solution.history.span))
        return float(last - first)
