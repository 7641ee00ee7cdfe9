"""What every method offers: one timed run, and the slip that it found."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.problems import Case, Floats

LONG = 1e-3
"""Wall time (s) from which a run is likely to be interrupted on a busy machine; shorter ones are right in the median."""


class UnavailableError(Exception):
    """The method cannot do this problem, or its package is not installed; the message says which."""


@dataclass(frozen=True)
class Runner:
    """A problem made ready for one method at one tolerance: `run` is what is timed, `before` and what made the runner are not."""

    case: Case
    tolerance: float
    run: Callable[[], None]
    slip: Callable[[Floats], Floats]
    steps: Callable[[], int]
    arrest: Callable[[], float] = lambda: math.nan
    before: Callable[[], None] = lambda: None

    def error(self) -> float:
        """Measured against the reference, after a run."""
        self.before()
        self.run()
        return self.case.error(self.slip(self.case.times), self.arrest())

    def seconds(self) -> float:
        """Time of one run: on the wall, but of the processor where it is longer than LONG, so that other work hardly counts."""
        self.before()
        before, start = time.process_time(), time.perf_counter()
        self.run()
        wall = time.perf_counter() - start
        return wall if wall < LONG else time.process_time() - before


Method = Callable[[Case, float], Runner]


def interleaved(runners: dict[str, Runner], rounds: int = 20, budget: float = 0.4) -> dict[str, list[float]]:
    """Times of every runner, in turns, so that what else the machine does hits all alike; about `budget` s for each."""
    once = {name: max(runner.seconds(), 1e-6) for name, runner in runners.items()}
    times: dict[str, list[float]] = {name: [] for name in runners}
    for _ in range(rounds):
        for name, runner in runners.items():
            if len(times[name]) * once[name] < 4.0 * budget:
                repeats = min(max(int(budget / rounds / once[name]), 1), 200)
                times[name] += [runner.seconds() for _ in range(repeats)]
    return times
