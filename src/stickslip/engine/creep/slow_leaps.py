"""Leaps over slow sliding: where a run slides slowly, and how far it may leap."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from stickslip.engine.creep.landing import SHORTEST_LEAP
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.slow import BOTH, HEAVY, PLAIN, Offsets, SlowMotion
from stickslip.engine.history.series import horner
from stickslip.engine.state.layout import Floats
from stickslip.problem import Problem

MOST_OFFSETS = 12_000
"""Largest number of offsets that are followed: a round trip of more than a thousand pieces is not leaped over."""
FASTEST_CHANGE = 0.02
"""Largest relative change of the slip rate in a round trip: above it the motion is not slow."""
SAFETY_OF_ESTIMATE = 4.0
"""Bound of the error as a multiple of its estimate."""
RATE_SHARE = 10.0
"""Largest relative error of the slip rate, as a multiple of the tolerance of slip."""
PRECISION = 1e-10
"""Relative local error of the integration, far below that of the averaged equations."""
BISECTIONS_OF_STEP = 8
"""Number of bisections that look for the end of slow sliding within a step of the integration."""
STEP_COST, STRETCH_COST = 400, 10
"""Cost of a step of the integration, in pieces of history that are computed meanwhile, and what each stretch adds to it."""
FEWEST_STEPS, MOST_STEPS = 10, 250
"""Number of steps that a leap takes at least, about, and at most: they take a second or two, in which a run cannot be stopped."""
RESOLVED = 0.1
"""Share of the tolerance to which slip rates are resolved where several pieces of a round trip are followed as one."""
PUSHED = 1.0
"""Largest force on the mass of the contact within a round trip, over the direct effect, as a share of the tolerance."""
FADED = 0.1
"""Share of the tolerance within which slip rates and states are taken for stable steady sliding: other leaps begin there."""


class SlowStep(NamedTuple):
    """A step of the integration: from one moment to another (round trips since the leap began), with all between them."""

    begin: float
    end: float
    between: Callable[[float], Floats]


@dataclass(frozen=True)
class SlowLeap:
    """A leap over slow sliding, and the averaged state where it lands."""

    motion: SlowMotion
    steps: list[SlowStep]
    trips: int
    landing: Floats
    error: float  # of the slip, m


@dataclass
class SlowLeaps:
    """Find how far the averaged motion may be followed: the error of slip stays below `tolerance` times the slip.

    One object makes one leap. `slipped` is the slip before it, since the start of the run.
    """

    problem: Problem
    tolerance: float
    steady: Floats | None
    """States of steady sliding at the pull rate if that is stable: it is left to the leaps over steady sliding."""
    slipped: float = 0.0  # m
    quickest: float = 0.0  # largest pace so far: see `Slow`
    error: float = 0.0  # of the slip at the last state that was examined, m
    cost: int = 0  # of looking for a leap, in round trips that could have been computed meanwhile
    at_end: bool = False
    """True if a longer run might leap, or leap farther."""
    motion: SlowMotion = field(init=False)

    @np.errstate(all="ignore")  # a step that is tried and refused may overflow
    def leap(self, run: LeapingRun, most: int) -> SlowLeap | None:
        """Return a leap over at most so many round trips, None if none is worth its cost."""
        store, rows = run.store, slice(int(run.count.previous_from), int(run.count.previous_to))
        way, pieces = int(math.copysign(1.0, self.problem.first_pull_rate)), rows.stop - rows.start
        if (store.mode[rows] != way).any() or (store.bend[rows] != 0.0).any() or store.trip[rows][-1] != run.count.trip - 1:
            return None
        if not (way * store.rate[rows].sum(axis=1)).min() > 0.0:
            return None
        self.at_end = most * pieces < FEWEST_STEPS * STEP_COST
        if self.at_end:
            return None
        begins, widths, rates = store.phase_from[rows], store.speed[rows], way * store.rate[rows]

        def log_rate(phase: Floats) -> Floats:
            row = np.searchsorted(begins, phase, side="right") - 1
            return np.asarray(np.log(horner(rates[row], (phase - begins[row]) / widths[row])))

        turn = self.problem.round_trip_time
        offsets = Offsets.of(np.append(begins, turn), log_rate, turn, RESOLVED * self.tolerance)
        if offsets.phase.size > MOST_OFFSETS:
            return None
        step_cost = (STEP_COST + STRETCH_COST * len(offsets.phase)) // pieces
        self.motion, rate = SlowMotion(self.problem, offsets), np.exp(log_rate(offsets.phase.ravel()))
        self.slipped = abs(float(run.state.slip_now))
        now = [run.state.state_now[k] for k in range(len(self.problem.friction.states))]
        start = self.motion.start(rate, np.array(now))
        steps = self._steps(start, most) if self._is_slow(start) else []
        trips, self.cost = math.floor(steps[-1].end) if steps else 0, len(steps) * step_cost
        if trips < SHORTEST_LEAP:
            return None
        steps = [one._replace(end=min(one.end, float(trips))) for one in steps if one.begin < trips]
        landing = steps[-1].between(float(trips))
        return SlowLeap(self.motion, steps, trips, landing, self.error) if self._is_slow(landing) else None

    def _steps(self, start: Floats, most: int) -> list[SlowStep]:
        """Return the steps of the integration as far as the motion stays slow and its error is allowed."""
        from scipy.integrate import DOP853  # takes a moment to load, which other runs do not need

        allowed = np.full_like(start, PRECISION)
        allowed[:, -1] *= self.slipped + self.motion.speed * self.problem.round_trip_time

        def change(_: float, y: Floats) -> Floats:
            return self.motion.at(y.reshape(start.shape)).change.ravel()

        solver = DOP853(change, 0.0, start.ravel(), float(most), rtol=PRECISION, atol=allowed.ravel())
        steps: list[SlowStep] = []
        while solver.status == "running" and len(steps) < MOST_STEPS:
            solver.step()
            if solver.status == "failed":
                break
            step = SlowStep(solver.t_old, solver.t, _shaped(solver.dense_output(), start.shape))
            end = self._reached(step)
            steps.append(step._replace(end=end))
            self.at_end = step.end == most
            if end < step.end or self._has_faded(step.between(end)):
                break
        return steps

    def _reached(self, step: SlowStep) -> float:
        """Return the last moment of a step with slow motion."""
        low, high = step.begin, step.end
        if self._is_slow(step.between(high)):
            return high
        for _ in range(BISECTIONS_OF_STEP):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._is_slow(step.between(middle)) else (low, middle)
        return low

    def _has_faded(self, y: Floats) -> bool:
        """Return True if nothing is left but stable steady sliding."""
        if self.steady is None:
            return False
        faster, beyond = y[BOTH, : self.motion.size] - math.log(self.motion.speed), y[BOTH, self.motion.size : -1] - self.steady
        return bool(max(np.abs(faster).max(), np.abs(beyond).max()) <= FADED * self.tolerance)

    def _is_slow(self, y: Floats) -> bool:
        """Return True if the motion is slow in a state, and its error is allowed."""
        now = self.motion.at(y)
        if not (np.isfinite(now.change).all() and now.rises and now.pace <= FASTEST_CHANGE):
            return False
        if self.problem.body.has_inertia and self.motion.push(y) > PUSHED * self.tolerance:
            return False
        quickest, off = max(self.quickest, now.pace), y - y[BOTH]
        off[:, -1] += now.slip_begins - now.slip_begins[BOTH]
        off[:, : self.motion.size] += now.quicker - now.quicker[BOTH]
        error = SAFETY_OF_ESTIMATE * (quickest * np.abs(off[PLAIN]) + np.abs(off[HEAVY]))
        if error[-1] > self.tolerance * (self.slipped + y[BOTH, -1]):
            return False
        if error[: self.motion.size].max() > RATE_SHARE * self.tolerance:
            return False
        self.quickest, self.error = quickest, float(error[-1])
        return True


def _shaped(dense: Callable[[float], Floats], shape: tuple[int, ...]) -> Callable[[float], Floats]:
    return lambda moment: dense(moment).reshape(shape)
