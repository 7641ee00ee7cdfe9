"""A driver of finite impedance, which neither changes nor has a motion of its own: what all passive drivers do holds for it."""

from __future__ import annotations

from stickslip.engine import History
from stickslip.problem.bodies import BodyWithWaves, OfLayers
from stickslip.solution.observables.driver_of_waves import DriverBehind, DriverOfLayers, DriverOfWaves


class LossyBehind(DriverBehind):
    """Drivers of finite impedance."""

    def a_slab(self, history: History, body: BodyWithWaves) -> DriverOfWaves:
        """Return one behind a uniform body."""
        return DriverOfWaves(history, body)

    def layers(self, history: History, body: OfLayers) -> DriverOfLayers:
        """Return one behind layers."""
        return DriverOfLayers(history, body)


ANSWERS = LossyBehind()
