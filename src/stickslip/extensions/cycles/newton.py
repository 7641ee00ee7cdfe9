"""Newton's iteration on the return to a section, with the curvature that earlier returns show: from a place to the cycle near it.

Source: Schnabel & Frank 1984, SIAM J. Numer. Anal. 21, 815, for the curvature (tensor methods).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.orbit import Orbit, extent_of, is_steady_sliding, missed_share
from stickslip.extensions.cycles.section import Return, Section
from stickslip.extensions.cycles.short_runs import ROUGH_RTOL
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

MOST_ITERATIONS, MOST_HALVINGS = 20, 6
"""Newton's iterations (1), and how often a step is halved that leads away."""
CLOSED_SHARE = 1e-11
"""Newton's iteration ends where the return misses the start by less than this share (1) of the cycle's extent."""
GOOD_ENOUGH = 1e-7
"""A cycle is found if at last it misses by no more than this share (1)."""
SHORT_STEP = 1e-2
"""A step of no more than this share (1) of the extent leads so near that the next run is as exact as wished."""
FARTHER, LARGER, SHORTEST_WAY = 4.0, 3.0, 1e-3
"""A step is at most so many times (1) as long as the way to the return that shows the curvature, which makes it longer by no more
than the second; nearer returns (1, share of the extent) show rounding."""


class Miss(NamedTuple):
    """What a return to a section misses: the place where it starts, and the place where it ends less that."""

    start: Floats
    missed: Floats


class NextSteps(NamedTuple):
    """The next step, and Newton's own without curvature."""

    curved: Floats
    straight: Floats


def closed(section: Section, place: Floats, guess: float) -> Orbit:
    """Return the cycle near a place on a section, by Newton's iteration; `guess` is about its period (s).

    Raises InputError if the iteration finds none.
    """
    if len(place):
        return closed_beyond(section, roughly(section).returned(place, guess), guess)
    now = section.returned(place, guess)
    return Orbit(now, extent_of(now.history, section.at_onset, now.piece), 1, 0.0)


def roughly(section: Section) -> Section:
    """Return the same section with runs that only lead to the next place."""
    return replace(section, rtol=max(section.rtol, ROUGH_RTOL))


def for_step(section: Section, step: Floats) -> Section:
    """Return the section for the run after a step (1, shares of the extent): with rough runs, unless it leads very near."""
    return section if np.abs(step).max() <= SHORT_STEP else roughly(section)


def closed_beyond(section: Section, now: Return, period: float, earlier: Sequence[Miss] = ()) -> Orbit:
    """Return the cycle near a return, by Newton's iteration, from about its period (s).

    `earlier` are returns that are known near there. Runs are rough as long as they only lead to the next place.
    Raises InputError if the iteration finds no cycle.
    """
    seen, extent = list(earlier), extent_of(now.history, section.at_onset, now.piece)
    share, change = missed_share(now, extent), abs(now.time - period)
    if now.section == section and share <= CLOSED_SHARE:
        return _once_round(Orbit(now, extent, 1, change))
    period = now.time
    for n in range(MOST_ITERATIONS):
        steps = next_steps(now, seen, extent)
        seen.append(Miss(now.start, now.missed))
        tried = _shortened(section, now, steps, share, extent)
        period, change = tried.time, abs(tried.time - period)
        new, exact = missed_share(tried, extent), now.section == section
        if tried.section == section and (new <= CLOSED_SHARE or (exact and share <= GOOD_ENOUGH and new >= 0.5 * share)):
            best = now if exact and share <= new else tried
            return _once_round(Orbit(best, extent_of(best.history, section.at_onset, best.piece), n + 2, change))
        now, share = tried, new
    raise InputError("cycle: Newton's iteration finds no cycle near this run: give another start, or a longer run (near)")


def _once_round(orbit: Orbit) -> Orbit:
    """Return a cycle that may have been found as several of its periods, once round. Raises InputError if it is steady sliding.

    A run that comes to a cycle from two sides in turn is closer to itself after two periods than after one.
    """
    _check_that_it_moves(orbit)
    if orbit.rounds == 1:
        return orbit
    return closed_beyond(orbit.section, orbit.section.returned(orbit.place, orbit.once), orbit.once)


@np.errstate(over="ignore", invalid="ignore")  # on the way to steady sliding the extent of a cycle may be next to nothing
def next_steps(now: Return, seen: Sequence[Miss], extent: Floats) -> NextSteps:
    """Return the next steps from a return. Raises InputError if the cycles near here cannot be told apart.

    The miss of a step d is F + J d + a (s d)^2 / 2 where s leads to an earlier return, and a makes that miss what it does.
    """
    derivative = (now.about - np.eye(len(now.start))) * extent / extent[:, None]
    missed = now.missed / extent
    try:
        straight: Floats = np.asarray(np.linalg.solve(derivative, -missed), np.float64)
    except np.linalg.LinAlgError:
        raise InputError("cycle: every motion near this run repeats itself: nothing brings it to one of them") from None
    ways = [(one.start - now.start) / extent for one in seen]
    lengths = np.array([np.linalg.norm(way) for way in ways])
    usable = np.flatnonzero(lengths >= max(np.linalg.norm(straight) / FARTHER, SHORTEST_WAY))
    curved = straight
    if len(usable):
        n = int(usable[lengths[usable].argmin()])
        curved = curved_step(derivative, straight, ways[n], seen[n].missed / extent - missed)
    return NextSteps(curved * extent, straight * extent)


def curved_step(derivative: Floats, straight: Floats, way: Floats, change: Floats) -> Floats:
    """Return the step with the curvature that the change of a miss along a way shows; the straight one if there is none."""
    length = way @ way
    bend = np.linalg.solve(derivative, (change - derivative @ way) / length**2)  # a / 2, behind the derivative
    along, turns = straight @ way, bend @ way
    inside = 1.0 + 4.0 * along * turns
    if not inside > 0.0:
        return straight
    goes = 2.0 * along / (1.0 + np.sqrt(inside))
    found = straight - bend * goes**2
    return found if np.linalg.norm(found) <= LARGER * np.linalg.norm(straight) else straight


def _shortened(section: Section, now: Return, steps: NextSteps, share: float, extent: Floats) -> Return:
    """Return the return after a step, shortened where it leads away. Raises InputError where it still does."""
    step = steps.curved
    for _ in range(MOST_HALVINGS):
        try:
            found = for_step(section, step / extent).returned(now.start + step, now.time)
        except InputError:
            step = 0.25 * step
            continue
        if missed_share(found, extent) < 2.0 * share or share <= GOOD_ENOUGH:
            return found
        step = 0.5 * step
    raise InputError("cycle: Newton's iteration leads away from this run: no cycle is near; give another start, or a longer run")


def _check_that_it_moves(orbit: Orbit) -> None:
    """Refuse steady sliding. Raises InputError."""
    now = orbit.closed
    piece = np.repeat(np.arange(now.piece + 1), 3)
    rates = now.history.rate(Positions.inside(piece, np.tile([0.0, 0.5, 1.0], now.piece + 1)))

    def step() -> float:
        beyond = now.slopes() - np.eye(len(now.start))
        found = np.linalg.lstsq(beyond * orbit.extent / orbit.extent[:, None], -now.missed / orbit.extent, rcond=None)[0]
        return abs(float(found[0]))  # of the load: a state that hardly matters may stand still

    if is_steady_sliding(float(np.ptp(rates)), now.section.problem.first_pull_rate, step):
        raise InputError("cycle: Newton's iteration leads to steady sliding: no other cycle is near this run")
