"""The method of characteristics: waves move by one cell in one step, so that only the contact is approximated."""

from __future__ import annotations

import numpy as np

from stickslip.schemes.contract import Contact, Floats, Grid, Meeting, Sample


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
        self.slip, self.rate, self.work = 0.0, 0.0, 0.0

    def first(self, contact: Contact) -> Sample:
        """Return the state just after t = 0."""
        return self._meet(contact, 0.0)

    def advance(self, contact: Contact) -> Sample:
        """Move each wave by one cell, and meet the driver and the contact."""
        grid, self.step = self.grid, self.step + 1
        power = self._driver_power()
        self.to_contact = np.append(self.to_contact[1:], 0.0)
        self.to_driver = np.append(0.0, self.to_driver[:-1])
        wave, Z = float(self.to_driver[-1]), grid.impedance
        if grid.is_rigid:
            self.to_contact[-1] = 2.0 * Z * grid.pull_rate - wave
        else:
            rate = (wave + grid.push(self.step * grid.dt)) / (Z + grid.driver_impedance)
            self.to_contact[-1] = 2.0 * Z * rate - wave
        self.work += 0.5 * grid.dt * (power + self._driver_power())
        return self._meet(contact, grid.dt)

    def _driver_power(self) -> float:
        incoming, outgoing = float(self.to_contact[-1]), float(self.to_driver[-1])
        return (incoming + outgoing) * (incoming - outgoing) / (4.0 * self.grid.impedance)

    def _meet(self, contact: Contact, step: float) -> Sample:
        grid = self.grid
        load, half = grid.stress + float(self.to_contact[0]), 0.5 * step
        slip = grid.slip + self.slip + half * self.rate
        rate, traction = contact.meet(Meeting(load, grid.impedance, slip, half), self.rate)
        self.slip += half * (self.rate + rate)
        self.rate = rate
        self.to_driver[0] = grid.impedance * rate - (traction - grid.stress)
        density = (self.to_contact**2 + self.to_driver**2) / (4.0 * grid.shear_modulus)
        return Sample(self.step * grid.dt, self.slip, rate, traction, float(np.trapezoid(density, dx=grid.dx)), self.work)
