"""Solve for the states of a law along a given motion, in compiled code, and keep every step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from stickslip.engine import compile_formula
from stickslip.extensions.given_motion.compiled import along_motion as at
from stickslip.extensions.given_motion.compiled.nodes import PLACES_IN_STEP, PLACES_OF_POINTS, WEIGHTS
from stickslip.extensions.given_motion.intervals import MotionInIntervals, Places
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.uncompiled import lend_memory
from stickslip.friction import FrictionLaw

AT_ONCE = 20_000
"""Largest number of steps that are taken at once, without looking at the run."""
SHORT_RUN = 2_000
"""Steps that are taken first: most runs have fewer."""
MOST_STEPS = 20_000_000
"""Largest number of steps of a run."""
LEAST_TOLERANCE = 1e-14
"""Smallest tolerance (1) of a step: below it all is rounding."""


@dataclass(frozen=True, eq=False)
class StepsOfStates:
    """The states, in the form that formulas use, in all steps: the polynomial through the values at Radau's points."""

    interval: Places
    """The interval of each step."""
    since: Floats
    """The start (s) of each step since the start of its interval."""
    length: Floats
    tried: Floats
    """The length (s) with which the next step was begun."""
    values: Floats
    """(steps, states, points): the states at the points."""
    errors: Floats
    """(steps, states): bounds of the errors of the states at the ends of steps."""

    def first(self, count: int) -> StepsOfStates:
        """Return the first steps."""
        return StepsOfStates(*(getattr(self, one.name)[:count] for one in fields(self)))

    def within(self, k: Places, since: Floats) -> tuple[list[Floats], list[Floats]]:
        """Return the states in steps k at times (s) since the starts of their intervals, and bounds of their errors."""
        place = np.clip((since - self.since[k]) / self.length[k], 0.0, 1.0)
        gaps = place[..., None] - PLACES_OF_POINTS
        hit = gaps == 0.0
        basis = WEIGHTS / np.where(hit, 1.0, gaps)
        basis = np.where(hit.any(axis=-1, keepdims=True), hit, basis / basis.sum(axis=-1, keepdims=True))
        states, errors = [], []
        for i in range(self.values.shape[1]):
            begins = self.values[k, i, :1]
            states.append(np.asarray(begins[..., 0] + (basis * (self.values[k, i] - begins)).sum(axis=-1)))
            before = np.where(k > 0, self.errors[k - 1, i], 0.0)
            errors.append(np.asarray(before + self.errors[k, i]))
        return states, errors

    @classmethod
    def joined(cls, parts: Sequence[StepsOfStates]) -> StepsOfStates:
        """Return the steps of several parts of a run, one after the other."""
        return cls(*(np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(cls)))


