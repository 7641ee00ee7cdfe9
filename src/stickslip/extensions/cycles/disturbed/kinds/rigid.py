"""Rigid bodies: their runs can stand at any time, and carry a load."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from stickslip.engine import TERMS
from stickslip.extensions.cycles.disturbed.asked import MOST_COMPARISONS, NO_SERIES, ComparedKind, advance
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem, Stop

if TYPE_CHECKING:
    from stickslip.run import ExactRun

FEWEST_INTERVALS = 64
"""A run has at least so many intervals (1)."""


class ComparedRigid(ComparedKind):
    """Answers of a rigid body on a spring."""

    def interval(self, run: ExactRun, duration: float) -> float:
        """Return half a period of its own, or less in a short run, or more in a long one."""
        stiffness = run.params.stiffness
        own = math.pi * math.sqrt(run.params.inertia / stiffness) if stiffness > 0.0 else math.inf
        return max(duration / MOST_COMPARISONS, min(own, duration / FEWEST_INTERVALS))

    def lead(self, run: ExactRun, mark: int, interval: float) -> None:
        """Lead a run to so many intervals (s)."""
        time, trip = mark * interval, run.problem.round_trip_time
        whole = math.floor(time / trip)
        run.last, run.count.to_the_end = (whole, time - whole * trip), 1
        while advance(run) != Stop.FINISHED:
            pass

    def marks(self, run: ExactRun, interval: float) -> int:
        """Return 1: marks are intervals."""
        return 1

    def where(self, run: ExactRun) -> tuple[int, ...]:
        """Return the side of a play where the spring pulls."""
        return 0, int(run.count.side)

    def time(self, run: ExactRun) -> float:
        """Return the time (s)."""
        return run.time

    def standing(self, run: ExactRun) -> slice:
        """Return no piece."""
        return slice(0, 0)

    def needed(self, run: ExactRun) -> int:
        """Return the last piece of the history."""
        return run.length - 1

    def series(self, run: ExactRun) -> Floats:
        """Return no waves."""
        return NO_SERIES

    def add_waves(self, run: ExactRun, series: Floats) -> None:
        """Add nothing."""

    def load(self, run: ExactRun) -> float:
        """Return the load (N, minus the reference strength) on the present piece."""
        return float(run.scratch[0] @ run.state.xi ** np.arange(TERMS))

    def add_load(self, run: ExactRun, load: float, slip: float) -> None:
        """Add to the present piece of load, and let the integral of a position loop take its share of slip on it."""
        wound = run.params.winding * run.state.speed * slip
        run.scratch[0, :2] += load + wound * run.state.xi, -wound

    def borne(self, run: ExactRun, load: float, slip: float) -> float:
        """Return what the spring has; in a position loop the integral makes a load of its own, and in a play it bears none."""
        return load if run.params.winding > 0.0 else -run.params.stiffness * slip

    def has_load(self) -> bool:
        """Return True."""
        return True

    def has_place(self, problem: Problem) -> bool:
        """Return True next to hard stops and in a play."""
        return problem.body.has_stops or problem.body.has_play


ANSWERS = ComparedRigid()
