"""The size of a disturbance: each number and wave as a share of how far it goes in the motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from stickslip.extensions.cycles.disturbed.stand import (
    DRIVER_PUSH,
    DRIVER_RATE,
    FIRST_STATE,
    LAW_SLIP,
    LOAD_NUMBER,
    RATE_NUMBER,
    SLIP_NUMBER,
    Carried,
    Stand,
)
from stickslip.foundation.arrays import Floats
from stickslip.run import ExactRun

MOVING_DRIVERS = ("machine", "damper")
"""Kinds of drivers that have a motion of their own."""
LEAST_SHARE = 1e-3
"""A motion counts as no smaller than this share (1) of the strength."""
WAVES_AT_FIRST = 8
"""Number of cosines in the first disturbance of a wave (1)."""


@dataclass
class Measure:
    """Sizes of disturbances are shares of how far each number and each wave goes; numbers that decide nothing do not count."""

    by_phase: bool
    """True if each moment of the round trip moves by itself, so that each has a disturbance of its own."""
    counts: Floats
    """Which numbers count (1): 1 or 0."""
    numbers: Floats
    waves: Floats

    @classmethod
    def of(cls, run: ExactRun) -> Self:
        """Return one for the runs of a problem."""
        problem, count, law, kind = run.problem, run.count, run.problem.friction, Stand(run).kind
        decides = np.ones(FIRST_STATE + int(count.states))
        decides[RATE_NUMBER] = count.has_inertia
        decides[LAW_SLIP] = law.depends_on_slip
        decides[SLIP_NUMBER], decides[LOAD_NUMBER] = kind.has_place(problem), kind.has_load()
        decides[[DRIVER_RATE, DRIVER_PUSH]] = problem.driver_kind in MOVING_DRIVERS
        least = LEAST_SHARE * abs(run.params.reference)
        rate, trip, numbers = least / run.params.impedance, problem.round_trip_time, np.zeros(len(decides))
        numbers[RATE_NUMBER] = numbers[DRIVER_RATE] = rate
        numbers[SLIP_NUMBER] = numbers[LAW_SLIP] = rate * trip
        numbers[LOAD_NUMBER] = numbers[DRIVER_PUSH] = least
        return cls(not decides.any(), decides, numbers, np.full(len(Stand(run).series), least))

    def see(self, stand: Stand) -> None:
        """Take note of how far all goes in the history that is kept."""
        run = stand.run
        store, here = run.store, slice(run.length)
        trip = stand.run.problem.round_trip_time
        now = np.abs(stand.numbers)
        now[RATE_NUMBER] = now[DRIVER_RATE] = _range(store.rate[here])
        now[SLIP_NUMBER] = now[LAW_SLIP] = now[RATE_NUMBER] * trip
        now[LOAD_NUMBER] = _range(store.load[here])
        now[DRIVER_PUSH] = now[RATE_NUMBER] * run.params.impedance
        self.numbers = np.maximum(self.numbers, now)
        if self.waves.size:
            self.waves = np.maximum(self.waves, np.ptp(stand.here.waves, axis=1))

    def scaled(self, one: Carried, stand: Stand) -> Floats:
        """Return what is carried in these sizes, as a vector whose length is its size (1)."""
        numbers = self.counts * one.numbers / np.where(self.numbers > 0.0, self.numbers, 1.0)
        return np.concatenate([numbers, (one.waves / self.waves[:, None] * np.sqrt(stand.weights.ravel())).ravel()])

    def parted(self, one: Carried, stand: Stand) -> tuple[Carried, float]:
        """Return a disturbance as its direction, whose size is 1, and its size (1): by phase the mean of sizes as logarithms."""
        if not self.by_phase:
            size = float(np.linalg.norm(self.scaled(one, stand)))
            return one.times(1.0 / size if size > 0.0 else 0.0), size
        sizes = np.linalg.norm(one.waves / self.waves[:, None], axis=0)
        if not (sizes > 0.0).all():
            return one, 0.0
        return Carried(one.numbers, one.waves / sizes), math.exp(float(stand.weights.ravel() @ np.log(sizes)))


def first_disturbance(stand: Stand, measure: Measure) -> Carried:
    """Return a disturbance to begin with: of the states of the law, and of each wave or of a rigid body's place on its spring."""
    numbers = np.zeros(len(stand.numbers))
    numbers[FIRST_STATE:] = measure.numbers[FIRST_STATE:]
    if not len(stand.series):
        stiffness = stand.run.params.stiffness
        numbers[SLIP_NUMBER] = measure.numbers[SLIP_NUMBER]
        numbers[LOAD_NUMBER] = -stiffness * numbers[SLIP_NUMBER]
        return Carried(numbers, np.zeros((0, 0)))
    turns = np.pi * stand.phases.ravel() / stand.run.problem.round_trip_time
    way = sum(np.cos(n * turns + n) / (n + 1) for n in range(WAVES_AT_FIRST))
    return Carried(numbers, measure.waves[:, None] * way)


def _range(series: Floats) -> float:
    """Return how far the ends of polynomials go."""
    return float(np.ptp(np.append(series[:, 0], series.sum(axis=1))))
