"""What decides all that follows of a run: some numbers, and the waves of a round trip where that is over.

There it can be read, compared with that of another run, and disturbed. A body of layers has a wave in each cell, a uniform body the
one that left its contact, and a rigid body none, whose run may stand anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Self

import numpy as np

from stickslip.engine import TERMS
from stickslip.extensions.cycles.disturbed.asked import COMPARED, ComparedKind
from stickslip.foundation.arrays import Floats
from stickslip.run import ExactRun

MOST_POINTS, FEWEST_POINTS, POINTS_IN_ALL = 10, 2, 2000
"""Points of Gauss and Legendre on each piece of a wave (1), fewer where pieces are many, and about how many there are in all."""
SPARE_PIECES = 64
"""Room for more pieces of history (1) in a copy of a run."""
SHORT_WAY = 1e-5
"""The motion of a driver is differenced over this share (1) of a round trip."""
STATE_NUMBERS = ("rate_now", "slip_now", "law_slip", "driver_rate", "driver_push")
RATE_NUMBER, SLIP_NUMBER, LAW_SLIP, DRIVER_RATE, DRIVER_PUSH, LOAD_NUMBER = range(len(STATE_NUMBERS) + 1)
"""Numbers of the state of a run, the load of a rigid body, and behind them the states of the law."""
FIRST_STATE = LOAD_NUMBER + 1


@dataclass(frozen=True)
class WavePoints:
    """Points of Gauss and Legendre on a piece of a wave, as places (1), their weights (1), and powers of values there."""

    places: Floats
    weights: Floats
    powers: Floats
    """From values at the points to the coefficients of powers of the place (1)."""

    @classmethod
    @lru_cache(maxsize=16)
    def on(cls, pieces: int) -> Self:
        """Return those for so many pieces."""
        places, weights = np.polynomial.legendre.leggauss(int(np.clip(POINTS_IN_ALL // max(pieces, 1), FEWEST_POINTS, MOST_POINTS)))
        places = 0.5 * (places + 1.0)
        return cls(places, 0.5 * weights, np.asarray(np.linalg.inv(np.vander(places, increasing=True)), float))


@dataclass(frozen=True)
class Carried:
    """What a run carries over the end of a round trip, or a difference of two: numbers, and waves (a row each) at points."""

    numbers: Floats
    waves: Floats

    def __sub__(self, other: Carried) -> Carried:
        return Carried(self.numbers - other.numbers, self.waves - other.waves)

    def times(self, factor: float) -> Carried:
        """Return it, a factor times as large."""
        return Carried(factor * self.numbers, factor * self.waves)


@dataclass(frozen=True)
class Stand:
    """Where a run stands: at the end of a round trip, or a run of a rigid body anywhere."""

    run: ExactRun

    @property
    def kind(self) -> ComparedKind:
        """The answers of the kind of body."""
        return COMPARED[self.run.problem.body.structure]

    @cached_property
    def pieces(self) -> slice:
        """The pieces of the history whose waves are still to come back."""
        return self.kind.standing(self.run)

    @property
    def where(self) -> tuple[int, ...]:
        """Numbers that runs must share to be compared: those of their kind, which way they slip, the piece of the law."""
        return (*self.kind.where(self.run), int(self.run.count.mode), int(self.run.count.piece))

    @property
    def time(self) -> float:
        """The time (s)."""
        return self.kind.time(self.run)

    @property
    def points(self) -> WavePoints:
        """The points on each piece of a wave."""
        return WavePoints.on(self.pieces.stop - self.pieces.start)

    @cached_property
    def series(self) -> Floats:
        """The waves as polynomials: (waves, pieces, TERMS)."""
        return self.kind.series(self.run)

    @cached_property
    def phases(self) -> Floats:
        """The phases (s) of the points: of each piece a row."""
        store, here, xi = self.run.store, self.pieces, self.points.places
        return np.asarray(store.phase_from[here, None] + store.speed[here, None] * xi + store.bend[here, None] * xi * xi)

    @cached_property
    def weights(self) -> Floats:
        """The weights (1) of the points in a mean over the round trip."""
        store, here = self.run.store, self.pieces
        lasts = store.speed[here, None] + 2.0 * store.bend[here, None] * self.points.places
        return np.asarray(lasts * self.points.weights / self.run.problem.round_trip_time)

    @cached_property
    def numbers(self) -> Floats:
        """The numbers, and the states of the law."""
        state = self.run.state
        states = [state.state_now[n] for n in range(int(self.run.count.states))]
        return np.array([*(getattr(state, name) for name in STATE_NUMBERS), self.kind.load(self.run), *states], float)

    def at(self, phases: Floats) -> Carried:
        """Return what is carried, with the waves at phases (s)."""
        store, here = self.run.store, self.pieces
        if here.start == here.stop:
            return Carried(self.numbers, np.zeros((0, 0)))
        wanted = phases.ravel()
        piece = np.clip(np.searchsorted(store.phase_from[here], wanted, "right") - 1, 0, here.stop - here.start - 1)
        begin, speed, bend = (one[here][piece] for one in (store.phase_from, store.speed, store.bend))
        gone = wanted - begin
        xi = 2.0 * gone / (speed + np.sqrt(np.maximum(speed * speed + 4.0 * bend * gone, 0.0)))
        found, series = np.zeros((len(self.series), len(wanted))), self.series[:, piece]
        for k in range(TERMS - 1, -1, -1):
            found = found * xi + series[:, :, k]
        return Carried(self.numbers, found)

    @cached_property
    def here(self) -> Carried:
        """What is carried, with the waves at the own points."""
        return self.at(self.phases)

    @cached_property
    def flow(self) -> Carried:
        """How fast that changes in time: a disturbance along it is a shift in time."""
        store, here, last = self.run.store, self.pieces, self.run.length - 1
        found = np.zeros((len(self.series), self.phases.size))
        if self.phases.size:
            lasts = store.speed[here, None] + 2.0 * store.bend[here, None] * self.points.places
            slopes = sum(k * self.series[:, :, k, None] * self.points.places ** (k - 1) for k in range(1, TERMS))
            found = (slopes / lasts).reshape(len(self.series), -1)
        pace = float(store.speed[last] + 2.0 * store.bend[last])

        def changes(series: Floats) -> Any:
            return series @ np.arange(TERMS) / pace

        numbers = np.zeros(len(self.numbers))
        numbers[RATE_NUMBER] = changes(store.rate[last])
        numbers[LOAD_NUMBER] = changes(store.load[last])
        numbers[LAW_SLIP] = abs(self.run.state.rate_now)
        numbers[SLIP_NUMBER] = self.run.state.rate_now - self.run.problem.first_pull_rate
        if len(numbers) > FIRST_STATE:
            numbers[FIRST_STATE:] = changes(store.state[last])
        return Carried(numbers, found)


def copied(run: ExactRun, into: ExactRun) -> ExactRun:
    """Make a run stand where another one stands, and return it."""
    length = run.length
    into.reserve(length + SPARE_PIECES)
    into.store.pieces[:length], into.store.state[:length] = run.store.pieces[:length], run.store.state[:length]
    into.forgotten = run.forgotten
    into.restore(run.snapshot())
    return into


def disturb(run: ExactRun, by: Carried) -> None:
    """Add a disturbance to what a run carries; its waves are given at the points of the run itself."""
    stand, state = Stand(run), run.state
    for n, name in enumerate(STATE_NUMBERS):
        setattr(state, name, getattr(state, name) + float(by.numbers[n]))
    for n, change in enumerate(by.numbers[FIRST_STATE:].tolist()):
        state.state_now[n] += change
    stand.kind.add_load(run, float(by.numbers[LOAD_NUMBER]), float(by.numbers[SLIP_NUMBER]))
    powers = stand.points.powers
    pieces = stand.pieces.stop - stand.pieces.start
    stand.kind.add_waves(run, by.waves.reshape(len(by.waves), pieces, len(powers)) @ powers.T)


def flow_of_driver(flow: Carried, run: ExactRun, spare: ExactRun) -> Carried:
    """Return a flow with that of a driver which moves by itself, from a short way of a spare run, which is lost."""
    moved = copied(run, spare)
    stand, first = Stand(moved), int(moved.count.previous_from)
    store, short = moved.store, SHORT_WAY * run.problem.round_trip_time
    speed, bend = float(store.speed[first]), float(store.bend[first])
    share = 2.0 * short / (speed + np.sqrt(speed * speed + 4.0 * bend * short))
    before, shrunk = stand.numbers, np.zeros_like(stand.series)
    shrunk[:, 0] = stand.series[:, 0] * (share ** np.arange(TERMS) - 1.0)
    stand.kind.add_waves(moved, shrunk)
    store.speed[first], store.bend[first] = share * speed, share * share * bend
    store.phase_to[first] = store.phase_from[first] + short
    moved.count.pause_at = int(moved.count.trip) + 1
    while moved.count.ready == 0:
        moved.advance(1)
    numbers = flow.numbers.copy()
    driven = [DRIVER_RATE, DRIVER_PUSH]
    numbers[driven] = (Stand(moved).numbers - before)[driven] / short
    return Carried(numbers, flow.waves)
