"""Differences that sum by parts, with the friction imposed weakly by penalties (SAT), and Runge-Kutta's fourth-order steps.

Energy is bounded as in the exact slab: a penalty only takes energy away, (Z dv - ds)^2/(4Z) per time for the differences dv and ds
of velocity and stress between node and contact. Runge-Kutta's steps change a quadratic energy by dt^2/2 times the sum of
(b_i a_ij + b_j a_ji - b_i b_j) k_i k_j over the slopes k of the stages. Sources: B. Strand 1994, J. Comput. Phys. 110, 47; J.E.
Kozdon, E.M. Dunham, J. Nordström 2012, J. Sci. Comput. 50, 341.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.sparse import csr_array, lil_array

from stickslip.extensions.schemes.contract import Energies, Grid, Meeting, Sample, SchemeContact
from stickslip.foundation.arrays import Floats

NORMS = {
    2: (1 / 2,),
    4: (17 / 48, 59 / 48, 43 / 48, 49 / 48),
    6: (13649 / 43200, 12013 / 8640, 2711 / 4320, 5359 / 4320, 7877 / 8640, 43801 / 43200),
}
"""Weights of the nodes next to a boundary, in cells, by the order inside."""
INSIDE = {2: (1 / 2,), 4: (2 / 3, -1 / 12), 6: (3 / 4, -3 / 20, 1 / 60)}
"""Weights of the nodes to the right in a first difference; those to the left have the other sign."""
STAGES = ((0.5, 1 / 6), (0.5, 1 / 3), (1.0, 1 / 3), (0.0, 1 / 6))
"""For each stage: the place of the next stage, as a share of the step, and the weight."""
STAGE_SHARES = np.array([weight for _, weight in STAGES])
PRODUCTS = STAGE_SHARES[:, None] * np.diag([share for share, _ in STAGES[:-1]], -1)
DEFECT = PRODUCTS + PRODUCTS.T - np.outer(STAGE_SHARES, STAGE_SHARES)
"""Weights of the products of two stages' slopes in the change of an energy over a Runge-Kutta step."""


class SummationByParts:
    """Differences of an even order inside and of half of it at the boundaries."""

    courant, largest_courant = 0.5, 0.7

    def __init__(self, inside: int) -> None:
        self.inside = inside
        self.name, self.title = f"sbp{inside}", f"summation by parts, order {inside} inside, with SAT"
        self.order = {2: 2.0, 4: 3.0, 6: 4.0}[inside]

    def begin(self, grid: Grid) -> Weak:
        """Return the slab at t = 0."""
        return Weak(grid, self.inside)


@cache
def closure(inside: int) -> Floats:
    """Return the antisymmetric part of Q next to a boundary, from the condition that the difference is exact for polynomials.

    The degree of the polynomials is half of the order inside. Of several solutions it is the one with the smallest sum of squares.
    """
    weights, arms = np.array(NORMS[inside]), INSIDE[inside]
    size, degree = len(weights), inside // 2
    place = {pair: k for k, pair in enumerate((i, j) for i in range(size) for j in range(i + 1, size))}
    rows, right = [], []
    for i in range(size):
        for power in range(degree + 1):
            row = np.zeros(len(place))
            for j in range(size):
                if i != j:
                    row[place[min(i, j), max(i, j)]] += (1.0 if i < j else -1.0) * float(j**power)
            outside = sum(arm * float((i + k) ** power) for k, arm in enumerate(arms, 1) if i + k >= size)
            corner = 0.5 * float(power == 0) if i == 0 else 0.0
            rows.append(row)
            right.append(weights[i] * (power * float(i ** (power - 1)) if power else 0.0) - outside + corner)
    found = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    block = np.zeros((size, size))
    for (i, j), k in place.items():
        block[i, j], block[j, i] = found[k], -found[k]
    block[0, 0] = -0.5
    return block


@cache
def difference(inside: int, cells: int) -> tuple[csr_array, Floats]:
    """Return the first difference on a grid of a number of cells, for a cell of length 1, and the weights of the nodes."""
    count, block, arms = cells + 1, closure(inside), INSIDE[inside]
    size = len(block)
    Q = lil_array((count, count))
    for i in range(count):
        for k, arm in enumerate(arms, 1):
            if i + k < count and not (i < size and i + k < size) and not (i >= count - size and i + k >= count - size):
                Q[i, i + k], Q[i + k, i] = arm, -arm
    Q[:size, :size] = block
    Q[-size:, -size:] = -block[::-1, ::-1]
    weights = np.ones(count)
    weights[:size], weights[-size:] = NORMS[inside], NORMS[inside][::-1]
    return csr_array(Q.multiply(1.0 / weights[:, None])), weights


