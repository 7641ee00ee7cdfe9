"""A stack of layers between a contact and a driver, cut into cells of equal travel time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from stickslip.bodies.cells import CellCut, cut_into_cells
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import NumberSeries, Quantity

LARGEST_ERROR = 0.1
"""Largest relative error (1) of a layer's travel time that may be allowed."""


def of_layers(unit: str, meaning: str) -> NumberSeries:
    """Declare a number of each layer, from the contact outwards."""
    return NumberSeries(Quantity(unit, f"{meaning} of each layer, from the contact outwards", above=0), least=1)


@dataclass(frozen=True)
class Layers:
    """The layers on one side of a contact, from the contact outwards, and the impedance of the driver behind them (Pa s/m).

    `counts` is the number of cells of each layer, and `time` what a wave takes to cross one (s).
    """

    density: tuple[float, ...]
    wave_speed: tuple[float, ...]
    counts: tuple[int, ...]
    time: float
    driver_impedance: float

    @property
    def impedances(self) -> tuple[float, ...]:
        """The impedance rho c of each layer (Pa s/m)."""
        return tuple(rho * c for rho, c in zip(self.density, self.wave_speed, strict=True))

    @property
    def cell_impedances(self) -> tuple[float, ...]:
        """The impedance of each cell (Pa s/m)."""
        return tuple(z for z, count in zip(self.impedances, self.counts, strict=True) for _ in range(count))

    @property
    def thickness(self) -> tuple[float, ...]:
        """The thickness of each layer (m) that makes its travel time a whole number of cells."""
        return tuple(n * self.time * c for n, c in zip(self.counts, self.wave_speed, strict=True))

    @property
    def passed(self) -> Floats:
        """The share (1) of the compliance between the contact and each place where cells meet, from 0 to 1 at the driver."""
        return np.array([0.0, *accumulate(1.0 / z for z in self.cell_impedances)]) * (self.stiffness * self.time)

    @property
    def stiffness(self) -> float:
        """The decrease of the stress per metre of slow slip under a rigid driver (Pa/m): the cells are springs Z / T in series."""
        return 1.0 / (self.time * math.fsum(1.0 / z for z in self.cell_impedances))

    @property
    def slow_mass(self) -> float:
        """The mass (kg/m^2) with the kinetic energy of slow slip, whose velocity falls with the compliance passed."""
        near, far = 1.0 - self.passed[:-1], 1.0 - self.passed[1:]
        masses = np.array(self.cell_impedances) * self.time
        return float(np.sum(masses * (near * near + near * far + far * far))) / 3.0

    @property
    def reflection(self) -> float:
        """The reflection coefficient of the driver for waves in the last layer."""
        if math.isinf(self.driver_impedance):
            return RIGID
        return (self.impedances[-1] - self.driver_impedance) / (self.impedances[-1] + self.driver_impedance)

    @property
    def inflow_delay(self) -> float:
        """The time (s) from the driver to the nearest place an even number of cells from the contact (`engine.waves.ladder`)."""
        return self.time if sum(self.counts) % 2 == 1 else 0.0

    @property
    def interface_reflections(self) -> tuple[float, ...]:
        """The share of a wave of stress from the contact that comes back where a layer meets the next one: (Z' - Z) / (Z' + Z).

        It is above 0 in front of a stiffer layer.
        """
        return tuple((beyond - near) / (beyond + near) for near, beyond in pairwise(self.impedances))


def travel_times(thickness: Sequence[float], wave_speed: Sequence[float]) -> tuple[float, ...]:
    """Return the time h/c (s) that a wave takes to cross each layer, before it is rounded."""
    return tuple(h / c for h, c in zip(thickness, wave_speed, strict=True))


def check_lengths(owner: str, names: Sequence[str], lists: Sequence[Sequence[float]]) -> None:
    """Raise InputError unless lists of numbers of layers are equally long."""
    if len({len(one) for one in lists}) > 1:
        found = ", ".join(f"{len(one)} of {name}" for name, one in zip(names, lists, strict=True))
        raise InputError(f"{owner}: {', '.join(names[:-1])} and {names[-1]} need one number for each layer, got {found}")


def cells_for(owner: str, times: tuple[float, ...], allowed: float) -> CellCut:
    """Return the cells of layers with these travel times (s). Raises InputError, which begins with `owner`, if there are none."""
    if allowed > LARGEST_ERROR:
        raise InputError(f"{owner}: travel_time_error must be at most {LARGEST_ERROR:g}, got {allowed:g}")
    try:
        return cut_into_cells(times, allowed)
    except InputError as error:
        raise InputError(f"{owner}: {error}") from None
