"""Define the bodies that slide on the contact, and what is asked of any: a rigid block on a spring, and an elastic slab."""

from __future__ import annotations

import math
from dataclasses import Field, dataclass
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np

from stickslip.foundation.constants import RIGID
from stickslip.foundation.conversion import Number, OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import check_fields, quantity
from stickslip.foundation.show import Declared


class Body(Protocol):
    """What every body that slides on a contact has, whatever solves its motion. Its loads are stresses (Pa) or forces (N).

    Units below are for a slab; for a block read N for Pa, and kg for kg/m^2.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    kind: ClassVar[str]
    """Name in scenario files."""
    load_unit: ClassVar[str]
    """SI unit of loads and tractions, which decides the other units: a row of `foundation.names.KINDS`."""

    @property
    def normal_load(self) -> float:
        """The normal load S on the contact (Pa), compression positive."""
        ...

    @property
    def stiffness(self) -> float:
        """The decrease of the load per metre of slow slip (Pa/m)."""
        ...

    @property
    def impedance(self) -> float:
        """The load per slip rate that is characteristic of the body (Pa s/m): Z of a slab, sqrt(K m) of a block."""
        ...

    @property
    def damping(self) -> float:
        """The load per slip rate by which the body resists slip (Pa s/m): by radiation of waves, or by viscosity."""
        ...

    @property
    def inertia(self) -> float:
        """The mass that slips with the contact (kg/m^2): the contact mass of a slab, the whole mass of a block."""
        ...

    @property
    def has_inertia(self) -> bool:
        """True if a mass slips with the contact, so that its slip rate cannot jump."""
        ...


class BodyOnCharacteristics(Body, Protocol):
    """What the exact solver needs besides: how slip acts on the contact again, after a round trip, along characteristics.

    Units are those of `Body`.
    """

    has_waves: ClassVar[bool]
    """True if slip sends waves into the body, which come back as load one round trip later; False if the body is rigid."""

    @property
    def driver_impedance(self) -> float:
        """The impedance of the driver (Pa s/m), inf for a driver that prescribes its displacement."""
        ...

    @property
    def is_driven_rigidly(self) -> bool:
        """True if the driver does not give way, or by less than rounding."""
        ...

    @property
    def has_machine(self) -> bool:
        """True if the driver has a motion of its own: a mass, or a gain that integrates."""
        ...

    @property
    def driver_inertia(self) -> float:
        """The mass of such a driver (kg/m^2)."""
        ...

    @property
    def driver_integral_gain(self) -> float:
        """The force of such a driver per way that it lags behind its pull rate (Pa/m)."""
        ...

    @property
    def reflection(self) -> float:
        """The share of an outgoing wave that comes back from the driver, between -1 and 1; 0 without waves."""
        ...

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: 2 h/c of a slab, the period of a block."""
        ...


MACHINE = "a driver with a mass or an integral gain"
"""Words for a driver that is a machine (`BodyOnCharacteristics.has_machine`)."""


def has_dashpot(body: BodyOnCharacteristics) -> bool:
    """Return True if the contact of a body with waves resists slip by another damping than its waves, whose damping is Z."""
    return body.has_waves and body.damping != body.impedance


def as_slab(body: BodyOnCharacteristics, refusal: str = "needs an elastic slab") -> ElasticSlab:
    """Return a body that must be a slab. Raises InputError with the text `refusal` for any other body."""
    if not isinstance(body, ElasticSlab):
        raise InputError(refusal)
    return body


def as_block(body: BodyOnCharacteristics) -> SpringBlock:
    """Return a body that must be a block; raise InputError for any other body."""
    if not isinstance(body, SpringBlock):
        raise InputError("needs a spring-block")
    return body


def _check_body(body: SpringBlock | ElasticSlab, normal: str) -> None:
    """Check the fields of a body whose normal load is called `normal`: a number, whereas a history belongs to the problem."""
    value = getattr(body, normal)
    if hasattr(value, "segments"):
        one = f"{type(body).__name__}: {normal} is one number, that at the start"
        raise InputError(f"{one}: a history is normal_load of the Problem, [loading.normal_load] in a scenario")
    check_fields(body)


