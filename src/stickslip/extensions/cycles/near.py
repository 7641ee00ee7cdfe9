"""The cycle of a rigid body near the end of a run: where it is cut, after how many meetings it closes, and where the run leads."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.engine import History
from stickslip.extensions.cycles.lag import section_rate
from stickslip.extensions.cycles.newton import Miss, closed, closed_beyond, roughly
from stickslip.extensions.cycles.orbit import Orbit, extent_of, missed_share
from stickslip.extensions.cycles.section import Crossings, Return, Section, crossings, onsets, places_of
from stickslip.extensions.cycles.tangent import RATE_ROW, pace_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem

MOST_MEETINGS = 16
"""Largest number of meetings with the section in one period (1) that is looked for."""
CLOSES = 1e-2
"""A run that comes back this close (1, share of its extent) is taken to close there."""
SOON = 0.05
"""A passage sooner after the start than this share (1) of the time between two of them belongs to the start."""
NEARLY_CLOSED = 1e-5
"""From a place that misses the cycle by so little (1, share of its extent) one step of Newton's iteration leads to it."""
SAME_PERIOD = 0.3
"""Returns that are compared last as long as each other but for this share (1)."""
NEAR_THE_RUN = 0.25
"""The limit of the meetings of a run is believed if it is no farther (1, share of the extent) from the last of them."""


def near_end(history: History, problem: Problem, rtol: float) -> Orbit:
    """Return the cycle near the end of a run. Raises InputError if there is none."""
    at_onset = len(onsets(history).time) > 1 and not problem.friction.states
    met = crossings(history, at_onset)
    if len(met.time) < 2:
        raise InputError(
            "cycle: the run does not come back: it neither begins to slip twice after a rest, nor passes the pull rate twice:"
            " give a longer run (near), or another start"
        )
    section = Section(problem, at_onset, rtol)
    met, begin = (met, 0) if at_onset else with_start(history, met)
    places, extent = places_of(history, met, at_onset), extent_of(history, at_onset, len(history) - 1)
    if not len(places):
        return closed(section, np.zeros(0), float(met.time[-1] - met.time[-2]))
    every = meetings(places[:, begin:], extent, CLOSES) or 1
    leads = Leads(section, places, met.time, extent, every)
    try:
        found = closed_beyond(section, leads.at_limit() or leads.at_last(), leads.period, leads.misses)
    except InputError:
        found = closed(section, places[:, -1], leads.period)
    if at_onset or problem.friction.states or not found.sticks:
        return found
    along = found.closed.history
    begins = places_of(along, onsets(along), at_onset=True)
    return closed(Section(problem, at_onset=True, rtol=rtol), begins[:, 0], found.period) if begins.shape[1] else found


@dataclass(frozen=True)
class Leads:
    """Where the meetings of a run with a section lead."""

    section: Section
    places: Floats
    """The places where it is met, in columns."""
    times: Floats
    extent: Floats
    every: int
    """After how many meetings the run closes."""

    @property
    def period(self) -> float:
        """About the period (s)."""
        return float(self.times[-1] - self.times[-1 - self.every])

    @property
    def is_regular(self) -> bool:
        """True if the run has come back twice, and that has taken about as long."""
        lasted = np.diff(self.times[:: -self.every])
        return len(lasted) > 1 and bool(abs(lasted[1] - lasted[0]) <= SAME_PERIOD * abs(lasted[0]))

    @cached_property
    def misses(self) -> list[Miss]:
        """Misses of the run, from each meeting to the one that should close it."""
        pairs = zip(self.places.T[: -self.every], self.places.T[self.every :], strict=True)
        return [Miss(start, end - start) for start, end in pairs]

    @cached_property
    def last_share(self) -> float:
        """By what share (1) the last of these misses its start."""
        return float(np.max(np.abs(self.misses[-1].missed) / self.extent))

    def at_limit(self) -> Return | None:
        """Return the rough return from the limit of the meetings; None if there is none, or if it misses more than the last one."""
        limit = limit_of(self.places[:, (self.places.shape[1] - 1) % self.every :: self.every], self.extent)
        if limit is None or self.last_share <= NEARLY_CLOSED:
            return None
        try:
            found = roughly(self.section).returned(limit, self.period)
        except InputError:
            return None
        return found if missed_share(found, self.extent) < self.last_share else None

    def at_last(self) -> Return:
        """Return the return from the last meeting, a rough one unless it nearly closes. Raises InputError if there is none."""
        section = self.section if self.last_share <= NEARLY_CLOSED else roughly(self.section)
        return section.returned(self.places[:, -1], self.period)


def limit_of(places: Floats, extent: Floats) -> Floats | None:
    """Return the fixed point of the linear map that a sequence shows; None if it is far from the last of them.

    Only those last steps count whose squares are below the last step: squares are what a map that is not linear adds.
    Source: Sidi 2017, Vector Extrapolation Methods, chapter 1 (reduced rank extrapolation).
    """
    steps = np.diff(places, axis=1) / extent[:, None]
    sizes = np.abs(steps).max(axis=0)[::-1]
    usable = int(np.argmin(np.append(sizes**2 < sizes[0], False)))
    count = min(len(places), usable - 1)
    if count < 1:
        return None
    steps = steps[:, -count - 1 :]
    shares, _, _, _ = np.linalg.lstsq(np.diff(steps, axis=1), -steps[:, -1], rcond=None)
    beyond = steps[:, 1:] @ shares
    if not np.all(np.abs(beyond) <= NEAR_THE_RUN):
        return None
    return np.asarray(places[:, -1] + beyond * extent)


def with_start(history: History, met: Crossings) -> tuple[Crossings, int]:
    """Return the meetings with the section of a run, with its start if that is one, and the number (1) of the first one after it.

    A stiff contact that starts a little off its slow motion passes the pull rate again at once: that is not a meeting of its own.
    """
    problem = history.problem
    if not problem.has_initial_rate or float(problem.initial_rate or 0.0) != section_rate(problem):
        return met, 0
    later = met.time > SOON * (met.time[-1] - met.time[-2])
    if later.all() and not pace_at(history, 0, 0.0)[RATE_ROW] > 0.0:
        return met, 0
    return Crossings(np.append(0, met.piece[later]), np.append(0.0, met.place[later]), np.append(0.0, met.time[later])), 1


def meetings(places: Floats, extent: Floats, share: float) -> int:
    """Return after how many meetings with the section the run closes to a share (1) of its extent, 0 if it does so nowhere."""
    for every in range(1, min(MOST_MEETINGS, places.shape[1] - 1) + 1):
        if np.all(np.abs(places[:, -1] - places[:, -1 - every]) <= share * extent):
            return every
    return 0
