"""The derivative of an output with respect to one number, from runs with values beside it at one step after the other."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.sensitivity.changes import alike
from stickslip.extensions.sensitivity.outputs import CurveAtTimes, Output, Reading
from stickslip.extensions.sensitivity.stencil import SIDES, Slope, slope_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Parameter, Problem
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate
from stickslip.run.study import MAX_PIECES
from stickslip.solution import Solution

FIRST_STEP, NEXT_STEP, MOST_STEPS = 0.01, 4.0, 11
"""The first step, as a share (1) of the number, the factor between steps, and how many are tried."""
MOST_SHORTER = 6
"""How many steps are tried (1) until there are values to both sides of a number."""
WELL_KNOWN = 1e-8
"""No further step is tried where errors are below this share (1) of the largest derivative."""
UNKNOWN, NO_EFFECT = 0.1, 1e-6
"""A derivative is not told if its error exceeds UNKNOWN of the largest one, unless the number hardly changes anything: errors of
the scaled derivative below NO_EFFECT of the largest value (1)."""
SEEN, TOO_FAR, TRIALS = 1e-5, 1e-2, 24
"""The first step of a number that is 0 changes the output by a share (1) between the first two; so many are tried."""
NEXT_TO, SAME_CELLS = 1e-8, 1e-3
"""Travel times of layers have another ratio if a number that changes by NEXT_TO (1) changes their errors in cells by more than a
share SAME_CELLS (1) of that."""
NEAR_TIME = 1e-3
"""The smallest steps move a change of the contact by less than this share (1) of the run."""
DIGITS = 12
"""Digits with which values of a number beside each other are told."""


class Missing(NamedTuple):
    """Where there is no derivative, between which values of the number runs differ, and why, in words; "" for what is not known."""

    where: str
    between: str
    why: str


class OfNumber(NamedTuple):
    """The derivatives with respect to one number, NaN where there is none, with errors, and what is said of them."""

    parameter: Parameter[Problem]
    slope: Floats
    error: Floats
    step: Floats
    """The step (in the unit of the number) of each derivative."""
    side: str
    """On which side of the number the values lie: "both", "above" or "below"."""
    missing: Missing | None
    runs: int


class _Tried(NamedTuple):
    """The members at one step: the numbers and what they gave, in the order of SIDES, and where all are alike."""

    side: str
    step: float
    values: list[float]
    readings: list[Reading | None]
    same: NDArray[np.bool_]


@dataclass
class Differences:
    """The runs of a study: of a problem, and of others that differ in one number."""

    problem: Problem
    output: Output
    base: Reading
    rtol: float
    ran: Callable[[], object] = lambda: None
    runs: int = field(default=0, init=False)

    def by(self, parameter: Parameter[Problem]) -> OfNumber:
        """Return the derivatives with respect to a number."""
        count, before = len(self.base.values), self.runs
        slope, error, step = (np.full(count, np.nan) for _ in range(3))
        error[:] = np.inf
        first = FIRST_STEP * abs(parameter.value) or self._first_step(parameter)
        if self._cuts_anew(parameter, first / FIRST_STEP):
            nothing = np.full(count, np.nan)
            why = "the body is cut into whole cells of equal travel time, and this changes the ratio of travel times"
            return OfNumber(parameter, nothing, nothing, nothing, "both", Missing("", "", why), self.runs - before)
        last: _Tried | None = None
        begin = trial = self._to_both_sides(parameter, first)
        grows = False
        for n in range(MOST_STEPS):
            tried = self._members(parameter, trial)
            if tried and last and tried.side != last.side:
                break  # values to one side alone say nothing of the other
            last = tried or last
            found = self._slopes(tried) if tried else None
            improved = False
            if tried and found:
                here = np.flatnonzero(tried.same)
                better = found.error < error[here]
                at = here[better]
                improved = bool(np.any(found.error < 0.5 * error[here]))
                slope[at], error[at], step[at] = found.slope[better], found.error[better], trial
            if np.all(error <= WELL_KNOWN * np.abs(slope).max()) or (grows and not improved):
                break
            if tried and tried.same.all() and not improved:
                if n > 1:
                    break
                grows, trial = True, begin  # a smaller step is worse: rounding decides
            trial *= NEXT_STEP if grows else 1.0 / NEXT_STEP
        told = self._told(slope, error, first)
        missing = None if told.all() else self._missing(parameter, last, np.flatnonzero(~told))
        blank = np.where(told, 0.0, np.nan)
        side = last.side if last else "both"
        return OfNumber(parameter, slope + blank, error + blank, step + blank, side, missing, self.runs - before)

    def _told(self, slope: Floats, error: Floats, step: float) -> NDArray[np.bool_]:
        """Return where derivatives are known well enough; `step` is a share FIRST_STEP of the number, or of its scale."""
        if not np.isfinite(error).any():
            return np.zeros(len(slope), bool)
        most = max(UNKNOWN * float(np.nanmax(np.abs(slope))), NO_EFFECT * FIRST_STEP / step * float(np.abs(self.base.values).max()))
        return np.asarray(error <= most)

    def _cuts_anew(self, parameter: Parameter[Problem], size: float) -> bool:
        """Return True if layers fit their cells differently with a value next to that of a number, of this size.

        Runs follow the cells: a derivative by them is not that of the layers.
        """
        cells: Any = getattr(self.problem.body, "cells", None)
        for sign in (1.0, -1.0) if cells else ():
            try:
                beside = parameter.put(parameter.value + sign * NEXT_TO * size).body
            except InputError:
                continue
            other = getattr(beside, "cells", cells)
            return bool(other.counts != cells.counts or abs(other.error - cells.error) > SAME_CELLS * NEXT_TO)
        return False

    def _to_both_sides(self, parameter: Parameter[Problem], step: float) -> float:
        """Return a step that is short enough for values to both sides of a number; this one if there are none, or hardly."""
        shorter = step
        for _ in range(MOST_SHORTER):
            with suppress(InputError):
                for place in (min(SIDES["both"]), max(SIDES["both"])):
                    parameter.put(parameter.value + place * shorter)
                return shorter
            shorter /= NEXT_STEP
        return step

    def _run(self, problem: Problem) -> Reading | None:
        """Return what a run gives, or None if it fails or does not give it."""
        self.runs += 1
        try:
            found = self.output.of(member_run(problem, self.output.last, self.rtol, self.output.most_events))
        except (InputError, ArithmeticError):
            found = None
        self.ran()
        return found

    def _same(self, reading: Reading | None) -> NDArray[np.bool_]:
        """Return where a run has had the same changes as the base run."""
        if reading is None:
            return np.zeros(len(self.base.values), bool)
        common = alike(self.base.changes, reading.changes)
        same = (reading.before == self.base.before) & (self.base.before <= common)
        return np.asarray(same & np.isfinite(reading.values))

    def _members(self, parameter: Parameter[Problem], step: float) -> _Tried | None:
        """Return the runs at one step, or None if there is none: the outermost first, for if none of it is alike it is no use."""
        for side, places in SIDES.items():
            try:
                values = [parameter.value + place * step for place in places]
                problems = [parameter.put(value) for value in values[1:]]
            except InputError:
                continue
            readings: list[Reading | None] = [self.base, *[None] * len(problems)]
            same = np.ones(len(self.base.values), bool)
            for n in (len(problems), len(problems) - 1, *range(1, len(problems) - 1)):
                readings[n] = self._run(problems[n - 1])
                same &= self._same(readings[n])
                if not same.any():
                    break
            return _Tried(side, step, values, readings, same)
        return None

    def _slopes(self, tried: _Tried) -> Slope | None:
        """Return the derivatives at one step, where all members are alike; None if they are nowhere."""
        if not tried.same.any():
            return None
        values = np.array([one.values for one in tried.readings if one is not None])
        return slope_of(values[:, tried.same], tried.side, tried.step)

    def _first_step(self, parameter: Parameter[Problem]) -> float:
        """Return a step for a number that is 0, in its unit: one with which the output changes, and little."""
        step, way = 1.0, 0.0
        size = float(np.abs(self.base.values).max()) or 1.0
        for _ in range(TRIALS):
            reading = None
            for sign in (1.0, -1.0):
                try:
                    reading = self._run(parameter.put(sign * step))
                    break
                except InputError:
                    continue
            change = np.inf
            if reading is not None and self._same(reading).any():
                change = float(np.nanmax(np.abs(reading.values - self.base.values)[self._same(reading)])) / size
            wanted = -1.0 if change > TOO_FAR else 1.0 if change < SEEN else 0.0
            if not wanted or wanted == -way:
                break
            step, way = step * 10.0**wanted, wanted
        return step / 3.0

    def _missing(self, parameter: Parameter[Problem], last: _Tried | None, missing: NDArray[np.intp]) -> Missing:
        """Return why there is no number at some places, told of the first of them."""
        first, whole = int(missing[0]), len(missing) == len(self.base.values)
        if last is None:
            return Missing("", "", f"it may have no values beside {brief(parameter.value, parameter.unit)}")
        where = ""
        if isinstance(self.output, CurveAtTimes):
            many = f" and {len(missing) - 1} of {len(self.base.values) - 1} other times" if len(missing) > 1 else ""
            where = f" at {brief(float(self.output.times[first]), 's')}{many}"
        for value, reading in zip(last.values, last.readings, strict=True):
            if value != parameter.value and (reading is not None or whole) and not self._same(reading)[first]:
                ends = [brief(one, parameter.unit, DIGITS) for one in sorted((parameter.value, value))]
                between = f"between {parameter.name} = {ends[0]} and {ends[1]}"
                return Missing(where, between, self._difference(reading, first))
        return Missing(where, "", "runs with values beside it lie on no smooth curve, down to the smallest step")

    def _difference(self, reading: Reading | None, first: int) -> str:
        """Say which change of the contact is not the same in another run."""
        if reading is None:
            return f"the {self.output.words} ceases to be: a run fails, ends before, or lacks the event"
        ours, theirs = self.base.changes, reading.changes
        n = alike(ours, theirs)
        if n < min(len(ours), len(theirs)):
            time, both = float(ours.time[n]), f"where {ours.words(n)} for one value, and {theirs.words(n)} for the other"
        else:
            n = int(min(self.base.before[first], reading.before[first]))
            longer = ours if self.base.before[first] > n else theirs
            time, both = float(longer.time[n]), f"where {longer.words(n)} for one of the values only"
            if self._is_near(time, first):
                return f"the change of the contact at {brief(time, 's')}, where {longer.words(n)}, moves across this time"
        return f"a change of the contact appears or vanishes: number {n + 1}, at {brief(time, 's')}, {both}"

    def _is_near(self, time: float, first: int) -> bool:
        """Return True if a change of the contact comes so close to a time of the output that a small step moves it across."""
        output = self.output
        return isinstance(output, CurveAtTimes) and abs(time - float(output.times[first])) <= NEAR_TIME * output.last


def member_run(problem: Problem, lasts: float, rtol: float, most_events: int | None) -> Solution:
    """Return a run that depends smoothly on its numbers: without leaps over creep, and without lumping of events."""
    exactly: Any = {"creep_rtol": 0.0, "shortest_event": 0.0, "max_pieces": MAX_PIECES, "max_events": most_events}
    return uninterrupted(simulate(problem, lasts, rtol, **exactly))
