"""Where a cycle is cut: an onset of slip, or a passage of the slip rate through the pull rate upwards, and the returns to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.compiled.places import MOST_IN_PIECE, find_passages
from stickslip.extensions.cycles.lag import at_lag, impacts_of, is_wound, section_rate
from stickslip.extensions.cycles.short_runs import short_run
from stickslip.extensions.cycles.tangent import FIRST_STATE_ROW, LOAD_ROW, RATE_ROW, Tangent, pace_at, values_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import one_argument
from stickslip.problem import INITIAL_STATES, Problem
from stickslip.problem.bodies import as_on_spring

SPARE_TIME, MOST_TRIES = 1.1, 6
"""A run to a return lasts longer than the guessed period by this factor (1), and is doubled so often if it has no return."""
AT_START = 1e-9
"""A passage before this share (1) of the run is that of the start."""


class Crossings(NamedTuple):
    """Moments when a run crosses a section: pieces, places (1) in them, and times (s)."""

    piece: Any
    place: Floats
    time: Floats


class SlipsAndRests(NamedTuple):
    """How often slip forwards, slip backwards and rest begin (1)."""

    forwards: int
    backwards: int
    rests: int


@dataclass(frozen=True)
class Return:
    """A run from a section to its return there."""

    start: Floats
    """Load, states and lag where it starts; at an onset the lag, if a loop integrates it: a law without states fixes all else."""
    end: Floats
    """The same at the return."""
    time: float
    """The time (s) of the return."""
    history: History
    piece: int
    place: float
    section: Section
    first: int = 0
    """The first piece of the history that belongs to it."""
    begin: float = 0.0
    """When it starts in its history (s)."""
    passed: int = 1
    """How often the section is crossed on the way, the end among them."""

    @property
    def missed(self) -> Floats:
        """How far the return is from the start."""
        return np.asarray(self.end - self.start)

    def slopes(self, *, exactly: bool = True) -> Floats:
        """Return the derivative of the return by the start; there is none at an onset where all is fixed."""
        if not len(self.start):
            return np.zeros((0, 0))
        grown = Tangent(self.history, self.piece, self.place).grown(exactly=exactly)
        pace, cut = pace_at(self.history, self.piece, self.place), LOAD_ROW if self.section.at_onset else RATE_ROW
        onto = grown - np.outer(pace, grown[cut]) / pace[cut]
        problem = self.section.problem
        if problem.body.has_play:  # the load says how far behind the end of the spring it is
            onto[:, LOAD_ROW] += onto[:, -1] / problem.body.stiffness
        kept = coordinates(np.arange(len(pace) - problem.body.has_play), self.section.at_onset)
        return np.asarray(onto[np.ix_(kept, kept)])

    @cached_property
    def about(self) -> Floats:
        """The derivative of the return as Newton's iteration needs it."""
        return self.slopes(exactly=False)

    @cached_property
    def sticks(self) -> bool:
        """True if the contact rests on the way."""
        history = self.history
        return bool((history.store.mode[: self.piece + 1] == 0).any() or history.rests[: self.piece].any())

    @cached_property
    def impacts(self) -> int:
        """How often the body meets a hard stop on the way."""
        return impacts_of(self.history, self.piece)

    @cached_property
    def slips(self) -> SlipsAndRests:
        """How often the contact begins to slip forwards and backwards, and comes to rest, on a way that closes."""
        mode, unrecorded = self.history.store.mode[: self.piece + 1], self.history.rests[: self.piece]
        seen = np.insert(mode, 1 + np.flatnonzero(unrecorded), 0)
        begins = seen[seen != np.roll(seen, 1)]
        return SlipsAndRests(*(int((begins == one).sum()) for one in (1, -1, 0)))


