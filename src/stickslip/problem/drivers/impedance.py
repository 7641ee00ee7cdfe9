"""How a driver resists a motion of its end, as a function of its growth rate."""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.foundation.arrays import Floats


class DriverImpedance(NamedTuple):
    """How a driver resists a motion exp(s t) of its end, stress over velocity (Pa s/m): a quotient of two polynomials in s.

    It is M s + kp + ki/s of a driver with a mass and gains, Zd of one that only loses energy, and 1/0 of a rigid one. Coefficients
    begin with the lowest order.
    """

    numerator: Floats
    denominator: Floats

    @property
    def is_constant(self) -> bool:
        """True if it is the same for every s: the driver sends back the same share of every wave."""
        return len(self.numerator) == len(self.denominator) == 1

    @property
    def steady(self) -> float:
        """The stress per velocity (Pa s/m) at a steady rate, s = 0: inf if the driver does not give way in the long run."""
        return float(self.numerator[0] / self.denominator[0]) if self.denominator[0] else math.inf
