"""A driver that holds its rate: it sends back all of a wave with its sign reversed, and nothing goes beyond it."""

from __future__ import annotations

from stickslip.engine import Epoch, Floats
from stickslip.solution.observables.driver_of_waves import DriverBehind, DriverOfLayers, DriverOfWaves, SumOfPower


class RigidBehindSlab(DriverOfWaves):
    """A rigid driver behind a uniform body."""

    by_storing = True

    def impedance_at(self, time: Floats) -> float:
        """Return 0: no wave goes beyond it."""
        return 0.0

    def shears_at(self, time: float) -> float:
        """Return its pull rate."""
        return float(self.problem.pull_rate_at(time))

    def radiated(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return 0."""
        return 0.0


class RigidBehindLayers(DriverOfLayers):
    """A rigid driver behind layers, as the one on the other side is, if there is one."""

    def shears_at(self, time: float) -> float:
        """Return its pull rate."""
        return float(self.problem.pull_rate_at(time))


ANSWERS = DriverBehind(RigidBehindSlab, RigidBehindLayers)
