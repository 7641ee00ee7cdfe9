"""No driver: nothing holds a rigid body without a spring, whose load is what it was at the start, and a force on it."""

from __future__ import annotations

import numpy as np

from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.spring import Spring


class Undriven(Spring):
    """What stands in place of a driver: a spring of stiffness 0, whose answers hold but for one."""

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return 0: nothing resists."""
        return DriverImpedance(np.zeros(1), np.ones(1))


ANSWERS = Undriven()
