"""What a run is held to: the truth of its case, and the law along the way."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from tests.core.run.adversarial.cases import Case
from tests.core.run.adversarial.truth import Truth, is_decided, truth_of
from tests.core.run.adversarial.walk import TooStiffError

CLAIM = 1e-7
"""Of the slip and of the end of the first event, at the default rtol."""


class Errors(NamedTuple):
    """Largest error of the slip, relative to the total; relative error of the end of the first event, 0 where there is none."""

    slip: float
    end: float

    @property
    def largest(self) -> float:
        """The larger of the two."""
        return max(self.slip, self.end)


def errors(run: ss.Solution, truth: Truth) -> Errors:
    """Errors of a run; infinite where it ends too early or its first event does not end."""
    if run.history.duration < truth.times[-1] * (1.0 - 1e-6):
        return Errors(np.inf, np.inf)
    slips = run.slip(np.minimum(truth.times, run.history.duration))
    slip = float(np.abs(slips - truth.slips).max()) / truth.total
    if truth.end is None:
        return Errors(slip, 0.0)
    events = run.catalogue(0.0)
    end = float(events.end.iloc[0]) if len(events) else np.nan
    return Errors(slip, abs(end / truth.end - 1.0) if np.isfinite(end) else np.inf)


def decided_truth(case: Case) -> Truth | None:
    """The truth, or None where rounding decides the case (`truth.DISTURBANCE`) or an explicit method cannot give it."""
    try:
        truth = truth_of(case)
        return truth if truth.total > 0.0 and is_decided(case, truth) else None
    except TooStiffError:
        return None


def off_the_law(run: ss.Solution, points: int = 4001) -> float:
    """Largest ||traction| - S mu| while slipping, as a share of S, at times that do not know the steps of the run."""
    times = np.linspace(0.0, run.history.duration, points)[1:]
    rate, normal, law = run.slip_rate(times), run.problem.normal, run.problem.friction
    slips = np.abs(rate) > 0.0
    slip = run.problem.law_slip + run.slip(times) - run.problem.initial_slip
    found: NDArray[np.float64] = np.abs(np.abs(run.traction(times)) - normal * law.coefficient(slip, np.abs(rate)))
    return float(found[slips].max(initial=0.0)) / normal
