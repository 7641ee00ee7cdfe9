"""Define an elastic slab."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from stickslip.foundation.conversion import Number, OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import Name
from stickslip.foundation.quantities import Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import BodyOnCharacteristics, check_body, check_driver, check_equivalent
from stickslip.problem.bodies.uniform.with_waves import WithWaves, contact_damping

if TYPE_CHECKING:
    from stickslip.problem.bodies.rigid.blocks import SpringBlock

DRIVER_INERTIA = Quantity(
    "kg/m^2", "mass of the driver, per unit area: inf for a rigid driver", at_least=0, infinite=True, word="rigid"
)
"""Mass of a driver that is a machine."""
DRIVER_INTEGRAL_GAIN = Quantity(
    "Pa/m", "integral gain of the driver: stress for each metre that it lags behind its pull rate", at_least=0
)
"""Integral gain of such a driver."""
CONTACT_DAMPING = contact_damping("Pa s/m", "stress")
"""Dashpot of the contact of a slab."""


@dataclass(frozen=True)
class ElasticSlab(Declared, WithWaves):
    """A slab of given thickness in antiplane or in-plane shear: rho u_tt = G u_xx, friction at x = 0, a driver at x = h.

    A driver of finite impedance is a half-space. With a mass or an integral gain it is a machine, and the impedance is its
    proportional gain: M dVd/dt = Zd (V - Vd) + ki phi + far stress - stress, with dphi/dt = V - Vd, for its mass M, its rate Vd,
    the pull rate V and the integral gain ki. With a contact mass the slip
    rate has no jumps (shocks). With `contact_damping` D the contact resists with S mu + D v, such as through a viscous film; D v
    is not radiated. Raises InputError if a number is out of range, or `p_wave_speed` does not exceed sqrt(4/3)
    `wave_speed`.
    """

    kind: ClassVar[str] = "elastic-slab"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (7)-(13)"
    load_unit: ClassVar[str] = "Pa"
    noun: ClassVar[str] = "slab"
    mass_field: ClassVar[str] = "contact_mass"
    modulus_name: ClassVar[Name] = Name("shear modulus", "G", "Pa", "shear modulus rho c^2")
    impedance_formula: ClassVar[str] = "rho c"

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
    driver_inertia: Number = declare(DRIVER_INERTIA, 0.0)
    driver_integral_gain: Number = declare(DRIVER_INTEGRAL_GAIN, 0.0)
    contact_damping: Number = declare(CONTACT_DAMPING, 0.0)

    def __post_init__(self) -> None:
        check_body(self)
        check_driver(self)
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
    def shear_modulus(self) -> float:
        """The shear modulus G = rho c^2 (Pa)."""
        return self.density * self.wave_speed**2

    @property
    def modulus(self) -> float:
        """The shear modulus (Pa)."""
        return self.shear_modulus

    @property
    def distance(self) -> float:
        """The thickness (m)."""
        return self.thickness

    @property
    def inertia(self) -> float:
        """The contact mass (kg/m^2)."""
        return self.contact_mass

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
        check_equivalent(self)
        mass = self.density * self.thickness / 3.0 + self.contact_mass
        from stickslip.problem.bodies.rigid.blocks import SpringBlock  # few slabs are asked for one

        return SpringBlock(mass, self.stiffness, self.normal_stress, self.contact_damping)


def as_slab(body: BodyOnCharacteristics, refusal: str = "needs an elastic slab") -> ElasticSlab:
    """Return a body that must be a slab. Raises InputError with the text `refusal` for any other body."""
    if not isinstance(body, ElasticSlab):
        raise InputError(refusal)
    return body
