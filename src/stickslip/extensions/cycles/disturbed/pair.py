"""Two runs of one problem that differ a little: brought to the ends of the same round trips, compared, and made alike again."""

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
    LOAD,
    RATE,
    SLIP,
    Carried,
    Stand,
    copied,
    disturb,
    flow_of_driver,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem, Stop
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, ExactRun

PASSES = 20_000
"""Number of passes of the engine's loop in one call (1), between which Ctrl-C is heard."""
MOST_WAITS = 1000
"""Round trips (1) after which two runs must rest or slip alike at the end of one."""
MOST_COMPARISONS = 2048
"""The runs are compared no more often than this (1)."""
SPARE_TRIPS = 2.0
"""A run may go on for so many round trips (1) after its duration, to the end of one."""
LEAST_SHARE = 1e-3
"""A motion counts as no smaller than this share (1) of the strength."""
WAVES_AT_FIRST = 8
"""Number of cosines in the first disturbance of a wave (1)."""


def begun(problem: Problem, duration: float, rtol: float) -> ExactRun:
    """Return a run that can be led from the end of a round trip to another one, and leaps over nothing but rest."""
    lasts = duration + SPARE_TRIPS * problem.round_trip_time
    options = CallOptions.of(Scenario(problem, lasts), duration=lasts, rtol=rtol, creep_rtol=0.0)
    return ExactRun.begin(problem, options.check("lyapunov", problem))


def lead(run: ExactRun, mark: int, interval: float) -> None:
    """Lead a run to the end of so many round trips, or behind them, or a run of a rigid body to so many intervals (s).

    Raises InputError.
    """
    if run.count.is_block:
        trip = run.problem.round_trip_time
        whole = math.floor(mark * interval / trip)
        run.last, run.count.to_the_end = (whole, mark * interval - whole * trip), 1
    while run.count.is_block or run.count.trip < mark:
        run.count.pause_at = run.count.pause_at if run.count.is_block else mark
        code = run.advance(PASSES)
        if code == Stop.FINISHED and run.count.is_block:
            return
        if code == Stop.LOCKED:
            raise InputError(
                f"lyapunov: the contact rests for ever from {brief(run.time, 's', 4)} on, and sends disturbances back as they are"
            )
        if code not in (Stop.NONE, Stop.END_AHEAD) and not (code == Stop.FULL and run.grow()):
            raise InputError(f"lyapunov: the run ended at {brief(run.time, 's', 4)}: {run.solution(code).status}")
        if run.count.sparse == 1:
            raise InputError("lyapunov: of slabs without mass or states, under a law of slip, no disturbances are followed")


@dataclass
class Measure:
    """Sizes of what is carried (1): by how much each number and each wave has varied; numbers that decide nothing do not count."""

    counts: Floats
    """Which numbers count (1): 1 or 0."""
    numbers: Floats
    waves: Floats

    @classmethod
    def of(cls, run: ExactRun) -> Self:
        """Return one for the runs of a problem."""
        problem, count, law = run.problem, run.count, run.problem.friction
        decides = np.ones(FIRST_STATE + int(count.states))
        decides[RATE] = count.has_inertia
        decides[LAW_SLIP] = law.depends_on_slip
        decides[SLIP] = count.is_block and (problem.body.structure == "loop" or problem.body.has_stops or problem.body.has_play)
        decides[LOAD] = count.is_block
        decides[[DRIVER_RATE, DRIVER_PUSH]] = problem.driver_kind in ("machine", "damper")
        least = LEAST_SHARE * abs(run.params.reference)
        rate, trip, numbers = least / run.params.impedance, problem.round_trip_time, np.zeros(len(decides))
        numbers[RATE] = numbers[DRIVER_RATE] = rate
        numbers[SLIP] = numbers[LAW_SLIP] = rate * trip
        numbers[LOAD] = numbers[DRIVER_PUSH] = least
        return cls(decides, numbers, np.full(len(Stand(run).series), least))

    def see(self, stand: Stand) -> None:
        """Take note of how far all goes in the history that is kept."""
        run = stand.run
        store, here = run.store, slice(run.length)
        trip = stand.run.problem.round_trip_time
        now = np.abs(stand.numbers)
        now[RATE] = now[DRIVER_RATE] = _range(store.rate[here])
        now[SLIP] = now[LAW_SLIP] = now[RATE] * trip
        now[LOAD] = _range(store.load[here])
        now[DRIVER_PUSH] = now[RATE] * run.params.impedance
        self.numbers = np.maximum(self.numbers, now)
        if self.waves.size:
            self.waves = np.maximum(self.waves, np.ptp(stand.here.waves, axis=1))

    def scaled(self, one: Carried, stand: Stand) -> Floats:
        """Return what is carried in these sizes, as a vector whose length is its size (1)."""
        numbers = self.counts * one.numbers / np.where(self.numbers > 0.0, self.numbers, 1.0)
        waves = one.waves / np.where(self.waves > 0.0, self.waves, 1.0)[:, None]
        return np.concatenate([numbers, (waves * np.sqrt(stand.weights.ravel())).ravel()])