@dataclass(frozen=True)
class SpringBlock(Declared):
    """A rigid block pulled through a spring: m dv/dt + damping v + tau = K (D0 + V t - u). Loads and tractions are forces, in N."""

    kind: ClassVar[str] = "spring-block"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (4)-(6); the damping is an addition"
    load_unit: ClassVar[str] = "N"
    has_waves: ClassVar[bool] = False
    has_inertia: ClassVar[bool] = True
    driver_impedance: ClassVar[float] = math.inf
    """The end of the spring is displaced as prescribed, as the face of a slab is by a rigid driver."""
    is_driven_rigidly: ClassVar[bool] = True
    has_machine: ClassVar[bool] = False
    driver_inertia: ClassVar[float] = 0.0
    driver_integral_gain: ClassVar[float] = 0.0
    reflection: ClassVar[float] = 0.0

    mass: Number = quantity("kg", "mass m", above=0)
    stiffness: Number = quantity("N/m", "stiffness K of the spring", above=0)
    normal_force: Number = quantity("N", "normal force S on the contact, compression positive", above=0)
    damping: Number = quantity("N s/m", "viscous resistance to slip", at_least=0, default=0.0)

    def __post_init__(self) -> None:
        _check_body(self, "normal_force")

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


@dataclass(frozen=True)
class ElasticSlab(Declared):
    """A slab of given thickness in antiplane or in-plane shear: rho u_tt = G u_xx, friction at x = 0, a driver at x = h.

    A driver of finite impedance is a half-space. With a mass or an integral gain it is a machine, and the impedance is its
    proportional gain: M dVd/dt = Zd (V - Vd) + ki phi + far stress - stress, with dphi/dt = V - Vd. With a contact mass the slip
    rate has no jumps (shocks). Raises InputError if a number is out of range, or `p_wave_speed` does not exceed sqrt(4/3)
    `wave_speed`.
    """

    kind: ClassVar[str] = "elastic-slab"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (7)-(13)"
    load_unit: ClassVar[str] = "Pa"
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
    driver_inertia: Number = quantity(
        "kg/m^2", "mass of the driver, per unit area: inf for a rigid driver", at_least=0, infinite=True, word="rigid", default=0.0
    )
    driver_integral_gain: Number = quantity(
        "Pa/m", "stress with which the driver makes up for each metre that it lags behind its pull rate", at_least=0, default=0.0
    )
    contact_mass: Number = quantity("kg/m^2", "mass of the sliding face, per unit area", at_least=0, default=0.0)
    p_wave_speed: OptionalNumber = quantity(
        "m/s", "compressional wave speed: only for the (constant) normal strain", above=0, default=None
    )

    def __post_init__(self) -> None:
        _check_body(self, "normal_stress")
        self._check_driver()
        if self.p_wave_speed is not None and self.p_wave_speed <= self.wave_speed * math.sqrt(4 / 3):
            limit = self.wave_speed * math.sqrt(4 / 3)
            raise InputError(
                f"ElasticSlab: p_wave_speed must exceed sqrt(4/3) wave_speed = {limit:g} m/s, got {self.p_wave_speed:g}"
            )

    def _check_driver(self) -> None:
        rigid, gain = np.isinf(self.driver_impedance), np.greater(self.driver_integral_gain, 0.0)
        heavy = np.greater(self.driver_inertia, 0.0) & ~np.isinf(self.driver_inertia)
        for name, given in (("driver_inertia", heavy), ("driver_integral_gain", gain)):
            if np.any(given & rigid):
                why = "a rigid driver holds its rate whatever its mass and gains"
                raise InputError(f"ElasticSlab: {name} needs a finite driver_impedance, the proportional gain: {why}")
        if np.any(gain & np.equal(self.driver_impedance, 0.0)):
            why = "nothing damps the driver, and its swings grow where friction falls with the slip rate"
            raise InputError(
                f"ElasticSlab: driver_integral_gain needs a driver_impedance, the proportional gain, above 0: without it {why}"
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

        It is -1 for a rigid driver, 0 for a matched half-space and +1 for a dead load. A driver with a mass or an integral gain
        sends back a wave that depends on how long the one that it meets lasts: r holds where neither is felt.
        """
        if np.all(np.isinf(self.driver_impedance) | np.isinf(self.driver_inertia)):
            return RIGID
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @property
    def front_reflection(self) -> float:
        """The share of a sharp wave front that the driver sends back: a mass has no time to give way."""
        return RIGID if np.any(np.greater(self.driver_inertia, 0.0)) else self.reflection

    @cached_property
    def is_driven_rigidly(self) -> bool:
        """True if the driver reflects the whole wave with its sign reversed, r = -1."""
        return bool(np.all(self.reflection == RIGID))

    @cached_property
    def has_machine(self) -> bool:
        """True if the driver has a motion of its own: a mass or an integral gain."""
        own = np.greater(self.driver_inertia, 0.0) | np.greater(self.driver_integral_gain, 0.0)
        return bool(np.any(own)) and not self.is_driven_rigidly

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


BODIES: dict[str, type[BodyOnCharacteristics]] = {body.kind: body for body in (SpringBlock, ElasticSlab)}
"""Every body by its name in scenario files."""
