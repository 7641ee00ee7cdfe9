"""Ends of branches of cycles of bodies with waves: what happens there, and where the branch goes on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.edges import CORNER, GRAZING, LOSS_OF_STICK, NOT_FOUND, CycleEdge
from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.measures import least_rate, measures_of
from stickslip.extensions.cycles.meeting import CLOSE_PERIOD, NEXT_TO_EDGE
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.reaching import STRAIGHT
from stickslip.extensions.cycles.waves.mesh import mesh_of
from stickslip.extensions.cycles.waves.of_driver import kept_by_driver, rate_and_push
from stickslip.extensions.cycles.waves.orbit import coordinates, spread
from stickslip.extensions.cycles.waves.section import WavePlace, WaveSection, states_at
from stickslip.extensions.cycles.waves.sources import source_of
from stickslip.foundation.arrays import Floats

FIRST_SHORT, MOST_SHORT, SAME_MOTION = 1e-4, 16, 1e-2
"""First step towards an end (1), the number of steps, halved without a cycle, and by what share (1) a period may change there."""
GOES_ON, TELLS = 5, 10.0
"""A branch whose last steps towards an end have all found a cycle, so many (1), goes on behind a corner, if steps are longer than
the miss of the last cycle by a factor (1): shorter ones tell nothing."""
ACROSS, SAME_CORNER, MEETS = (1e-5, 1e-4), 3e-5, 0.1
"""How far (1, shares of the range) beyond the last cycle one is looked for behind a corner: farther than the parameter is moved to
see how a return changes, so that no difference reaches over the corner; how near to each other (1, share of the range) two corners
are one; and by what share (1) of their distance straight lines from both sides may miss each other at a corner, as at no jump."""
NEAR_MEAN = 0.05
"""A cycle without rest is cut about where it passes its mean slip rate, if off it by less than this share (1) of its amplitude."""
SHORTEST_AWAY, MOST_AWAY = 2e-7, 40
"""First step away from an edge (1), and the largest number of such steps, until they are as long as others."""
SHORT_REST, TOUCHES = 1e-2, 1e-3
"""A rest that lasts a smaller share (1) of the period vanishes next to the end of a branch; slip rate and load touch rest and
strength where they come as near (1, of their extent) as the second."""
LOOKED_AT = 33
"""Number of places in each piece (1) where the least slip rate is looked for."""


class EndOfPart(NamedTuple):
    """Where a part of a branch ends, and where the next one begins, if one does."""

    edge: CycleEdge | None
    """None if only the section is another from there on."""
    onward: tuple[Path, PlaceOnBranch] | None


class Corner(NamedTuple):
    """A corner of a branch: the value (SI) of the parameter there, and the first cycle behind it."""

    value: float
    beyond: PlaceOnBranch


def farther(path: Path, last: PlaceOnBranch, corners: list[float]) -> EndOfPart:
    """Return where cycles with rest end beyond the last place of a branch, and where it goes on, if it does come farther.

    `corners` are the values (SI) of those before, with that of this one from now on: a corner next to one of them is the same.
    """
    end = end_of_rests(path, last)
    if end.onward is None:
        return end
    value, before = end.onward[1].value if end.edge is None else end.edge.value, list(corners)
    corners.append(value)
    if not any(abs(value - one) <= SAME_CORNER * path.range for one in before):
        return end
    onward = end.onward[1]
    if abs(onward.value - last.value) >= 0.5 * ACROSS[0] * path.range:
        return EndOfPart(None, end.onward)
    corner = across(path, [last, onward])
    if corner is None:
        return EndOfPart(CycleEdge(NOT_FOUND, last.value, last.orbit), None)
    return EndOfPart(None, (path, corner.beyond))


def end_of_rests(path: Path, last: PlaceOnBranch) -> EndOfPart:
    """Return where cycles with rest end beyond the last place of a branch, by steps that become shorter."""
    length, found, changes, before, value = FIRST_SHORT, 0, _changes_in(last.orbit), last.way, last.value
    passed = [last]
    for _ in range(MOST_SHORT):
        try:
            new = path.step(last, length)
            if abs(new.orbit.period - last.orbit.period) > SAME_MOTION * last.orbit.period:
                raise NoCycleError("follow: this is another cycle")
            moved = path.together(new.orbit.place, new.value) - path.together(last.orbit.place, last.value)
            last, found = new if new.way @ moved >= 0.0 else replace(new, way=-new.way), found + 1
            passed.append(last)
        except NoCycleError:
            length, found, value = 0.5 * length, 0, last.value
    name = _name_of_end(last.orbit)
    if name != LOSS_OF_STICK:
        closed: Any = last.orbit
        if found >= GOES_ON and length > TELLS * closed.share:
            name = CORNER if _changes_in(last.orbit) == changes else GRAZING
            if name == CORNER and abs(before @ last.way) >= STRAIGHT:
                return EndOfPart(None, (path, last))
            return EndOfPart(CycleEdge(name, value, last.orbit), (path, last))
        corner = across(path, passed)
        if corner is not None:
            name = CORNER if _changes_in(corner.beyond.orbit) == changes else GRAZING
            return EndOfPart(CycleEdge(name, corner.value, last.orbit), (path, corner.beyond))
    edge = CycleEdge(name, last.value, last.orbit)
    begun = _without_rest(path, edge) if name == LOSS_OF_STICK else None
    if begun is None:
        return EndOfPart(edge, None)
    other, first = begun
    return EndOfPart(edge._replace(value=_value_of_touch(other, first)), (other, _led_away(other, first)))


def across(path: Path, passed: Sequence[PlaceOnBranch]) -> Corner | None:
    """Return the corner beyond the last of the places passed, by a step in the parameter alone; None if none is found.

    Lines that go straight on from both sides meet at a corner.
    """
    last = passed[-1]
    clear = ([one for one in passed if abs(last.value - one.value) > 0.5 * ACROSS[0] * path.range] or passed[:1])[-1]
    begin = path.together(clear.orbit.place, clear.value)
    for share in ACROSS:
        try:
            target = last.value + share * path.range * float(np.sign(last.way[-1]))
            new = path.at_value(target, last.orbit.place, last.orbit.period)
        except NoCycleError:
            continue
        moved, ways = path.together(new.orbit.place, new.value) - begin, np.column_stack([clear.way, -new.way])
        lengths = np.linalg.lstsq(ways, moved, rcond=None)[0]
        same = abs(new.orbit.period - last.orbit.period) <= SAME_MOTION * last.orbit.period and new.orbit.sticks
        if same and np.linalg.norm(ways @ lengths - moved) <= MEETS * np.linalg.norm(moved):
            low, high = sorted((last.value, new.value))
            value = float(np.clip(clear.value + lengths[0] * clear.way[-1] * path.range, low, high))
            return Corner(value, new if new.way @ moved >= 0.0 else replace(new, way=-new.way))
    return None


def _changes_in(orbit: FoundCycle) -> int:
    """Return how often in a period (1) slip begins, or ends."""
    modes = orbit.closed.history.store.mode[orbit.closed.first : orbit.closed.piece + 1]
    return int(np.count_nonzero(np.diff(modes)))


def _value_of_touch(path: Path, first: PlaceOnBranch) -> float:
    """Return the value (SI) where the least slip rate of cycles without rest is 0, next to the first one, on a line."""
    try:
        second = path.step(first, SHORTEST_AWAY)
    except NoCycleError:
        return first.value
    rates = least_rate(first.orbit), least_rate(second.orbit)
    if second.orbit.sticks or not rates[1] > rates[0]:
        return first.value
    return first.value - rates[0] * (second.value - first.value) / (rates[1] - rates[0])


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


def cut_anew(path: Any, last: PlaceOnBranch) -> EndOfPart | None:
    """Return the last place of a branch without rest, cut where it passes its mean slip rate; None if it is cut about there.

    The mean changes along a branch, and a small cycle no longer passes what was the mean of a large one.
    """
    found, level = measures_of(last.orbit), _mean_level(last.orbit)
    place = _at_level(path, last.orbit, level)
    if abs(level - path.level) * last.orbit.section.problem.first_pull_rate < NEAR_MEAN * found.amplitude or place is None:
        return None
    other, target = _other(path, place, at_onset=False, level=level)
    try:
        new = other.at(other.together(target, last.value), np.eye(len(other.scales))[-1], last.orbit.period, place)
    except NoCycleError:
        return None
    return EndOfPart(None, (other, new if new.way[-1] * last.way[-1] >= 0.0 else replace(new, way=-new.way)))


def _mean_level(orbit: FoundCycle) -> float:
    """Return the mean slip rate of a cycle, as a share of the pull rate (1)."""
    level: float = measures_of(orbit).slip / orbit.period / orbit.section.problem.first_pull_rate
    return level


def _at_level(path: Path, orbit: FoundCycle, level: float) -> WavePlace | None:
    """Return the place of a cycle where its slip rate last passes a share (1) of the pull rate; None if it does not."""
    closed = orbit.closed
    met = WaveSection(orbit.section.problem, False, path.rtol, level).met(closed.history)
    before = np.flatnonzero(met.time < closed.end)
    if not len(before):
        return None
    n = int(before[-1])
    return _place_at(closed, (int(met.piece[n]), float(met.place[n])), float(met.time[n]))


def _without_rest(path: Path, edge: CycleEdge) -> tuple[Path, PlaceOnBranch] | None:
    """Return where cycles without rest begin, at an edge where stick is lost: they are cut where they pass their mean slip rate."""
    level = _mean_level(edge.orbit)
    place = _at_level(path, edge.orbit, level)
    return None if place is None else _next_to(path, edge, place, at_onset=False, level=level)


def with_rest(path: Path, edge: CycleEdge) -> tuple[Path, PlaceOnBranch] | None:
    """Return where cycles with rest begin, at an edge where the slip rate touches 0: they are cut there."""
    closed = edge.orbit.closed
    pieces = np.arange(closed.first, closed.piece)
    at = Positions.inside(np.repeat(pieces, LOOKED_AT), np.tile(np.linspace(0.0, 1.0, LOOKED_AT), len(pieces)))
    n = int(closed.history.rate(at).argmin())
    piece, place = int(at.piece[n]), float(at.xi[n])
    store = closed.history.store
    time = float(closed.history.start[piece] + place * (store.speed[piece] + place * store.bend[piece]))
    begun = _next_to(path, edge, _place_at(closed, (piece, place), time), at_onset=True, level=1.0)
    return None if begun is None else (begun[0], _led_away(*begun))


def _place_at(closed: Any, where: tuple[int, float], time: float) -> WavePlace:
    """Return the place of a cycle at a piece, a place (1) in it, and a time (s)."""
    history, source = closed.history, source_of(closed.history, time)
    mesh = mesh_of(source, source.kinks(closed.time))
    kept = kept_by_driver(history, time, rate_and_push(history.problem, closed.start.kept))
    return WavePlace(mesh, states_at(history, *where), kept, source.at(mesh.phases))


def _other(path: Any, place: WavePlace, *, at_onset: bool, level: float) -> tuple[Any, Floats]:
    """Return the path of cycles that are cut elsewhere, and the coordinates of a place there."""
    even: Floats = spread(place).scale
    scales = np.append(even * np.sqrt(len(even)), path.range)
    return replace(path, at_onset=at_onset, level=level, scales=scales), coordinates(place)


def _next_to(path: Any, edge: CycleEdge, place: WavePlace, *, at_onset: bool, level: float) -> tuple[Path, PlaceOnBranch] | None:
    """Return the path of the other cycles that meet at an edge, and the first one, which leads away from it."""
    other, begin = _other(path, place, at_onset=at_onset, level=level)
    across = np.eye(len(other.scales))[-1]
    for share in NEXT_TO_EDGE:
        for sign in (1.0, -1.0):
            target = other.together(begin, edge.value + sign * share * path.range)
            try:
                found = other.at(target, across, edge.orbit.period, place)
            except NoCycleError:
                continue
            close = abs(found.orbit.period - edge.orbit.period) <= CLOSE_PERIOD * edge.orbit.period
            if close and found.orbit.sticks == at_onset:
                return other, found if found.way[-1] * sign > 0.0 else replace(found, way=-found.way)
    return None


def _led_away(path: Path, now: PlaceOnBranch) -> PlaceOnBranch:
    """Return a place on a branch that leads away from its first one, next to an edge, where steps are as long as others."""
    length = SHORTEST_AWAY
    for _ in range(MOST_AWAY):
        try:
            new = path.step(now, length)
            if new.orbit.sticks != now.orbit.sticks:
                raise NoCycleError("follow: this is another cycle")
        except NoCycleError:
            length *= 0.5
            continue
        now, length = new if new.way @ now.way > 0.0 else replace(new, way=-new.way), 2.0 * length
        if length > FIRST_SHORT:
            break
    return now
