"""Implicit methods with linear finite elements: Newmark's of constant mean acceleration, its damped form HHT-alpha, and theta.

Sources: N.M. Newmark 1959, J. Eng. Mech. Div. ASCE 85, 67; H.M. Hilber, T.J.R. Hughes, R.L. Taylor 1977, Earthq. Eng. Struct. Dyn.
5, 283.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
from scipy.sparse import csc_matrix, diags_array
from scipy.sparse.linalg import splu, spsolve

from stickslip.extensions.schemes.contract import Energies, Grid, Meeting, Sample, SchemeContact, strain_energy
from stickslip.foundation.arrays import Floats


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
        """Factorise the matrix of a step for the velocities at its end; the new traction has a weight in them."""
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

    def first(self, contact: SchemeContact) -> Sample:
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

    def advance(self, contact: SchemeContact) -> Sample:
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


class Theta:
    """Forces and velocities of a step are the mean of old and new ones, with weights 1 - theta and theta.

    First order, unless theta is 1/2.
    """

    courant, largest_courant = 0.5, math.inf

    def __init__(self, name: str, title: str, theta: float) -> None:
        self.name, self.title, self.theta = name, title, theta
        self.order = 2.0 if theta == 0.5 else 1.0

    def begin(self, grid: Grid) -> Weighted:
        """Return the slab at t = 0."""
        return Weighted(grid, self.theta)


class Weighted(Elements):
    """A slab that moves by the theta method.

    A step dissipates (theta - 1/2) (dv M dv + du K du), with the changes dv and du of the velocities and displacements.
    """

    def __init__(self, grid: Grid, theta: float) -> None:
        super().__init__(grid)
        self.theta, self.weight = theta, theta
        step = theta * grid.dt
        self.solver(self.mass / grid.dt + theta * (self.drag + step * self.stiffness), theta)

    def predict(self) -> tuple[Floats, float]:
        """Return the right-hand side without the new traction, and the increase of a displacement with the new velocity, s."""
        theta, step = self.theta, self.grid.dt
        self.still = self.displacement + (1.0 - theta) * step * self.rate
        right = self.mass @ self.rate / step
        right += theta * (self.push(self.step + 1) - self.stiffness @ self.still) + (1.0 - theta) * self.imbalance()
        return right, theta * step

    def base(self) -> float:
        """Return the displacement of the contact node at the end of the step if its velocity is 0 there, m."""
        return float(self.still[0])

    def finish(self, rate: Floats) -> None:
        """Take over the velocities at the end of the step."""
        theta, step, change, before = self.theta, self.grid.dt, rate - self.rate, self.displacement
        self.displacement = self.still + theta * step * rate
        moved = self.displacement - before
        self.damped += (2.0 * theta - 1.0) * (self.kinetic_energy(change) + strain_energy(self.grid, moved))
        self.friction += float(moved[0]) * (theta * self.excess + (1.0 - theta) * self.excess_before)
        force = self.mass @ change / step + self.stiffness @ (before + theta * moved)
        self.driver += float(moved[-1]) * float(force[-1])
        self.rate = rate


class Newmark:
    """Forces of a step are the mean of old and new ones, with the weights alpha and 1 - alpha. Second order.

    With alpha = 0 it is Newmark's method, which keeps the energy of linear waves and damps none of them; alpha up to 1/3 damps
    those that the grid does not resolve. The other parameters are beta = (1 + alpha)^2/4 and gamma = 1/2 + alpha.
    """

    order, courant, largest_courant = 2.0, 0.5, math.inf

    def __init__(self, name: str, title: str, alpha: float) -> None:
        self.name, self.title, self.alpha = name, title, alpha

    def begin(self, grid: Grid) -> Accelerated:
        """Return the slab at t = 0."""
        return Accelerated(grid, self.alpha)


class Accelerated(Elements):
    """A slab whose state includes the accelerations of the nodes.

    With b = alpha (1/2 - alpha), changes du and da in a step, and the change du' in the step before, the balance stores
    v M v/2 + u K u/2 + alpha^2 dt^2 a M a/8 + b du K du/2 and dissipates b (du - du') K (du - du')/2 + alpha^3 dt^2 da M da/4. A
    force from outside does the work du (mean of its ends + b (its change - its change in the step before)).
    """

    def __init__(self, grid: Grid, alpha: float) -> None:
        super().__init__(grid)
        self.alpha, self.weight = alpha, 1.0 - alpha
        self.gamma, self.beta = 0.5 + alpha, 0.25 * (1.0 + alpha) ** 2
        self.per_rate, self.mixed = self.beta * grid.dt / self.gamma, alpha * (0.5 - alpha)
        matrix = self.mass / (self.gamma * grid.dt) + self.weight * (self.drag + self.per_rate * self.stiffness)
        self.solver(matrix, self.weight)

    def begin(self) -> None:
        """Find the accelerations at t = 0."""
        force, mass = self.imbalance(), self.mass.tolil()
        if self.grid.is_rigid:
            mass[-1, :] = 0.0
            mass[-1, -1], force[-1] = 1.0, 0.0
        self.acceleration: Floats = np.asarray(spsolve(mass.tocsc(), force))
        self.moved: Floats = np.zeros_like(force)
        self.push_before = float((self.mass @ self.acceleration)[-1])  # the driver's traction; nothing has moved
        self.push_change = self.excess_change = 0.0

    def predict(self) -> tuple[Floats, float]:
        """Return the right-hand side without the new traction, and the increase of a displacement with the new velocity, s."""
        step, old = self.grid.dt, self.acceleration
        self.rate_guess = self.rate + (1.0 - self.gamma) * step * old
        guess = self.displacement + step * self.rate + (0.5 - self.beta) * step**2 * old
        self.still = guess - self.per_rate * self.rate_guess
        right = self.mass @ self.rate_guess / (self.gamma * step)
        right += self.weight * (self.push(self.step + 1) - self.stiffness @ self.still) + self.alpha * self.imbalance()
        return right, self.per_rate

    def base(self) -> float:
        """Return the displacement of the contact node at the end of the step if its velocity is 0 there, m."""
        return float(self.still[0])

    def finish(self, rate: Floats) -> None:
        """Take over the velocities at the end of the step."""
        alpha, before, moved_before, old = self.alpha, self.displacement, self.moved, self.acceleration
        elastic_before = float((self.stiffness @ before)[-1])
        self.displacement = self.still + self.per_rate * rate
        self.acceleration = (rate - self.rate_guess) / (self.gamma * self.grid.dt)
        self.rate, self.moved = rate, self.displacement - before
        force = float((self.mass @ self.acceleration)[-1]) - alpha * (self.push_before - elastic_before)
        push = force / (1.0 - alpha) + float((self.stiffness @ self.displacement)[-1])
        self.driver += self._work(-1, (self.push_before, push), self.push_change)
        self.friction += self._work(0, (self.excess_before, self.excess), self.excess_change)
        self.push_change, self.excess_change = push - self.push_before, self.excess - self.excess_before
        self.push_before = push
        strain = strain_energy(self.grid, self.moved - moved_before)
        self.damped += self.mixed * strain + 0.5 * alpha**3 * self.grid.dt**2 * self.kinetic_energy(self.acceleration - old)

    def _work(self, node: int, ends: tuple[float, float], change: float) -> float:
        """Return the work (J/m^2) of a force on a node with values at both ends of the step (Pa), and its change before."""
        first, last = ends
        return float(self.moved[node]) * (0.5 * (first + last) + self.mixed * (last - first - change))

    def stored(self) -> float:
        """Return the energy that the balance of the scheme counts, without that of the uniform stress, J/m^2."""
        inertia = 0.25 * self.alpha**2 * self.grid.dt**2 * self.kinetic_energy(self.acceleration)
        return super().stored() + inertia + self.mixed * strain_energy(self.grid, self.moved)
