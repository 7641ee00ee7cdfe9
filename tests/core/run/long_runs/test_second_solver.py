"""Whatever implements `run.solver.Solver` is run as the exact solver is: progress, Ctrl-C, a number of events, a full history."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

import stickslip as ss
from stickslip.problem.run_codes import ENOUGH_EVENTS, FULL_HISTORY, INTERRUPTED, Stop
from stickslip.run.options import CallOptions
from stickslip.run.progress import Pace
from stickslip.run.run_loop import WholeHistory, run_to_end
from stickslip.run.solver import NewEvents, Solver

PROBLEM = ss.Problem(ss.SpringBlock(2.0, 8.0, 10.0), ss.friction.Coulomb(0.6, 0.4), 0.05, initial_excess=0.0)
STEP = 1e-4


class Computed(NamedTuple):
    """The result of the second solver: what ended it, slip (m) and slip rate (m/s) after each step."""

    code: int
    slip: list[float]
    rate: list[float]


@dataclass
class Ends:
    """Ends of slip that are new: the number of the step of each."""

    run: SmallSteps
    steps: list[int]

    def tell(self) -> None:
        self.run.told += len(self.steps)


class News(NamedTuple):
    """What is told of the progress."""

    time: float
    steps: int


@dataclass
class SmallSteps:
    """A block on a spring under Coulomb friction, by small steps of symplectic Euler."""

    options: CallOptions
    slip: list[float] = field(default_factory=lambda: [0.0])
    rate: list[float] = field(default_factory=lambda: [0.0])
    room: int = 100
    told: int = 0

    @property
    def time(self) -> float:
        return STEP * (self.length - 1)

    @property
    def length(self) -> int:
        return len(self.slip)

    @property
    def can_be_saved(self) -> bool:
        return True

    @property
    def has_enough(self) -> bool:
        return self.told == self.options.max_events

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

    def grow(self) -> bool:
        grows = self.room < self.options.most_pieces
        self.room = min(4 * self.room, self.options.most_pieces)
        return grows

    def new_events(self) -> Ends:
        """Events of a block that sticks or slips: one is over when the slip rate becomes zero."""
        moves = np.asarray(self.rate) > 0.0
        ends = (np.flatnonzero(moves[:-1] & ~moves[1:]) + 1).tolist()[self.told : self.options.max_events]
        if ends and self.told + len(ends) == self.options.max_events:
            del self.slip[ends[-1] + 1 :], self.rate[ends[-1] + 1 :]
        return Ends(self, ends)

    def report(self, pace: Pace) -> News:
        return News(self.time, self.length)

    def save(self) -> None: ...

    def finish(self, code: int) -> Computed:
        return Computed(code, self.slip, self.rate)


def computed(duration: float, **options: Any) -> Computed:
    solver: Solver[NewEvents, Computed] = SmallSteps(CallOptions(duration, **options))
    return run_to_end(solver, WholeHistory(solver))


def test_it_agrees_with_the_exact_solver() -> None:
    """Symplectic Euler has an error of order 1 in the step: abs 3e-4 m of 0.8 m."""
    found = computed(30.0)
    times = STEP * np.arange(len(found.slip))
    exact = ss.simulate(PROBLEM, 30.0)
    assert found.code == Stop.FINISHED
    assert np.abs(exact.slip(np.minimum(times, 30.0)) - found.slip).max() < 3e-4
    assert exact.slip(30.0) > 0.8


def test_it_stops_after_a_number_of_events_at_the_step_that_ends_the_last() -> None:
    found = computed(100.0, max_events=2)
    assert found.code == ENOUGH_EVENTS
    moves = np.asarray(found.rate) > 0.0
    assert np.count_nonzero(moves[:-1] & ~moves[1:]) == 2
    assert found.rate[-2] > 0.0 == found.rate[-1]


def test_progress_is_reported_and_ctrl_c_leaves_a_result() -> None:
    told: list[News] = []

    def tell(news: News) -> None:
        told.append(news)
        if news.time > 1.0:
            raise KeyboardInterrupt

    found = computed(1e6, progress=tell)
    assert found.code == INTERRUPTED
    assert 1.0 < told[-1].time < 1e6
    assert told[-1].steps == len(found.slip)


def test_a_full_history_ends_the_run() -> None:
    found = computed(1e6, max_pieces=500)
    assert found.code == FULL_HISTORY
    assert len(found.slip) == 500
