"""Newmark's method of constant mean acceleration, and its damped form HHT-alpha, with linear finite elements.

Sources: N.M. Newmark 1959, J. Eng. Mech. Div. ASCE 85, 67; H.M. Hilber, T.J.R. Hughes, R.L. Taylor 1977, Earthq. Eng. Struct. Dyn.
5, 283.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse.linalg import spsolve

from stickslip.schemes.contract import Floats, Grid
from stickslip.schemes.finite_elements import Elements


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
    """A slab whose state includes the accelerations of the nodes."""

    def __init__(self, grid: Grid, alpha: float) -> None:
        super().__init__(grid)
        self.alpha, self.weight = alpha, 1.0 - alpha
        self.gamma, self.beta = 0.5 + alpha, 0.25 * (1.0 + alpha) ** 2
        self.per_rate = self.beta * grid.dt / self.gamma
        matrix = self.mass / (self.gamma * grid.dt) + self.weight * (self.drag + self.per_rate * self.stiffness)
        self.solver(matrix, self.weight)

    def begin(self) -> None:
        """Find the accelerations at t = 0."""
        force, mass = self.imbalance(), self.mass.tolil()
        if self.grid.is_rigid:
            mass[-1, :] = 0.0
            mass[-1, -1], force[-1] = 1.0, 0.0
        self.acceleration: Floats = np.asarray(spsolve(mass.tocsc(), force))

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
        self.displacement = self.still + self.per_rate * rate
        self.acceleration = (rate - self.rate_guess) / (self.gamma * self.grid.dt)
        self.rate = rate