@dataclass
class Pair:
    """A run, and another one that differs a little from it."""

    run: ExactRun
    other: ExactRun
    shifts: bool
    """True if a shift in time is no disturbance, because nothing that drives the run varies in time."""

    interval: float
    """The time (s) from one comparison to the next."""
    mark: int = 1
    """How many intervals of a rigid body, or round trips, are over."""

    @classmethod
    def begin(cls, problem: Problem, duration: float, rtol: float, *, shifts: bool) -> Self:
        """Return two runs that are alike, at the end of the first round trip, or interval of a rigid body."""
        one, other = begun(problem, duration, rtol), begun(problem, duration, rtol)
        interval = max(duration / MOST_COMPARISONS, problem.round_trip_time)
        if one.count.is_block:
            pace = one.params.stiffness / one.params.inertia
            interval = max(duration / MOST_COMPARISONS, min(math.pi / math.sqrt(pace) if pace > 0.0 else math.inf, duration / 64))
        pair = cls(one, other, shifts, interval)
        lead(one, 1, interval)
        return pair

    def lead(self) -> Stand:
        """Lead both runs on by an interval, or more until both rest or both slip; return where the first one stands then."""
        block = self.run.count.is_block
        self.mark += 1 if block else math.ceil(self.interval / self.run.problem.round_trip_time - 1e-6)
        for _ in range(MOST_WAITS):
            for one in (self.run, self.other):
                lead(one, self.mark, self.interval)
            stand, other = Stand(self.run), Stand(self.other)
            if not block:
                self.mark = max(stand.where[0], other.where[0])
            if stand.where == other.where:
                return stand
            self.mark += block or stand.where[0] == other.where[0]
        raise InputError(f"lyapunov: two runs that differ a little part for good before {brief(stand.time, 's', 4)}")

    def apart(self, stand: Stand, measure: Measure) -> tuple[Carried, float]:
        """Return how the other run differs from the run, without a shift in time, and the size of that (1)."""
        between = Stand(self.other).at(stand.phases) - stand.here
        vector = measure.scaled(between, stand)
        if self.shifts:
            flow = stand.flow
            if measure.counts[DRIVER_RATE]:
                flow = flow_of_driver(flow, self.run, self.other)
            along = measure.scaled(flow, stand)
            size = float(along @ along)
            share = float(along @ vector) / size if size > 0.0 else 0.0
            between, vector = between - flow.times(share), vector - share * along
        return between, float(np.linalg.norm(vector))

    def differ_by(self, between: Carried) -> None:
        """Let the other run stand where the run does, but for a disturbance; forget what is over."""
        count = self.run.count
        self.run.forget_before(int(count.previous_from) if not count.is_block else self.run.length - 1)
        disturb(copied(self.run, self.other), between)


def first_disturbance(stand: Stand, measure: Measure) -> Carried:
    """Return a disturbance to begin with: of the states of the law, and of each wave or of a rigid body's place on its spring."""
    numbers = np.zeros(len(stand.numbers))
    numbers[FIRST_STATE:] = measure.numbers[FIRST_STATE:]
    if not len(stand.series):
        stiffness = stand.run.params.stiffness
        numbers[LOAD] = measure.numbers[LOAD]
        numbers[SLIP] = -numbers[LOAD] / stiffness if stiffness > 0.0 else 0.0
        return Carried(numbers, np.zeros((0, 0)))
    turns = np.pi * stand.phases.ravel() / stand.run.problem.round_trip_time
    way = sum(np.cos(n * turns + n) / (n + 1) for n in range(WAVES_AT_FIRST))
    return Carried(numbers, measure.waves[:, None] * way)


def _range(series: Floats) -> float:
    """Return how far the ends of polynomials go."""
    return float(np.ptp(np.append(series[:, 0], series.sum(axis=1))))
