"""What every method offers: one timed run, and the slip that it found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.problems import Case, Floats


class Unavailable(Exception):
    """The method cannot do this problem, or its package is not installed; the message says which."""


@dataclass(frozen=True)
class Runner:
    """A problem made ready for one method at one tolerance: `run` is what is timed, everything before it is not."""

    case: Case
    tolerance: float
    run: Callable[[], None]
    slip: Callable[[Floats], Floats]
    steps: Callable[[], int]
    arrest: Callable[[], float]

    def error(self) -> float:
        """Measured against the reference, after a run."""
        self.run()
        return self.case.error(self.slip(self.case.times), self.arrest())


Method = Callable[[Case, float], Runner]
