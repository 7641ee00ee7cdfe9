"""A cycle of a rigid body: a run from a section that comes back to where it started."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.section import Crossings, Return, Section, SlipsAndRests, coordinates, crossings, places_of
from stickslip.extensions.cycles.tangent import values_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution import Solution

INSTANT = 1e-6
"""A rest shorter than this share (1) of the period is an instant."""
HALVES_ALIKE = 2e-3
"""Cycles whose halves are closer than this share (1) of the extent are of half the period."""
NEAR_HALF = 0.1
"""How far (1, share of the period) from half of it the middle of a doubled cycle may be."""
SAME_PLACE, SAME_TIME = 1e-6, 1e-2
"""A cycle is back where it began if it misses that by no more than this share (1) of its extent, and that much (1) earlier."""
STEADY_SHARE = 1e-9
"""A slip rate that varies by less than this share (1) of the pull rate is steady sliding."""
SLIGHT_SHARE, LEFT_SHARE = 1e-2, 0.1
"""One that varies by less than the first share (1) of the pull rate is, too, if the next step of Newton's iteration would take more
than the second share (1) of that away: it is what the iteration has left of a motion that decays."""


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
    def slips(self) -> SlipsAndRests:
        """How often slip forwards, slip backwards and rest begin in a period."""
        return self.closed.slips

    @cached_property
    def once(self) -> float:
        """When it is back where it began for the first time (s)."""
        met = crossings(self.closed.history, self.section.at_onset)
        sooner = met.time < (1.0 - SAME_TIME) * self.period
        if not len(self.place) or not sooner.any():
            return self.period
        met = Crossings(*(each[sooner] for each in met))
        away = np.abs(places_of(self.closed.history, met, self.section.at_onset) - self.place[:, None]) / self.extent[:, None]
        earlier = met.time[away.max(axis=0) <= SAME_PLACE]
        return float(earlier[0]) if len(earlier) else self.period

    @property
    def rounds(self) -> int:
        """How often it goes round before it ends (1): more than once, it is no period."""
        return round(self.period / self.once)

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
    def is_kept(self) -> bool:
        """True: tables keep load and states where it starts."""
        return True

    @cached_property
    def is_of_half(self) -> bool:
        """True if it is back where it began after half of its period already."""
        history, section = self.closed.history, self.section
        met = crossings(history, section.at_onset)
        if not len(met.time):
            return False
        away = np.abs(met.time - 0.5 * self.period)
        nearest = int(away.argmin())
        if away[nearest] > NEAR_HALF * self.period:
            return False
        at = Positions.inside(met.piece[nearest : nearest + 1], met.place[nearest : nearest + 1])
        place = coordinates(values_at(history, at), section.at_onset)[:, 0]
        return bool(np.all(np.abs(place - self.place) <= HALVES_ALIKE * self.extent))

    @property
    def certainty(self) -> str:
        """Say in one sentence what is known of the error of the period."""
        rtol = self.section.rtol
        if not len(self.place):
            return f"measured, from onset to onset in a run with rtol {rtol:g}, which closes exactly"
        return (
            f"measured, not proven: after {self.iterations} runs of one period (rtol {rtol:g}) the run misses its start by"
            f" {missed_share(self.closed, self.extent):.1g} of the extent of the cycle, and the last step of Newton's iteration"
            f" changed the period by {brief(self.change, 's', 2)}"
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


def is_steady_sliding(swing: float, pull: float, step: Callable[[], float]) -> bool:
    """Return True if a slip rate that goes to and fro by a swing (m/s) about a pull rate (m/s) is that of steady sliding.

    `step` returns the next step of Newton's iteration, as a share (1) of how far the motion goes; only slight motion asks for it.
    """
    return swing <= STEADY_SHARE * pull or (swing <= SLIGHT_SHARE * pull and step() >= LEFT_SHARE)


def extent_of(history: History, at_onset: bool, last: int) -> Floats:
    """Return how far load and states go in a history up to a piece."""
    pieces = np.arange(last + 1)
    values = coordinates(values_at(history, Positions.inside(np.tile(pieces, 2), np.repeat([0.0, 1.0], len(pieces)))), at_onset)
    return np.asarray(np.ptp(values, axis=1) + 1e-300)


def missed_share(one: Return, extent: Floats) -> float:
    """Return by what share (1) of an extent a return misses its start."""
    return float(np.max(np.abs(one.missed) / extent))
