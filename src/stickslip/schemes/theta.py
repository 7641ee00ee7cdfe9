"""The theta method with linear finite elements; theta = 1 is backward Euler."""

from __future__ import annotations

import math

from stickslip.foundation.arrays import Floats
from stickslip.schemes.contract import Grid, strain_energy
from stickslip.schemes.finite_elements import Elements


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
