"""From a run of a body with waves to the cycle near its end: Newton's iteration on the wave of a round trip, by exact runs.

The derivative of a return is a matrix, from the linear equation of disturbances along the run (`disturbed`). Where that does not
hold, it is known by differences of runs: each says what it does to one disturbance; GMRES then solves Newton's equation, and
Arnoldi's iteration finds the leading multipliers.

Source: Knoll & Keyes 2004, J. Comput. Phys. 193, 357, for Newton's iteration without a matrix.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import Positions
from stickslip.extensions.cycles.orbit import is_steady_sliding
from stickslip.extensions.cycles.waves.image import Image, difference, grown, missed_share, slopes_at
from stickslip.extensions.cycles.waves.krylov import largest, leading, solved
from stickslip.extensions.cycles.waves.mesh import RESOLVED, WaveMesh, mesh_of
from stickslip.extensions.cycles.waves.section import WavePlace, WaveReturn, WaveSection
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.solution import Solution

EVEN_PIECES = 24
"""Number of pieces of the mesh on which waves of a branch are compared (1)."""
MOST_ITERATIONS, MOST_HALVINGS = 14, 5
"""Newton's iterations (1), and how often a step is shortened that leads away."""
CLOSED_SHARE, GOOD_ENOUGH = 1e-9, 1e-6
"""A cycle closes to this share (1) of its extent; where rounding or kinks forbid that, to the second."""
SAME_MESH = 1e-7
"""The mesh stays as it is where a return misses its start by no more than this share (1): kinks no longer move."""
RESOLVED_OF_MISS = 1e-2
"""The mesh resolves a wave to this share (1) of the miss of the return."""
MISSED_BETWEEN = 1e-7
"""Between the points of its mesh a wave misses its start by no more than this share (1) of its extent, in the mean."""
LINEAR_SHARE, MOST_DIRECTIONS = 1e-4, 60
"""Newton's equation is solved to this share (1), with no more disturbances than this."""
MANY_MULTIPLIERS, LEAST_LARGE = 6, 0.5
"""Most multipliers (1), and the size (1) below which all but the first are left out, or roughly known if by differences of runs."""


@dataclass(frozen=True)
class WaveOrbit:
    """A cycle of a body with waves: a run from a section that comes back to the wave with which it began."""

    closed: WaveReturn
    section: WaveSection
    share: float
    """By what share (1) of its extent it misses its start."""
    iterations: int
    """Number of runs of one period that have found it."""
    change: float
    """The last change of the period (s) in Newton's iteration."""
    known: Floats | None = None
    """The derivative of the return over the scales of its `Image`, if it has been worked out already."""

    @property
    def period(self) -> float:
        """The period (s)."""
        return self.closed.time

    @property
    def sticks(self) -> bool:
        """True if the contact rests once in a period."""
        return self.closed.sticks

    @property
    def grazes(self) -> bool:
        """False: a rest for an instant leaves waves that go on."""
        return False

    @property
    def forgets_all(self) -> bool:
        """False: waves outlast a rest."""
        return False

    @property
    def is_kept(self) -> bool:
        """False: a wave is too much for a table."""
        return False

    @property
    def is_of_half(self) -> bool:
        """False: cycles of twice the period are not followed."""
        return False

    def problem_on_it(self, problem: Problem) -> Problem:
        """Return the problem itself: no number of a problem says which wave it begins with."""
        return problem

    def run_of_it(self) -> Solution:
        """Return the run of one period behind the round trip that holds the wave."""
        run, code = self.section.run_from(self.closed.start, self.period)
        return run.solution(code)

    @property
    def certainty(self) -> str:
        """Say in one sentence what is known of the error of the period."""
        return (
            f"measured, not proven: after {self.iterations} runs of one period (rtol {self.section.rtol:g}) wave and contact miss"
            f" their start by {self.share:.1g} of the extent of the cycle, and the last step of Newton's iteration changed the"
            f" period by {brief(self.change, 's', 2)}"
        )

    @property
    def place(self) -> Floats:
        """Where the cycle meets the section: numbers, and the wave at points that are evenly spread over a round trip."""
        return coordinates(self.closed.start)

    @property
    def extent(self) -> Floats:
        """Sizes of the states, and how far the wave goes, for each of these."""
        return spread(self.closed.start).scale

    @cached_property
    def sharp_waves(self) -> float:
        """What a period multiplies the sharpest waves by (1): all that is not among the multipliers fades at least so fast."""
        return self.closed.source.sharp_factor(self.closed.begin)

    @property
    def slopes(self) -> Floats | None:
        """The derivative of the return over the scales of its `Image`; None where it is known by differences of runs only."""
        return slopes_at(self.closed) if self.known is None else self.known

    @cached_property
    def multipliers(self) -> NDArray[Any]:
        """The leading multipliers, the largest first.

        By differences of runs they are exact where they are large, else roughly the largest.
        """
        place = self.closed.start
        image = Image(place, self.period)
        slopes = self.slopes
        if slopes is not None:
            return largest(slopes, MANY_MULTIPLIERS, max(LEAST_LARGE, self.sharp_waves))
        phases = place.mesh.phases / self.closed.begin
        swing: Any = sum(np.cos(math.pi * n * phases + n) / (n + 1) for n in range(8))
        start = np.concatenate([np.ones(sum(place.counts)), np.resize(swing, len(place.wave))])
        large = max(LEAST_LARGE, math.sqrt(self.sharp_waves))
        return leading(grown(image, self.section), start, MANY_MULTIPLIERS, large, MOST_DIRECTIONS)


