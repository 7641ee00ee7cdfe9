"""What drives a contact: how a driver resists a motion of its end, and what it does at a steady rate."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.contact.wave_modes import Polynomial
from stickslip.problem.bodies import BodyOnCharacteristics


class DriverImpedance(NamedTuple):
    """How a driver resists a motion exp(s t) of its end, stress over velocity (Pa s/m): a quotient of two polynomials in s.

    It is M s + kp + ki/s of a driver with a mass and gains, Zd of one that only loses energy, and 1/0 of a rigid one. Coefficients
    begin with the lowest order.
    """

    numerator: Polynomial
    denominator: Polynomial

    @property
    def is_constant(self) -> bool:
        """True if it is the same for every s: the driver sends back the same share of every wave."""
        return len(self.numerator) == len(self.denominator) == 1

    @property
    def steady(self) -> float:
        """The stress per velocity (Pa s/m) at a steady rate, s = 0: inf if the driver does not give way in the long run."""
        return float(self.numerator[0] / self.denominator[0]) if self.denominator[0] else math.inf


def driver_impedance(body: BodyOnCharacteristics) -> DriverImpedance:
    """Return how the driver of a uniform body resists a motion exp(s t) of its end."""
    if body.is_driven_rigidly:
        return DriverImpedance(np.ones(1), np.zeros(1))
    resists = poly.polytrim([body.driver_impedance, body.driver_inertia])
    if body.driver_integral_gain > 0.0:
        return DriverImpedance(np.append(body.driver_integral_gain, resists), np.array([0.0, 1.0]))
    return DriverImpedance(resists, np.ones(1))


class SteadyDrive(NamedTuple):
    """What drives a contact at a steady slip rate v, pulled at a rate V: traction = far stresses + by_pull V - resists v."""

    resists: float
    """Impedance of drivers and drag of layers together (Pa s/m); inf if the drivers hold the rate."""
    by_pull: float
    """Impedance through which the pull acts (Pa s/m)."""
    shares: tuple[float, ...] = (1.0,)
    """Share (1) in the traction of the far stress on each side."""
