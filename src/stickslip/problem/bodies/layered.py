"""Define bodies of layers: a slab, and two slabs with the contact between them or on both."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, cast

from stickslip.foundation.conversion import Number, Numbers, OptionalNumbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity, declare, quantity
from stickslip.foundation.show import Declared
from stickslip.problem.bodies.cells import CellCut
from stickslip.problem.bodies.contract import BodyOnCharacteristics, WithWaves, check_body, check_driver, check_equivalent
from stickslip.problem.bodies.layers import (
    Layers,
    cells_for,
    check_lengths,
    drag_of_layers,
    driver_of,
    even,
    given_drag,
    longest_cell,
    of_layers,
    travel_times,
)
from stickslip.problem.bodies.sliding import DRIVER_INERTIA, DRIVER_INTEGRAL_GAIN, SpringBlock

APART, JOINED = "apart", "joined"
"""What slips on two slabs: one on the other, or both on a third body, such as the two parts of a string under a bow."""
OTHER = " on the other side"
LISTS = ("thickness", "density", "wave_speed", "drag")
"""The lists of one side of a slab that have a number for each layer."""
DRAG_STEP = Quantity("1", "largest share of a wave that drag takes at one place", above=0)
LARGEST_STEP = 0.5
"""Largest `drag_step` (1) that may be allowed."""
USUAL_STEP = 0.02
"""The `drag_step` (1) unless it is given."""


def _driver(side: str) -> Quantity:
    meaning = f"impedance Zd of the driver{side}: inf for a rigid driver, 0 for a dead load"
    return Quantity("Pa s/m", meaning, at_least=0, infinite=True, word="rigid")


class OfLayers(WithWaves, ABC):
    """What follows from the stacks of layers of a body, one or two: a base for such bodies."""

    load_unit: ClassVar[str]
    part: ClassVar[str] = "layer"  # what sentences call one
    timed: ClassVar[tuple[str, ...]] = ("thickness", "wave_speed")  # the lists that decide travel times, and so the cells
    untimed: ClassVar[str] = "densities"  # words for lists that do not
    impedance_formula: ClassVar[str] = "rho c"
    is_uniform: ClassVar[bool] = False
    travel_time_error: Number

    @property
    @abstractmethod
    def stacks(self) -> tuple[Layers, ...]:
        """The layers of each side, with their cells."""

    @property
    @abstractmethod
    def inertia(self) -> float:
        """The mass that slips with the contact (kg/m^2)."""

    @property
    @abstractmethod
    def cells(self) -> CellCut:
        """The cells of equal travel time that the layers are cut into."""

    @property
    def is_joined(self) -> bool:
        """True if there are two sides that move as one."""
        return False

    @property
    def has_drag(self) -> bool:
        """True if there is drag in any layer, against which waves die."""
        return any(one.drag is not None for one in self.stacks)

    def _together(self, numbers: tuple[float, ...]) -> float:
        """Return what several impedances or stiffnesses are together: sides that are joined resist side by side."""
        if len(numbers) == 1:
            return numbers[0]
        return sum(numbers) if self.is_joined else 1.0 / sum(1.0 / one for one in numbers)

    @property
    def impedance(self) -> float:
        """The impedance Z at the contact (Pa s/m), which damps the slip there."""
        return self._together(tuple(one.impedances[0] for one in self.stacks))

    @property
    def last_impedance(self) -> float:
        """The impedance of the layer at the (first) driver (Pa s/m)."""
        return self.stacks[0].impedances[-1]

    @property
    def stiffness(self) -> float:
        """The decrease of the load per metre of slow slip under rigid drivers (Pa/m)."""
        return self._together(tuple(one.stiffness for one in self.stacks))

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: that to the first place where cells meet, and back."""
        return 2.0 * self.cells.time

    @property
    def two_way_time(self) -> float:
        """The longest two-way travel time (s) from the contact to a driver, through all layers."""
        return 2.0 * max(sum(one.counts) * one.time for one in self.stacks)

    @property
    def inflow_delay(self) -> float:
        """The time (s) that a loading takes from the driver to where the engine adds it: see `engine.waves.ladder`."""
        return self.stacks[0].inflow_delay

    @property
    def is_driven_rigidly(self) -> bool:
        """True if no driver gives way."""
        return all(math.isinf(one.driver_impedance) for one in self.stacks)

    @property
    def has_machine(self) -> bool:
        """True if the driver has a motion of its own: a mass or an integral gain. It is an even number of cells away."""
        return any(one.driver_inertia > 0.0 or one.driver_gain > 0.0 for one in self.stacks)

    @property
    def distance(self) -> float:
        """The thickness of all layers (m), with their travel times rounded to cells."""
        return math.fsum(h for one in self.stacks for h in one.thickness)

    @property
    def fastest_rate(self) -> float:
        """The slip rate (m/s) at which the body would slide as fast as waves run in its slowest layer."""
        return min(min(one.wave_speed) for one in self.stacks)

    @cached_property
    def reflection(self) -> float:
        """The reflection coefficient of the (first) driver for waves in the last layer."""
        return self.stacks[0].reflection

    def rates_at_start(self, rate: float, shear: float) -> list[tuple[float, float]]:
        """Return the velocities (m/s, towards forward slip) of the contact and of the driver on each side.

        The contact slips at `rate`, and the drivers move apart by `shear` faster than that; sides that are apart share this.
        """
        if len(self.stacks) == 1 or self.is_joined:
            return [(rate, rate + shear)] * len(self.stacks)
        first, other = (shear * self.stiffness / one.stiffness for one in self.stacks)
        return [(rate + shear - first, rate + shear), (-other, 0.0)]

    def slow_limit(self) -> tuple[float, float]:
        """Return the mass and the damping (SI) of the layers in slow motion, under rigid drivers.

        The mass has the kinetic energy of the layers, in which the velocity falls from the contact to a driver in proportion to the
        compliance passed, and the damping has the loss by their drag. Raises InputError if a driver is not rigid.
        """
        soft = "other_driver_impedance" if math.isinf(self.stacks[0].driver_impedance) else "driver_impedance"
        check_equivalent(cast(BodyOnCharacteristics, self), soft)
        whole = self.stiffness
        shares = [1.0 if self.is_joined else whole / one.stiffness for one in self.stacks]
        mass = sum(share * share * one.slow_mass for share, one in zip(shares, self.stacks, strict=True))
        damping = sum(share * share * one.slow_damping for share, one in zip(shares, self.stacks, strict=True))
        return mass, damping