def fitted_mesh(met: WaveReturn, share: float) -> WaveMesh:
    """Return the mesh for the wave at a return that misses its start by a share (1): finer ones would resolve what is yet wrong."""
    return mesh_of(met.source, met.source.kinks(met.time), max(RESOLVED, RESOLVED_OF_MISS * share))


def with_sharp_kinks(section: WaveSection, now: WaveReturn, share: float) -> WaveReturn:
    """Return the return of a return that misses its start by a share (1), whose wave has its kinks where the mesh has edges.

    If it misses more it is not taken: the start is put on the new mesh. Where kinks no longer move and the mesh is fine, all stays
    as it is.
    """
    if share <= SAME_MESH and now.start.mesh.is_fine:
        return now
    mesh = fitted_mesh(now, share)
    try:
        again = section.returned(now.on(mesh), now.time)
        if missed_share(again) <= share:
            return again
    except InputError:
        pass
    return section.returned(now.start.on(mesh), now.time)


def even_mesh(trip: float) -> WaveMesh:
    """Return the mesh of a round trip (s) on which waves are compared, whatever their kinks."""
    return WaveMesh(np.linspace(0.0, trip, EVEN_PIECES + 1))


def spread(place: WavePlace) -> WavePlace:
    """Return a place with its wave at points that are evenly spread over a round trip."""
    return place.on(even_mesh(float(place.mesh.edges[-1])))


def coordinates(place: WavePlace) -> Floats:
    """Return the numbers of a place and its wave at points that are evenly spread over a round trip."""
    return spread(place).vector


def closed(section: WaveSection, place: WavePlace, guess: float) -> WaveOrbit:
    """Return the cycle near a place on a section, by Newton's iteration; `guess` is about its period (s).

    Raises InputError if the iteration finds none.
    """
    now, runs, change = section.returned(place, guess), 1, math.inf
    best: WaveOrbit | None = None
    for _ in range(MOST_ITERATIONS):
        now, runs = with_sharp_kinks(section, now, missed_share(now)), runs + 1
        share = missed_share(now)
        before, best = best, WaveOrbit(now, section, share, runs, change) if best is None or share < best.share else best
        if share <= CLOSED_SHARE or (before is not None and before.share <= GOOD_ENOUGH and share > 0.5 * before.share):
            return checked(best)
        image = Image(now.start, now.time)
        missed = now.landed.vector / image.scale - image.start
        step, directions = _newton_step(image, section, now, missed)
        period, now = now.time, _shortened(image, section, step, share)
        runs, change = runs + directions + 1, abs(now.time - period)
    if best is not None and best.share <= GOOD_ENOUGH:
        return checked(best)
    raise InputError("cycle: Newton's iteration finds no cycle near this run: give another start, or a longer run (near)")


def _newton_step(image: Image, section: WaveSection, now: WaveReturn, missed: Floats) -> tuple[Floats, int]:
    """Return the step of Newton's iteration from a return, and the number of runs that it took."""
    slopes = slopes_at(now)
    if slopes is None:
        step, _, directions = solved(difference(image, section, missed), -missed, LINEAR_SHARE, MOST_DIRECTIONS)
        return step, directions
    try:
        return np.asarray(np.linalg.solve(slopes - np.eye(len(slopes)), -missed)), 0
    except np.linalg.LinAlgError:
        raise InputError("cycle: every motion near this run repeats itself: nothing brings it to one of them") from None


def _shortened(image: Image, section: WaveSection, step: Floats, share: float) -> WaveReturn:
    """Return the return after a step of Newton's, shortened where it leads away. Raises InputError where it still does."""
    for _ in range(MOST_HALVINGS):
        try:
            there, met = image.of(image.start + step, section)
        except InputError:
            step = 0.25 * step
            continue
        if float(np.abs(there - image.start - step).max()) < 2.0 * share or share <= GOOD_ENOUGH:
            return met
        step = 0.5 * step
    raise InputError("cycle: Newton's iteration leads away from this run: no cycle is near; give another start, or a longer run")


def checked(orbit: WaveOrbit) -> WaveOrbit:
    """Refuse steady sliding, and waves that their mesh does not resolve. Raises InputError."""
    now, problem = orbit.closed, orbit.section.problem
    piece = np.repeat(np.arange(now.first, now.piece + 1), 3)
    at = Positions.inside(piece, np.resize([0.0, 0.5, 1.0], len(piece)))
    rates = now.history.rate(at)

    def step() -> float:
        image = Image(now.start, now.time)
        found, _ = _newton_step(image, orbit.section, now, now.landed.vector / image.scale - image.start)
        wave = np.abs(found * image.scale)[-len(now.start.wave) :]
        return float(wave.max() / np.ptp(2.0 * problem.body.echo_impedance * rates - now.history.excess(at)))

    if is_steady_sliding(float(np.ptp(rates)), problem.first_pull_rate, step):
        raise InputError("cycle: Newton's iteration leads to steady sliding: no other cycle is near this run")
    if now.between > MISSED_BETWEEN:
        raise InputError(
            "cycle: the wave has a front too narrow for its mesh, and misses its start between the points: no cycle is found"
        )
    return orbit
