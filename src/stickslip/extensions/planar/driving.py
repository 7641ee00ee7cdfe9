"""The load that the driver brings to a contact which never slips: the loading of a planar slab, the same at all nodes."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.planar.asked import PLANAR_DRIVERS
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.problem.bodies import ElasticSlab


def locked_load(problem: Problem, steps: int, round_trips: int) -> Floats:
    """Return the load (Pa) of a contact that never slips, minus the initial load, of shape (round_trips, steps + 1).

    It is that at the beginning and at the end of each step. Where the load jumps at the end of a round trip, that row has the value
    before the jump and the next row the value after it.

    Source: paper eqs (12)-(13), with v = 0, and a driver of finite impedance: beta(t) = -r beta(t - R) + what enters at the driver.
    """
    body = problem.body
    assert isinstance(body, ElasticSlab)
    impedance, trip = body.impedance, body.two_way_time
    within: Floats = np.asarray(np.arange(steps + 1) * (trip / steps), float)
    slope, reflection = impedance * problem.first_pull_rate / (0.5 * trip), body.reflection
    found = np.empty((round_trips, steps + 1))
    found[0] = slope * within
    late = 2 * np.arange(steps + 1) >= steps  # from h/c on
    if PLANAR_DRIVERS[problem.driver_kind].reflects_at_first(problem):
        # what the driver reflects then left the contact before the start: it follows from the initial stress and velocity
        before = slope * (trip - within[late]) - problem.load
        found[0, late] = reflection * before + _entering(problem, within[late]) - problem.load
    for n in range(1, round_trips):
        sent = -(found[n - 1] + problem.load)
        found[n] = reflection * sent + _entering(problem, np.asarray(within + n * trip, float)) - problem.load
    return found


def _entering(problem: Problem, times: Floats) -> Floats:
    """Return what the driver adds to the load (Pa) at given times: it set out from the driver half a round trip earlier."""
    assert isinstance(problem.body, ElasticSlab)
    return PLANAR_DRIVERS[problem.driver_kind].entering(problem, times - 0.5 * problem.body.two_way_time)
