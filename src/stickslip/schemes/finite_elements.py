"""Linear finite elements of the slab: matrices, and what all implicit schemes share."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import splu

from stickslip.foundation.arrays import Floats
from stickslip.schemes.contract import Contact, Energies, Grid, Meeting, Sample, strain_energy


class Elements(ABC):
    """A slab of linear elements with consistent mass; `force` is what accelerated the nodes at the last step, Pa.

    A step is linear but for the friction: the velocities at its end are `free` minus `reply` times the traction of the contact.
    Energy is counted with the matrices of the elements, and with the forces at the ends that the scheme takes in a step.
    """

    def __init__(self, grid: Grid) -> None:
        self.grid, self.step = grid, 0
        self.driver, self.friction, self.damped = 0.0, 0.0, 0.0
        count = grid.cells + 1
        ends = np.ones(count)
        ends[[0, -1]] = 0.5
        self.mass = grid.density * grid.dx / 6.0 * diags_array([4.0 * ends, 1.0, 1.0], offsets=[0, 1, -1], shape=(count, count))
        self.stiffness = (
            grid.shear_modulus / grid.dx * diags_array([2.0 * ends, -1.0, -1.0], offsets=[0, 1, -1], shape=(count, count))
        )
        drag = np.zeros(count)
        drag[-1] = 0.0 if grid.is_rigid else grid.driver_impedance
        self.drag = diags_array(drag)
        self.displacement: Floats = np.zeros(count)
        self.rate: Floats = grid.start_rates
        self.contact_rate, self.traction, self.excess_before = 0.0, grid.stress, 0.0

    def solver(self, matrix: csc_matrix, weight: float) -> None:
        """Factorise the matrix of a step for the velocities at its end, in which the new traction has a weight."""
        system = csc_matrix(matrix).tolil()
        if self.grid.is_rigid:
            system[-1, :] = 0.0
            system[-1, -1] = 1.0
        self.system = splu(system.tocsc())
        unit = np.zeros(self.grid.cells + 1)
        unit[0] = weight
        self.reply: Floats = self.system.solve(unit)

    def push(self, step: int) -> Floats:
        """Return the forces from outside at a step, Pa: the driver's, if it gives way."""
        force = np.zeros(self.grid.cells + 1)
        if not self.grid.is_rigid:
            force[-1] = self.grid.push(step * self.grid.dt)
        return force

    def imbalance(self) -> Floats:
        """Return the force on each node at the last step, Pa."""
        force: Floats = self.push(self.step) - self.stiffness @ self.displacement - self.drag @ self.rate
        force[0] -= self.excess
        return force

    @property
    def excess(self) -> float:
        """Return the traction of the contact at the last step minus the uniform stress at t = 0, Pa."""
        return self.traction - self.grid.stress

    def first(self, contact: Contact) -> Sample:
        """Return the state just after t = 0: the traction of sudden slip, before any node has moved."""
        grid = self.grid
        self.contact_rate, self.traction = contact.meet(Meeting(grid.stress, grid.impedance, grid.slip), 0.0)
        self.begin()
        return self._sample()

    def begin(self) -> None:  # noqa: B027 # most schemes need nothing
        """Prepare what the scheme needs at t = 0."""

    @abstractmethod
    def predict(self) -> tuple[Floats, float]:
        """Return the right-hand side without the new traction, and the increase of a displacement with the new velocity, s."""

    @abstractmethod
    def finish(self, rate: Floats) -> None:
        """Take over the velocities at the end of the step."""

    @abstractmethod
    def base(self) -> float:
        """Return the displacement of the contact node at the end of the step if its velocity is 0 there, m."""

    def advance(self, contact: Contact) -> Sample:
        """Move by one step of time."""
        grid = self.grid
        right, per_rate = self.predict()
        right[0] += self.weight * grid.stress
        if grid.is_rigid:
            right[-1] = grid.pull_rate
        free = self.system.solve(right)
        impedance = 1.0 / float(self.reply[0])
        meeting = Meeting(impedance * float(free[0]), impedance, grid.slip + self.base(), per_rate)
        self.excess_before = self.excess
        self.contact_rate, self.traction = contact.meet(meeting, self.contact_rate)
        rate = free - self.reply * self.traction
        rate[0] = self.contact_rate
        self.step += 1
        self.finish(rate)
        return self._sample()

    weight = 1.0
    """Weight of the new traction in a step."""

    def kinetic_energy(self, rate: Floats) -> float:
        """Return the kinetic energy of velocities at the nodes, J/m^2."""
        return 0.5 * float(rate @ (self.mass @ rate))

    def stored(self) -> float:
        """Return the energy that the balance of the scheme counts, without that of the uniform stress, J/m^2."""
        return self.kinetic_energy(self.rate) + strain_energy(self.grid, self.displacement)

    def _sample(self) -> Sample:
        slip, driven = float(self.displacement[0]), float(self.displacement[-1])
        own = Energies(self.stored(), self.driver, self.friction, self.damped)
        return Sample(self.step * self.grid.dt, slip, self.contact_rate, self.traction, own.beside(self.grid.stress, slip, driven))
