"""What a finished run of an axis in a position loop says: the lag stretches the proportional gain, the integral works beside it.

With the lag e = r - u the force of the controller is kp e + kd (V - v) + q. Of its work, kp e stores 1/2 kp e^2 as a spring does,
and kd (V - v)^2 is damped; q works along the way of the axis, and nothing is stored in it.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import as_on_spring
from stickslip.solution.observables.asked import LoadCompared
from stickslip.solution.observables.given_load import pulled, value_at
from stickslip.solution.observables.kinds.rigid import (
    ObservablesOfRigid,
    damped_power,
    driver_force,
    is_pushed,
    lost_between,
    pushing,
)
from stickslip.solution.observables.proof import Places
from stickslip.solution.observables.proof_of_load import compared_in_steps, times_in
from stickslip.solution.observables.quadrature import between, up_to


class ObservablesOfLoop(ObservablesOfRigid):
    """The answers of axes in a position loop; energies are in J. Without an integral they are those of a body on a spring."""

    def energies(self, history: History, at: Positions, nodes: int) -> dict[str, Floats]:
        """Return them from the lag; the work of the integral is that of the driver, too."""
        found = super().energies(history, at, nodes)
        if as_on_spring(history.problem.body).integral_gain:
            found["work"] = up_to(history, at, lambda some: _power(history, some), nodes=nodes)
            found["elastic"] = 0.5 * history.problem.body.stiffness * lag(history, at) ** 2
            found["stored"] = found["elastic"] + found["kinetic"]
        return found

    def event_energies(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return them from the lag at the start and at the end of each event."""
        body = as_on_spring(history.problem.body)
        if not body.integral_gain:
            return super().event_energies(history, first, last)
        stored = (body.stiffness * lag(history, one) ** 2 + body.inertia * history.rate(one) ** 2 for one in (first, last))
        begun, ended = stored
        return {
            "released": 0.5 * (begun - ended),
            "work": between(history, first, last, lambda some: _power(history, some)),
            "damped": between(history, first, last, damped_power(history)) + lost_between(history, first, last),
            "trapped": np.zeros(len(begun)),
        }

    def load_compared(self, history: History) -> LoadCompared:
        """Compare the loads with the forces of the controller, its integral found again by quadrature of the lag."""
        return compared_in_steps(history, _of_controller)


def lag(history: History, at: Positions) -> Floats:
    """Return how far slip is behind the reference (m)."""
    time, _ = history.times_inside(at)
    return as_on_spring(history.problem.body).reference_step + pulled(history.problem, time) - history.slipped(at)


def _power(history: History, at: Positions) -> Floats:
    """Return the power (W) of the controller, as if it pulled the end of a spring, and what its integral gives to the lag."""
    problem, body = history.problem, as_on_spring(history.problem.body)
    time, inside = history.times_inside(at)
    pull, rate = value_at(problem.pull_rate, time, inside), history.rate(at)
    force = problem.strength + driver_force(history, at)
    integral = force - body.stiffness * lag(history, at) - body.driver_damping * (pull - rate)
    given = pushing(history, at) * rate if is_pushed(history) else 0.0
    return np.asarray(pull * force - integral * (pull - rate) + given)


def _of_controller(history: History, piece: Places, xi: Floats) -> Floats:
    """Return the load minus the reference strength (N), from what it is where the history begins."""
    problem, body = history.problem, as_on_spring(history.problem.body)
    places, first = Positions.inside(piece, xi), Positions.inside(np.zeros(1, int), 0.0)

    def at_once(at: Positions, time: Floats, inside: Floats) -> Floats:
        """Return what the proportional and the derivative gain make of the reference, with what is given (N)."""
        straight = body.stiffness * lag(history, at) + body.driver_damping * value_at(problem.pull_rate, time, inside)
        return np.asarray(straight + pushing(history, at))

    _, _, time, inside = times_in(history, piece, xi)
    found = history.excess(first) + at_once(places, time, inside) - at_once(first, *history.times_inside(first))
    return np.asarray(found + body.integral_gain * up_to(history, places, lambda at: lag(history, at)))


ANSWERS = ObservablesOfLoop()
