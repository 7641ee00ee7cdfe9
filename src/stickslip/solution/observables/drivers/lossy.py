"""A driver of finite impedance, which neither changes nor has a motion of its own: what all passive drivers do holds for it."""

from __future__ import annotations

from stickslip.solution.observables.driver_of_waves import DriverBehind, DriverOfLayers, DriverOfWaves

ANSWERS = DriverBehind(DriverOfWaves, DriverOfLayers)
