"""Cycles with and without rest that meet where stick is lost: where the others begin, next to an edge of a branch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.edges import LOSS_OF_STICK, CycleEdge
from stickslip.extensions.cycles.found import kind_of
from stickslip.extensions.cycles.measures import measures_of
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.section import coordinates, passages
from stickslip.extensions.cycles.tangent import values_at

NEXT_TO_EDGE = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Distances (1, shares of the range) from an edge, where a branch is taken up again, with or without rest."""
CLOSE_PERIOD = 0.1
"""Cycles that meet at an edge have periods that differ by no more than this share (1), next to it."""
CLOSE_AMPLITUDE = 0.1
"""So do their amplitudes (1)."""


def without_rest(path: Path, edge: CycleEdge, last: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
    """Return where cycles without rest begin, at an edge where stick is lost; None at any other."""
    if edge.name != LOSS_OF_STICK:
        return None
    met = passages(last.orbit.closed.history)
    if not len(met.time):
        return None
    at = values_at(last.orbit.closed.history, Positions.inside(met.piece[:1], met.place[:1]))
    place = coordinates(at, at_onset=False)[:, 0]
    other = path.cut(at_onset=False)
    along = np.eye(len(other.scales))[0]  # the load where the pull rate is passed is the largest: less of it does not graze
    for share in NEXT_TO_EDGE:
        target = other.together(place, edge.value) - share * along
        try:
            found = other.at(target, along, edge.orbit.period)
        except NoCycleError:
            continue
        if _is_next_to(edge, found, at_onset=False):
            return other, found if found.way[0] < 0.0 else replace(found, way=-found.way)
    return None


def with_rest(path: Path, edge: CycleEdge, last: PlaceOnBranch, *, came_up: bool) -> tuple[Path, PlaceOnBranch] | None:
    """Return where cycles with rest begin, at an edge where the slip rate touches 0; under laws with states none is found."""
    if last.orbit.section.problem.friction.states:
        return None
    other = path.cut(at_onset=True)
    for share in NEXT_TO_EDGE:
        for sign in (1.0, -1.0) if came_up else (-1.0, 1.0):
            value = edge.value + sign * share * path.range
            try:
                found = other.at_value(value, np.zeros(0), edge.orbit.period)
            except NoCycleError:
                continue
            if _is_next_to(edge, found, at_onset=True):
                return other, found if found.way[-1] * sign > 0.0 else replace(found, way=-found.way)
    return None


def with_other_impacts(path: Path, edge: CycleEdge, last: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
    """Return where cycles begin that meet hard stops more or less often, at an edge where a stop is grazed; None: not found."""
    ahead = 1.0 if last.way[-1] > 0.0 else -1.0
    for share in NEXT_TO_EDGE:
        for sign in (ahead, -ahead):
            try:
                found = path.at_value(edge.value + sign * share * path.range, last.orbit.place, last.orbit.period)
            except NoCycleError:
                continue
            near = abs(found.orbit.period - edge.orbit.period) <= CLOSE_PERIOD * edge.orbit.period
            if near and kind_of(found.orbit) != kind_of(last.orbit):
                return path, found if found.way[-1] * sign > 0.0 else replace(found, way=-found.way)
    return None


def _is_next_to(edge: CycleEdge, found: PlaceOnBranch, *, at_onset: bool) -> bool:
    """Return True if a cycle may be the one that meets another at an edge."""
    period, swing = edge.orbit.period, measures_of(edge.orbit).amplitude
    alike = abs(found.orbit.period - period) <= CLOSE_PERIOD * period and found.orbit.sticks == at_onset
    return alike and abs(measures_of(found.orbit).amplitude - swing) <= CLOSE_AMPLITUDE * swing  # that of steady sliding is 0
