"""Define a string in torsion, such as a drill string. Slip is an angle, in rad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.conversion import Number, OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import Name
from stickslip.foundation.quantities import Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import check_body, check_driver, check_equivalent
from stickslip.problem.bodies.on_bit import BIT_RADIUS, NORMAL_TORQUE, WEIGHT_ON_BIT, OnBit
from stickslip.problem.bodies.rigid.blocks import RotatingBlock
from stickslip.problem.bodies.soft_torque import with_soft_torque
from stickslip.problem.bodies.uniform.with_waves import WithWaves, contact_damping

OUTER = "outer diameter of the section"
INNER = "inner diameter of the section"
DRIVE = Quantity(
    "N m s", "impedance Zd of the drive: inf for a stiff drive, 0 for a constant torque", at_least=0, infinite=True, word="rigid"
)
DRIVE_INERTIA = Quantity("kg m^2", "moment of inertia of the drive: inf for a stiff drive", at_least=0, infinite=True, word="rigid")
DRIVE_INTEGRAL_GAIN = Quantity(
    "N m/rad", "integral gain of the drive: torque for each radian that it lags behind its pull rate", at_least=0
)

CONTACT_DAMPING = contact_damping("N m s", "torque")


def check_pipe(owner: str, outer: float, inner: float, entry: str = "") -> None:
    """Raise InputError unless a pipe has a wall; diameters in m. `entry` is the index of a section, such as "[0]"."""
    if not np.all(np.less(inner, outer)):
        raise InputError(f"{owner}: inner_diameter{entry} must be below outer_diameter{entry} = {outer:g} m, got {inner:g}")


def polar_moment_of(outer: float, inner: float) -> float:
    """Return the polar moment J (m^4) of a pipe; diameters in m. Powers of an array may differ from those of a number by a bit."""
    return math.pi / 32.0 * (outer * outer * outer * outer - inner * inner * inner * inner)


@dataclass(frozen=True)
class TorsionalString(Declared, OnBit, WithWaves):
    """A string in torsion, such as a drill string: I u_tt = G J u_xx, a bit with friction at x = 0, a drive at x = length.

    The slip u is the angle (rad) of the bit, and loads are torques (N m). The bit resists with the torque S mu, where S is
    `normal_torque`, or `weight_on_bit` times `bit_radius`. The polar moment J of the section follows from `outer_diameter` and
    `inner_diameter` unless it is given as `polar_moment`; I = rho J is the inertia per length, and sqrt(I G J) = J sqrt(rho G) the
    impedance. A drive of finite impedance Zd turns slower than the pull rate by torque / Zd. With `driver_inertia` or
    `driver_integral_gain` it is a machine, as the driver of an `ElasticSlab` can be: a top drive under SoftTorque. With `inertia`,
    that of bit and collars, the rate has no jumps. With `contact_damping` D the bit resists with D v besides.
    """

    kind: ClassVar[str] = "torsional-string"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (7)-(13), with angles for lengths and torques for stresses"
    load_unit: ClassVar[str] = "N m"
    noun: ClassVar[str] = "string"
    mass_field: ClassVar[str] = "inertia"
    modulus_name: ClassVar[Name] = Name("torsional rigidity", "GJ", "N m^2", "torque per twist of a metre")
    impedance_formula: ClassVar[str] = "sqrt(I G J)"

    length: Number = quantity("m", "length of the string", above=0)
    density: Number = quantity("kg/m^3", "density rho", above=0)
    shear_modulus: Number = quantity("Pa", "shear modulus G", above=0)
    outer_diameter: OptionalNumber = quantity("m", OUTER, above=0, default=None)
    inner_diameter: Number = quantity("m", INNER, at_least=0, default=0.0)
    polar_moment: OptionalNumber = quantity("m^4", "polar moment J of the section, in place of diameters", above=0, default=None)
    weight_on_bit: OptionalNumber = declare(WEIGHT_ON_BIT, None)
    bit_radius: OptionalNumber = declare(BIT_RADIUS, None)
    normal_torque: OptionalNumber = declare(NORMAL_TORQUE, None)
    driver_impedance: Number = declare(DRIVE, math.inf)
    driver_inertia: Number = declare(DRIVE_INERTIA, 0.0)
    driver_integral_gain: Number = declare(DRIVE_INTEGRAL_GAIN, 0.0)
    inertia: Number = quantity("kg m^2", "moment of inertia of bit and collars", at_least=0, default=0.0)
    contact_damping: Number = declare(CONTACT_DAMPING, 0.0)

    def __post_init__(self) -> None:
        check_body(self)
        check_driver(self)
        if (self.polar_moment is None) == (self.outer_diameter is None) or (self.polar_moment is not None and self.inner_diameter):
            raise InputError("TorsionalString: give either outer_diameter, with inner_diameter of a pipe, or polar_moment")
        if self.outer_diameter is not None:
            check_pipe("TorsionalString", self.outer_diameter, self.inner_diameter)
        self.check_bit()

    @property
    def section(self) -> float:
        """The polar moment J of the section (m^4)."""
        if self.polar_moment is not None:
            return self.polar_moment
        assert self.outer_diameter is not None
        return polar_moment_of(self.outer_diameter, self.inner_diameter)

    @property
    def wave_speed(self) -> float:
        """The speed sqrt(G / rho) of torsional waves (m/s)."""
        found: float = np.sqrt(self.shear_modulus / self.density)
        return found

    @property
    def fastest_rate(self) -> float:
        """The slip rate (rad/s) at which the surface of the string would move as fast as its waves run.

        Where the diameters are not known, the string is as thin as its polar moment allows.
        """
        outer = self.outer_diameter or (32.0 / math.pi * self.section) ** 0.25
        return 2.0 * self.wave_speed / outer

    @property
    def inertia_per_length(self) -> float:
        """The moment of inertia per length, I = rho J (kg m)."""
        return self.density * self.section

    @property
    def modulus(self) -> float:
        """The torque per twist of a metre, G J (N m^2)."""
        return self.shear_modulus * self.section

    @property
    def impedance(self) -> float:
        """The wave impedance Z = sqrt(I G J) (N m s)."""
        return self.inertia_per_length * self.wave_speed

    @property
    def distance(self) -> float:
        """The length (m)."""
        return self.length

    def with_soft_torque(self, setting: Any, gain: Any = None, inertia: Any = None) -> TorsionalString:
        """Return the string with a drive tuned to a period of stick-slip (s, or a text such as "5 s"), or "impedance matched".

        The setting gives `driver_impedance`, `driver_inertia` and `driver_integral_gain`: see
        `stickslip.problem.bodies.soft_torque`. `gain` (N m s) takes the place of the impedance of the pipe, and `inertia` (kg m^2)
        that of the drive. Raises InputError.
        """
        return with_soft_torque(self, setting, gain, inertia)

    def equivalent_block(self) -> RotatingBlock:
        """Return the rotating block to which the string is equivalent in slow motion: K = G J / length, inertia I length / 3 + bit.

        The twist is then uniform, as in `ElasticSlab.equivalent_block`. Raises InputError if the drive is not stiff.
        """
        check_equivalent(self)
        inertia = self.inertia_per_length * self.length / 3.0 + self.inertia
        return RotatingBlock(inertia, self.stiffness, self.normal_load, self.contact_damping)
