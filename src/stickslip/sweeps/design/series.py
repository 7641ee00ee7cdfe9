"""Curves over time that a sweep keeps for every member, sampled at the same times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.errors import InputError, nearest
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.evaluation import CURVES
from stickslip.solution.solution import Solution
from stickslip.sweeps.design.design import Design

Floats = NDArray[np.float64]
PREFIX = "series_"
"""Prefix of a curve's name among the results. It tells slip over time from the quantity `slip`, that of the whole run."""
TIME = "time"
"""Name of the dimension of the samples."""
LARGEST = 1_000_000
"""Largest number of samples of a curve, which limits its size to 8 MB for each member."""


@dataclass(frozen=True, eq=False)
class Series:
    """The curves of a solution that are kept, and the sampling times (s). Samples at a shock are right limits."""

    curves: tuple[str, ...]
    times: Floats

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the curves among the results."""
        return tuple(PREFIX + curve for curve in self.curves)

    def of(self, solution: Solution) -> dict[str, Floats]:
        """Return the samples of a solution by name, with NaN after the end of its run."""
        there = self.times <= solution.history.duration
        found = {}
        for curve, name in zip(self.curves, self.names, strict=True):
            values = np.full(len(self.times), np.nan)
            values[there] = getattr(solution, curve)(self.times[there])
            found[name] = values
        return found


def read_series(scenario: Scenario, design: Design, curves: Sequence[str], samples: int) -> Series | None:
    """Return the series of these curves, or None if there are no curves.

    `samples` is the number of times, evenly spaced from 0 s to the longest duration of any member. Raises InputError for an
    unknown or repeated curve, and for a number of samples out of range.
    """
    if not curves:
        return None
    allowed = [*CURVES, *(["state"] if scenario.problem.friction.state else [])]
    for curve in curves:
        if curve not in allowed:
            raise InputError(f"sweep: series {ascii(curve)[:60]} is unknown; {nearest(curve, allowed)}")
    if len(set(curves)) < len(curves):
        raise InputError("sweep: a series is given twice")
    check_whole("sweep: samples", samples, 2, LARGEST)
    durations = dict(zip(design.names, design.columns, strict=True)).get("run.duration")
    last = scenario.duration if durations is None else float(durations.max())
    return Series(tuple(curves), np.linspace(0.0, last, samples))
