"""How fast small disturbances of a motion grow: the result of `ss.studies.lyapunov`, and the error of a mean over a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief, number
from stickslip.problem import TOO_MANY, Problem
from stickslip.run import Study, uninterrupted
from stickslip.run.simulate import simulate
from stickslip.run.study import MAX_PIECES
from stickslip.solution import Solution

LOST_SHARE = 0.1
"""A disturbance of this share (1) of the motion changes an event into another one: it ends the horizon."""
SURE_ERRORS = 3.0
"""An exponent that differs from 0 by more standard errors than this (1) is said to have its sign."""
ERROR_BATCHES = 16
"""A standard error is taken from so many parts of a run (1)."""
DRIFTED = 0.1
"""A motion whose size changes along the run by more than this share (1), steadily, has not come to the one that stays."""
DRIFT_ERRORS = 5.0
"""A drift is told from chance if it is larger than so many of its standard errors (1), which few parts of a run tell roughly."""


@dataclass(frozen=True)
class MeasuredGrowth:
    """What a run tells of its disturbances: their growth up to some times, and what is said of it."""

    time: Floats
    """Ends (s) of intervals, after the start of the first one."""
    growth: Floats
    """The logarithm (1) of the size of a disturbance at these times."""
    exponent: float
    """The mean growth rate, 1/s."""
    error: float
    """Its standard error, 1/s."""
    counted: float
    """The time (s) over which it is the mean."""
    how: str
    """How it was found, in words."""
    events: float = math.nan
    """The number of events in this time, NaN if there are no events of the kind."""
    sum_of_all: float = math.nan
    """The sum of all exponents, 1/s; NaN where it is not known."""
    known: float = math.nan
    """The first disturbance, as a share (1) of the motion: what tolerance and rounding make."""
    per_event: float = math.nan
    """The growth (1) in an event, where it is not the exponent times the time of one."""
    drift: float = 0.0
    """The change of the logarithm of the motion's own size (1) along the run, if it drifts."""


def law_in(problem: Problem, direction: int) -> Any:
    """Return the law of a problem for a direction of slip, 1 or -1: its own backward one if it has two."""
    law = problem.friction
    return law.ways[1] if direction < 0 and law.backward_from else law


def along(time: Floats, growth: Floats, sizes: Floats, how: str, **more: float) -> MeasuredGrowth:
    """Return the growth along a run, with the mean of its rate and the error of that; `time` and `growth` begin with a start.

    `sizes` are those of the motion itself in each interval. Where they drift, the error has the drift in it: what a disturbance
    grows with the motion itself is not what it does when the motion has settled.
    """
    counted = float(time[-1] - time[0])
    exponent = float(growth[-1] - growth[0]) / counted
    error, drift = error_of_mean(np.diff(growth), np.diff(time), exponent), drift_of(sizes)
    error = math.hypot(error, drift / counted)
    return MeasuredGrowth(time, growth - growth[0], exponent, error, counted, how, drift=drift, **more)


def drift_of(sizes: Floats) -> float:
    """Return the change of the logarithm of sizes (1) along a run; 0 if it is small, or no larger than chance makes it.

    It is that of the line through the means of ERROR_BATCHES parts of the run, or through the sizes if these are few.
    """
    logs = np.log(np.maximum(sizes, np.finfo(float).tiny))
    means = np.array([part.mean() for part in np.array_split(logs, ERROR_BATCHES)]) if len(logs) >= 2 * ERROR_BATCHES else logs
    if len(means) < 3:
        return 0.0
    left, place = means - means.mean(), np.linspace(-0.5, 0.5, len(means))
    drift = float(place @ left / (place @ place))
    left = left - drift * place
    error = math.sqrt(float(left @ left / (place @ place)) / (len(means) - 2.0))
    return drift if abs(drift) > max(math.log1p(DRIFTED), DRIFT_ERRORS * error) else 0.0


def whole_run(problem: Problem, lasts: float, rtol: float, cures: str) -> Solution:
    """Return a run of a problem that has lasted so long (s); `cures` say what helps if its history is full. Raises InputError."""
    run = uninterrupted(simulate(problem, lasts, rtol, max_pieces=MAX_PIECES))
    if run.status.ok:
        return run
    why = str(run.status)
    if run.status.name == TOO_MANY:
        why = f"its history reached the limit of {MAX_PIECES} pieces at {brief(run.duration, 's', 4)}; what helps: {cures}"
    raise InputError(f"lyapunov: the run did not reach {brief(lasts, 's')}: {why}")


