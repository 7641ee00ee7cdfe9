"""Define the rigid block on a spring, paper eqs (4)-(6)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.foundation.brief_repr import Declared
from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import check_fields, quantity


@dataclass(frozen=True)
class SpringBlock(Declared):
    """A rigid block pulled through a spring: m dv/dt + damping v + tau = K (D0 + V t - u). Loads and tractions are forces, in N."""

    kind: ClassVar[str] = "spring-block"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (4)-(6); the damping is an addition"
    load_unit: ClassVar[str] = "N"
    energy_unit: ClassVar[str] = "J"
    has_waves: ClassVar[bool] = False
    has_inertia: ClassVar[bool] = True
    driver_impedance: ClassVar[float] = math.inf
    """The end of the spring is displaced as prescribed, as the face of a slab is by a rigid driver."""
    is_driven_rigidly: ClassVar[bool] = True
    reflection: ClassVar[float] = 0.0

    mass: Number = quantity("kg", "mass m", above=0)
    stiffness: Number = quantity("N/m", "stiffness K of the spring", above=0)
    normal_force: Number = quantity("N", "normal force S on the contact, compression positive", above=0)
    damping: Number = quantity("N s/m", "viscous resistance to slip", at_least=0, default=0.0)

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def period(self) -> float:
        """The period of free undamped oscillation, 2 pi sqrt(m / K) (s)."""
        found: float = 2.0 * math.pi * np.sqrt(self.mass / self.stiffness)
        return found

    @property
    def round_trip_time(self) -> float:
        """The period (s), after which the spring has brought the block's motion back."""
        return self.period

    @property
    def impedance(self) -> float:
        """Sqrt(K m) (N s/m), which takes the place of a slab's impedance."""
        found: float = np.sqrt(self.stiffness * self.mass)
        return found

    @property
    def normal_load(self) -> float:
        """The normal force S (N)."""
        return self.normal_force

    @property
    def inertia(self) -> float:
        """The mass (kg)."""
        return self.mass
