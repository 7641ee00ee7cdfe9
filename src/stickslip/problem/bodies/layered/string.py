"""Define a string in torsion of several sections, such as drill pipe and collars. Slip is an angle, in rad."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.conversion import Number, Numbers, OptionalNumber, OptionalNumbers
from stickslip.foundation.quantities import NumberSeries, Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import check_body, check_driver
from stickslip.problem.bodies.layered.of_layers import DRAG_STEP, USUAL_STEP, OfOneSide, check_stacks
from stickslip.problem.bodies.on_bit import BIT_RADIUS, NORMAL_TORQUE, WEIGHT_ON_BIT, OnBit
from stickslip.problem.bodies.rigid.blocks import RotatingBlock
from stickslip.problem.bodies.soft_torque import with_soft_torque
from stickslip.problem.bodies.uniform.string import (
    CONTACT_DAMPING,
    DRIVE,
    DRIVE_INERTIA,
    DRIVE_INTEGRAL_GAIN,
    INNER,
    OUTER,
    check_pipe,
    polar_moment_of,
)

LISTS = ("length", "outer_diameter", "inner_diameter", "density", "shear_modulus", "drag")
"""The lists that have a number for each section."""


def _of_sections(unit: str, meaning: str) -> NumberSeries:
    return NumberSeries(Quantity(unit, f"{meaning}, from the bit outwards", above=0), least=1)


def _from_zero(unit: str, meaning: str) -> NumberSeries:
    return NumberSeries(Quantity(unit, meaning, at_least=0), least=1)


@dataclass(frozen=True)
class SectionedString(Declared, OnBit, OfOneSide):
    """A string in torsion of several sections, such as drill pipe and collars, with a bit at x = 0 and a drive behind the last one.

    Lists go from the bit outwards. The bit resists with the torque S mu, where S is `normal_torque`, or `weight_on_bit` times
    `bit_radius`; `inertia` turns with it. A section has the polar moment J of its diameters, the inertia per length rho J and the
    impedance J sqrt(rho G), and waves are reflected where impedances differ. Sections are cut into cells that a wave crosses in
    equal times; their travel times are rounded to whole numbers of cells, as those of a `LayeredSlab` are.

    With `drag` D, such as that of mud, rho J dv/dt = dM/dx - D v, with the torque M: D is the torque that a metre meets for each
    rad/s. With `driver_inertia` or `driver_integral_gain` the drive is a machine, as that of a `TorsionalString` can be, and with
    `contact_damping` the bit resists as there. Raises
    InputError if a number is out of range, if an inner diameter is not below the outer one, if the lists differ in length, or if no
    more than 4096 cells can be as exact as `travel_time_error`.
    """

    kind: ClassVar[str] = "sectioned-string"
    source: ClassVar[str] = "Goupillaud 1961, Geophysics 26, 754, for the sections; Campillo et al. 1996, eqs (7)-(13), with angles"
    load_unit: ClassVar[str] = "N m"
    noun: ClassVar[str] = "string"
    mass_field: ClassVar[str] = "inertia"
    part: ClassVar[str] = "section"
    timed: ClassVar[tuple[str, ...]] = ("length", "density", "shear_modulus")
    untimed: ClassVar[str] = "diameters"
    impedance_formula: ClassVar[str] = "J sqrt(rho G)"

    length: Numbers = declare(_of_sections("m", "length of each section"))
    outer_diameter: Numbers = declare(_of_sections("m", OUTER))
    inner_diameter: Numbers = declare(_from_zero("m", f"{INNER}, from the bit outwards"))
    density: Numbers = declare(_of_sections("kg/m^3", "density rho of each section"))
    shear_modulus: Numbers = declare(_of_sections("Pa", "shear modulus G of each section"))
    weight_on_bit: OptionalNumber = declare(WEIGHT_ON_BIT, None)
    bit_radius: OptionalNumber = declare(BIT_RADIUS, None)
    normal_torque: OptionalNumber = declare(NORMAL_TORQUE, None)
    driver_impedance: Number = declare(DRIVE, math.inf)
    inertia: Number = quantity("kg m^2", "moment of inertia of the bit", at_least=0, default=0.0)
    travel_time_error: Number = quantity("1", "largest relative error of a section's travel time", above=0, default=1e-3)
    drag: OptionalNumbers = declare(_from_zero("N s", "drag on each section: torque over rotation rate for each metre"), None)
    drag_step: Number = declare(DRAG_STEP, USUAL_STEP)
    driver_inertia: Number = declare(DRIVE_INERTIA, 0.0)
    driver_integral_gain: Number = declare(DRIVE_INTEGRAL_GAIN, 0.0)
    contact_damping: Number = declare(CONTACT_DAMPING, 0.0)

    def __post_init__(self) -> None:
        check_body(self)
        check_driver(self)
        check_stacks(self, [LISTS], self.drag_step)
        for i, (outer, inner) in enumerate(zip(self.outer_diameter, self.inner_diameter, strict=True)):
            check_pipe(type(self).__name__, outer, inner, f"[{i}]")
        self.check_bit()
        _ = self.cells

    @property
    def wave_speeds(self) -> tuple[float, ...]:
        """The speed sqrt(G / rho) of torsional waves in each section (m/s)."""
        return tuple(math.sqrt(stiff / rho) for stiff, rho in zip(self.shear_modulus, self.density, strict=True))

    @property
    def fastest_rate(self) -> float:
        """The slip rate (rad/s) at which the surface of a section would move as fast as its waves run."""
        return min(2.0 * speed / outer for speed, outer in zip(self.wave_speeds, self.outer_diameter, strict=True))

    @property
    def inertia_per_length(self) -> tuple[float, ...]:
        """The moment of inertia per length rho J of each section (kg m)."""
        moments = (polar_moment_of(*both) for both in zip(self.outer_diameter, self.inner_diameter, strict=True))
        return tuple(rho * moment for rho, moment in zip(self.density, moments, strict=True))

    @property
    def given(self) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
        """The length of each section, its inertia per length, and its wave speed."""
        return self.length, self.inertia_per_length, self.wave_speeds

    def with_soft_torque(self, setting: Any, gain: Any = None, inertia: Any = None) -> SectionedString:
        """Return the string with a drive tuned to a period of stick-slip (s, or a text such as "5 s"), or "impedance matched".

        The setting gives `driver_impedance`, `driver_inertia` and `driver_integral_gain`: see
        `stickslip.problem.bodies.soft_torque`. `gain` (N m s) takes the place of the impedance of the pipe, and `inertia` (kg m^2)
        that of the drive. Raises InputError.
        """
        return with_soft_torque(self, setting, gain, inertia)

    def equivalent_block(self) -> RotatingBlock:
        """Return the rotating block to which the string is equivalent in slow motion, with the bit.

        Its stiffness is that of the sections in series; its inertia and damping are those of `slow_limit`. Raises InputError if the
        drive is not stiff.
        """
        inertia, damping = self.slow_limit()
        return RotatingBlock(inertia + self.inertia, self.stiffness, self.normal_load, damping)
