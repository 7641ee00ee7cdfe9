"""The infinite elastic slab, paper eqs (7)-(13)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.bodies.spring_block import SpringBlock
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import check_quantities, quantity


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
        if np.all(np.isinf(self.driver_impedance)):
            return -1.0
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @property
    def is_driven_rigidly(self) -> bool:
        """Whether the driver sends everything back, turned round: r = -1."""
        return bool(np.all(self.reflection == -1.0))

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

    def equivalent_block(self) -> SpringBlock:
        """The block of the slab's slow limit, for each m^2 of contact: K = G/h, m = rho h/3 + contact mass, S of 1 m^2, no damping.

        Slow means that the motion takes many travel times h/c. The slab is then sheared evenly, its velocity falls linearly from
        the contact to the driver and it holds rho (h/3) v^2/2. It is the order (omega h/c)^2 of the load that the slab takes at
        the frequency omega, G k cot(k h) = G/h - omega^2 rho h/3 + ..., k = omega/c. It is not the block of the first mode, whose
        m = rho h/2 and K = (pi^2/8) G/h swings at the slab's own c/4h: this one swings at sqrt(3) c/(2 pi h), 10 % faster.

        Raises InputError for a driver that is not rigid: its impedance stands behind the spring, not beside it as a block's
        damping does; in the slow limit it lets the spring go and leaves a mass rho h.
        Source: Campillo et al. 1996 compare the two bodies; which block a slab is follows from its eqs (7)-(13) as above.
        """
        if not math.isinf(self.driver_impedance):
            raise InputError(
                "ElasticSlab: equivalent_block needs a rigid driver: behind one of finite impedance nothing holds the slab in the "
                f"slow limit, so there is no spring; got driver_impedance = {self.driver_impedance:g} Pa s/m"
            )
        mass = self.density * self.thickness / 3.0 + self.contact_mass
        return SpringBlock(mass=mass, stiffness=self.stiffness, normal_force=self.normal_stress)
