"""How far a rigid body is behind the end of its spring, or behind the reference of its position loop, where that matters.

Load and slip rate say all of a body on a spring. The load of a position loop has the integral of the lag in it, so that the lag is
a state of its own. Hard stops bar the way at a lag, under a reference at rest. A spring beside a play feels no lag that is small.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem, driver_of
from stickslip.problem.bodies import as_on_spring

SMALL_RATE = 0.01
"""Slip rate (1) that cuts a motion about a set point, as a share of its `usual_rate`."""


def is_wound(problem: Problem) -> bool:
    """Return True if a position loop integrates the lag, which then is a coordinate of the section."""
    return bool(getattr(problem.body, "integral_gain", 0.0) > 0.0)


def force_of_slip(problem: Problem) -> float:
    """Return about by how much (N) friction falls in slip about a set point: its range, or all of it if that is 0."""
    return float(problem.normal * (problem.friction.variation or problem.friction.static_coefficient(0.0)))


def usual_rate(problem: Problem) -> float:
    """Return the slip rate (m/s) with which those of a cycle are compared: the pull rate, or that of a free slip if it is 0."""
    return problem.first_pull_rate or force_of_slip(problem) / float(problem.body.impedance)


def section_rate(problem: Problem) -> float:
    """Return the slip rate (m/s) that cuts a motion without rest: the pull rate, or a small one if that is 0."""
    return problem.first_pull_rate or SMALL_RATE * usual_rate(problem)


def loading_rate(problem: Problem) -> float:
    """Return about how fast (N/s) the load of a contact at rest grows: by the pull, and by the integral of a lag of usual size."""
    pulled: float = problem.body.stiffness * problem.first_pull_rate
    if is_wound(problem):
        pulled += as_on_spring(problem.body).integral_gain * force_of_slip(problem) / problem.body.stiffness
    return pulled


def impacts_of(history: History, last: int) -> int:
    """Return how often the body meets a hard stop in a history up to a piece."""
    body, mode, slip = as_on_spring(history.problem.body), history.store.mode[:last], history.store.slip[1 : last + 1]
    return int((((mode > 0) & (slip == body.stop_ahead)) | ((mode < 0) & (slip == -body.stop_behind))).sum())


def has_lag(problem: Problem) -> bool:
    """Return True if disturbances of the lag are followed."""
    return is_wound(problem) or bool(problem.body.has_play)


def lags_at(history: History, at: Positions) -> Floats:
    """Return the lag (m) at positions in a history."""
    problem = history.problem
    first = float(driver_of(problem).numbers(problem)["first_lag"])
    return np.asarray(first + problem.first_pull_rate * history.times_inside(at)[0] - history.slipped(at))


def lags_of(history: History) -> Floats:
    """Return the lag (m) where each piece of a history begins; nothing where it does not matter."""
    if not has_lag(history.problem):
        return np.zeros(0)
    pieces = np.arange(len(history))
    return lags_at(history, Positions.inside(pieces, np.zeros(len(pieces))))


def at_lag(problem: Problem, lag: float, load: float | None = None) -> dict[str, Any]:
    """Return what a problem must change to start at a lag (m) behind its reference, under a load (N), or at the static strength.

    The load jumps at the start with the step of the reference. Stops stay where they are, seen from a reference at rest.
    """
    body: Any = problem.body
    moved, jump = lag - body.reference_step, body.stiffness * lag
    stops = {"stop_ahead": max(body.stop_ahead + moved, 0.0), "stop_behind": max(body.stop_behind - moved, 0.0)}
    loads = {"initial_load": None if load is None else load - jump, "initial_excess": -jump if load is None else None}
    return {"body": replace(body, reference_step=lag, **stops), **loads}
