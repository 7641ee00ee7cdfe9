"""Define a column of soil: an elastic slab with a free top, whose modes are damped."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import Name
from stickslip.foundation.quantities import Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import check_body
from stickslip.problem.bodies.rigid.blocks import SpringBlock
from stickslip.problem.bodies.uniform.hysteretic import LARGEST_DAMPING, Damper, damper_of
from stickslip.problem.bodies.uniform.slab import ElasticSlab
from stickslip.problem.bodies.uniform.with_waves import WithWaves


@dataclass(frozen=True)
class SoilColumn(Declared, WithWaves):
    """A column of soil in shear on a contact with friction, with a free top: rho u_tt = G u_xx, damped as by hysteresis.

    Stuck at its base, the column swings in modes. The first has the period 4 h/c, and the first two the damping ratio that is
    given; modes 3, 4 and 5 have about 0.7, 0.5 and 0.4 of it. A column that slides as a whole is not damped at all: if it is stiff
    it is a rigid block of the mass rho h. Gravity along a slope is the far stress, by default the initial load. Without damping the
    column is an `ElasticSlab` with ``driver_impedance=0``.

    The damping is that of a mass behind a dashpot at the top, which is taken from the column: see `damper`. Places and stresses in
    the column are those of the part that carries waves. Raises InputError if a number is out of range.
    """

    kind: ClassVar[str] = "soil-column"
    source: ClassVar[str] = "Campillo et al. 1996, eqs (7)-(13), with a free top; the damper is ours"
    load_unit: ClassVar[str] = "Pa"
    noun: ClassVar[str] = "column"
    mass_field: ClassVar[str] = ElasticSlab.mass_field
    modulus_name: ClassVar[Name] = ElasticSlab.modulus_name
    impedance_formula: ClassVar[str] = "rho c, of a damped column less by the factor of its stretch"
    driver_may_change: ClassVar[bool] = False
    inertia: ClassVar[float] = 0.0
    driver_impedance: ClassVar[float] = 0.0
    driver_inertia: ClassVar[float] = 0.0
    driver_integral_gain: ClassVar[float] = 0.0

    density: Number = quantity("kg/m^3", "density rho", above=0)
    wave_speed: Number = quantity("m/s", "shear wave speed c", above=0)
    thickness: Number = quantity("m", "thickness h", above=0)
    normal_stress: Number = quantity("Pa", "normal stress S on the contact, compression positive", above=0)
    damping_ratio: Number = declare(Quantity("1", "damping ratio of modes 1 and 2", at_least=0, at_most=LARGEST_DAMPING), 0.0)

    def __post_init__(self) -> None:
        check_body(self)

    @cached_property
    def damper(self) -> Damper:
        """The damper at the top, as shares of the column."""
        if np.ndim(self.damping_ratio):  # members of a batch, which has none that are damped
            return damper_of(0.0)
        return damper_of(float(self.damping_ratio))

    @property
    def is_damped(self) -> bool:  # type: ignore[override]
        """True if there is a damper at the top."""
        return anywhere(np.greater(self.damping_ratio, 0.0))

    @property
    def driver_kind(self) -> str:
        """The kind of driver: "damper", or that of a free top."""
        return "damper" if self.is_damped else "lossy"

    @property
    def impedance(self) -> float:
        """The wave impedance Z (Pa s/m)."""
        return self.density * self.wave_speed / self.damper.stretch

    @property
    def modulus(self) -> float:
        """The shear modulus of the part that carries waves (Pa)."""
        return self.density * self.wave_speed**2 / self.damper.stretch

    @property
    def distance(self) -> float:
        """The thickness (m) of the part that carries waves."""
        return self.thickness * ((1.0 - self.damper.mass) * self.damper.stretch)

    @property
    def dashpot_of_damper(self) -> float:
        """The dashpot D of the damper (Pa s/m)."""
        return self.damper.dashpot * self.impedance

    @property
    def mass_of_damper(self) -> float:
        """The mass of the damper (kg/m^2)."""
        return self.damper.mass * self.density * self.thickness

    @property
    def pace_of_damper(self) -> float:
        """How fast the damper takes up what it meets (1/s): Z D / mass / (Z + D)."""
        return self.dashpot_of_damper / self.mass_of_damper / (1.0 + self.damper.dashpot)

    @cached_property
    def reflection(self) -> float:
        """The share of a sharp wave front that the top sends back, (Z - D) / (Z + D)."""
        return (1.0 - self.damper.dashpot) / (1.0 + self.damper.dashpot)

    def equivalent_block(self) -> SpringBlock:
        """Raise InputError: nothing holds the column, so that there is no spring."""
        raise InputError("SoilColumn: equivalent_block needs a body that is held, and the top of a column is free")
