"""Pseudo-arclength continuation of cycles of bodies with waves: the path of `cycles.path`, with a wave in the place of a start."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from stickslip.extensions.cycles.edges import CycleEdge
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.waves.bordered import Bordered
from stickslip.extensions.cycles.waves.ends import EndOfPart, cut_anew, farther, with_rest
from stickslip.extensions.cycles.waves.image import SMALL_NUDGE, Image, difference, missed_share, slopes_at
from stickslip.extensions.cycles.waves.of_driver import moving
from stickslip.extensions.cycles.waves.orbit import LINEAR_SHARE, WaveOrbit, checked, coordinates, even_mesh, with_sharp_kinks
from stickslip.extensions.cycles.waves.section import WavePlace, WaveReturn, WaveSection
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath, Scenario

NEWTON_ROUNDS, MOST_NO_NEARER = 8, 1
"""Largest number of Newton's iterations in a step (1), and how often one may bring a return no nearer to its start."""
CLOSED, STILL_CLOSED = 1e-8, 1e-6
"""A cycle of a branch closes to this share of its extent (1); where kinks forbid that, to the second."""
MUCH_NEARER = 1e-2
"""A step of Newton's iteration brings a return much nearer if its miss is this share (1) of the miss before."""
MOST_SECTIONS = 8
"""Number of sections that a path remembers (1)."""
DIRECTION_SHARE = 1e-3
"""The direction of a branch is known to this share (1)."""


@dataclass(frozen=True)
class WavePath(Path):
    """Cycles of one scenario, cut at one kind of section, with one number of the problem as a parameter."""

    joins: ClassVar[bool] = False
    same_step: float = 1e-10
    """An edge within a step is found to this share of the step (1): cycles close to little less, and multipliers follow."""
    level: float = 1.0
    """The slip rate on a section without rest, as a share of the pull rate (1)."""
    counts: tuple[int, int] = (0, 0)
    """How many states there are, and how many numbers the driver keeps (1)."""

    def section(self, value: float) -> Any:
        """Return the section of the problem with a value (SI) of the parameter.

        Raises InputError if the problem refuses it, or if the driver has other numbers of its own there.
        """
        known = self._sections
        if value not in known:
            if len(known) >= MOST_SECTIONS:
                known.clear()
            problem = self.problem_at(value)
            if sum(moving(problem)) != self.counts[1]:
                at = f"{self.parameter.name} = {brief(value, self.parameter.unit)}"
                raise InputError(f"follow: a driver with {at} has a number of its own more or less: begin and end beside 0")
            known[value] = WaveSection(problem, self.at_onset, self.rtol, self.level)
        return known[value]

    @cached_property
    def _sections(self) -> dict[float, WaveSection]:
        """Sections by their values: a problem is made and prepared once."""
        return {}

    @cached_property
    def _corners(self) -> list[float]:
        """Values (SI) of the parameter where the branch has turned."""
        return []

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
        """Return the cycle to which Newton's iteration leads from a return.

        A derivative serves as long as steps with it bring the return much nearer to its start.
        """
        share, last, runs, is_new, no_nearer = np.inf, np.inf, 0, True, 0
        bordered: Bordered | None = None
        for _ in range(NEWTON_ROUNDS):
            section = self.section(value)
            now = with_sharp_kinks(section, now, missed_share(now))
            off = self._off(coordinates(now.start), value, target, way)
            last, share = share, max(missed_share(now), abs(off))
            if share <= CLOSED or (share <= STILL_CLOSED and share > 0.5 * last and is_new):
                break
            no_nearer += share > 0.5 * last
            if no_nearer > MOST_NO_NEARER:
                break
            is_new = bordered is None or share > MUCH_NEARER * last
            if bordered is None or is_new:
                bordered = self._bordered(now, value, way)
            place, change = bordered.step(now, off, LINEAR_SHARE)
            value += change * self.range
            section = self.section(value)
            now, runs = section.returned(place.over(section.problem.round_trip_time), now.time), runs + 1
        if share > STILL_CLOSED:
            raise NoCycleError("follow: Newton's iteration finds no cycle here")
        bordered = self._bordered(now, value, way, exactly=True)
        orbit = checked(WaveOrbit(now, section, share, runs, 0.0, bordered.slopes))
        moved, change = bordered.ahead(DIRECTION_SHARE)
        new = np.append(coordinates(moved) / self.scales[:-1], change)
        return PlaceOnBranch(value, orbit, new / np.linalg.norm(new))

    def _off(self, place: Floats, value: float, target: Floats, way: Floats) -> float:
        """Return how far a start is from the plane through `target` across `way`."""
        return float((self.together(place, value) - target) @ way)

    def _bordered(self, now: WaveReturn, value: float, way: Floats, *, exactly: bool = False) -> Bordered:
        """Return the derivative of the miss of a return, and of the distance from the plane, by start and parameter.

        That by the parameter is a difference of two runs if `exactly`, else of one from the return.
        """
        image, count = Image(now.start, now.time), sum(now.start.counts)
        here = now.landed.vector / image.scale
        up = image.of(image.start, self.section(value + SMALL_NUDGE * self.range))[0]
        low = image.of(image.start, self.section(value - SMALL_NUDGE * self.range))[0] if exactly else here
        by_value = (up - low) / (SMALL_NUDGE * (1.0 + exactly))
        mesh, weights = image.place.mesh, way[:-1] / self.scales[:-1]
        even = mesh.matrix_at(even_mesh(float(mesh.edges[-1])).phases)
        by_start = np.append(weights[:count], weights[count:].reshape(-1, len(even)) @ even)
        grown = difference(image, self.section(value), here - image.start)
        return Bordered(image, slopes_at(now), grown, by_value, np.append(by_start * image.scale, way[-1]))

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

    def end_beyond(self, last: PlaceOnBranch) -> EndOfPart | None:
        """Return the edge where cycles with rest end, beyond the last place of a branch, and where the branch goes on."""
        return farther(self, last, self._corners) if self.at_onset else cut_anew(self, last)

    def rest_begun(self, edge: CycleEdge) -> tuple[Path, PlaceOnBranch] | None:
        """Return where cycles with rest begin, at an edge where the slip rate touches 0."""
        return with_rest(self, edge)

    def longest_step(self, begin: PlaceOnBranch, share: float) -> float:
        """Return the longest step that moves the start by no more than a share (1) of the extent of the cycle."""
        moves = np.abs(begin.way[:-1]) * np.sqrt(len(begin.way) - 1.0)
        return float(np.min(share / np.maximum(moves, 1e-300), initial=np.inf))


def path_of(orbit: WaveOrbit, scenario: Scenario, parameter: ParameterPath, span: float) -> WavePath:
    """Return the path of a cycle, with its extent as the scale of its start: the root of the mean square is what counts."""
    scales: Any = np.append(orbit.extent * np.sqrt(len(orbit.place)), span)
    section, counts = orbit.section, orbit.closed.start.counts
    return WavePath(scenario, parameter, section.at_onset, section.rtol, scales, level=section.level, counts=counts)
