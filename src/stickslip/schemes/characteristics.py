"""The method of characteristics: waves move by one cell in one step, so that only the contact is approximated."""

from __future__ import annotations

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.schemes.contract import Contact, Energies, Grid, Meeting, Sample


class Characteristics:
    """Riemann variables on a grid of Courant number 1; slip by the trapezoidal rule. Second order."""

    name, title, order, courant, largest_courant = "characteristics", "method of characteristics", 2.0, 1.0, 1.0

    def begin(self, grid: Grid) -> Waves:
        """Return the slab at t = 0."""
        return Waves(grid)


class Waves:
    """The waves in the slab: `to_contact` holds Z v + sigma at the nodes, `to_driver` Z v - sigma; stresses minus the first one."""

    def __init__(self, grid: Grid) -> None:
        self.grid, self.step = grid, 0
        self.to_contact: Floats = grid.impedance * grid.start_rates
        self.to_driver: Floats = self.to_contact.copy()
        self.slip, self.rate, self.excess, self.driven = 0.0, 0.0, 0.0, 0.0
        self.driver, self.friction = 0.0, 0.0

    def first(self, contact: Contact) -> Sample:
        """Return the state just after t = 0."""
        return self._meet(contact, 0.0)

    def advance(self, contact: Contact) -> Sample:
        """Move each wave by one cell, and meet the driver and the contact."""
        grid, self.step = self.grid, self.step + 1
        rate_before, power_before = self._driver()
        self.to_contact = np.append(self.to_contact[1:], 0.0)
        self.to_driver = np.append(0.0, self.to_driver[:-1])
        wave, Z = float(self.to_driver[-1]), grid.impedance
        if grid.is_rigid:
            self.to_contact[-1] = 2.0 * Z * grid.pull_rate - wave
        else:
            rate = (wave + grid.push(self.step * grid.dt)) / (Z + grid.driver_impedance)
            self.to_contact[-1] = 2.0 * Z * rate - wave
        rate_after, power_after = self._driver()
        self.driven += 0.5 * grid.dt * (rate_before + rate_after)
        self.driver += 0.5 * grid.dt * (power_before + power_after)
        return self._meet(contact, grid.dt)

    def _driver(self) -> tuple[float, float]:
        """Return the rate of the driver (m/s), and its power beyond that of the uniform stress, W/m^2."""
        incoming, outgoing = float(self.to_contact[-1]), float(self.to_driver[-1])
        rate = (incoming + outgoing) / (2.0 * self.grid.impedance)
        return rate, 0.5 * (incoming - outgoing) * rate

    def _meet(self, contact: Contact, step: float) -> Sample:
        grid = self.grid
        load, half = grid.stress + float(self.to_contact[0]), 0.5 * step
        slip = grid.slip + self.slip + half * self.rate
        rate, traction = contact.meet(Meeting(load, grid.impedance, slip, half), self.rate)
        excess = traction - grid.stress
        self.slip += half * (self.rate + rate)
        self.friction += half * (self.excess * self.rate + excess * rate)
        self.rate, self.excess = rate, excess
        self.to_driver[0] = grid.impedance * rate - excess
        density = (self.to_contact**2 + self.to_driver**2) / (4.0 * grid.shear_modulus)
        own = Energies(float(np.trapezoid(density, dx=grid.dx)), self.driver, self.friction, 0.0)
        return Sample(self.step * grid.dt, self.slip, rate, traction, own.beside(grid.stress, self.slip, self.driven))
