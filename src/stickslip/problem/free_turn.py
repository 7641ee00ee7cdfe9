"""The round trip of a body without a spring, which has no period, and to which nothing comes back.

It is a measure of time alone, for the history that is written. Times in it are resolved to its own rounding, so that it may not be
much longer than what happens; if it is shorter, there are more pieces.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.problem.fields import ProblemFields
from stickslip.problem.loading_history import LoadingHistory

PARTS_IN_A_TRIP = 16.0
"""How many first parts (1) of a loading are in a round trip: few, so that their times are resolved."""


def turn_of_free(problem: ProblemFields, rate: Any, longest: float) -> Any:
    """Return the round trip (s): `longest` if that is finite, as the period of a tone, else what loading or throw say.

    That is a few of the first parts of the loading, else twice the time that friction of mu = 1 takes to stop a body thrown at
    a rate (m/s), else what the body has.
    """
    if longest < math.inf:
        return longest
    given = (problem.pull_rate, problem.force, problem.normal_load, problem.ground_velocity, problem.ground_acceleration)
    breaks = [one.parts[0] for one in given if isinstance(one, LoadingHistory) and len(one.parts[0]) > 1]
    if breaks:
        return float(min(min(PARTS_IN_A_TRIP * one[1], one[-1]) for one in breaks))
    stops: Any = 2.0 * problem.body.inertia * abs(rate) / problem.normal
    if isinstance(stops, np.ndarray):  # of many members
        return np.where(stops > 0.0, stops, problem.body.round_trip_time)
    return stops or problem.body.round_trip_time
