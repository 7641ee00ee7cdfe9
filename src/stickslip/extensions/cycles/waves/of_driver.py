"""What a driver that moves by itself keeps beside the waves, where a cycle is cut.

Half a round trip before a cut the driver has met the wave that left the contact a round trip before it. What it had then, and the
wave of that round trip, decide how it goes on. Its numbers are kept as stresses, in the unit of the wave.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from stickslip.engine import History
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem, driver_of
from stickslip.problem.bodies import BodyWithWaves, as_waves


def moving(problem: Problem) -> tuple[bool, bool]:
    """Return whether the rate of the driver is a number of its own, and whether the push of its integral gain is."""
    body, moves = cast(BodyWithWaves, problem.body), driver_of(problem).moves
    return moves and body.driver_inertia > 0.0, moves and body.driver_integral_gain > 0.0


def rate_and_push(problem: Problem, kept: Floats) -> Floats:
    """Return the rate (m/s) and the push (Pa) of a driver that keeps these stresses (Pa)."""
    found, own = np.zeros(2), np.array(moving(problem))
    found[own] = kept
    found[0] /= 2.0 * problem.body.echo_impedance
    return found


def kept_by_driver(history: History, time: float, begun: Floats) -> Floats:
    """Return the stresses (Pa) that the driver keeps at a cut at a time (s) of a run.

    They are what its motion sends, and its push. The latter is that at the first moment when the driver met a wave of the run,
    which is in `begun` (m/s, Pa), with what has come since: its gain times how far it has fallen behind its pull rate.
    """
    problem, trip, own = history.problem, history.round_trip_time, moving(history.problem)
    if not any(own):
        return np.zeros(0)
    body, now = as_waves(problem.body), time - 0.5 * trip
    rate = 2.0 * body.echo_impedance * history.machine.at(np.array([now]))
    way = history.machine.way(np.array([0.5 * trip]), np.array([now]))
    push = begun[1] + body.driver_integral_gain * (problem.first_pull_rate * (time - trip) - way)
    return np.asarray(np.concatenate([rate, push])[np.array(own)])