class Weak:
    """Velocity and stress (minus that of the start) at the nodes.

    Behind them are the slip of the contact, the displacement of the driver, the work of the driver, the work of friction, and what
    the penalties dissipate; works are of stresses minus that of the start.
    """

    def __init__(self, grid: Grid, inside: int) -> None:
        self.grid, self.step, self.damped = grid, 0, 0.0
        self.slope, weights = difference(inside, max(grid.cells, 2 * len(NORMS[inside])))
        self.penalty = 1.0 / (float(weights[0]) * grid.dx)
        self.nodes = 2 * (grid.cells + 1)
        self.norm = grid.dx * np.concatenate([weights * grid.density, weights / grid.shear_modulus])
        self.state = np.concatenate([grid.start_rates, np.zeros(grid.cells + 1), np.zeros(5)])
        self.contact_rate = 0.0

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state just after t = 0."""
        return self._sample(contact)

    def advance(self, contact: SchemeContact) -> Sample:
        """Move by one step of time."""
        start, stage = self.state, self.state
        time = self.step * self.grid.dt
        begun, slopes = time, []
        for share, _ in STAGES:
            slopes.append(self._slope(stage, begun, contact))
            stage, begun = start + share * self.grid.dt * slopes[-1], time + share * self.grid.dt
        self.state = start + self.grid.dt * sum(weight * slope for (_, weight), slope in zip(STAGES, slopes, strict=True))
        waves = np.array(slopes)[:, : self.nodes]
        self.damped += 0.5 * self.grid.dt**2 * float((DEFECT * ((waves * self.norm) @ waves.T)).sum())
        self.step += 1
        return self._sample(contact)

    def _meet(self, state: Floats, contact: SchemeContact) -> tuple[float, float]:
        """Return slip rate and traction of the contact."""
        grid = self.grid
        load = grid.stress + grid.impedance * float(state[0]) + float(state[grid.cells + 1])
        return contact.meet(Meeting(load, grid.impedance, grid.slip + float(state[self.nodes])), self.contact_rate)

    def _slope(self, state: Floats, time: float, contact: SchemeContact) -> Floats:
        """Return the rate of change of the state."""
        grid, nodes = self.grid, self.grid.cells + 1
        Z, rho, G = grid.impedance, grid.density, grid.shear_modulus
        rate, stress = state[:nodes], state[nodes : self.nodes]
        accelerations = self.slope @ stress / (rho * grid.dx)
        stressing = G * (self.slope @ rate) / grid.dx
        slip_rate, traction = self._meet(state, contact)
        at_contact = Z * rate[0] - stress[0] - (Z * slip_rate - (traction - grid.stress))
        accelerations[0] -= 0.5 * self.penalty * at_contact / rho
        stressing[0] += 0.5 * self.penalty * at_contact * G / Z
        wave = Z * float(rate[-1]) - float(stress[-1])
        driven = grid.pull_rate if grid.is_rigid else (wave + grid.push(time)) / (Z + grid.driver_impedance)
        at_driver = Z * rate[-1] + stress[-1] - (2.0 * Z * driven - wave)
        accelerations[-1] -= 0.5 * self.penalty * at_driver / rho
        stressing[-1] -= 0.5 * self.penalty * at_driver * G / Z
        works = [driven * (Z * driven - wave), slip_rate * (traction - grid.stress), (at_contact**2 + at_driver**2) / (4.0 * Z)]
        return np.concatenate([accelerations, stressing, [slip_rate, driven, *works]])

    def _sample(self, contact: SchemeContact) -> Sample:
        self.contact_rate, traction = self._meet(self.state, contact)
        waves = self.state[: self.nodes]
        slip, driven, driver, friction, penalised = self.state[self.nodes :].tolist()
        own = Energies(0.5 * float(self.norm @ waves**2), driver, friction, self.damped + penalised)
        energies = own.beside(self.grid.stress, slip, driven)
        return Sample(self.step * self.grid.dt, slip, self.contact_rate, traction, energies)
