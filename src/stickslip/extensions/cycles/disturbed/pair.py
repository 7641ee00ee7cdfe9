"""Two runs of one problem that differ a little: brought to the ends of the same round trips, compared, and made alike again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from stickslip.extensions.cycles.disturbed.asked import COMPARED
from stickslip.extensions.cycles.disturbed.measure import Measure
from stickslip.extensions.cycles.disturbed.stand import (
    DRIVER_RATE,
    LOAD_NUMBER,
    SLIP_NUMBER,
    Carried,
    Stand,
    copied,
    disturb,
    flow_of_driver,
)
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, ExactRun

MOST_WAITS = 1000
"""Two runs must rest or slip alike at the end of one of so many round trips (1)."""
STILL_SHARE = 1e-6
"""In steady sliding, where all moves by less than this share (1) in a round trip, no disturbance is a shift in time."""
SPARE_SHARE, SPARE_TRIPS = 0.1, 100.0
"""A run may go on for this share (1) of its duration and so many round trips (1) more, until both runs rest or slip alike."""


def begun(problem: Problem, duration: float, rtol: float) -> ExactRun:
    """Return a run that can be led from the end of a round trip to another one, and leaps over nothing but rest."""
    lasts = (1.0 + SPARE_SHARE) * duration + SPARE_TRIPS * problem.round_trip_time
    options = CallOptions.of(Scenario(problem, lasts), duration=lasts, rtol=rtol, creep_rtol=0.0)
    return ExactRun.begin(problem, options.check("lyapunov", problem))


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
        """Return two runs that are alike, at the first place where they can stand."""
        one, other, kind = begun(problem, duration, rtol), begun(problem, duration, rtol), COMPARED[problem.body.structure]
        interval = kind.interval(one, duration)
        kind.lead(one, 1, interval)
        return cls(one, other, shifts, interval)

    def lead(self) -> Stand:
        """Lead both runs on by an interval, or more until both rest or both slip; return where the first one stands then."""
        kind = self.stand.kind
        self.mark += kind.marks(self.run, self.interval)
        for _ in range(MOST_WAITS):
            for one in (self.run, self.other):
                kind.lead(one, self.mark, self.interval)
            stand, other = self.stand, Stand(self.other)
            if stand.where == other.where:
                self.mark = max(self.mark, stand.where[0])
                return stand
            self.mark = max(self.mark + (stand.where[0] == other.where[0]), stand.where[0], other.where[0])
        raise InputError(f"lyapunov: two runs that differ a little part for good before {brief(self.stand.time, 's', 4)}")

    @property
    def stand(self) -> Stand:
        """Where the run stands."""
        return Stand(self.run)

    def flow(self, stand: Stand, measure: Measure) -> Carried:
        """Return how fast what the run carries changes in time; the other run is lost where the driver moves."""
        return flow_of_driver(stand.flow, self.run, self.other) if measure.counts[DRIVER_RATE] else stand.flow

    def apart(self, stand: Stand, measure: Measure) -> tuple[Carried, float]:
        """Return how the other run differs from the run, without a shift in time: the direction, and the size (1)."""
        between = Stand(self.other).at(stand.phases) - stand.here
        load, slip = (float(between.numbers[n]) for n in (LOAD_NUMBER, SLIP_NUMBER))
        between.numbers[LOAD_NUMBER] = stand.kind.borne(self.run, load, slip)
        if self.shifts and not measure.by_phase:
            flow = self.flow(stand, measure)
            along, vector = measure.scaled(flow, stand), measure.scaled(between, stand)
            size = float(along @ along)
            moves = math.sqrt(size) * self.run.problem.round_trip_time > STILL_SHARE
            between -= flow.times(float(along @ vector) / size if moves else 0.0)
        return measure.parted(between, stand)

    def differ_by(self, between: Carried) -> None:
        """Let the other run stand where the run does, but for a disturbance; forget what is over."""
        self.run.forget_before(self.stand.kind.needed(self.run))
        disturb(copied(self.run, self.other), between)
