"""Two runs of one problem that differ a little: brought to the ends of the same round trips, compared, and made alike again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from stickslip.extensions.cycles.disturbed.measure import Measure
from stickslip.extensions.cycles.disturbed.stand import (
    DRIVER_RATE,
    Carried,
    Stand,
    copied,
    disturb,
    flow_of_driver,
    on_spring,
)
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
STILL = 1e-6
"""In steady sliding, where all moves by less than this share (1) in a round trip, no disturbance is a shift in time."""
SPARE_SHARE, SPARE_TRIPS = 0.1, 100.0
"""A run may go on for this share (1) of its duration and so many round trips (1) more, until both runs rest or slip alike."""


def begun(problem: Problem, duration: float, rtol: float) -> ExactRun:
    """Return a run that can be led from the end of a round trip to another one, and leaps over nothing but rest."""
    lasts = (1.0 + SPARE_SHARE) * duration + SPARE_TRIPS * problem.round_trip_time
    options = CallOptions.of(Scenario(problem, lasts), duration=lasts, rtol=rtol, creep_rtol=0.0)
    return ExactRun.begin(problem, options.check("lyapunov", problem))


def lead(run: ExactRun, mark: int, interval: float) -> None:
    """Lead a run to the end of so many round trips, or behind them, or a run of a rigid body to so many intervals (s).

    Raises InputError.
    """
    block = run.count.is_block == 1
    if block:
        trip = run.problem.round_trip_time
        whole = math.floor(mark * interval / trip)
        run.last, run.count.to_the_end = (whole, mark * interval - whole * trip), 1
    code = Stop.NONE
    while code != Stop.FINISHED if block else run.count.trip < mark:
        run.count.pause_at = run.count.pause_at if block else mark
        code = Stop(run.advance(PASSES))
        if code not in (Stop.NONE, Stop.END_AHEAD, Stop.LOCKED, Stop.FINISHED) and not (code == Stop.FULL and run.grow()):
            raise InputError(f"lyapunov: the run ended at {brief(run.time, 's', 4)}: {run.solution(code).status}")
        if run.count.sparse == 1:
            raise InputError("lyapunov: of slabs without mass or states, under a law of slip, no disturbances are followed")
        if run.count.is_locked == 1:
            raise InputError("lyapunov: the contact comes to rest for ever, where disturbances neither grow nor tell anything")


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

    @property
    def stand(self) -> Stand:
        """Where the run stands."""
        return Stand(self.run)

    def flow(self, stand: Stand, measure: Measure) -> Carried:
        """Return how fast what the run carries changes in time; the other run is lost where the driver moves."""
        return flow_of_driver(stand.flow, self.run, self.other) if measure.counts[DRIVER_RATE] else stand.flow

    def apart(self, stand: Stand, measure: Measure) -> tuple[Carried, float]:
        """Return how the other run differs from the run, without a shift in time: the direction, and the size (1)."""
        between = on_spring(self.run, Stand(self.other).at(stand.phases) - stand.here)
        if self.shifts and not measure.by_phase:
            flow = self.flow(stand, measure)
            along, vector = measure.scaled(flow, stand), measure.scaled(between, stand)
            size = float(along @ along)
            moves = math.sqrt(size) * self.run.problem.round_trip_time > STILL
            between -= flow.times(float(along @ vector) / size if moves else 0.0)
        return measure.parted(between, stand)

    def differ_by(self, between: Carried) -> None:
        """Let the other run stand where the run does, but for a disturbance; forget what is over."""
        count = self.run.count
        self.run.forget_before(int(count.previous_from) if not count.is_block else self.run.length - 1)
        disturb(copied(self.run, self.other), between)
