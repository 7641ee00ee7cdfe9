"""Explicit schemes: central differences with lumped mass, at the contact or moved from it, and the method of characteristics."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.schemes.contract import Energies, Grid, Meeting, Sample, SchemeContact, strain_energy
from stickslip.foundation.arrays import Floats


class CentralDifferences:
    """Leap-frog in time: velocities at half steps, friction at the mean of the two that surround a step. Second order.

    The contact node has the mass rho dx/2, and therefore the effective impedance Z / (Courant number).
    """

    order, largest_courant = 2.0, 1.0

    def __init__(self, name: str, title: str, courant: float) -> None:
        self.name, self.title, self.courant = name, title, courant

    def begin(self, grid: Grid) -> LeapFrog:
        """Return the slab at t = 0."""
        return LeapFrog(grid)


class MassRedistribution:
    """Leap-frog in time without mass at the contact node, which holds in balance at every step; its mass moves to the next node.

    The balance is taken with the slip rate of the step that leads to it: second order in the slip for friction of slip, first order
    for friction of slip rate. The effective impedance is Z (Courant number).

    Source: H.B. Khenous, P. Laborde, Y. Renard 2008, Eur. J. Mech. A 27, 918, who redistribute the mass so that the total, the
    centre and the moment are kept; here, in one dimension, only the total is.
    """

    name, title, order, courant, largest_courant = "mass-redistribution", "mass redistribution", 2.0, 0.8, 1.0

    def begin(self, grid: Grid) -> MasslessContact:
        """Return the slab at t = 0."""
        return MasslessContact(grid)


class Regularised(CentralDifferences):
    """Friction mu tanh(v/v0) with v0 = `smoothing` S (range of mu)/Z: the contact never sticks, but creeps.

    It tends to friction with stick as v0 tends to 0, not with the grid.
    """

    order = 0.0
    smoothing = 1e-3

    def __init__(self) -> None:
        super().__init__("regularised", "central differences, friction mu tanh(v/v0)", 0.8)


class LeapFrog:
    """A slab with lumped masses; `rate` holds the velocities half a step after the displacements.

    The energy (v M v + u K u')/2 at a half step, with the displacements u before and u' after it, changes by the works of friction
    and driver on the mean of the velocities around a step, and by nothing else. A sample has the mean of the energies around it.
    """

    def __init__(self, grid: Grid) -> None:
        self.grid, self.step = grid, 0
        self.driver, self.friction = 0.0, 0.0
        self.displacement: Floats = np.zeros(grid.cells + 1)
        self.rate: Floats = grid.start_rates
        self.contact_rate = 0.0
        self.mass = np.full(grid.cells + 1, grid.density * grid.dx)
        self.mass[[0, -1]] *= 0.5
        self.energies = Energies(0.5 * float(self.mass @ self.rate**2), 0.0, 0.0, 0.0)

    def _forces(self) -> Floats:
        """Return the elastic force on each node, Pa; displacements count from the start."""
        tension = np.diff(self.displacement) * (self.grid.shear_modulus / self.grid.dx)
        return np.diff(np.concatenate([[0.0], tension, [0.0]]))

    def _kick_interior(self, forces: Floats, step: float) -> float:
        """Change the velocities of all nodes but the contact's over a step (s), and return the traction of the driver (Pa)."""
        grid, time = self.grid, self.step * self.grid.dt
        last = float(self.rate[-1])
        self.rate[1:-1] += step * forces[1:-1] / self.mass[1:-1]
        if grid.is_rigid:
            self.rate[-1] = grid.pull_rate
            return -float(forces[-1])
        push, drag = grid.push(time), grid.driver_impedance
        inertia = self.mass[-1] / step
        self.rate[-1] = ((inertia - 0.5 * drag) * last + forces[-1] + push) / (inertia + 0.5 * drag)
        return float(push - 0.5 * drag * (last + self.rate[-1]))

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state just after t = 0: half a step from the velocities at t = 0."""
        return self._kick(contact, 0.5 * self.grid.dt)

    def advance(self, contact: SchemeContact) -> Sample:
        """Move the displacements by one step, and the velocities from half a step before to half a step after it."""
        self.displacement += self.grid.dt * self.rate
        self.step += 1
        return self._kick(contact, self.grid.dt)

    def _kick(self, contact: SchemeContact, step: float) -> Sample:
        grid, before, forces = self.grid, self.rate.copy(), self._forces()
        push = self._kick_interior(forces, step)
        start = step < grid.dt  # then velocities are known at the step itself, not half a step before
        inertia = self.mass[0] / step
        held = grid.stress + forces[0] + inertia * before[0]
        share = 1.0 if start else 2.0
        meeting = Meeting(held + (share - 1.0) * inertia * before[0], share * inertia, grid.slip + self.displacement[0])
        rate, traction = contact.meet(meeting, self.contact_rate)
        sticks = rate == 0.0
        traction = held if sticks else traction
        self.rate[0] = 0.0 if sticks else share * rate - (share - 1.0) * before[0]
        self.contact_rate = rate
        self.driver += step * push * 0.5 * float(before[-1] + self.rate[-1])
        self.friction += step * (traction - grid.stress) * 0.5 * float(before[0] + self.rate[0])
        earlier = self.energies
        self._count(self.displacement, self.displacement + grid.dt * self.rate)
        shown = earlier if start else Energies(*(0.5 * (a + b) for a, b in zip(earlier, self.energies, strict=True)))
        return Sample(self.step * grid.dt, float(self.displacement[0]), rate, traction, shown)

    def _count(self, before: Floats, after: Floats) -> None:
        """Take over the energies at a half step, with the displacements (m) before and after it."""
        stored = 0.5 * float(self.mass @ self.rate**2) + strain_energy(self.grid, before, after)
        middle = 0.5 * (before + after)
        own = Energies(stored, self.driver, self.friction, 0.0)
        self.energies = own.beside(self.grid.stress, float(middle[0]), float(middle[-1]))


class MasslessContact(LeapFrog):
    """A slab whose contact node has no mass. A sample has the energies of half a step before, the last that are known."""

    def __init__(self, grid: Grid) -> None:
        super().__init__(grid)
        self.mass[1] += self.mass[0]
        self.mass[0] = 0.0
        self.energies = Energies(0.5 * float(self.mass @ self.rate**2), 0.0, 0.0, 0.0)
        self.before: Floats = self.displacement.copy()
        self.excess = 0.0

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state at t = 0, when nothing has moved."""
        grid, last = self.grid, float(self.rate[-1])
        push = self._kick_interior(self._forces(), 0.5 * grid.dt)
        self.driver += 0.5 * grid.dt * push * 0.5 * (last + float(self.rate[-1]))
        return Sample(0.0, 0.0, 0.0, grid.stress, self.energies)

    def advance(self, contact: SchemeContact) -> Sample:
        """Move all nodes but the contact's by one step, put the contact in balance with them, and kick."""
        grid, node, last = self.grid, float(self.displacement[0]), float(self.rate[-1])
        earlier, self.before = float(self.before[0]), self.displacement.copy()
        self.displacement[1:] += grid.dt * self.rate[1:]
        self.step += 1
        stiffness = grid.shear_modulus / grid.dx
        load = grid.stress + stiffness * (float(self.displacement[1]) - node)
        meeting = Meeting(load, stiffness * grid.dt, grid.slip + node, grid.dt)
        self.contact_rate, traction = contact.meet(meeting, self.contact_rate)
        self.displacement[0] = node + grid.dt * self.contact_rate
        self.friction += 0.5 * self.excess * (float(self.displacement[0]) - earlier)
        self.excess = traction - grid.stress
        self._count(self.before, self.displacement)
        push = self._kick_interior(self._forces(), grid.dt)
        self.driver += grid.dt * push * 0.5 * (last + float(self.rate[-1]))
        return Sample(self.step * grid.dt, float(self.displacement[0]), self.contact_rate, traction, self.energies)


class Characteristics:
    """Riemann variables on a grid of Courant number 1; slip by the trapezoidal rule. Second order."""

    name, title, order, courant, largest_courant = "characteristics", "method of characteristics", 2.0, 1.0, 1.0

    def begin(self, grid: Grid) -> WavesOnGrid:
        """Return the slab at t = 0."""
        return WavesOnGrid(grid)


class WavesOnGrid:
    """The waves in the slab: `to_contact` holds Z v + sigma at the nodes, `to_driver` Z v - sigma; stresses minus the first one."""

    def __init__(self, grid: Grid) -> None:
        self.grid, self.step = grid, 0
        self.to_contact: Floats = grid.impedance * grid.start_rates
        self.to_driver: Floats = self.to_contact.copy()
        self.slip, self.rate, self.excess, self.driven = 0.0, 0.0, 0.0, 0.0
        self.driver, self.friction = 0.0, 0.0

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state just after t = 0."""
        return self._meet(contact, 0.0)

    def advance(self, contact: SchemeContact) -> Sample:
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

    def _meet(self, contact: SchemeContact, step: float) -> Sample:
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
