"""A driver of finite impedance, which neither changes nor has a motion of its own."""

from stickslip.solution.observables.driver_of_waves import BehindLayers, BehindSlab, DriverBehind

ANSWERS = DriverBehind(BehindSlab, BehindLayers)
