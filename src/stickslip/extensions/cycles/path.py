"""Steps along a branch of cycles, by pseudo-arclength: Newton's iteration on the start and on one number of the problem together.

Source: Keller 1977, in Applications of Bifurcation Theory (ed. Rabinowitz), 359.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from stickslip.extensions.cycles.find_cycle import check_can_be_followed, time_of_cycle
from stickslip.extensions.cycles.found import FoundCycle, kind_of
from stickslip.extensions.cycles.orbit import Orbit, extent_of
from stickslip.extensions.cycles.section import Return, Section
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.scenarios import ParameterPath, Scenario

NEWTON_ROUNDS = 12
"""Largest number of Newton's iterations in a step (1)."""
CLOSED, STILL_CLOSED = 1e-11, 1e-8
"""A cycle closes to this share of its extent (1); where rounding forbids that, to the second."""
NUDGE = 1e-6
"""The parameter is moved by this share (1) of its range to see how the return changes."""
NUDGES, NUDGE_SHORTER = 3, 0.05
"""How often it is moved less if the runs on both sides are of another kind, each time by this factor (1)."""
TRIES = 2
"""How often a run to a return may be doubled (1)."""


class NoCycleError(InputError):
    """No cycle has been found here."""


@dataclass(frozen=True)
class PlaceOnBranch:
    """A cycle on a branch: the value (SI) of the parameter, the cycle, and the direction of the branch."""

    value: float
    orbit: FoundCycle
    way: Floats
    """Unit vector along the branch: coordinates of the start over `Path.scales`, and the parameter over the range, at the end."""