def error_of_mean(growth: Floats, lasts: Floats, rate: float) -> float:
    """Return the standard error (1/s) of a mean rate of growth from increments that depend on each other, and their durations (s).

    It is that of the means of ERROR_BATCHES long parts of the run, which hardly depend on each other, or of the increments if
    these are few (batch means; Flyvbjerg & Petersen 1989, J. Chem. Phys. 91, 461).
    """
    if len(growth) < 2:
        return math.nan
    left = growth - rate * lasts
    sums = np.array([part.sum() for part in np.array_split(left, ERROR_BATCHES)]) if len(left) >= 2 * ERROR_BATCHES else left
    return math.sqrt(len(sums) / (len(sums) - 1.0) * float(sums @ sums)) / float(lasts.sum())


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovExponent(Study):
    """The result of `lyapunov`: at what rate small disturbances of a motion grow or fade, and for how long events are predictable.

    `table` has a row for each interval of the run that counts: time (s) at its end, and growth (1), the logarithm of the size of a
    disturbance there.
    """

    problem: Any
    """What was run."""
    found: MeasuredGrowth = field(compare=False)

    @property
    def exponent(self) -> float:
        """The largest Lyapunov exponent (1/s) of disturbances other than a shift in time; -inf if they end."""
        return self.found.exponent

    @property
    def error(self) -> float:
        """The standard error of the exponent (1/s), from how its mean changes along the run; NaN if it cannot be told."""
        return self.found.error

    @property
    def per_event(self) -> float:
        """The growth from one event to the next, as a logarithm (1); NaN if there is no event."""
        if not math.isnan(self.found.per_event):
            return self.found.per_event
        return self.exponent * self.found.counted / self.found.events if self.found.events > 0.0 else math.nan

    @property
    def sum_of_all(self) -> float:
        """The sum of all exponents (1/s), which is how fast a volume of disturbances grows; NaN where it is not known."""
        return -math.inf if self.exponent == -math.inf else self.found.sum_of_all  # no other is larger than the largest

    @property
    def chaotic(self) -> bool | None:
        """True if disturbances grow, False if they fade.

        None: the exponent is 0, or lies within three standard errors of it, which are large if the motion itself grows or shrinks.
        """
        if math.isinf(self.exponent):
            return False
        return None if not abs(self.exponent) > SURE_ERRORS * self.error else self.exponent > 0.0

    @property
    def horizon(self) -> float:
        """About how long (s) single events are predictable, if rounding and tolerance are all that disturbs them; inf: for ever.

        The first disturbance grows to a tenth of the motion at the rate of the exponent. NaN if that disturbance is not known.
        """
        if self.chaotic is not True:
            return math.inf
        return math.log(LOST_SHARE / self.found.known) / self.exponent

    @cached_property
    def table(self) -> pd.DataFrame:
        """The growth of a disturbance along the run."""
        return pd.DataFrame({"time": self.found.time, "growth": self.found.growth})

    @property
    def text(self) -> str:
        """Say in one sentence at what rate disturbances grow."""
        if math.isinf(self.exponent):
            return f"not chaotic: {self.found.how}"
        size = f"{number(self.exponent, 5)} 1/s"
        if not math.isnan(self.error):
            size += f" (standard error {number(self.error, 2)})"
        what = {
            True: f"chaotic: a disturbance grows by a factor e in {brief(1.0 / self.exponent, 's', 4)}" if self.exponent else "",
            False: f"not chaotic: a disturbance fades by a factor e in {brief(-1.0 / self.exponent, 's', 4)}"
            if self.exponent
            else "",
            None: "neither growth nor decay of disturbances can be told",
        }[self.chaotic]
        hint = "; a longer run (duration) tells more" if self.chaotic is None else ""
        if self.exponent == 0.0 and self.error == 0.0:
            what, hint = "disturbances stay as they are", ""
        if self.found.drift:
            turns, times = "grows" if self.found.drift > 0.0 else "shrinks", brief(math.exp(abs(self.found.drift)), "", 3)
            drifts = f"the motion still drifts, the range of its slip rate {turns} by a factor {times} along the run"
            what, so = (drifts, "") if self.chaotic is None else (what, f"; {drifts}")
            hint = f"{so}: give a longer run (duration), or leave out more at its start (skip)"
        return f"{what}: the largest Lyapunov exponent is {size}, {self.found.how}{hint}"

    @property
    def event_text(self) -> str:
        """Say in one sentence what an event makes of a disturbance; "" if there is none."""
        if not math.isfinite(self.per_event):
            return ""
        return f"from one event to the next a disturbance is multiplied by {number(math.exp(self.per_event), 4)} on average"

    @property
    def sum_text(self) -> str:
        """Say in one sentence what becomes of a volume of disturbances; "" if it is not known."""
        return f"the sum of all exponents is {number(self.sum_of_all, 5)} 1/s" if math.isfinite(self.sum_of_all) else ""

    @property
    def horizon_text(self) -> str:
        """Say in one sentence for how long single events are predictable; "" if disturbances do not grow."""
        if not math.isfinite(self.horizon):
            return ""
        first = f"a first disturbance of {number(self.found.known, 2)} of the motion"
        return f"single events are predictable for about {brief(self.horizon, 's', 3)}: {first} grows to a tenth of it then"

    @property
    def texts(self) -> tuple[str, ...]:
        """All that is said of it, in sentences."""
        return tuple(text for text in (self.text, self.event_text, self.sum_text, self.horizon_text) if text)

    def _about(self) -> Iterable[str]:
        return self.texts

    def _sentences(self) -> Iterable[str]:
        return self.texts

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.cycles.figures.lyapunov import draw_growth

        return draw_growth