@dataclass(frozen=True)
class Section:
    """A section of the motion of a problem, and the returns to it."""

    problem: Problem
    at_onset: bool
    """True at the onset of forward slip, under a law without states; False where the slip rate passes the pull rate upwards."""
    rtol: float = 1e-12

    def start_at(self, place: Floats) -> Problem:
        """Return the problem that starts at a place on the section."""
        states: dict[str, Any] = dict.fromkeys(INITIAL_STATES)
        loads: dict[str, Any] = {
            "initial_load": None if self.at_onset else float(place[0]),
            "initial_excess": 0.0 if self.at_onset else None,
        }
        if is_wound(self.problem) or as_on_spring(self.problem.body).reference_step != 0.0:  # the step is behind it
            lag = float(place[-1]) if is_wound(self.problem) else 0.0
            loads = at_lag(self.problem, lag, loads["initial_load"])
        if self.at_onset:
            return replace(self.problem, initial_rate=None, **loads, **states)
        law = self.problem.friction
        if law.states:
            seen = np.ravel(law.outer_state(np.array(one_argument(tuple(place[1 : 1 + len(law.states)].tolist())))))
            states |= dict(zip(INITIAL_STATES, seen.tolist(), strict=False))
        return replace(self.problem, initial_rate=section_rate(self.problem), **loads, **states)

    def returned(self, place: Floats, guess: float, tries: int = MOST_TRIES) -> Return:
        """Return the run from a place on the section to its return next to a `guess` of the time (s) that it takes.

        A stiff contact may pass the pull rate again at once, where it starts a little off its slow motion.

        The run is made twice as long up to `tries` times. Raises InputError if there is no return then.
        """
        problem, lasts = self.start_at(place), SPARE_TIME * guess
        for _ in range(tries):
            run = short_run(problem, lasts, self.rtol)
            met = crossings(run.history, self.at_onset)
            # Where nothing is open all is as at the start, so that the first return is the period. Elsewhere it is the one next to
            # the guess, if none beyond the run may be nearer.
            nearest = int(np.abs(met.time - guess).argmin()) if len(met.time) and len(place) else 0
            if len(met.time) and (not len(place) or abs(met.time[nearest] - guess) <= lasts - guess):
                piece, xi, time = int(met.piece[nearest]), float(met.place[nearest]), float(met.time[nearest])
                end = coordinates(values_at(run.history, Positions.inside(piece, xi)), self.at_onset)[:, 0]
                return Return(place, end, time, run.history, piece, xi, self, passed=nearest + 1)
            if not run.status.ok:
                raise InputError(f"cycle: a run of one period did not reach its end: {run.status}")
            lasts *= 2.0
        what = "begins to slip after a rest" if self.at_onset else "passes the pull rate"
        raise InputError(f"cycle: the contact no longer {what} within {lasts / 2.0:.4g} s: there is no cycle near")


def coordinates(values: Any, at_onset: bool) -> Any:
    """Return what may vary on a section, of load, slip rate, states and lag: at an onset only the lag."""
    return np.asarray(values[FIRST_STATE_ROW:] if at_onset else np.delete(values, RATE_ROW, axis=0))


def places_of(history: History, met: Crossings, at_onset: bool = False) -> Floats:
    """Return what may vary on a section where a run crosses it, each in a row."""
    return np.asarray(coordinates(values_at(history, Positions.inside(met.piece, met.place)), at_onset))


def crossings(history: History, at_onset: bool) -> Crossings:
    """Return where a run crosses a section, without its start."""
    return onsets(history) if at_onset else passages(history)


def onsets(history: History) -> Crossings:
    """Return the moments when forward slip begins after a rest, at the ends of the rests."""
    mode = history.store.mode
    rested = (mode[:-1] == 0) | history.rests[:-1]
    found = 1 + np.flatnonzero((mode[1:] == 1) & rested)
    return Crossings(found - 1, np.ones(len(found)), history.start[found])


def passages(history: History, rate: float | None = None) -> Crossings:
    """Return the moments when the slip rate passes a rate (m/s), by default that of the section, upwards, to rounding."""
    store, most = history.store, MOST_IN_PIECE * len(history)
    pieces, places = np.empty(most, np.int64), np.empty(most)
    count = find_passages(store.pieces, section_rate(history.problem) if rate is None else rate, pieces, places)
    pieces, places = pieces[:count], places[:count]
    times = history.start[pieces] + places * (store.speed[pieces] + places * store.bend[pieces])
    later = times > AT_START * history.duration
    return Crossings(pieces[later], places[later], times[later])
