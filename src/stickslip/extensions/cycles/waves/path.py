"""Pseudo-arclength continuation of cycles of bodies with waves: the path of `cycles.path`, with a wave in the place of a start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.edges import GRAZING, LOSS_OF_STICK, NOT_FOUND, CycleEdge
from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.measures import measures_of
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.waves.krylov import solved
from stickslip.extensions.cycles.waves.of_driver import moving
from stickslip.extensions.cycles.waves.orbit import (
    LINEAR_SHARE,
    MOST_DIRECTIONS,
    SMALL_NUDGE,
    Image,
    WaveOrbit,
    checked,
    coordinates,
    difference,
    even_mesh,
    missed_share,
    with_sharp_kinks,
)
from stickslip.extensions.cycles.waves.section import WavePlace, WaveReturn, WaveSection
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath, Scenario

NEWTON_ROUNDS = 8
"""Largest number of Newton's iterations in a step (1)."""
CLOSED, STILL_CLOSED = 1e-8, 1e-6
"""A cycle of a branch closes to this share of its extent (1); where kinks forbid that, to the second."""
DIRECTION_SHARE = 1e-3
"""The direction of a branch is known to this share (1)."""

FIRST_SHORT, MOST_SHORT, SAME_MOTION = 1e-4, 16, 1e-2
"""First step towards an end (1), the number of steps, halved without a cycle, and by what share (1) a period may change there."""
SHORT_REST, TOUCHES = 1e-2, 1e-3
"""A rest that lasts a smaller share (1) of the period vanishes next to the end of a branch; slip rate and load touch rest and
strength where they come as near (1, of their extent) as the second."""


@dataclass(frozen=True)
class WavePath(Path):
    """Cycles of one scenario, cut at one kind of section, with one number of the problem as a parameter."""

    joins: ClassVar[bool] = False
    same_step: float = 1e-7
    """An edge within a step is found to this share of the step (1), which is what multipliers are known to."""
    level: float = 1.0
    """The slip rate on a section without rest, as a share of the pull rate (1)."""
    counts: tuple[int, int] = (0, 0)
    """How many states there are, and how many numbers the driver keeps (1)."""

    def section(self, value: float) -> Any:
        """Return the section of the problem with a value (SI) of the parameter.

        Raises InputError if the problem refuses it, or if the driver has other numbers of its own there.
        """
        problem = self.problem_at(value)
        if sum(moving(problem)) != self.counts[1]:
            at = f"{self.parameter.name} = {brief(value, self.parameter.unit)}"
            raise InputError(f"follow: a driver with {at} has a number of its own more or less: begin and end beside 0")
        return WaveSection(problem, self.at_onset, self.rtol, self.level)

    def at(self, target: Floats, way: Floats, guess: float, begin: WavePlace | None = None) -> PlaceOnBranch:
        """Return the cycle in the plane through `target` across `way`, and the direction of the branch. Raises NoCycleError.

        The search begins at a place, or at the target itself.
        """
        if begin is None:
            begin = self._spread(target, self.section(float(target[-1] * self.range)).problem.round_trip_time)
        value = float(target[-1] * self.range)
        try:
            now = self.section(value).returned(begin, guess)
            return self._newton(now, value, target, way)
        except InputError as error:
            raise NoCycleError(str(error)) from None

    def _spread(self, target: Floats, trip: float) -> WavePlace:
        """Return the place with the coordinates of a target, over a round trip that lasts so long (s)."""
        return WavePlace.of(even_mesh(trip), target[:-1] * self.scales[:-1], self.counts)

    def _newton(self, now: WaveReturn, value: float, target: Floats, way: Floats) -> PlaceOnBranch:
        """Return the cycle to which Newton's iteration leads from a return."""
        share, last, runs = np.inf, np.inf, 0
        for _ in range(NEWTON_ROUNDS):
            section = self.section(value)
            now = with_sharp_kinks(section, now, missed_share(now))
            off = self._off(coordinates(now.start), value, target, way)
            last, share, image = share, max(missed_share(now), abs(off)), Image(now.start, now.time)
            good = share <= CLOSED or (share <= STILL_CLOSED and share > 0.5 * last)
            along = self._derivative(image, value, way)
            if good:
                break
            missed = np.append(now.on(image.place.mesh).vector / image.scale - image.start, off)
            step, _, _ = solved(along, -missed, LINEAR_SHARE, MOST_DIRECTIONS)
            value += float(step[-1]) * self.range
            now, runs = image.of(image.start + step[:-1], self.section(value))[1], runs + 1
        if share > STILL_CLOSED:
            raise NoCycleError("follow: Newton's iteration finds no cycle here")
        orbit = checked(WaveOrbit(now, self.section(value), share, runs, 0.0))
        ahead = np.zeros(len(image.start) + 1)
        ahead[-1] = 1.0
        grown, _, _ = solved(along, ahead, DIRECTION_SHARE, MOST_DIRECTIONS)
        moved = image.place.moved_to(grown[:-1] * image.scale)
        new = np.append(coordinates(moved) / self.scales[:-1], grown[-1])
        return PlaceOnBranch(value, orbit, new / np.linalg.norm(new))

    def _off(self, place: Floats, value: float, target: Floats, way: Floats) -> float:
        """Return how far a start is from the plane through `target` across `way`."""
        return float((self.together(place, value) - target) @ way)

    def _derivative(self, image: Image, value: float, way: Floats) -> Callable[[Floats], Floats]:
        """Return the derivative of the miss of a return, and of the distance from the plane, by start and parameter."""
        section = self.section(value)
        missed = image.of(image.start, section)[0] - image.start
        ends = [image.of(image.start, self.section(value + sign * SMALL_NUDGE * self.range))[0] for sign in (1.0, -1.0)]
        by_value, grown = (ends[0] - ends[1]) / (2.0 * SMALL_NUDGE), difference(image, section, missed)

        def along(change: Floats) -> Floats:
            here = grown(change[:-1]) if change[:-1].any() else np.zeros(len(missed))
            moved = coordinates(image.place.moved_to(change[:-1] * image.scale)) / self.scales[:-1]
            return np.append(here + change[-1] * by_value, np.append(moved, change[-1]) @ way)

        return along

    def step(self, begin: PlaceOnBranch, length: float) -> PlaceOnBranch:
        """Return the cycle a step further along the branch. Raises NoCycleError."""
        orbit: Any = begin.orbit
        target = self.together(orbit.place, begin.value) + length * begin.way
        start: WavePlace = orbit.closed.start
        ahead = self._spread(length * begin.way, float(start.mesh.edges[-1]))
        moved = start.moved_to(start.vector + ahead.on(start.mesh).vector)
        try:
            trip = self.section(float(target[-1] * self.range)).problem.round_trip_time
        except InputError as error:
            raise NoCycleError(str(error)) from None
        return self.at(target, begin.way, orbit.period, moved.over(trip))

    def end_beyond(self, last: PlaceOnBranch) -> CycleEdge | None:
        """Return the edge where cycles with rest end, beyond the last place of a branch, by steps that become shorter."""
        if not self.at_onset:
            return None
        length = FIRST_SHORT
        for _ in range(MOST_SHORT):
            try:
                new = self.step(last, length)
                if abs(new.orbit.period - last.orbit.period) > SAME_MOTION * last.orbit.period:
                    raise NoCycleError("follow: this is another cycle")
                last = new if new.way @ last.way >= 0.0 else replace(new, way=-new.way)
            except NoCycleError:
                length *= 0.5
        return CycleEdge(_name_of_end(last.orbit), last.value, last.orbit)

    def longest_step(self, begin: PlaceOnBranch, share: float) -> float:
        """Return the longest step that moves the start by no more than a share (1) of the extent of the cycle."""
        moves = np.abs(begin.way[:-1]) * np.sqrt(len(begin.way) - 1.0)
        return float(np.min(share / np.maximum(moves, 1e-300), initial=np.inf))


