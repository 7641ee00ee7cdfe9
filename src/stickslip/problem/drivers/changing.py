"""A driver that changes by steps of the share r that it sends back: it is set free, stops, or takes up another share of waves."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem.drivers.driver import far_at_first, inflow_of
from stickslip.problem.drivers.lossy import LossyDriver
from stickslip.problem.drivers.segments import arriving, scaled, straight
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import SILENT
from stickslip.problem.problem import Problem


class ChangingDriver(LossyDriver):
    """What a driver that changes answers: it sends Z (1 - r) V + (1 + r) far stress, with the r of the moment."""

    missing_for_leaps: ClassVar[str] = "a driver that does not change"

    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the inflow through the driver as it changes, with the share that it sends back in each segment."""
        (pull, pull_tone), (far, far_tone) = (scaled(value, 1.0) for value in (problem.pull_rate, problem.far_stress))
        body, steps, bears = problem.body, np.array(problem.driver_steps), problem.body.first_share
        start = np.unique(np.concatenate([pull[0], far[0], steps[:, 0]]))
        share = steps[np.searchsorted(steps[:, 0], start, side="right") - 1, 1]
        of_pull, of_far = body.last_impedance * (1.0 - share), 1.0 + share
        pulled, stressed = (straight(one, start) for one in (pull, far))
        beyond = far_at_first(problem) if problem.far_stress is None else bears * (stressed[0] - problem.strength)
        value = of_pull * pulled[0] + of_far * (beyond + bears * problem.far_stress_rate * start)
        slope = of_pull * pulled[1] + of_far * bears * (stressed[1] + problem.far_stress_rate)
        tone, gain = (far_tone, of_far * bears) if pull_tone is SILENT else (pull_tone, of_pull)
        return replace(arriving(np.array([start, value, slope]), tone, body.inflow_delay, problem), reflection=share, gain=gain)

    def first_phases(self, problem: Problem, first: float) -> Floats:
        """Return the phases (s) of the first round trip at which segments begin, perhaps with another share."""
        start = inflow_of(problem).start
        return np.append(first, start[(start > first) & (start < problem.round_trip_time)])

    def pulled_shares(self, problem: Problem) -> list[float]:
        """Return 1 for the driver that changes, the first one, and 0 for another."""
        return [1.0, 0.0][: problem.body.drivers]


ANSWERS = ChangingDriver()
