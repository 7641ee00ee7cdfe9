"""Define a slab of layers: each has its own density, wave speed and thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise
from typing import ClassVar

import numpy as np

from stickslip.bodies.cells import Cells, cut_into_cells
from stickslip.bodies.contract import WithWaves, check_body, check_driver, check_equivalent
from stickslip.bodies.sliding import SpringBlock
from stickslip.foundation.constants import RIGID
from stickslip.foundation.conversion import Number, Numbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import NumberSeries, Quantity, declare, quantity
from stickslip.foundation.show import Declared

LARGEST_ERROR = 0.1
"""Largest relative error (1) of a layer's travel time that may be allowed."""


def of_layers(unit: str, meaning: str) -> NumberSeries:
    """Declare a number of each layer, from the contact outwards."""
    return NumberSeries(Quantity(unit, f"{meaning} of each layer, from the contact outwards", above=0), least=1)


@dataclass(frozen=True)
class LayeredSlab(Declared, WithWaves):
    """A slab of layers in antiplane or in-plane shear, with friction at x = 0, and a driver behind the last layer.

    A wave is reflected where layers of different impedance rho c meet. The layers are cut into cells that a wave crosses in equal
    times; their travel times are rounded to whole numbers of cells, with a relative error of at most `travel_time_error`, while
    their impedances, and the travel time of all together, stay as given. Raises InputError if a number is out of range, if the
    lists differ in length, or if no more than 4096 cells can be so exact.
    """

    kind: ClassVar[str] = "layered-slab"
    source: ClassVar[str] = "Goupillaud 1961, Geophysics 26, 754, for the layers; Campillo et al. 1996, eqs (7)-(13)"
    load_unit: ClassVar[str] = "Pa"
    normal_field: ClassVar[str] = "normal_stress"
    mass_field: ClassVar[str] = "contact_mass"
    is_uniform: ClassVar[bool] = False
    driver_inertia: ClassVar[float] = 0.0
    driver_integral_gain: ClassVar[float] = 0.0

    thickness: Numbers = declare(of_layers("m", "thickness h"))
    density: Numbers = declare(of_layers("kg/m^3", "density rho"))
    wave_speed: Numbers = declare(of_layers("m/s", "shear wave speed c"))
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
    travel_time_error: Number = quantity("1", "largest relative error of a layer's travel time", above=0, default=1e-3)

    def __post_init__(self) -> None:
        check_body(self, "normal_stress")
        check_driver(self)
        lengths = {name: len(getattr(self, name)) for name in ("thickness", "density", "wave_speed")}
        if len(set(lengths.values())) > 1:
            found = ", ".join(f"{number} of {name}" for name, number in lengths.items())
            raise InputError(f"LayeredSlab: thickness, density and wave_speed need one number for each layer, got {found}")
        if self.travel_time_error > LARGEST_ERROR:
            raise InputError(f"LayeredSlab: travel_time_error must be at most {LARGEST_ERROR:g}, got {self.travel_time_error:g}")
        try:
            _ = self.cells
        except InputError as error:
            raise InputError(f"LayeredSlab: {error}") from None

    @cached_property
    def cells(self) -> Cells:
        """The cells of equal travel time that the layers are cut into."""
        return cut_into_cells(self.travel_times, self.travel_time_error)

    @property
    def travel_times(self) -> tuple[float, ...]:
        """The time h/c (s) that a wave takes to cross each layer, before it is rounded."""
        return tuple(h / c for h, c in zip(self.thickness, self.wave_speed, strict=True))

    @property
    def impedances(self) -> tuple[float, ...]:
        """The impedance rho c of each layer (Pa s/m)."""
        return tuple(rho * c for rho, c in zip(self.density, self.wave_speed, strict=True))

    @property
    def cell_impedances(self) -> tuple[float, ...]:
        """The impedance of each cell (Pa s/m), from the contact outwards."""
        return tuple(z for z, count in zip(self.impedances, self.cells.counts, strict=True) for _ in range(count))

    @property
    def impedance(self) -> float:
        """The impedance Z of the layer at the contact (Pa s/m), which damps the slip there."""
        return self.impedances[0]

    @property
    def last_impedance(self) -> float:
        """The impedance of the layer at the driver (Pa s/m)."""
        return self.impedances[-1]

    @property
    def round_trip_time(self) -> float:
        """The time (s) after which slip acts on the contact again: that to the first place where cells meet, and back."""
        return 2.0 * self.cells.time

    @property
    def two_way_time(self) -> float:
        """The two-way travel time (s) from the contact to the driver, through all layers."""
        return 2.0 * sum(self.travel_times)

    @property
    def inflow_delay(self) -> float:
        """How much later (s) than the driver sends it a load joins the waves at the places that count: see `waves.ladder`."""
        return self.cells.time if len(self.cell_impedances) % 2 == 1 else 0.0

    @property
    def distance(self) -> float:
        """The thickness of all layers (m), with their travel times rounded to cells."""
        return math.fsum(self.rounded_thickness)

    @property
    def rounded_thickness(self) -> tuple[float, ...]:
        """The thickness of each layer (m) that makes its travel time a whole number of cells."""
        time = self.cells.time
        return tuple(n * time * c for n, c in zip(self.cells.counts, self.wave_speed, strict=True))

    @property
    def compliances(self) -> tuple[float, ...]:
        """The shift of each cell in slow slip per shear stress, T / Z (m/Pa)."""
        return tuple(self.cells.time / z for z in self.cell_impedances)

    @property
    def stiffness(self) -> float:
        """The decrease of the load per metre of slow slip under a rigid driver (Pa/m): the layers are springs in series."""
        return 1.0 / math.fsum(self.compliances)

    @property
    def normal_load(self) -> float:
        """The normal stress S (Pa)."""
        return self.normal_stress

    @property
    def inertia(self) -> float:
        """The contact mass (kg/m^2)."""
        return self.contact_mass

    @cached_property
    def reflection(self) -> float:
        """The reflection coefficient of the driver for waves in the last layer."""
        if math.isinf(self.driver_impedance):
            return RIGID
        return (self.last_impedance - self.driver_impedance) / (self.last_impedance + self.driver_impedance)

    @property
    def interface_reflections(self) -> tuple[float, ...]:
        """The share of a wave of stress from the contact that comes back where a layer meets the next one: (Z' - Z) / (Z' + Z).

        It is above 0 in front of a stiffer layer.
        """
        zs = self.impedances
        return tuple((beyond - near) / (beyond + near) for near, beyond in pairwise(zs))

    def equivalent_block(self) -> SpringBlock:
        """Return the block to which the slab is equivalent in slow motion, for each m^2 of contact.

        Its stiffness is that of the layers in series. Its mass has the kinetic energy of the slab, in which the velocity falls
        from the contact to the driver in proportion to the compliance passed. Raises InputError if the driver is not rigid.
        """
        check_equivalent(self)
        time, zs = self.cells.time, self.cell_impedances
        passed = np.array([0.0, *accumulate(self.compliances)]) * self.stiffness
        near, far = 1.0 - passed[:-1], 1.0 - passed[1:]
        mass = float(np.sum(np.array(zs) * time * (near * near + near * far + far * far))) / 3.0
        return SpringBlock(mass=mass + self.contact_mass, stiffness=self.stiffness, normal_force=self.normal_stress)
