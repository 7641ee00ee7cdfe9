"""Where a cycle of a body with waves is cut, and exact runs that begin there with a wave and return."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.section import Crossings, onsets, passages
from stickslip.extensions.cycles.short_runs import PASSES_AT_ONCE, advanced
from stickslip.extensions.cycles.waves.begin import begin_with
from stickslip.extensions.cycles.waves.mesh import WaveMesh, WaveSource
from stickslip.extensions.cycles.waves.of_driver import kept_by_driver, rate_and_push
from stickslip.extensions.cycles.waves.sources import source_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, Stop, driver_of
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, ExactRun
from stickslip.solution import Solution

LONGER_THAN_GUESS = 1.25
"""A run to a return lasts longer than the guessed period by this factor (1)."""
NO_STATE = 1e-15
"""A state that is no larger than this, in its unit, is 0, as a rest makes some, and has no size."""


@dataclass(frozen=True)
class WavePlace:
    """A place on a section: the states of the law, what the driver keeps, and the wave at the points of a mesh."""

    mesh: WaveMesh
    states: Floats
    kept: Floats
    """Stresses (Pa) that a driver with a motion of its own keeps, half a round trip before (`waves.of_driver`); none of others."""
    wave: Floats

    @property
    def vector(self) -> Floats:
        """States, what the driver keeps, and wave together."""
        return np.concatenate([self.states, self.kept, self.wave])

    @property
    def scale(self) -> Floats:
        """Their extents: sizes of the states, how far the wave goes, and both together for what the driver keeps."""
        sizes, reach = np.abs(self.states), float(np.ptp(self.wave)) + 1e-300
        states = np.where(sizes > NO_STATE, sizes, 1.0)
        return np.concatenate([states, np.abs(self.kept) + reach, np.full(len(self.wave), reach)])

    @property
    def counts(self) -> tuple[int, int]:
        """How many states there are, and how many numbers the driver keeps (1)."""
        return len(self.states), len(self.kept)

    @classmethod
    def of(cls, mesh: WaveMesh, vector: Floats, counts: tuple[int, int]) -> WavePlace:
        """Return the place with these numbers and this wave, all in one."""
        states, kept, wave = np.split(vector, np.cumsum(counts))
        return cls(mesh, states, kept, wave)

    def moved_to(self, vector: Floats) -> WavePlace:
        """Return the place with other numbers and another wave on the same mesh."""
        return WavePlace.of(self.mesh, vector, self.counts)

    def over(self, trip: float) -> WavePlace:
        """Return the same wave over a round trip that lasts so long (s)."""
        edges = self.mesh.edges
        return self if edges[-1] == trip else replace(self, mesh=replace(self.mesh, edges=edges * (trip / edges[-1])))

    def on(self, mesh: WaveMesh) -> WavePlace:
        """Return the same place on another mesh."""
        return replace(self, mesh=mesh, wave=self.mesh.at(self.wave, mesh.phases))


@dataclass(frozen=True)
class WaveReturn:
    """A run from a place on a section to its return there; the first round trip of its history is the wave at the start."""

    start: WavePlace
    solution: Solution
    piece: int
    place: float
    end: float
    """The time (s) of the return in the history."""
    first: int
    """The first piece of the history behind the wave."""
    at_onset: bool
    """True if it begins and ends at an onset of slip after a rest."""

    @property
    def history(self) -> History:
        """The history."""
        return self.solution.history

    @property
    def begin(self) -> float:
        """The time (s) in the history when the section is left."""
        return self.history.round_trip_time

    @property
    def time(self) -> float:
        """How long (s) the return takes."""
        return self.end - self.begin

    @property
    def source(self) -> WaveSource:
        """The wave of the last round trip before the return."""
        return source_of(self.history, self.end)

    @cached_property
    def states(self) -> Floats:
        """The states of the law at the return."""
        return states_at(self.history, self.piece, self.place)

    @cached_property
    def kept(self) -> Floats:
        """What the driver keeps at the return (Pa)."""
        return kept_by_driver(self.history, self.end, rate_and_push(self.history.problem, self.start.kept))

    def on(self, mesh: WaveMesh) -> WavePlace:
        """Return the place of the return, on a mesh."""
        return WavePlace(mesh, self.states, self.kept, self.source.at(mesh.phases))

    @cached_property
    def landed(self) -> WavePlace:
        """The place of the return on the mesh of the start."""
        return self.on(self.start.mesh)

    @cached_property
    def between(self) -> float:
        """By what share (1) of its extent the wave misses its start in the mean of the round trip, where the mesh has no points."""
        edges = self.start.mesh.edges
        phases = self.start.mesh.beside
        off = np.abs(self.source.at(phases) - self.start.mesh.at(self.start.wave, phases)).reshape(-1, len(phases))
        means = np.sum(0.5 * (off[:, 1:] + off[:, :-1]) * np.diff(phases), axis=1) / edges[-1]
        return float(means.max() / self.start.scale[-1])

    @cached_property
    def sticks(self) -> bool:
        """True if the contact rests on the way."""
        here = slice(self.first, self.piece + 1)
        return bool((self.history.store.mode[here] == 0).any() or self.history.rests[self.first : self.piece].any())


@lru_cache(maxsize=8)
def _options(problem: Problem, duration: float, rtol: float) -> CallOptions:
    """Return the options of runs of one duration (s)."""
    return CallOptions.of(Scenario(problem, duration), duration=duration, rtol=rtol, creep_rtol=0.0).check("cycle", problem)


@dataclass(frozen=True)
class WaveSection:
    """A section of the motion of a body with waves, and the returns to it."""

    problem: Problem
    at_onset: bool
    """True at an onset of forward slip after a rest; False where the slip rate passes a share of the pull rate upwards."""
    rtol: float = 1e-12
    level: float = 1.0
    """That share (1)."""

    @property
    def rate(self) -> float:
        """The slip rate (m/s) on the section."""
        return 0.0 if self.at_onset else self.level * self.problem.first_pull_rate

    def run_from(self, place: WavePlace, lasts: float) -> tuple[ExactRun, int]:
        """Return the run from a place that lasts so long (s), and the code of its end."""
        run = ExactRun.begin(self.problem, _options(self.problem, self.problem.round_trip_time + lasts, self.rtol))
        beside = np.concatenate([place.states, rate_and_push(self.problem, place.kept)])
        begin_with(run, place.mesh.edges, place.mesh.series(place.wave), self.rate, beside)
        while (code := advanced(run, PASSES_AT_ONCE)) is None:
            pass
        return run, code

    def returned(self, place: WavePlace, guess: float, *, longer: float = LONGER_THAN_GUESS) -> WaveReturn:
        """Return the run from a place to its return next to a `guess` of the time (s) that it takes.

        Raises InputError if the run meets no return within `longer` (1) times the guess.
        """
        run, code = self.run_from(place, longer * guess)
        if code not in (Stop.FINISHED, Stop.LOCKED):
            raise InputError(f"cycle: a run of one period did not reach its end: {run.solution(code).status}")
        solution = run.solution(code)
        trip, met = self.problem.round_trip_time, self.met(solution.history)
        if not len(met.time) or np.abs(met.time - trip - guess).min() > (longer - 1.0) * guess:  # what is beyond the run is farther
            what = "begins to slip after a rest" if self.at_onset else "passes its mean slip rate"
            raise InputError(f"cycle: the contact no longer {what} within {longer * guess:.4g} s: there is no cycle near")
        nearest = int(np.abs(met.time - trip - guess).argmin())
        piece, xi, time = int(met.piece[nearest]), float(met.place[nearest]), float(met.time[nearest])
        return WaveReturn(place, solution, piece, xi, time, len(place.mesh.edges) - 1, self.at_onset)

    def met(self, history: History) -> Crossings:
        """Return where a run that begins with a wave meets the section, not counting its start."""
        met = onsets(history) if self.at_onset else passages(history, self.rate)
        later = met.time > (1.0 + 1e-6) * self.problem.round_trip_time
        return Crossings(met.piece[later], met.place[later], met.time[later])

    def with_problem(self, problem: Problem) -> WaveSection:
        """Return the same section of another problem."""
        return replace(self, problem=problem)


def states_at(history: History, piece: int, place: float) -> Floats:
    """Return the states of the law at a place (1) in a piece of a history."""
    return np.array([one[0] for one in history.states(Positions.inside(piece, place))])


def place_in(history: History, met: Crossings, n: int, mesh: WaveMesh) -> WavePlace:
    """Return the place where a run that begins as its problem says meets a section for the n-th time."""
    time, problem = float(met.time[n]), history.problem
    kept = kept_by_driver(history, time, np.array(driver_of(problem).at_first(problem)))
    states = states_at(history, int(met.piece[n]), float(met.place[n]))
    return WavePlace(mesh, states, kept, source_of(history, time).at(mesh.phases))