def _name_of_end(orbit: FoundCycle) -> str:
    """Return what happens next to the end of a branch of cycles with rest."""
    if measures_of(orbit).stick_share < SHORT_REST:
        return LOSS_OF_STICK
    end = orbit.closed
    pieces = np.arange(end.first, end.piece)
    at = Positions.inside(np.repeat(pieces, 9), np.tile(np.linspace(0.0, 1.0, 9), len(pieces)))
    rests, rate, load = end.history.mode(at) == 0, end.history.rate(at), end.history.excess(at)
    inside = (rests[1:-1] == rests[:-2]) & (rests[1:-1] == rests[2:])
    low = ~rests[1:-1] & (rate[1:-1] <= rate[:-2]) & (rate[1:-1] <= rate[2:]) & (rate[1:-1] < TOUCHES * rate.max())
    high = rests[1:-1] & (load[1:-1] >= load[:-2]) & (load[1:-1] >= load[2:]) & (load[1:-1] > -TOUCHES * np.ptp(load))
    moves = (np.diff(load)[:-1] != 0.0) & (np.diff(load)[1:] != 0.0)  # two pieces share a place
    return GRAZING if np.any(inside & moves & (low | high)) else NOT_FOUND


def path_of(orbit: WaveOrbit, scenario: Scenario, parameter: ParameterPath, span: float) -> WavePath:
    """Return the path of a cycle, with its extent as the scale of its start: the root of the mean square is what counts."""
    scales: Any = np.append(orbit.extent * np.sqrt(len(orbit.place)), span)
    section, counts = orbit.section, orbit.closed.start.counts
    return WavePath(scenario, parameter, section.at_onset, section.rtol, scales, level=section.level, counts=counts)
