"""Define the infinite elastic slab, paper eqs (7)-(13)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from stickslip.bodies.spring_block import SpringBlock
from stickslip.foundation.brief_repr import Declared
from stickslip.foundation.constants import RIGID
from stickslip.foundation.conversion import Number, OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import check_fields, quantity


@dataclass(frozen=True)
class ElasticSlab(Declared):
    """A slab of given thickness in antiplane or in-plane shear: rho u_tt = G u_xx, friction at x = 0, a driver at x = h.

    A driver of finite impedance is a half-space. With a contact mass the slip rate has no jumps (shocks). Raises InputError if a
    number is out of range, or `p_wave_speed` does not exceed sqrt(4/3) `wave_speed`.
    """

    kind: ClassVar[str] = "elastic-slab"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (7)-(13)"
    load_unit: ClassVar[str] = "Pa"
    energy_unit: ClassVar[str] = "J m-2"
    has_waves: ClassVar[bool] = True

    density: Number = quantity("kg/m^3", "density rho", above=0)
    wave_speed: Number = quantity("m/s", "shear wave speed c", above=0)
    thickness: Number = quantity("m", "thickness h", above=0)
    normal_stress: Number = quantity("Pa", "normal stress S on the contact, compression positive", above=0)
    driver_impedance: Number = quantity(
        "Pa s/m",
        "impedance Zd of the driver: inf for a rigid driver, 0 for a dead load",
        at_least=0,
        infinite=True,
        word="rigid",
        default=math.inf,
    )
    contact_mass: Number = quantity("kg/m^2", "mass of the sliding face, per unit area", at_least=0, default=0.0)
    p_wave_speed: OptionalNumber = quantity(
        "m/s", "compressional wave speed: only for the (constant) normal strain", above=0, default=None
    )

    def __post_init__(self) -> None:
        check_fields(self)
        if self.p_wave_speed is not None and self.p_wave_speed <= self.wave_speed * math.sqrt(4 / 3):
            limit = self.wave_speed * math.sqrt(4 / 3)
            raise InputError(
                f"ElasticSlab: p_wave_speed must exceed sqrt(4/3) wave_speed = {limit:g} m/s, got {self.p_wave_speed:g}"
            )

    @property
    def impedance(self) -> float:
        """The wave impedance Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def damping(self) -> float:
        """The radiation damping, traction per slip rate that leaves with the waves (Pa s/m): the impedance."""
        return self.impedance

    @property
    def shear_modulus(self) -> float:
        """The shear modulus G = rho c^2 (Pa)."""
        return self.density * self.wave_speed**2

    @property
    def two_way_time(self) -> float:
        """The two-way travel time R = 2 h / c (s)."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def round_trip_time(self) -> float:
        """The two-way travel time R (s), after which a wave that slip has sent out comes back as load."""
        return self.two_way_time

    @property
    def normal_load(self) -> float:
        """The normal stress S (Pa)."""
        return self.normal_stress

    @property
    def inertia(self) -> float:
        """The contact mass (kg/m^2)."""
        return self.contact_mass

    @property
    def has_inertia(self) -> bool:
        """True if the contact has a mass, so that its slip rate cannot jump."""
        return self.contact_mass > 0.0

    @cached_property
    def reflection(self) -> float:
        """The reflection coefficient of the driver, r = (Z - Zd) / (Z + Zd).

        It is -1 for a rigid driver, 0 for a matched half-space and +1 for a dead load.
        """
        if np.all(np.isinf(self.driver_impedance)):
            return RIGID
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @cached_property
    def is_driven_rigidly(self) -> bool:
        """True if the driver reflects the whole wave with its sign reversed, r = -1."""
        return bool(np.all(self.reflection == RIGID))

    @property
    def stiffness(self) -> float:
        """The stiffness G / h (Pa/m), the decrease of the load per metre of slow slip under a rigid driver."""
        return self.shear_modulus / self.thickness

    @property
    def normal_strain(self) -> float:
        """The normal strain -S / (lambda + 2 G), no unit, which is constant through the slab.

        Raises
        ------
        InputError
            If the slab has no `p_wave_speed`.
        """
        if self.p_wave_speed is None:
            raise InputError("ElasticSlab: normal_strain needs p_wave_speed")
        return -self.normal_stress / (self.density * self.p_wave_speed**2)

    def equivalent_block(self) -> SpringBlock:
        """Return the block to which the slab is equivalent in slow motion, for each m^2 of contact.

        Returns
        -------
        SpringBlock
            A block without damping: K = G/h (N/m), m = rho h/3 + contact mass (kg) and the normal force S of 1 m^2 (N).

        Raises
        ------
        InputError
            If the driver is not rigid. A finite impedance acts in series with the spring, not in parallel as the damping of a
            block does; in the slow limit the driver then gives way, no spring is left, and the slab is a mass rho h.

        Notes
        -----
        Motion is slow if it takes many travel times h/c. The shear strain is then uniform, the velocity falls linearly from the
        contact to the driver, and the kinetic energy is rho (h/3) v^2/2 per unit area.

        At the angular frequency omega the load per unit displacement of the contact is G k cot(k h) = G/h - omega^2 rho h/3 + ...,
        with k = omega/c. The block matches the terms up to the order (omega h/c)^2.

        It is not the block that matches the first mode, which has m = rho h/2 and K = (pi^2/8) G/h and oscillates at the frequency
        c/(4h) of the slab. This block oscillates at sqrt(3) c/(2 pi h), which is 10 % higher.

        Source: Campillo et al. 1996 compare the two bodies; the equivalence follows from their eqs (7)-(13) as above.
        """
        if not self.is_driven_rigidly:
            raise InputError(
                "ElasticSlab: equivalent_block needs a rigid driver: behind one of finite impedance nothing holds the slab in the "
                f"slow limit, so there is no spring; got driver_impedance = {self.driver_impedance:g} Pa s/m"
            )
        mass = self.density * self.thickness / 3.0 + self.contact_mass
        return SpringBlock(mass=mass, stiffness=self.stiffness, normal_force=self.normal_stress)
