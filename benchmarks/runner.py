"""What every method offers: one timed run, and the slip that it found."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.problems import Case, Floats


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
        """Wall time of one run."""
        self.before()
        start = time.perf_counter()
        self.run()
        return time.perf_counter() - start


Method = Callable[[Case, float], Runner]