@dataclass(frozen=True)
class Path:
    """Cycles of one scenario, cut at one kind of section, with one number of the problem as a parameter."""

    scenario: Scenario
    parameter: ParameterPath
    at_onset: bool
    rtol: float
    scales: Floats
    """Sizes of the coordinates of the start; the last is the range of the parameter."""
    sizes: tuple[Floats, ...] = ()
    """Sizes of the start, from the extent of the first cycle: where it is not at an onset, and where it is."""
    joins: ClassVar[bool] = True
    """True: cycles with and without rest that meet are parts of one branch."""
    same_step: float = 1e-13
    """An edge within a step is found to this share of the step (1)."""

    def problem_at(self, value: float) -> Problem:
        """Return the problem with a value (SI) of the parameter. Raises InputError if there are no cycles of it."""
        problem = self.scenario.problem.parameters[self.parameter.name].put(value)
        check_can_be_followed(problem, "follow")
        return problem

    def section(self, value: float) -> Section:
        """Return the section of the problem with a value (SI) of the parameter. Raises InputError if the problem refuses it."""
        return Section(self.problem_at(value), self.at_onset, self.rtol)

    @property
    def range(self) -> float:
        """The range of the parameter, SI."""
        return float(self.scales[-1])

    def cut(self, *, at_onset: bool) -> Path:
        """Return the path of cycles that are cut at an onset, or that are not."""
        if at_onset == self.at_onset:
            return self
        return replace(self, at_onset=at_onset, scales=np.append(self.sizes[at_onset], self.range))

    def orbit_at(self, value: float, start: Floats, period: float) -> Orbit:
        """Return the cycle with a start that is known to rounding, by one run. Raises InputError if it does not come back."""
        now = self.section(value).returned(start, period)
        return Orbit(now, extent_of(now.history, self.at_onset, now.piece), 1, 0.0)

    def together(self, place: Floats, value: float) -> Floats:
        """Return start and parameter over their scales."""
        return np.append(place, value) / self.scales

    def solved(self, target: Floats, way: Floats, guess: float) -> tuple[float, Orbit, Floats]:
        """Return the value and the cycle in the plane through `target` across `way`, and the derivative of the miss of a return.

        Raises NoCycleError.
        """
        at, slopes = target.copy(), np.zeros((0, 0))
        best: tuple[float, float, Return, Floats] | None = None
        for n in range(NEWTON_ROUNDS):
            now, slopes = self._returned(at, guess, slopes, renew=n < 3)
            guess = now.time
            extent = extent_of(now.history, self.at_onset, now.piece)
            share = float(np.max(np.abs(now.missed) / extent, initial=0.0))
            if best is not None and share >= 0.5 * best[0] and best[0] <= STILL_CLOSED:
                break
            if best is None or share < best[0]:
                best = share, float(at[-1] * self.range), now, extent
            if share <= CLOSED:
                break
            matrix = np.vstack([slopes, way])
            missed = np.append(now.missed / self.scales[:-1], (at - target) @ way)
            try:
                at = at - np.linalg.solve(matrix, missed)
            except np.linalg.LinAlgError:
                raise NoCycleError("follow: the cycles near here cannot be told apart") from None
        assert best is not None
        if best[0] > STILL_CLOSED:
            raise NoCycleError("follow: Newton's iteration finds no cycle here")
        return best[1], Orbit(best[2], best[3], NEWTON_ROUNDS, 0.0), slopes

    def _returned(self, at: Floats, guess: float, known: Floats, *, renew: bool) -> tuple[Return, Floats]:
        """Return the run from a start, and the derivative of its miss by start and parameter, over their scales."""
        value, place = float(at[-1] * self.range), at[:-1] * self.scales[:-1]
        try:
            with np.errstate(over="ignore"):  # far from a cycle a state may overflow, which the problem refuses
                section = self.section(value)
                # The first return to an onset is the period, however much longer than that of the cycle before.
                lasts = max(guess, time_of_cycle(section.problem)) if not len(place) else guess
                now = section.returned(place, lasts, TRIES)
        except InputError as error:
            raise NoCycleError(str(error)) from None
        if not len(place):
            return now, np.zeros((0, 1))
        if known.size and not renew:
            return now, known
        by_place = (now.slopes(exactly=False) - np.eye(len(place))) * self.scales[:-1] / self.scales[:-1, None]
        if known.size:
            return now, np.column_stack([by_place, known[:, -1]])
        return now, np.column_stack([by_place, self._by_value(now, place, value)])

    def _by_value(self, now: Return, place: Floats, value: float) -> Floats:
        """Return how what a return misses changes with the parameter, over the scales, by a difference of runs of one kind.

        Next to where stick is lost the run on one side rests, and beyond the end of a range the problem refuses its value: the
        difference is then one of the other side alone. Raises NoCycleError if there is none.
        """
        nudge = NUDGE
        for _ in range(NUDGES):
            ends = [self._nudged(now, place, value + sign * nudge * self.range) for sign in (1.0, -1.0)]
            after, before = (now.end if one is None else one for one in ends)
            if any(one is not None for one in ends):
                width = nudge * sum(one is not None for one in ends)
                return np.asarray((after - before) / width / self.scales[:-1])
            nudge *= NUDGE_SHORTER
        raise NoCycleError("follow: no run beside this one is of its kind")

    def _nudged(self, now: Return, place: Floats, value: float) -> Floats | None:
        """Return the end of a run at a value next to another; None if it does not return, or is of another kind."""
        try:
            found = self.section(value).returned(place, now.time, TRIES)
        except InputError:
            return None
        return found.end if kind_of(found) == kind_of(now) else None

    def at(self, target: Floats, way: Floats, guess: float) -> PlaceOnBranch:
        """Return the cycle in the plane through `target` across `way`, and the direction of the branch. Raises NoCycleError."""
        value, orbit, slopes = self.solved(target, way, guess)
        new = np.linalg.solve(np.vstack([slopes, way]), np.append(np.zeros(len(slopes)), 1.0))
        return PlaceOnBranch(value, orbit, new / np.linalg.norm(new))

    def at_value(self, value: float, place: Floats, guess: float, way: Floats | None = None) -> PlaceOnBranch:
        """Return the cycle near a start at a value (SI) of the parameter. Raises NoCycleError."""
        along = np.zeros(len(self.scales))
        along[-1] = 1.0
        found = replace(self.at(self.together(place, value), along, guess), value=value)  # to the last digit
        return found if way is None or found.way @ way >= 0.0 else replace(found, way=-found.way)

    def step(self, begin: PlaceOnBranch, length: float) -> PlaceOnBranch:
        """Return the cycle a step further along the branch. Raises NoCycleError."""
        target = self.together(begin.orbit.place, begin.value) + length * begin.way
        return self.at(target, begin.way, begin.orbit.period)

    def longest_step(self, begin: PlaceOnBranch, share: float) -> float:
        """Return the longest step that moves the start by no more than a share (1) of the extent of the cycle."""
        moves = np.abs(begin.way[:-1]) * self.scales[:-1]
        return float(np.min(share * begin.orbit.extent / np.maximum(moves, 1e-300), initial=np.inf))

    def end_beyond(self, last: PlaceOnBranch) -> Any:
        """Return None: where cycles with rest end is found by bisection (`edges.loss_of_stick`)."""
        return None

    def rest_begun(self, edge: Any) -> Any:
        """Return None: where cycles with rest begin is found by `meeting.with_rest`."""
        return None


def path_of(orbit: Orbit, scenario: Scenario, parameter: ParameterPath, span: float) -> Path:
    """Return the path of a cycle, with its extent as the scale of its start."""
    closed = orbit.closed
    scales: Any = np.append(orbit.extent, span)
    sizes = tuple(extent_of(closed.history, at_onset=one, last=closed.piece) for one in (False, True))
    return Path(scenario, parameter, orbit.section.at_onset, orbit.section.rtol, scales, sizes)
