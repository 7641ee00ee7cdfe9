"""Newton's iteration on the return to a section: from a run to the cycle near it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.section import Crossings, Return, Section, coordinates, crossings, onsets
from stickslip.extensions.cycles.tangent import values_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution import Solution

MOST_ITERATIONS, MOST_HALVINGS = 20, 6
"""Newton's iterations (1), and how often a step is halved that leads away."""
CLOSED_SHARE = 1e-11
"""Newton's iteration ends where the return misses the start by less than this share (1) of the cycle's extent."""
GOOD_ENOUGH = 1e-7
"""A cycle is found if at last it misses by no more than this share (1)."""
MOST_MEETINGS = 16
"""Largest number of meetings with the section in one period (1) that is looked for."""
CLOSES = 1e-2
"""A run that comes back this close (1, share of its extent) is taken to close there."""
SAME_PLACE = 1e-6
"""A cycle is back where it began if it misses that by no more than this share (1) of its extent."""
INSTANT = 1e-6
"""A rest shorter than this share (1) of the period is an instant."""
STEADY_SHARE = 1e-9
"""A slip rate that varies by less than this share (1) of the pull rate is steady sliding."""


@dataclass(frozen=True)
class Orbit:
    """A cycle: a run from a section that comes back to where it started."""

    closed: Return
    extent: Floats
    """How far load and states go in a period."""
    iterations: int
    change: float
    """The last change of the period (s) in Newton's iteration."""

    @property
    def section(self) -> Section:
        """The section."""
        return self.closed.section

    @property
    def place(self) -> Floats:
        """Where the cycle meets the section: load and states, or nothing at an onset."""
        return self.closed.start

    @property
    def period(self) -> float:
        """The period (s)."""
        return self.closed.time

    @property
    def sticks(self) -> bool:
        """True if the contact rests once in a period."""
        return self.closed.sticks

    @property
    def impacts(self) -> int:
        """How often the body meets a hard stop in a period."""
        return self.closed.impacts

    @property
    def grazes(self) -> bool:
        """True if the contact rests for an instant only: what follows from a disturbance then depends on its sign."""
        end, history = self.closed, self.closed.history
        rests = history.start[: end.piece + 1][history.store.mode[: end.piece + 1] == 0]
        return self.section.at_onset and len(rests) > 0 and self.period - float(rests[0]) <= INSTANT * self.period

    @property
    def forgets_all(self) -> bool:
        """True if each rest ends all disturbances, because only the load is left then."""
        return self.section.at_onset and not len(self.place)

    @property
    def certainty(self) -> str:
        """Say in one sentence what is known of the error of the period."""
        rtol = self.section.rtol
        if not len(self.place):
            return f"measured, from onset to onset in a run with rtol {rtol:g}, which closes exactly"
        return (
            f"measured, not proven: after {self.iterations} runs of one period (rtol {rtol:g}) the run misses its start by"
            f" {_share(self.closed, self.extent):.1g} of the extent of the cycle, and the last step of Newton's iteration changed"
            f" the period by {brief(self.change, 's', 2)}"
        )

    def problem_on_it(self, problem: Problem) -> Problem:
        """Return the problem that starts on the cycle, where it meets the section."""
        return self.section.start_at(self.place)

    def run_of_it(self) -> Solution:
        """Return the run of one period."""
        return uninterrupted(simulate(self.section.start_at(self.place), self.period, self.section.rtol))

    @cached_property
    def multipliers(self) -> NDArray[Any]:
        """What a return multiplies disturbances by, the largest first: one less than there are load, slip rate and states."""
        if self.forgets_all:
            return np.array([np.nan if self.grazes else 0.0])
        found = np.linalg.eigvals(self.closed.slopes())
        if self.section.at_onset:  # the rest has left no more than these
            found = np.append(found, 0.0)
        return found[np.argsort(-np.abs(found), kind="stable")]


def extent_of(history: History, at_onset: bool, last: int) -> Floats:
    """Return how far load and states go in a history up to a piece."""
    pieces = np.arange(last + 1)
    values = coordinates(values_at(history, Positions.inside(np.tile(pieces, 2), np.repeat([0.0, 1.0], len(pieces)))), at_onset)
    return np.asarray(np.ptp(values, axis=1) + 1e-300)


