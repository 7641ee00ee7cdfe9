"""What is measured of a cycle: how fast it slips, what traction it bears, how far it goes and how long it rests."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.compiled.places import DampedMass, write_extremes
from stickslip.extensions.cycles.orbit import Orbit
from stickslip.foundation.arrays import Floats

ROUNDING = 1e-12
"""A slip rate of this share (1) of the greatest is rounding, where the contact rests."""


class Measures(NamedTuple):
    """Numbers of a cycle, in SI."""

    period: float
    """The period (s)."""
    slip: float
    """Slip in one period (m)."""
    greatest_rate: float
    """The greatest slip rate (m/s)."""
    least_rate: float
    """The least slip rate (m/s); below 0 it slips backwards."""
    greatest_traction: float
    """The greatest traction (N)."""
    least_traction: float
    """The least traction (N)."""
    stick_share: float
    """The share of rest in the period (1)."""

    @property
    def amplitude(self) -> float:
        """Half of the difference between greatest and least slip rate (m/s)."""
        return 0.5 * (self.greatest_rate - self.least_rate)


def measures_of(orbit: Orbit) -> Measures:
    """Return the numbers of a cycle, from its run."""
    end, history = orbit.closed, orbit.closed.history
    count = end.piece + 1
    ends = np.append(np.ones(count - 1), end.place)
    rates, tractions = _extremes(history, ends)
    rested = np.flatnonzero(history.rests[:count]) + 1
    if len(rested):  # the load when a rest ends that was not recorded
        loads = history.excess(history.just_before(rested[rested < len(history)]))
        tractions = min(tractions[0], *loads), max(tractions[1], *loads)
    strength, slowest = history.problem.strength, rates[0]
    if orbit.sticks and abs(slowest) <= ROUNDING * rates[1]:
        slowest = 0.0
    slips = _slip_time(history, ends)
    return Measures(
        period=orbit.period,
        slip=float(history.slipped(Positions.inside(end.piece, end.place))[0]),
        greatest_rate=rates[1],
        least_rate=slowest,
        greatest_traction=strength + tractions[1],
        least_traction=strength + tractions[0],
        stick_share=max(0.0, 1.0 - slips / orbit.period) if orbit.sticks else 0.0,
    )


def least_rate(orbit: Orbit) -> float:
    """Return the least slip rate (m/s) of a cycle."""
    end = orbit.closed
    return _extremes(end.history, np.append(np.ones(end.piece), end.place))[0][0]


def _slip_time(history: History, ends: Floats) -> float:
    """Return how long (s) the contact slips in the first pieces of a history."""
    store, here = history.store, slice(0, len(ends))
    lasts = ends * (store.speed[here] + ends * store.bend[here])
    return float(lasts[store.mode[here] != 0].sum())


def _extremes(history: History, ends: Floats) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the least and the greatest slip rate (m/s), and traction less the reference strength (N), in the first pieces."""
    body, found = history.problem.body, np.empty((2, 2))
    write_extremes(history.store.pieces, DampedMass(body.total_damping, body.inertia), 0, ends, found)
    rates, tractions = ((low, high) for low, high in found.tolist())
    return rates, tractions
