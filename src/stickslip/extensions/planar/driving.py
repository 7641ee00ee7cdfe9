"""The load that the driver brings to a contact which never slips: the loading of a planar slab, the same at all nodes."""

from __future__ import annotations

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem
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
    if not body.is_driven_rigidly or isinstance(problem.pull_rate, LoadingHistory):
        # what the driver reflects then left the contact before the start: it follows from the initial stress and velocity
        before = slope * (trip - within[late]) - problem.load
        found[0, late] = reflection * before + _entering(problem, within[late]) - problem.load
    for n in range(1, round_trips):
        sent = -(found[n - 1] + problem.load)
        found[n] = reflection * sent + _entering(problem, np.asarray(within + n * trip, float)) - problem.load
    return found


def _entering(problem: Problem, times: Floats) -> Floats:
    """Return what the driver adds to the load (Pa) at given times: it set out from the driver half a round trip earlier."""
    body = problem.body
    assert isinstance(body, ElasticSlab)
    sent = times - 0.5 * body.two_way_time
    pulled = problem.pull_rate_at(np.maximum(sent, 0.0))
    if body.is_driven_rigidly:
        return np.asarray(2.0 * body.impedance * pulled, float)
    far = problem.far_stress
    stress = far.at(np.maximum(sent, 0.0)) if isinstance(far, LoadingHistory) else problem.load if far is None else far
    stress = stress + problem.far_stress_rate * sent
    share = 2.0 * body.impedance / (body.impedance + body.driver_impedance)
    return np.asarray(share * (body.driver_impedance * pulled + stress), float)
