"""Define slabs of layers: one, and two with the contact between them or on both."""

from __future__ import annotations

import math
from abc import ABC
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from stickslip.foundation.conversion import Number, Numbers, OptionalNumbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.contract import check_body, check_driver
from stickslip.problem.bodies.layered.cells import CellCut
from stickslip.problem.bodies.layered.layers import (
    Layers,
    cells_for,
    drag_of_layers,
    given_drag,
    longest_cell,
    of_layers,
    travel_times,
)
from stickslip.problem.bodies.layered.of_layers import DRAG_STEP, USUAL_STEP, OfLayers, OfOneSide, check_stacks
from stickslip.problem.bodies.layered.sides import Apart, Joined, Sides
from stickslip.problem.bodies.rigid.blocks import SpringBlock
from stickslip.problem.bodies.uniform.slab import CONTACT_DAMPING, DRIVER_INERTIA, DRIVER_INTEGRAL_GAIN

APART, JOINED = "apart", "joined"
"""What slips on two slabs: one on the other, or both on a third body, such as the two parts of a string under a bow."""
TIES_OF_SIDES: dict[str, Sides] = {APART: Apart(), JOINED: Joined()}
OTHER = " on the other side"
LISTS = ("thickness", "density", "wave_speed", "drag")
"""The lists of one side of a slab that have a number for each layer."""


def _driver(side: str) -> Quantity:
    meaning = f"impedance Zd of the driver{side}: inf for a rigid driver, 0 for a dead load"
    return Quantity("Pa s/m", meaning, at_least=0, infinite=True, word="rigid")


class OfSlabs(OfLayers, ABC):
    """What slabs of layers have: stresses for loads, and a mass of the sliding face."""

    load_unit: ClassVar[str] = "Pa"
    mass_field: ClassVar[str] = "contact_mass"
    noun: ClassVar[str] = "slab"
    contact_mass: Number
    normal_stress: Number

    @property
    def inertia(self) -> float:
        """The contact mass (kg/m^2)."""
        return self.contact_mass

    def equivalent_block(self) -> SpringBlock:
        """Return the block to which the body is equivalent in slow motion, for each m^2 of contact.

        Its stiffness is that of the layers in series, and of both sides in series, or side by side if they are joined; its mass and
        its damping are those of `slow_limit`, with the contact mass. Raises InputError if a driver is not rigid.
        """
        mass, damping = self.slow_limit()
        return SpringBlock(mass + self.contact_mass, self.stiffness, self.normal_stress, damping)


@dataclass(frozen=True)
class LayeredSlab(Declared, OfOneSide, OfSlabs):
    """A slab of layers in antiplane or in-plane shear, with friction at x = 0, and a driver behind the last layer.

    A wave is reflected where layers of different impedance rho c meet. The layers are cut into cells that a wave crosses in equal
    times; their travel times are rounded to whole numbers of cells, with a relative error of at most `travel_time_error`, while
    their impedances, and the travel time of all together, stay as given. Raises InputError if a number is out of range, if the
    lists differ in length, or if no more than 4096 cells can be so exact.

    With `drag` D, such as that of mud on a pipe, rho dv/dt = dsigma/dx - D v, with velocities v relative to the other side of the
    contact: waves die, and stress at rest stays. Drag is lumped in the middle of cells, so finely that none of these places takes
    more than the share `drag_step` of a wave. At the start the stress grows outwards by what drag takes while the driver pulls.

    With `driver_inertia` or `driver_integral_gain` the driver is a machine, and with `contact_damping` the contact resists slip
    besides, as those of an `ElasticSlab` can.
    """

    kind: ClassVar[str] = "layered-slab"
    source: ClassVar[str] = "Goupillaud 1961, Geophysics 26, 754, for the layers; Campillo et al. 1996, eqs (7)-(13)"

    thickness: Numbers = declare(of_layers("m", "thickness h"))
    density: Numbers = declare(of_layers("kg/m^3", "density rho"))
    wave_speed: Numbers = declare(of_layers("m/s", "shear wave speed c"))
    normal_stress: Number = quantity("Pa", "normal stress S on the contact, compression positive", above=0)
    driver_impedance: Number = declare(_driver(""), math.inf)
    contact_mass: Number = quantity("kg/m^2", "mass of the sliding face, per unit area", at_least=0, default=0.0)
    travel_time_error: Number = quantity("1", "largest relative error of a layer's travel time", above=0, default=1e-3)
    drag: OptionalNumbers = declare(drag_of_layers(), None)
    drag_step: Number = declare(DRAG_STEP, USUAL_STEP)
    driver_inertia: Number = declare(DRIVER_INERTIA, 0.0)
    driver_integral_gain: Number = declare(DRIVER_INTEGRAL_GAIN, 0.0)
    contact_damping: Number = declare(CONTACT_DAMPING, 0.0)

    def __post_init__(self) -> None:
        check_body(self)
        check_driver(self)
        check_stacks(self, [LISTS], self.drag_step)
        _ = self.cells

    @property
    def given(self) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
        """The thickness, density and wave speed of each layer."""
        return self.thickness, self.density, self.wave_speed