class OfOneSide(OfLayers, ABC):
    """What bodies have whose layers are on one side of the contact: their cells, and a driver that may be a machine."""

    driver_impedance: Number
    driver_inertia: Number
    driver_integral_gain: Number
    drag: OptionalNumbers
    drag_step: Number

    @property
    @abstractmethod
    def given(self) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
        """The length of each layer, its inertia per length, and its wave speed."""

    @cached_property
    def cells(self) -> CellCut:
        """The cells of equal travel time that the layers are cut into; an even number of them before a machine."""
        lengths, density, speeds = self.given
        longest = longest_cell(density, self.drag, self.drag_step)
        found = cells_for(type(self).__name__, travel_times(lengths, speeds), self.travel_time_error, longest)
        return even(found) if any(self._driver[1:]) else found

    @cached_property
    def stacks(self) -> tuple[Layers, ...]:
        """The layers with their cells."""
        _, density, speeds = self.given
        driver, *machine = self._driver
        drag = given_drag(self.drag)
        return (Layers(tuple(density), tuple(speeds), self.cells.counts, self.cells.time, driver, drag, *machine),)

    @property
    def _driver(self) -> tuple[float, float, float]:
        return driver_of(self.driver_impedance, self.driver_inertia, self.driver_integral_gain)


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

    With `driver_inertia` or `driver_integral_gain` the driver is a machine, as that of an `ElasticSlab` can be.
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
    place where the slabs are joined. Raises InputError if a number is out of range, if lists differ in length, or if no more than
    4096 cells can be so exact.
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

    def __post_init__(self) -> None:
        check_body(self)
        check_stacks(self, [[f"{side}{name}" for name in LISTS] for side in ("", "other_")], self.drag_step)
        if self.contact_mass > 0.0 and not self.is_joined:
            why = "between two slabs it is not clear which of them it is on"
            raise InputError(f'{type(self).__name__}: contact_mass needs sides = "joined": {why}')
        _ = self.cells

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


def check_stacks(body: OfLayers, sides: Sequence[Sequence[str]], drag_step: float) -> None:
    """Raise InputError unless the lists of each side have one number for each layer, and the share that drag takes is small."""
    for names in sides:
        given = {name: getattr(body, name) for name in names if getattr(body, name) is not None}
        check_lengths(type(body).__name__, body.part, list(given), list(given.values()))
    if drag_step > LARGEST_STEP:
        raise InputError(f"{type(body).__name__}: drag_step must be at most {LARGEST_STEP:g}, got {drag_step:g}")
    if drag_step != USUAL_STEP and all(getattr(body, names[-1]) is None for names in sides):
        drags = " or ".join(names[-1] for names in sides)
        raise InputError(f"{type(body).__name__}: drag_step needs {drags}: nothing is lumped without it")