class StatesUnderWay:
    """The states of a law on their way along a motion, and the steps so far; it goes on behind steps that are given."""

    def __init__(
        self,
        law: FrictionLaw,
        motion: MotionInIntervals,
        start: tuple[float, ...],
        tolerance: float,
        before: StepsOfStates | None = None,
    ) -> None:
        tree, self.many = law.trees()[0], len(law.states)
        self.motion, self.name, self.table = motion, type(law).__name__, motion.table()
        self.formula = compile_formula(
            tree, law.parameters(), law.state_trees()
        )  # its machine code is needed as long as this lives
        self.constants = np.zeros(self.formula.size)
        self.formula.fill(np.array(law.piece_values(0), float), 0.0, self.constants)
        lend_memory(self.constants)
        self.compiled = at.LawWithStates(
            self.formula.address("state_value"),
            self.constants.ctypes.data,
            self.many,
            law.normal_coupling,
            np.array([float(one.reverses) for one in law.states]),
            np.array([one.scale for one in law.states]),
            max(tolerance, LEAST_TOLERANCE),
        )
        self.now = np.zeros(at.LEVELS + 3 * at.MOST_STATES_HERE)
        self.now[at.LEVELS : at.LEVELS + self.many] = start
        self.now[at.LEVELS + 2 * at.MOST_STATES_HERE :][: self.many] = np.abs(start)
        self.now[at.TRIED] = float(self.table[0, at.LASTING])
        self.parts: list[StepsOfStates] = []
        self.count = 0
        if before is not None and len(before.length):
            self._go_on_behind(before)

    def _go_on_behind(self, steps: StepsOfStates) -> None:
        """Put the run where some steps have left it."""
        now, place = self.now, int(steps.interval[-1])
        since = float(steps.since[-1] + steps.length[-1])
        is_over = since >= self.table[place, at.LASTING] * (1.0 - at.SHORTEST_STEP)
        now[at.AT_INTERVAL], now[at.SINCE] = (place + 1, 0.0) if is_over else (place, since)
        now[at.TRIED] = steps.tried[-1]
        ends, many = steps.values[:, :, -1], self.many
        now[at.LEVELS :][:many] = ends[-1]
        now[at.LEVELS + at.MOST_STATES_HERE :][:many] = steps.errors[-1]
        largest = now[at.LEVELS + 2 * at.MOST_STATES_HERE :][:many]
        largest[:] = np.maximum(largest, np.abs(ends).max(axis=0))
        self.parts, self.count = [steps], len(steps.length)

    @property
    def is_over(self) -> bool:
        """True at the end of the motion."""
        return bool(self.now[at.AT_INTERVAL] >= len(self.table))

    @property
    def time(self) -> float:
        """The time (s) that has been reached, in a motion that is not over."""
        return float(self.motion.start[int(self.now[at.AT_INTERVAL])] + self.now[at.SINCE])

    def advance(self, most: int) -> None:
        """Take at most so many steps. Raises InputError where the states cannot be followed."""
        most, many = min(most, AT_ONCE), self.many
        kept = at.KeptSteps(np.zeros((most, 4)), np.zeros((most, many * PLACES_IN_STEP)), np.zeros((most, many)))
        count = at.follow_states(self.table, self.compiled, self.now, kept, most)
        if count < 0 or self.count > MOST_STEPS:
            why = "no step is short enough" if count < 0 else f"{MOST_STEPS} steps are not enough"
            raise InputError(f"simulate: the state of {self.name} cannot be followed beyond {self.time:.9g} s: {why}")
        steps, values = kept.steps[:count], kept.states[:count].reshape(-1, many, PLACES_IN_STEP)
        errors = np.where(np.isnan(kept.errors[:count]), math.inf, kept.errors[:count])  # one that is no number bounds nothing
        since, length, tried = (steps[:, n].copy() for n in (1, 2, 3))
        self.parts.append(StepsOfStates(steps[:, 0].astype(np.int64), since, length, tried, values.copy(), errors))
        self.count += count

    def steps(self) -> StepsOfStates:
        """Return all steps so far."""
        self.parts = [StepsOfStates.joined(self.parts)]
        return self.parts[0]


def solve_states(law: FrictionLaw, motion: MotionInIntervals, start: tuple[float, ...], tolerance: float) -> StepsOfStates:
    """Follow the states of a law, given in the form of the formulas, along a motion to its end.

    Raises InputError where the states cannot be followed.
    """
    run = StatesUnderWay(law, motion, start, tolerance)
    while not run.is_over:
        run.advance(SHORT_RUN if not run.count else AT_ONCE)
    return run.steps()


def steps_that_stay(steps: StepsOfStates, before: MotionInIntervals, after: MotionInIntervals) -> int:
    """Return how many steps along a motion are those along the same motion to another end, bit for bit.

    A step is another one where the interval differs, and where its end shortens the step or would have done.
    """
    one, other = before.table(), after.table()
    common = min(len(one), len(other))
    began = before.start[:common] == after.start[:common]
    same = began & (one[:common] == other[:common]).all(axis=1)
    place = common if same.all() else int(np.argmin(same))
    count = int(np.searchsorted(steps.interval, place))
    alike = np.arange(at.INTERVAL_COLUMNS) != at.LASTING
    if place == common or not (began[place] and (one[place] == other[place])[alike].all()):
        return count
    inside = slice(count, int(np.searchsorted(steps.interval, place, side="right")))
    lasts = min(one[place, at.LASTING], other[place, at.LASTING]), max(one[place, at.LASTING], other[place, at.LASTING])
    tried = np.append(one[0, at.LASTING], steps.tried)[inside]
    freely = np.minimum(tried, _longest_step(one[place])) <= at.OF_REST * (lasts[0] - steps.since[inside])
    freely &= steps.length[inside] > at.SHORTEST_STEP * lasts[1]
    return count + (len(freely) if freely.all() else int(np.argmin(freely)))


def _longest_step(at_interval: Floats) -> float:
    """Return how long (s) a step may be at most, as the compiled `longest_step` does."""
    tones = ((at.RATE_TONE, at.RATE_FREQUENCY), (at.LOAD_TONE, at.LOAD_FREQUENCY))
    found = [2.0 * math.pi / (at.STEPS_PER_PERIOD * at_interval[of]) for tone, of in tones if at_interval[tone] != 0.0]
    return float(min(found, default=math.inf))
