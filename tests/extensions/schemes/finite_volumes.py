"""Finite volumes for a contact between layers, written for tests and independent of the package.

Each side of the contact is layers, from the contact outwards. In a cell are velocity and stress, beyond the stress of the start; at
each face the waves of both cells meet (Godunov). The contact solves Z v + S mu(v) = load with the wave that comes to it. At a
Courant number of 1 waves move by one cell in a step, without a loss; below it fronts become blunt.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Floats = NDArray[np.float64]


class Side(NamedTuple):
    """Layers with their densities (kg/m^3), wave speeds (m/s), and numbers of cells of equal travel time; what ends them."""

    density: tuple[float, ...]
    speed: tuple[float, ...]
    cells: tuple[int, ...]
    driver: float = np.inf
    start: tuple[float, float] = (0.0, 0.0)
    """Velocities at the contact and at the driver at the start, m/s, between which they are linear in travel time times c^2 rho."""


@dataclass(frozen=True)
class Contact:
    """Static friction, friction at a slip rate, the slip rate of the fold, normal stress over time and velocity of the ground."""

    static: float
    mu: Callable[[float], float]
    fold: float
    normal: Callable[[float], float]
    ground: Callable[[float], float] = lambda t: 0.0

    def rate(self, load: float, impedance: float, before: float, t: float) -> float:
        """Return the slip rate under a load: rest up to the static strength, then the branch of slip while it exists."""
        pressed = self.normal(t)

        def missing(rate: float) -> float:
            return impedance * rate + pressed * self.mu(rate) - load

        assert load > -self.static * pressed
        if (before == 0.0 and load <= self.static * pressed * (1.0 + 1e-13)) or missing(self.fold) >= 0.0:
            return 0.0
        return float(brentq(missing, self.fold, (load + pressed) / impedance, xtol=1e-300, rtol=1e-14))


class Moved(NamedTuple):
    """Slip at the ends of steps, and the mean slip rate and traction in each step, of which `time` is the beginning."""

    time: Floats
    slip: Floats
    rate: Floats
    traction: Floats


class _Row:
    """The cells of a side."""

    def __init__(self, side: Side, refined: int, courant: float) -> None:
        counts = np.array(side.cells) * refined
        self.z = np.repeat(np.array(side.density) * np.array(side.speed), counts)
        compliance = np.cumsum(np.append(0.0, 1.0 / self.z))
        middle = 0.5 * (compliance[1:] + compliance[:-1]) / compliance[-1]
        first, self.pull = side.start
        self.v = first + (self.pull - first) * middle
        self.s = np.zeros(self.z.size)
        self.driver, self.courant = side.driver, courant

    @property
    def coming(self) -> float:
        return float(self.s[0] + self.z[0] * self.v[0])

    def step(self, rate: float) -> None:
        """Move by a step, while the face at the contact has a velocity."""
        z, up, down = self.z, self.s - self.z * self.v, self.s + self.z * self.v
        end = self.pull if np.isinf(self.driver) else (self.driver * self.pull - up[-1]) / (self.driver + z[-1])
        inner = (down[1:] - up[:-1]) / (z[1:] + z[:-1])
        velocity = np.concatenate([[rate], inner, [end]])
        stress = np.append(down - z * velocity[:-1], up[-1] + z[-1] * end)
        self.v += self.courant / z * np.diff(stress)
        self.s += self.courant * z * np.diff(velocity)


def moved(sides: tuple[Side, ...], contact: Contact, load: float, cell: float, duration: float, **how: Any) -> Moved:
    """Slip from rest for a duration (s) under an initial load (Pa); `cell` is the travel time (s) of the cells that are given.

    Each of them is cut into `refined` ones. Sides are on either side of the contact if they are `apart`, and else both upon it.
    """
    refined, courant, apart = how.get("refined", 1), how.get("courant", 1.0), how.get("apart", False)
    rows = [_Row(side, refined, courant) for side in sides]
    dt = courant * cell / refined
    whole = 1.0 / sum(1.0 / row.z[0] for row in rows) if apart else sum(row.z[0] for row in rows)
    rate, rates, tractions = 0.0, [], []
    for n in range(round(duration / dt)):
        t = (n + 0.5) * dt
        moves = contact.ground(t)
        coming = sum(whole * row.coming / row.z[0] for row in rows) if apart else sum(row.coming for row in rows)
        beta = load + coming - whole * moves
        rate = contact.rate(beta, whole, rate, t)
        rates.append(rate)
        tractions.append(beta - whole * rate)
        stress = tractions[-1] - load
        for row in rows:
            row.step((row.coming - stress) / row.z[0] if apart else rate + moves)
    time = dt * np.arange(len(rates))
    return Moved(time, np.cumsum(rates) * dt, np.array(rates), np.array(tractions))


def fold_of(mu: Callable[[Floats], Floats], impedance: float, pressed: float, top: float) -> float:
    """Return the slip rate (m/s), 0 or above, at which impedance v + S mu(v) is least."""
    rates = np.append(0.0, np.geomspace(1e-6 * top, top, 200_001))
    return float(rates[np.argmin(impedance * rates + pressed * mu(rates))])


def orders(errors: list[float]) -> list[float]:
    """Return the orders of convergence between meshes, each twice as fine as the one before."""
    return [float(np.log2(coarse / fine)) for coarse, fine in pairwise(errors)]