@dataclass(frozen=True)
class TwoSlabs(Declared, OfSlabs):
    """Two slabs of layers on both sides of a contact, each with a driver behind its last layer.

    With sides = "apart" one slab slips on the other: the driver of the first one is pulled, that of the other one is held. With
    sides = "joined" both move as one on the contact, as the two parts of a string do under a bow, and both drivers are pulled; the
    friction is then shared between them. Layers are cut into cells as those of a `LayeredSlab` are, and drag acts as there, on
    velocities as an observer sees them for whom the driver that is held, or the third body, rests. A contact mass is that of the
    place where the slabs are joined. `contact_damping` D adds D v to friction, with the slip rate v of one slab on the other,
    or of both on the third body. Raises InputError if a number is out of range, if lists differ in length, or if no more than 4096
    cells can be so exact.
    """

    kind: ClassVar[str] = "two-slabs"
    driver_inertia: ClassVar[float] = 0.0
    driver_integral_gain: ClassVar[float] = 0.0
    source: ClassVar[str] = "Goupillaud 1961, Geophysics 26, 754, for the layers; Campillo et al. 1996, eqs (7)-(13)"

    thickness: Numbers = declare(of_layers("m", "thickness h"))
    density: Numbers = declare(of_layers("kg/m^3", "density rho"))
    wave_speed: Numbers = declare(of_layers("m/s", "shear wave speed c"))
    other_thickness: Numbers = declare(of_layers("m", "thickness", OTHER))
    other_density: Numbers = declare(of_layers("kg/m^3", "density", OTHER))
    other_wave_speed: Numbers = declare(of_layers("m/s", "shear wave speed", OTHER))
    normal_stress: Number = quantity("Pa", "normal stress S on the contact, compression positive", above=0)
    driver_impedance: Number = declare(_driver(""), math.inf)
    other_driver_impedance: Number = declare(_driver(OTHER), math.inf)
    contact_mass: Number = quantity("kg/m^2", "mass at the contact of joined sides, per unit area", at_least=0, default=0.0)
    travel_time_error: Number = quantity("1", "largest relative error of a layer's travel time", above=0, default=1e-3)
    sides: str = declare(Choice("whether slip is between the sides, or they slip as one", (APART, JOINED)), APART)
    drag: OptionalNumbers = declare(drag_of_layers(), None)
    other_drag: OptionalNumbers = declare(drag_of_layers(OTHER), None)
    drag_step: Number = declare(DRAG_STEP, USUAL_STEP)
    contact_damping: Number = declare(CONTACT_DAMPING, 0.0)

    def __post_init__(self) -> None:
        check_body(self)
        check_stacks(self, [[f"{side}{name}" for name in LISTS] for side in ("", "other_")], self.drag_step)
        if self.contact_mass > 0.0 and self.sides == APART:
            why = "between two slabs it is not clear which of them it is on"
            raise InputError(f'{type(self).__name__}: contact_mass needs sides = "joined": {why}')
        _ = self.cells

    @property
    def sides_together(self) -> Sides:
        """How the sides go together."""
        return TIES_OF_SIDES[self.sides]

    @property
    def is_joined(self) -> bool:
        """True if both sides move as one."""
        return self.sides == JOINED

    @cached_property
    def cells(self) -> CellCut:
        """The cells of equal travel time that the layers of both sides are cut into.

        Both drivers are an even number of cells away from the contact, or both an odd number.
        """
        times = travel_times(self.thickness, self.wave_speed) + travel_times(self.other_thickness, self.other_wave_speed)
        drags = (self.density, self.drag), (self.other_density, self.other_drag)
        longest = min(longest_cell(density, drag, self.drag_step) for density, drag in drags)
        found, own = cells_for(type(self).__name__, times, self.travel_time_error, longest), len(self.thickness)
        if sum(found.counts[:own]) % 2 == sum(found.counts[own:]) % 2:
            return found
        return CellCut(tuple(2 * count for count in found.counts), 0.5 * found.time, found.error)

    @cached_property
    def stacks(self) -> tuple[Layers, ...]:
        """The layers of both sides with their cells."""
        own, counts, time = len(self.thickness), self.cells.counts, self.cells.time
        return (
            Layers(tuple(self.density), tuple(self.wave_speed), counts[:own], time, self.driver_impedance, given_drag(self.drag)),
            Layers(
                tuple(self.other_density),
                tuple(self.other_wave_speed),
                counts[own:],
                time,
                self.other_driver_impedance,
                given_drag(self.other_drag),
            ),
        )
