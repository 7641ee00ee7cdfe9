"""Define what bodies of layers share: their cells, and what follows from the stacks on each side of the contact."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, cast

from stickslip.foundation.conversion import Number, OptionalNumbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.problem.bodies.contract import BodyOnCharacteristics, check_equivalent
from stickslip.problem.bodies.layered.cells import CellCut
from stickslip.problem.bodies.layered.layers import (
    Layers,
    cells_for,
    check_lengths,
    driver_of,
    even,
    given_drag,
    longest_cell,
    travel_times,
)
from stickslip.problem.bodies.layered.sides import Joined, Sides
from stickslip.problem.bodies.uniform.with_waves import WithWaves

DRAG_STEP = Quantity("1", "largest share of a wave that drag takes at one place", above=0)
LARGEST_STEP = 0.5
"""A user may allow at most this `drag_step` (1)."""
USUAL_STEP = 0.02
"""The `drag_step` (1) unless it is given."""


class OfLayers(WithWaves, ABC):
    """What follows from the stacks of layers of a body, one or two: a base for such bodies."""

    load_unit: ClassVar[str]
    part: ClassVar[str] = "layer"  # what sentences call one
    timed: ClassVar[tuple[str, ...]] = ("thickness", "wave_speed")  # the lists that decide travel times, and so the cells
    untimed: ClassVar[str] = "densities"  # words for lists that do not
    impedance_formula: ClassVar[str] = "rho c"
    structure: ClassVar[str] = "layered"
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
    def sides_together(self) -> Sides:
        """How the sides go together."""
        return Joined()

    @property
    def is_joined(self) -> bool:
        """True if there are two sides that move as one."""
        return False

    @property
    def _stiffness(self) -> list[float]:
        return [one.stiffness for one in self.stacks]

    @property
    def has_drag(self) -> bool:
        """True if there is drag in any layer, against which waves die."""
        return any(one.drag is not None for one in self.stacks)

    @property
    def impedance(self) -> float:
        """The impedance Z at the contact (Pa s/m), which damps the slip there."""
        return self.sides_together.together([one.impedances[0] for one in self.stacks])

    @property
    def last_impedance(self) -> float:
        """The impedance of the layer at the (first) driver (Pa s/m)."""
        return self.stacks[0].impedances[-1]

    @property
    def stiffness(self) -> float:
        """The decrease of the load per metre of slow slip under rigid drivers (Pa/m)."""
        return self.sides_together.together(self._stiffness)

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: that to the first place where cells meet, and back."""
        return 2.0 * self.cells.time

    @property
    def two_way_time(self) -> float:
        """The longest two-way travel time (s) from the contact to a driver, through all layers."""
        return 2.0 * max(sum(one.counts) * one.time for one in self.stacks)

    @property
    def longest_way(self) -> float:
        """The time (s) of a wave to the driver and back, through all layers."""
        return self.two_way_time

    @property
    def time_to_driver(self) -> float:
        """The time (s) of a wave through all layers to the (first) driver."""
        return sum(self.stacks[0].counts) * self.stacks[0].time

    def grows_in_a_trip(self, rate: Any) -> Any:
        """Return the growth of the load (Pa) at rest in one `round_trip_time`, under rigid drivers at a rate (m/s)."""
        return self.stiffness * rate * self.round_trip_time

    @property
    def drivers(self) -> int:  # type: ignore[override] # a constant of bodies with one
        """The number of drivers: one for each side."""
        return len(self.stacks)

    @property
    def has_ground(self) -> bool:  # type: ignore[override]
        """True unless two sides slip on each other: each is then the ground of the other."""
        return self.sides_together.has_ground

    def check_uniform(self, refusal: str) -> None:
        """Refuse: it has layers."""
        raise InputError(f"needs a uniform body with waves: a {type(self).__name__} has layers")

    def meets_driver_at_first(self, excess: Any, rate: Any, shear: Any) -> Any:
        """Return the wave (Pa, minus the reference strength) that meets the first driver at the start."""
        behind = self.first_share * (excess - self.impedance * rate) + self.held_at_start(rate, shear)[0]
        return self.last_impedance * (rate + shear) - behind

    @property
    def pulled_shares(self) -> list[float]:
        """The share (1) of each driver in an inflow that varies: 0 of one that is held."""
        first = self.last_impedance
        return [one.impedances[-1] / first if pulled else 0.0 for one, pulled in zip(self.stacks, self.is_pulled, strict=True)]

    @property
    def first_share(self) -> float:  # type: ignore[override]
        """The share (1) of the load that the first side bears."""
        return self.shares[0]

    @property
    def shares(self) -> list[float]:
        """The share (1) of the load that each side bears."""
        return self.sides_together.shares(self._stiffness)

    @property
    def is_pulled(self) -> list[bool]:
        """True for each side whose driver is pulled; it is held on another."""
        return self.sides_together.is_pulled(self.drivers)

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

    def added_at_contact(self, sent: tuple[Any, Any]) -> tuple[Any, Any]:
        """Return nothing: each driver behind layers has its own inflow, in the ladder."""
        return 0.0, 0.0

    def rates_at_start(self, rate: float, shear: float) -> list[tuple[float, float]]:
        """Return the velocities (m/s, towards forward slip) of the contact and of the driver on each side.

        The contact slips at `rate`, and the drivers move apart by `shear` faster than that; sides that are apart share this.
        """
        return self.sides_together.rates_at_start(rate, shear, self._stiffness)

    def held_at_start(self, rate: float, shear: float) -> list[float]:
        """Return the stress (Pa) that drag takes at the start between the contact and the driver of each side."""
        rates = self.rates_at_start(rate, shear)
        return [float(one.held(*both)[-1]) for one, both in zip(self.stacks, rates, strict=True)]

    def slow_limit(self) -> tuple[float, float]:
        """Return the mass and the damping (SI) of the layers and their contact in slow motion, under rigid drivers.

        The mass has the kinetic energy of the layers, in which the velocity falls from the contact to a driver in proportion to the
        compliance passed, and the damping has the loss by their drag and by a dashpot.
        Raises InputError if a driver is not rigid.
        """
        soft = "other_driver_impedance" if math.isinf(self.stacks[0].driver_impedance) else "driver_impedance"
        check_equivalent(cast(BodyOnCharacteristics, self), soft)
        shares = self.sides_together.slipping(self._stiffness)
        mass = sum(share * share * one.slow_mass for share, one in zip(shares, self.stacks, strict=True))
        damping = sum(share * share * one.slow_damping for share, one in zip(shares, self.stacks, strict=True))
        return mass, damping + self.contact_damping


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