def closed(section: Section, place: Floats, guess: float) -> Orbit:
    """Return the cycle near a place on a section, by Newton's iteration; `guess` is about its period (s).

    Raises InputError if the iteration finds none.
    """
    now = section.returned(place, guess)
    extent = extent_of(now.history, section.at_onset, now.piece)
    if not len(place):
        return Orbit(now, extent, 1, 0.0)
    period, share = now.time, _share(now, extent)
    for n in range(MOST_ITERATIONS):
        step = _step(now)
        tried = _shortened(section, now, step, share, extent)
        period, change = tried.time, abs(tried.time - period)
        new = _share(tried, extent)
        if new <= CLOSED_SHARE or (share <= GOOD_ENOUGH and new >= 0.5 * share):
            best = tried if new < share else now
            found = _checked(Orbit(best, extent_of(best.history, section.at_onset, best.piece), n + 2, change))
            once = _first_time_round(found)
            return found if once is None else closed(section, found.place, once)
        now, share = tried, new
    raise InputError("cycle: Newton's iteration finds no cycle near this run: give another start, or a longer run (near)")


def _first_time_round(orbit: Orbit) -> float | None:
    """Return the period (s) of a cycle that has been found as several of its periods; None if it is found as one.

    A run that comes to a cycle from two sides in turn is closer to itself after two periods than after one.
    """
    met = crossings(orbit.closed.history, orbit.section.at_onset)
    away = np.abs(places_of(orbit.closed.history, met, orbit.section.at_onset) - orbit.place[:, None]) / orbit.extent[:, None]
    earlier = met.time[(away.max(axis=0) <= SAME_PLACE) & (met.time < (1.0 - CLOSES) * orbit.period)]
    return float(earlier[0]) if len(earlier) else None


def _step(now: Return) -> Floats:
    """Return the step of Newton's iteration. Raises InputError if the cycles near here cannot be told apart."""
    try:
        return np.asarray(np.linalg.solve(now.slopes(exactly=False) - np.eye(len(now.start)), -now.missed))
    except np.linalg.LinAlgError:
        raise InputError("cycle: every motion near this run repeats itself: nothing brings it to one of them") from None


def _share(one: Return, extent: Floats) -> float:
    return float(np.max(np.abs(one.missed) / extent))


def _shortened(section: Section, now: Return, step: Floats, share: float, extent: Floats) -> Return:
    """Return the return after a step of Newton's, shortened where it leads away. Raises InputError where it still does."""
    for _ in range(MOST_HALVINGS):
        try:
            found = section.returned(now.start + step, now.time)
        except InputError:
            step = 0.25 * step
            continue
        if _share(found, extent) < 2.0 * share or share <= GOOD_ENOUGH:
            return found
        step = 0.5 * step
    raise InputError("cycle: Newton's iteration leads away from this run: no cycle is near; give another start, or a longer run")


def _checked(orbit: Orbit) -> Orbit:
    """Refuse steady sliding. Raises InputError."""
    now = orbit.closed
    piece = np.repeat(np.arange(now.piece + 1), 3)
    rates = now.history.rate(Positions.inside(piece, np.tile([0.0, 0.5, 1.0], now.piece + 1)))
    if np.ptp(rates) <= STEADY_SHARE * now.section.problem.first_pull_rate:
        raise InputError("cycle: Newton's iteration leads to steady sliding: no other cycle is near this run")
    return orbit


def places_of(history: History, met: Crossings, at_onset: bool = False) -> Floats:
    """Return what may vary on a section where a run crosses it, each in a row."""
    return np.asarray(coordinates(values_at(history, Positions.inside(met.piece, met.place)), at_onset))


def near_end(history: History, problem: Problem, rtol: float) -> Orbit:
    """Return the cycle near the end of a run. Raises InputError if there is none."""
    at_onset = len(onsets(history).time) > 1 and not problem.friction.states
    met = crossings(history, at_onset)
    if len(met.time) < 2:
        raise InputError(
            "cycle: the run does not come back: it neither begins to slip twice after a rest, nor passes the pull rate twice:"
            " give a longer run (near), or another start"
        )
    places = places_of(history, met, at_onset)
    every = meetings(places, extent_of(history, at_onset, len(history) - 1), CLOSES) or 1
    found = closed(Section(problem, at_onset, rtol), places[:, -1], float(met.time[-1] - met.time[-1 - every]))
    if at_onset or problem.friction.states or not found.sticks:
        return found
    along = found.closed.history
    begins = places_of(along, onsets(along), at_onset=True)
    return closed(Section(problem, at_onset=True, rtol=rtol), begins[:, 0], found.period) if begins.shape[1] else found


def meetings(places: Floats, extent: Floats, share: float) -> int:
    """Return after how many meetings with the section the run closes to a share (1) of its extent, 0 if it does so nowhere."""
    for every in range(1, min(MOST_MEETINGS, places.shape[1] - 1) + 1):
        if np.all(np.abs(places[:, -1] - places[:, -1 - every]) <= share * extent):
            return every
    return 0
