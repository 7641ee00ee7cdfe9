"""What a numerical scheme is, and its series: it moves the body by one step, and leaves the contact equation to the contact.

A scheme that treats the contact implicitly, at one node, finds two numbers in each step: the load, which is the traction that the
contact would have if its slip rate were 0, and an effective impedance. The contact then solves

    impedance v + traction(u, v) = load,    u = slip + slip_per_rate v,

and the scheme completes its step with the slip rate and the traction that come back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem


@dataclass(frozen=True)
class Grid:
    """A slab cut into equal cells, with its driver and its start, for a run; every number in SI.

    Displacements count from the start. There the slab has the uniform stress `stress` and the velocity V x/h.
    """

    cells: int
    density: float
    """rho, kg/m^3."""
    wave_speed: float
    """c, m/s."""
    thickness: float
    """h, m."""
    driver_impedance: float
    """Zd, Pa s/m; inf for a rigid driver."""
    pull_rate: float
    """V, m/s."""
    stress: float
    """Shear stress at t = 0, Pa."""
    far_stress: float
    """Far stress at t = 0 minus `stress`, Pa."""
    far_stress_rate: float
    """Pa/s."""
    slip: float
    """Slip at t = 0, m."""
    courant: float
    """Courant number c dt / dx."""
    problem: Problem
    """The problem itself, for a scheme that takes more from it."""
    duration: float
    """s; the last step ends there or just beyond it."""

    @property
    def dx(self) -> float:
        """The length of a cell, m."""
        return self.thickness / self.cells

    @property
    def dt(self) -> float:
        """The step of time, s."""
        return self.courant * self.dx / self.wave_speed

    @property
    def impedance(self) -> float:
        """Z = rho c, Pa s/m."""
        return self.density * self.wave_speed

    @property
    def shear_modulus(self) -> float:
        """G = rho c^2, Pa."""
        return self.density * self.wave_speed**2

    @property
    def is_rigid(self) -> bool:
        """True if the driver prescribes the displacement."""
        return bool(np.isinf(self.driver_impedance))

    @property
    def start_rates(self) -> Floats:
        """The velocity V x/h of each node at t = 0, m/s."""
        return self.pull_rate * np.linspace(0.0, 1.0, self.cells + 1)

    def push(self, t: float) -> float:
        """Return the traction (Pa, minus that of the start) which a driver that gives way would exert on a slab at rest."""
        return self.far_stress + self.far_stress_rate * t + self.driver_impedance * self.pull_rate


class Meeting(NamedTuple):
    """The contact equation of one step, all but the friction."""

    load: float
    """Traction at slip rate 0, Pa."""
    impedance: float
    """Effective impedance, Pa s/m."""
    slip: float
    """Slip at slip rate 0, m."""
    slip_per_rate: float = 0.0
    """Increase of the slip with the slip rate of this step, s; 0 if the scheme knows the slip beforehand."""


class Met(NamedTuple):
    """The slip rate (m/s) and the traction (Pa) that solve the contact equation of one step."""

    rate: float
    traction: float


class SchemeContact(Protocol):
    """The contact, as a scheme sees it."""

    def meet(self, meeting: Meeting, before: float) -> Met:
        """Solve the contact equation of a step; `before` is the slip rate (m/s) of the step before."""


class Energies(NamedTuple):
    """The balance of a scheme's own energy since t = 0, J/m^2: stored + friction + damped - driver is constant.

    Each scheme counts so that the balance of its discrete equations closes to rounding: with velocities of half steps,
    the norm of its differences, or means of two tractions. All of these tend to the energies of the exact slab.
    """

    stored: float
    """Kinetic energy, and strain energy without that of the uniform stress at t = 0."""
    driver: float
    """Work of the driver."""
    friction: float
    """Work against friction, that is heat."""
    damped: float
    """Energy that the scheme itself dissipates, by a formula of its own; negative if it makes energy."""

    def beside(self, stress: float, slip: float, driven: float) -> Energies:
        """Return the whole energies, if these are of stresses beyond the uniform one (Pa) of the start.

        `slip` and `driven` are the displacements (m) of the contact and of the driver.
        """
        stored, driver, friction, damped = self
        return Energies(stored + stress * (driven - slip), driver + stress * driven, friction + stress * slip, damped)


class Sample(NamedTuple):
    """What a scheme shows at the end of a step."""

    time: float
    """s."""
    slip: float
    """Slip since the start, m."""
    rate: float
    """Slip rate, m/s."""
    traction: float
    """Traction at the contact, Pa."""
    energies: Energies | None = None
    """The balance of energy; None if the scheme does not count it."""


class Motion(Protocol):
    """A body in motion on a grid under one scheme."""

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state just after t = 0."""

    def advance(self, contact: SchemeContact) -> Sample:
        """Move by one step of time, and return the state at its end."""


class Scheme(Protocol):
    """A numerical scheme for a slab; an object with these attributes and this method is one."""

    name: str
    title: str
    order: float
    """Order of convergence of the slip where the slip rate is smooth and friction depends on slip."""
    courant: float
    """Courant number that is taken if none is given."""
    largest_courant: float
    """Largest stable Courant number; inf for a scheme that is stable with any step."""

    def begin(self, grid: Grid) -> Motion:
        """Return the slab at rest against its contact, at t = 0."""


def strain_energy(grid: Grid, displacement: Floats, later: Floats | None = None) -> float:
    """Return the strain energy (J/m^2) of displacements from the start on linear elements, without that of the uniform stress.

    With displacements of the step after, the result changes by the work of the elastic forces at the step between two such results.
    """
    strain = np.diff(displacement)
    other = strain if later is None else np.diff(later)
    return 0.5 * grid.shear_modulus / grid.dx * float(strain @ other)


@dataclass(frozen=True, eq=False)
class Series:
    """A series at the contact: slip since t = 0 (m), slip rate (m/s) and traction (Pa) at ascending times (s).

    `name` is that of the scheme or program, and `cells` the number of cells in the thickness, 0 if unknown. `energies` has a row of
    `Energies` (J/m^2) for each time, or is None. Raises InputError if there are fewer than three times, if they do not ascend, or
    if shapes differ or a number is not finite.
    """

    time: Floats
    slip: Floats
    rate: Floats
    traction: Floats
    name: str = "series"
    cells: int = 0
    energies: Floats | None = None

    def __post_init__(self) -> None:
        if self.time.size < 3:
            raise InputError(f"{self.name}: a series needs three or more times, got {self.time.size}")
        back = np.flatnonzero(np.diff(self.time) <= 0.0)
        if back.size:
            before, after = self.time[back[0] : back[0] + 2].tolist()
            raise InputError(f"{self.name}: times must ascend, but {after:.12g} s (sample {back[0] + 2}) follows {before:.12g} s")
        for name in ("time", "slip", "rate", "traction"):
            values = getattr(self, name)
            if values.shape != self.time.shape:
                raise InputError(f"{self.name}: {name} must have as many numbers as there are times")
            if not np.isfinite(values).all():
                raise InputError(f"{self.name}: {name}: a number is not finite")

    @property
    def step(self) -> float:
        """The median step of time, s."""
        return float(np.median(np.diff(self.time)))
