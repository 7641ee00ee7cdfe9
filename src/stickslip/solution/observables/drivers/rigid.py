"""A driver that holds its rate: it sends back all of a wave with its sign reversed, and nothing goes beyond it."""

from __future__ import annotations

from stickslip.engine import Epoch, Floats
from stickslip.solution.observables.driver_of_waves import BehindLayers, BehindSlab, DriverBehind, SumOfPower


class RigidBehindSlab(BehindSlab):
    """A rigid driver behind a uniform body."""

    by_storing = True

    def impedance_at(self, time: Floats) -> float:
        """Return 0: no wave goes beyond it."""
        return 0.0

    def radiated(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return 0."""
        return 0.0


ANSWERS = DriverBehind(RigidBehindSlab, BehindLayers)
