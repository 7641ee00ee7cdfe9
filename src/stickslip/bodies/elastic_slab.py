"""The infinite elastic slab, paper eqs (7)-(13)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from stickslip.errors import InputError
from stickslip.quantities import check_quantities, quantity


@dataclass(frozen=True)
class ElasticSlab:
    """A slab of given thickness in antiplane or in-plane shear: rho u_tt = G u_xx, friction at x = 0, a driver at x = h.

    The driver is rigid (driver_impedance = inf: the displacement is prescribed), a half-space of finite impedance, or a dead
    load (0). A contact mass (kg/m^2) gives the sliding face inertia of its own: no shocks then.
    Source: Campillo et al. 1996, eqs (7)-(13).
    """

    kind: ClassVar[str] = "elastic-slab"

    density: float = quantity("kg/m^3", "density rho", above=0)
    wave_speed: float = quantity("m/s", "shear wave speed c", above=0)
    thickness: float = quantity("m", "thickness h", above=0)
    normal_stress: float = quantity("Pa", "normal stress S on the contact, compression positive", above=0)
    driver_impedance: float = quantity(
        "Pa s/m", "impedance Zd of what pulls the far side: inf rigid, 0 a dead load", at_least=0, infinite=True, default=math.inf
    )
    contact_mass: float = quantity("kg/m^2", "mass of the sliding face, per unit area", at_least=0, default=0.0)
    p_wave_speed: float | None = quantity(
        "m/s", "compressional wave speed: only for the (constant) normal strain", above=0, default=None
    )

    def __post_init__(self) -> None:
        check_quantities(self)
        if self.p_wave_speed is not None and self.p_wave_speed <= self.wave_speed * math.sqrt(4 / 3):
            limit = self.wave_speed * math.sqrt(4 / 3)
            raise InputError(
                f"ElasticSlab: p_wave_speed must exceed sqrt(4/3) wave_speed = {limit:g} m/s, got {self.p_wave_speed:g}"
            )

    @property
    def impedance(self) -> float:
        """Z = rho c, in Pa s/m."""
        return self.density * self.wave_speed

    @property
    def shear_modulus(self) -> float:
        """G = rho c^2, in Pa."""
        return self.density * self.wave_speed**2

    @property
    def two_way_time(self) -> float:
        """R = 2 h / c, in s."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def reflection(self) -> float:
        """r = (Z - Zd) / (Z + Zd): what comes back from the driver; -1 rigid, 0 matched, +1 dead load."""
        if math.isinf(self.driver_impedance):
            return -1.0
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @property
    def stiffness(self) -> float:
        """G / h, in Pa/m: the load lost per metre of slow slip under a rigid driver."""
        return self.shear_modulus / self.thickness

    @property
    def normal_strain(self) -> float:
        """u_x = -S / (lambda + 2 G), constant through the slab. Needs p_wave_speed."""
        if self.p_wave_speed is None:
            raise InputError("ElasticSlab: normal_strain needs p_wave_speed")
        return -self.normal_stress / (self.density * self.p_wave_speed**2)
