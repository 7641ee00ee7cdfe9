"""Whatever implements `run.solver.Solver` is run as the exact solver is: progress, Ctrl-C, a number of events, a full history."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Self

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.state.layout import Stop
from stickslip.run.monitor import run_to_end
from stickslip.run.options import RunOptions
from stickslip.run.progress import Report
from stickslip.run.simulate import WholeHistory
from stickslip.run.solver import Solver
from stickslip.trajectory.status import ENOUGH_EVENTS, FULL_HISTORY, INTERRUPTED

PROBLEM = ss.Problem(ss.SpringBlock(2.0, 8.0, 10.0), ss.friction.Coulomb(0.6, 0.4), 0.05, initial_excess=0.0)
STEP = 1e-4


class Computed(NamedTuple):
    """The result of the second solver: what ended it, slip (m) and slip rate (m/s) after each step."""

    code: int
    slip: list[float]
    rate: list[float]


class Ends(NamedTuple):
    """Ends of slip that are new: the number of the step of each."""

    starts_and_stops: StartsAndStops
    known_by: list[int]

    def first_ones(self, count: int) -> Ends:
        return self._replace(known_by=self.known_by[:count])

    def tell(self) -> None:
        self.starts_and_stops.told += len(self.known_by)


@dataclass
class StartsAndStops:
    """Events of a block that sticks or slips: one is over when the slip rate becomes zero."""

    threshold: float
    told: int = 0

    def look(self, history: list[float]) -> Ends:
        moves = np.asarray(history) > 0.0
        return Ends(self, (np.flatnonzero(moves[:-1] & ~moves[1:]) + 1).tolist()[self.told :])


@dataclass
class SmallSteps:
    """A block on a spring under Coulomb friction, by small steps of symplectic Euler."""

    options: RunOptions
    slip: list[float] = field(default_factory=lambda: [0.0])
    rate: list[float] = field(default_factory=lambda: [0.0])
    room: int = 100
    forgotten: int = 0

    @property
    def time(self) -> float:
        return STEP * (self.length - 1)

    @property
    def length(self) -> int:
        return len(self.slip)

    @property
    def fastest(self) -> float:
        return self.rate[-1]

    def advance(self, budget: int) -> int:
        body, law = PROBLEM.body, PROBLEM.friction
        assert isinstance(body, ss.SpringBlock)
        assert isinstance(law, ss.friction.Coulomb)
        static = body.normal_force * law.static
        for _ in range(budget):
            if self.time >= self.options.duration:
                return Stop.FINISHED
            if self.length >= self.room:
                return Stop.FULL
            pull = static + body.stiffness * (0.05 * (self.time + STEP) - self.slip[-1])
            force = pull - body.normal_force * law.dynamic
            rate = max(self.rate[-1] + STEP * force / body.mass, 0.0) if self.rate[-1] > 0.0 or pull > static else 0.0
            self.rate.append(rate)
            self.slip.append(self.slip[-1] + STEP * rate)
        return Stop.NONE

    def grow(self, most: int) -> bool:
        grows = self.room < most
        self.room = min(4 * self.room, most)
        return grows

    def snapshot(self) -> int:
        return self.length

    def restore(self, snapshot: int) -> None:
        del self.slip[snapshot:], self.rate[snapshot:]

    def history(self) -> list[float]:
        return self.rate

    def events(self, event_rate: float | None = None) -> StartsAndStops:
        return StartsAndStops(event_rate or 1e-6)

    def solution(self, code: int) -> Computed:
        return Computed(code, self.slip, self.rate)


class Keep(WholeHistory):
    """A sink that returns what the solver computed."""

    def finish(self, run: Solver[Any], stream: Any, code: int) -> Any:
        return run.solution(code)

    @classmethod
    def of(cls, duration: float, **options: Any) -> tuple[Self, Computed]:
        solver: Solver[Computed] = SmallSteps(RunOptions(duration, **options))
        sink = cls()
        return sink, run_to_end(solver, sink)


def test_it_agrees_with_the_exact_solver() -> None:
    """Symplectic Euler has an error of order 1 in the step: abs 3e-4 m of 0.8 m."""
    _, found = Keep.of(30.0)
    times = STEP * np.arange(len(found.slip))
    exact = ss.simulate(PROBLEM, 30.0)
    assert found.code == Stop.FINISHED
    assert np.abs(exact.slip(np.minimum(times, 30.0)) - found.slip).max() < 3e-4
    assert exact.slip(30.0) > 0.8


def test_it_stops_after_a_number_of_events_at_the_step_that_ends_the_last() -> None:
    _, found = Keep.of(100.0, max_events=2)
    assert found.code == ENOUGH_EVENTS
    moves = np.asarray(found.rate) > 0.0
    assert np.count_nonzero(moves[:-1] & ~moves[1:]) == 2
    assert found.rate[-2] > 0.0 == found.rate[-1]


def test_progress_is_reported_and_ctrl_c_leaves_a_result() -> None:
    told: list[Report] = []

    def tell(report: Report) -> None:
        told.append(report)
        if report.time > 1.0:
            raise KeyboardInterrupt

    _, found = Keep.of(1e6, progress=tell)
    assert found.code == INTERRUPTED
    assert 1.0 < told[-1].time < 1e6
    assert told[-1].pieces == len(found.slip)
    assert {report.doing for report in told} <= {"stuck", "slipping", "creeping"}


def test_a_full_history_ends_the_run() -> None:
    _, found = Keep.of(1e6, max_pieces=500)
    assert found.code == FULL_HISTORY
    assert len(found.slip) == 500


@pytest.mark.parametrize("share", [0.3, 0.7])
def test_a_snapshot_is_the_same_run(share: float) -> None:
    solver = SmallSteps(RunOptions(3.0), room=10**6)
    solver.advance(int(share * 3.0 / STEP))
    before, rates = solver.snapshot(), replace(solver).rate.copy()
    solver.advance(1000)
    solver.restore(before)
    assert solver.rate == rates
