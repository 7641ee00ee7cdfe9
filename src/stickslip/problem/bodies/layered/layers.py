"""A stack of layers between a contact and a driver, cut into cells of equal travel time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import NumberSeries, Quantity
from stickslip.problem.bodies.layered.cells import CellCut, cut_into_cells

LARGEST_ERROR = 0.1
"""A user may allow at most this relative error (1) of a layer's travel time."""


def of_layers(unit: str, meaning: str, side: str = "") -> NumberSeries:
    """Declare a number above 0 of each layer on one side, from the contact outwards."""
    return NumberSeries(Quantity(unit, f"{meaning} of each layer{side}, from the contact outwards", above=0), least=1)


def drag_of_layers(side: str = "") -> NumberSeries:
    """Declare the drag of each layer on one side."""
    meaning = f"viscous drag of each layer{side}: stress over velocity for each metre of thickness"
    return NumberSeries(Quantity("Pa s/m^2", meaning, at_least=0), least=1)


@dataclass(frozen=True)
class Layers:
    """The layers on one side of a contact, from the contact outwards, and the impedance of the driver behind them (Pa s/m).

    Units below are for a slab. The layers of a string are its sections: read inertia per length (kg m) for density, N m for Pa, and
    rad for m where it is slip.

    `counts` is the number of cells of each layer, and `time` what a wave takes to cross one (s). Layers with drag have an even
    number of them: the drag of two cells acts between these, on the velocity there.
    """

    density: tuple[float, ...]
    wave_speed: tuple[float, ...]
    counts: tuple[int, ...]
    time: float
    driver_impedance: float
    drag: tuple[float, ...] | None = None
    """Drag of each layer (Pa s/m^2), if there is any."""
    driver_inertia: float = 0.0
    """Mass of a driver that is a machine (kg/m^2)."""
    driver_gain: float = 0.0
    """Its integral gain (Pa/m)."""

    @property
    def drags(self) -> Floats:
        """The stress over velocity (Pa s/m) that drag takes at the far end of each cell."""
        if self.drag is None:
            return np.zeros(sum(self.counts))
        lengths = 2.0 * self.time * np.array(self.wave_speed)
        found = np.repeat(np.array(self.drag) * lengths, self.counts)
        found[1::2] = 0.0
        return found

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

    def rates(self, contact: float, driver: float) -> Floats:
        """Return the velocity (m/s) at each place where cells meet while the layers are sheared evenly between two velocities."""
        return np.asarray(contact + (driver - contact) * self.passed)

    def held(self, contact: float, driver: float) -> Floats:
        """Return the stress (Pa) that drag then takes between the contact and each of these places."""
        return np.append(0.0, np.cumsum(self.drags * self.rates(contact, driver)[1:]))

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
    def slow_damping(self) -> float:
        """The damping (Pa s/m) with the loss of slow slip, beyond what drag takes under a driver while the contact rests."""
        left = 1.0 - self.passed[1:]
        return float(np.sum(self.drags * left * left))

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


def driver_of(impedance: float, inertia: float, gain: float) -> tuple[float, float, float]:
    """Return impedance, mass and integral gain of a driver: one of infinite mass is rigid."""
    return (math.inf, 0.0, 0.0) if math.isinf(inertia) else (impedance, inertia, gain)


def even(found: CellCut) -> CellCut:
    """Return cells whose number is even: half as long ones if it is odd."""
    odd = sum(found.counts) % 2 == 1
    return CellCut(tuple(2 * count for count in found.counts), 0.5 * found.time, found.error) if odd else found


def travel_times(thickness: Sequence[float], wave_speed: Sequence[float]) -> tuple[float, ...]:
    """Return the time h/c (s) that a wave takes to cross each layer, before it is rounded."""
    return tuple(h / c for h, c in zip(thickness, wave_speed, strict=True))


def check_lengths(owner: str, part: str, names: Sequence[str], lists: Sequence[Sequence[float]]) -> None:
    """Raise InputError unless lists of numbers of layers, each called a `part`, are equally long."""
    if len({len(one) for one in lists}) > 1:
        found = ", ".join(f"{len(one)} of {name}" for name, one in zip(names, lists, strict=True))
        raise InputError(f"{owner}: {', '.join(names[:-1])} and {names[-1]} need one number for each {part}, got {found}")


def given_drag(drag: Sequence[float] | None) -> tuple[float, ...] | None:
    """Return the drags of layers (Pa s/m^2), or None if there is no drag at all."""
    return tuple(drag) if drag is not None and any(drag) else None


def longest_cell(density: Sequence[float], drag: Sequence[float] | None, step: float) -> float:
    """Return the longest time (s) that two halves of a cell may take, so that drag takes at most the share `step` (1) of a wave."""
    return min((2.0 * step * rho / one for rho, one in zip(density, drag or (), strict=False) if one > 0.0), default=math.inf)


def cells_for(owner: str, times: tuple[float, ...], allowed: float, longest: float) -> CellCut:
    """Return the cells of layers with these travel times (s). Raises InputError, which begins with `owner`, if there are none.

    `longest` is that of `cut_into_cells`.
    """
    if allowed > LARGEST_ERROR:
        raise InputError(f"{owner}: travel_time_error must be at most {LARGEST_ERROR:g}, got {allowed:g}")
    try:
        return cut_into_cells(times, allowed, longest)
    except InputError as error:
        raise InputError(f"{owner}: {error}") from None
