"""Define the rigid block on a spring, paper eqs (4)-(6)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.foundation.quantities import check_fields, quantity


@dataclass(frozen=True)
class SpringBlock:
    """A rigid block pulled through a spring: m dv/dt + damping v + tau = K (D0 + V t - u). Loads and tractions are forces, in N.

    Parameters
    ----------
    mass
        Mass m (kg).
    stiffness
        Stiffness K of the spring (N/m).
    normal_force
        Normal force S on the contact (N), compression positive.
    damping
        Viscous resistance to slip (N s/m).

    Notes
    -----
    Source: Campillo et al. 1996, eqs (4)-(6); the damping is an addition.
    """

    kind: ClassVar[str] = "spring-block"

    mass: float = quantity("kg", "mass m", above=0)
    stiffness: float = quantity("N/m", "stiffness K of the spring", above=0)
    normal_force: float = quantity("N", "normal force S on the contact, compression positive", above=0)
    damping: float = quantity("N s/m", "viscous resistance to slip", at_least=0, default=0.0)

    @property
    def period(self) -> float:
        """Return the period of free undamped oscillation, 2 pi sqrt(m / K) (s)."""
        found: float = 2.0 * math.pi * np.sqrt(self.mass / self.stiffness)
        return found

    def __post_init__(self) -> None:
        check_fields(self)
