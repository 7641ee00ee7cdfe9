"""A driver with a motion of its own: a mass, or a gain that integrates. What its motion sends is added by the engine.

M dVd/dt = Zd (V - Vd) + ki phi + far stress - stress, with dphi/dt = V - Vd, for its mass M, its rate Vd, the pull rate V, the
proportional gain Zd and the integral gain ki.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.driver import inflow_of
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.lossy import LossyDriver
from stickslip.problem.drivers.segments import arriving, scaled
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading import LoadingHistory
from stickslip.problem.problem import Problem


class Machine(LossyDriver):
    """What a machine answers. Its inflow is the force of pull and far stress on it, which move it."""

    moves: ClassVar[bool] = True
    missing_for_leaps: ClassVar[str] = "a driver without a mass and an integral gain"

    def reflection(self, body: BodyOnCharacteristics) -> float:
        """Return -1: what its own motion sends comes on top."""
        return RIGID

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return Zd + M s + ki/s."""
        resists = np.asarray(poly.polytrim([body.driver_impedance, body.driver_inertia]), float)
        if body.driver_integral_gain > 0.0:
            return DriverImpedance(np.append(body.driver_integral_gain, resists), np.array([0.0, 1.0]))
        return DriverImpedance(resists, np.ones(1))

    def gain(self, body: BodyOnCharacteristics) -> float:
        """Return 1: all of its stress moves it."""
        return 1.0

    def inflow(self, problem: Problem) -> Inflow:
        """Return the force (Pa) of pull and far stress on it, as it would arrive at the contact."""
        found = super().inflow(problem)
        return replace(found, reflection=np.full(len(found.start), RIGID))

    def steady_inflow(self, problem: Problem) -> tuple[float, float]:
        """Return all of the force: it is where the machine is found, whatever is before it."""
        return self.sent_steadily(problem)

    def at_first(self, problem: Problem) -> tuple[float, float]:
        """Return its rate (m/s) when the first wave of the run leaves it, and the force of its integral gain (Pa).

        A machine with a mass starts at the pull rate; without mass the balance of forces sets its rate at once. The integral is 0
        at the start, so that a far stress that does not balance the stress in the slab acts as a jump, whatever the gain: it
        accelerates the machine. The smaller the gain, the closer the motion comes to that without one.
        """
        body = problem.body
        if body.driver_inertia > 0.0:
            return problem.first_pull_rate, 0.0
        force = float(inflow_of(problem).at(np.array(body.inflow_delay)))
        left = body.meets_driver_at_first(problem.excess, problem.rate, problem.initial_shear)
        return (force + left) / (body.last_impedance + body.driver_impedance), 0.0

    def first_sent(self, problem: Problem, time: float) -> float:
        """Return what its motion sends at first: 2 Z times its rate (Pa)."""
        return 2.0 * problem.body.impedance * self.at_first(problem)[0]

    def pulled_shares(self, problem: Problem) -> list[float]:
        """Return no share: the pull moves the machine, whose motion is added."""
        return [0.0]

    def pulls(self, problem: Problem) -> list[Inflow]:
        """Return its pull rate (m/s), as it arrives at the contact."""
        return [pull_of(problem)]

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return its numbers; the spring is that of layers before it."""
        body = problem.body
        pulled = isinstance(problem.pull_rate, LoadingHistory) and body.driver_impedance > 0.0
        return {
            "reflection": RIGID,
            "driver_inertia": body.driver_inertia,
            "driver_impedance": body.driver_impedance,
            "driver_gain": body.driver_integral_gain,
            "driver_spring": body.stiffness,
            "pull_share": 1.0 / body.driver_impedance if pulled else 0.0,
        }

    def gathered(self, problem: Problem, trip: Floats, offset: Floats, trips: Floats) -> Floats:
        """Return the growth of a load at rest, while the machine moves at the rate to which it has settled."""
        after = (trip + 1.0) * problem.round_trip_time
        return np.asarray(trips * problem.body.grows_in_a_trip(1.0) * settled_rate(problem, after))

    def changes_within(self, problem: Problem) -> float:
        """Return the time (s) in which its mass, or its gain without a mass, answers a change of the force on it."""
        pace = pace_of(problem.body)
        return 1.0 / pace if pace > 0.0 else math.inf


ANSWERS = Machine()


def pace_of(body: BodyOnCharacteristics) -> float:
    """Return how fast (1/s) the motion of a machine may change by its own size: see `engine.waves.driver`."""
    resists = body.driver_impedance + body.last_impedance
    if body.driver_inertia == 0.0:
        return body.driver_integral_gain / resists
    return resists / body.driver_inertia + math.sqrt(body.driver_integral_gain / body.driver_inertia)


def pull_of(problem: Problem) -> Inflow:
    """Return the pull rate (m/s) of a machine, as it arrives at the contact."""
    return arriving(*scaled(problem.pull_rate, 1.0), problem.body.inflow_delay, problem)


def settled_rate(problem: Problem, time: Floats) -> Floats:
    """Return the rate (m/s) that a machine tends to while the contact rests, under the loading that has arrived at times (s).

    See `engine.waves.driver_at_rest`.
    """
    body, pull, driven = problem.body, pull_of(problem), inflow_of(problem)
    gain = body.driver_integral_gain
    grows = driven.slope[driven.segment(time)] - body.driver_impedance * pull.slope[pull.segment(time)]
    stiffness = body.grows_in_a_trip(1.0) / problem.round_trip_time
    return np.asarray((gain * pull.value[pull.segment(time)] + grows) / (gain + stiffness))
