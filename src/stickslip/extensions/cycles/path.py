"""Steps along a branch of cycles, by pseudo-arclength: Newton's iteration on the start and on one number of the problem together.

Source: Keller 1977, in Applications of Bifurcation Theory (ed. Rabinowitz), 359.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.orbit import Orbit, extent_of
from stickslip.extensions.cycles.section import Return, Section
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import ParameterPath, Scenario

NEWTON_ROUNDS = 12
"""Largest number of Newton's iterations in a step (1)."""
CLOSED, STILL_CLOSED = 1e-11, 1e-8
"""A cycle closes to this share of its extent (1); where rounding forbids that, to the second."""
NUDGE = 1e-6
"""The parameter is moved by this share (1) of its range to see how the return changes."""
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
    joins: ClassVar[bool] = True
    """True: cycles with and without rest that meet are parts of one branch."""
    same_step: float = 1e-13
    """An edge within a step is found to this share of the step (1)."""

    def section(self, value: float) -> Section:
        """Return the section of the problem with a value (SI) of the parameter. Raises InputError if the problem refuses it."""
        problem = self.scenario.problem.parameters[self.parameter.name].put(value)
        return Section(problem, self.at_onset, self.rtol)

    @property
    def range(self) -> float:
        """The range of the parameter, SI."""
        return float(self.scales[-1])

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
                now = self.section(value).returned(place, guess, TRIES)
        except InputError as error:
            raise NoCycleError(str(error)) from None
        if not len(place):
            return now, np.zeros((0, 1))
        if known.size and not renew:
            return now, known
        by_place = (now.slopes(exactly=False) - np.eye(len(place))) * self.scales[:-1] / self.scales[:-1, None]
        if known.size:
            return now, np.column_stack([by_place, known[:, -1]])
        return now, np.column_stack([by_place, self._by_value(place, value, now.time)])

    def _by_value(self, place: Floats, value: float, guess: float) -> Floats:
        """Return how what a return misses changes with the parameter, over the scales, by a central difference."""
        step = NUDGE * self.range
        try:
            ends = [self.section(value + sign * step).returned(place, guess, TRIES).end for sign in (1.0, -1.0)]
        except InputError as error:
            raise NoCycleError(str(error)) from None
        return np.asarray((ends[0] - ends[1]) / (2.0 * NUDGE) / self.scales[:-1])

    def at(self, target: Floats, way: Floats, guess: float) -> PlaceOnBranch:
        """Return the cycle in the plane through `target` across `way`, and the direction of the branch. Raises NoCycleError."""
        value, orbit, slopes = self.solved(target, way, guess)
        new = np.linalg.solve(np.vstack([slopes, way]), np.append(np.zeros(len(slopes)), 1.0))
        return PlaceOnBranch(value, orbit, new / np.linalg.norm(new))

    def at_value(self, value: float, place: Floats, guess: float, way: Floats | None = None) -> PlaceOnBranch:
        """Return the cycle near a start at a value (SI) of the parameter. Raises NoCycleError."""
        along = np.zeros(len(self.scales))
        along[-1] = 1.0
        found = self.at(self.together(place, value), along, guess)
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


def path_of(orbit: Orbit, scenario: Scenario, parameter: ParameterPath, span: float) -> Path:
    """Return the path of a cycle, with its extent as the scale of its start."""
    scales: Any = np.append(orbit.extent, span)
    return Path(scenario, parameter, orbit.section.at_onset, orbit.section.rtol, scales)
