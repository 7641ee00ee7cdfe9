"""What is measured of a cycle: how fast it slips, what traction it bears, how far it goes and how long it rests."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.compiled.places import DampedMass, write_extremes
from stickslip.extensions.cycles.found import ClosedRun, FoundCycle
from stickslip.foundation.arrays import Floats, Integers1

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


def measures_of(orbit: FoundCycle) -> Measures:
    """Return the numbers of a cycle, from its run."""
    end: ClosedRun = orbit.closed
    history = end.history
    rates, tractions = _extremes(end)
    rested = end.first + np.flatnonzero(history.rests[end.first : end.piece + 1]) + 1
    if len(rested):  # the load when a rest ends that was not recorded
        loads = history.excess(history.just_before(rested[rested < len(history)]))
        tractions = min(tractions[0], *loads), max(tractions[1], *loads)
    strength, slowest = history.problem.strength, rates[0]
    if orbit.sticks and abs(slowest) <= ROUNDING * rates[1]:
        slowest = 0.0
    slipped = history.slipped_since(Positions.inside(end.first, 0.0), Positions.inside(end.piece, end.place))
    return Measures(
        period=orbit.period,
        slip=float(slipped[0]) if history.problem.first_pull_rate != 0.0 else 0.0,  # about a set point at rest, but for rounding
        greatest_rate=rates[1],
        least_rate=slowest,
        greatest_traction=strength + tractions[1],
        least_traction=strength + tractions[0],
        stick_share=max(0.0, 1.0 - _slip_time(end) / orbit.period) if orbit.sticks else 0.0,
    )


def swing_of(orbit: FoundCycle) -> float:
    """Return the difference between the largest and the least slip in a period (m); slip turns back where pieces end."""
    end: ClosedRun = orbit.closed
    at = Positions.inside(
        np.append(np.arange(end.first, end.piece + 1), end.piece), np.append(np.zeros(end.piece - end.first + 1), end.place)
    )
    return float(np.ptp(end.history.slipped_since(Positions.inside(end.first, 0.0), at)))


def least_rate(orbit: FoundCycle) -> float:
    """Return the least slip rate (m/s) of a cycle."""
    return _extremes(orbit.closed)[0][0]


def _pieces(run: ClosedRun) -> tuple[Integers1, Floats]:
    """Return the pieces of a run that belong to the cycle, and the places (1) where they end."""
    pieces = np.arange(run.first, run.piece + 1)
    return pieces, np.append(np.ones(len(pieces) - 1), run.place)


def _slip_time(run: ClosedRun) -> float:
    """Return how long (s) the contact slips."""
    store, (pieces, ends) = run.history.store, _pieces(run)
    lasts = ends * (store.speed[pieces] + ends * store.bend[pieces])
    return float(lasts[store.mode[pieces] != 0].sum())


def _extremes(run: ClosedRun) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the least and the greatest slip rate (m/s) of a cycle, and traction less the reference strength."""
    history, (_, ends), found = run.history, _pieces(run), np.empty((2, 2))
    body = history.problem.body
    write_extremes(history.store.pieces, DampedMass(body.total_damping, body.inertia), run.first, ends, found)
    rates, tractions = ((low, high) for low, high in found.tolist())
    return rates, tractions
