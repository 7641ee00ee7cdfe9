"""Fronts along a slab, in units in which rho = c = h = 1 and the stress drop is 1, by the volume method.

G0 is 1/2 then, and slip far behind a steady front below c is 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.reference.planar import PlanarCase, SlipWeakeningAtNodes, Volume

Array = NDArray[np.float64]

DYNAMIC = 5.0
"""Dynamic strength, far enough from 0 that slip does not reverse."""


class ForcedFront(SlipWeakeningAtNodes):
    """Linear slip weakening with a fracture energy of `share` G0, and strength that falls in time once a forced front has passed.

    The forced front leaves y = 0 in both directions with speed 0, approaches its speed in a time `ramp`, and ends at `reach`.
    """

    def __init__(self, y: Array, share: float, strength: float, speed: float, reach: float, width: float, ramp: float) -> None:
        super().__init__(y.shape, DYNAMIC + strength, DYNAMIC, share / strength)
        times = np.linspace(0.0, 400.0, 100_001)
        places = speed * (times - ramp * (1.0 - np.exp(-times / ramp))) if ramp else speed * times
        self.passes = np.where(np.abs(y) < reach, np.interp(np.abs(y), places, times), np.inf)
        self.time, self.fall = 0.0, width / speed

    def __call__(self, slip: Array, rate: Array, nodes: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        strength, by_slip, by_rate = super().__call__(slip, rate, nodes)
        left = np.clip(1.0 - (self.time - self.passes[nodes]) / self.fall, 0.0, 1.0)
        forced = self.dynamic[nodes] + (self.static[nodes] - self.dynamic[nodes]) * left
        return np.minimum(strength, forced), np.where(forced < strength, 0.0, by_slip), by_rate


@dataclass
class Front:
    """A run of two fronts that leave y = 0."""

    y: Array
    run: Volume
    friction: ForcedFront
    passed: Array
    """When half of the weakening had happened at each node; NaN if it has not."""

    def speeds(self, places: Array, around: float = 0.25) -> tuple[Array, Array]:
        """Return times and speeds of the front at some places, from parabolas through the nodes around each."""
        fits = []
        for place in places:
            near = (np.abs(self.y - place) <= around) & np.isfinite(self.passed)
            fits.append(np.polyfit(self.y[near] - place, self.passed[near], 2) if near.sum() > 3 else np.full(3, np.nan))
        _, slowness, times = np.transpose(fits)
        return times, 1.0 / slowness

    def place(self) -> float:
        """Return the y that the forced front has reached."""
        right = self.y >= 0.0
        return float(np.interp(self.run.time, self.friction.passes[right], self.y[right]))

    def advance(self) -> None:
        """Take a step, and note when the front passes."""
        run, before = self.run, self.run.slip
        self.friction.time = run.time + 0.5 * run.step_of_time
        run.advance()
        half = 0.5 * self.friction.distance
        new = np.isnan(self.passed) & (run.slip >= half)
        self.passed[new] = run.time - run.step_of_time * ((run.slip - half)[new] / (run.slip - before)[new])


def start(length: float, per_thickness: int, duration: float, strength: float = 3.0, *forced: float, share: float = 1e9) -> Front:
    """Return a run at its start, with so many nodes in a length h; `forced`: speed, reach, width and ramp of `ForcedFront`."""
    n = round(length * per_thickness)
    y = np.arange(n) / per_thickness - 0.5 * length
    friction = ForcedFront(y, share, strength, *forced)
    case = PlanarCase(1.0, 1.0, 1.0, (length,), np.full(n, DYNAMIC + 1.0), friction)
    return Front(y, Volume(case, 2 * per_thickness, duration), friction, np.full(n, np.nan))
