"""A driver that does not give way: it moves the far end of a body with waves as it is pulled."""

from __future__ import annotations

import numpy as np

from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.driver import Driver
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.segments import arriving, scaled
from stickslip.problem.inflow import Inflow
from stickslip.problem.problem import Problem


class RigidDriver(Driver):
    """What a rigid driver answers."""

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return 1/0: it does not give way."""
        return DriverImpedance(np.ones(1), np.zeros(1))

    def sent_steadily(self, problem: Problem) -> tuple[float, float]:
        """Return the inflow 2 Z V, which does not grow."""
        return 2.0 * problem.body.impedance * problem.first_pull_rate, 0.0

    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the inflow 2 Z V(t), of the impedance at the driver."""
        body = problem.body
        return arriving(*scaled(problem.pull_rate, 2.0 * body.last_impedance), body.inflow_delay, problem)

    def ramp(self, problem: Problem) -> float:
        """Return what the pull adds to the load in one round trip."""
        found: float = problem.body.grows_in_a_trip(problem.first_pull_rate)
        return found


ANSWERS = RigidDriver()
