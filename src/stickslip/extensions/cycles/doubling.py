"""Cycles of twice the period: where they begin at an edge of a branch, and whether a cycle is one of half its period."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stickslip.engine import Positions
from stickslip.extensions.cycles.edges import HALVING, CycleEdge
from stickslip.extensions.cycles.orbit import Orbit
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.section import coordinates, crossings
from stickslip.extensions.cycles.tangent import values_at

BESIDE_DOUBLING = (1e-2, 3e-2, 3e-3)
"""Distances (1, shares of the extent) from an edge, along the disturbance that a period reverses, where a cycle is looked for."""
HALVES_ALIKE = 2e-3
"""Cycles whose halves are closer than this share (1) of the extent are of half the period."""
NEAR_HALF = 0.1
"""How far (1, share of the period) from half of it the middle of a doubled cycle may be."""
MOST_DOUBLED = 3
"""How often the period may double (1) on branches that are followed."""


def first_doubled(path: Path, edge: CycleEdge) -> PlaceOnBranch | None:
    """Return a cycle of twice the period next to an edge where the period doubles, and the way from it; None if none is found."""
    orbit = edge.orbit
    values, vectors = np.linalg.eig(orbit.closed.slopes())
    along = np.append(np.real(vectors[:, int(np.abs(values + 1.0).argmin())]) / path.scales[:-1], 0.0)
    along /= np.linalg.norm(along)
    for share in BESIDE_DOUBLING:
        try:
            found = path.at(path.together(orbit.place, edge.value) + share * along, along, 2.0 * orbit.period)
        except NoCycleError:
            continue
        if abs(found.orbit.period - 2.0 * orbit.period) < 0.5 * orbit.period and not is_of_half(found.orbit):
            return found if found.way @ along > 0.0 else replace(found, way=-found.way)
    return None


def end_of_doubling(path: Path, now: PlaceOnBranch, new: PlaceOnBranch) -> CycleEdge | None:
    """Return where a cycle becomes one of half its period between two places on a branch; None if it does not.

    There the cycle of half the period has the multiplier -1.
    """
    if not is_of_half(new.orbit) or is_of_half(now.orbit):
        return None
    last = new.orbit

    def beyond(value: float) -> float:
        nonlocal last
        last = path.at_value(value, last.place, (0.5 if last is new.orbit else 1.0) * last.period).orbit
        return float(np.prod(1.0 + last.multipliers).real)

    with suppress(NoCycleError, ValueError):
        found = float(brentq(beyond, new.value, now.value, xtol=1e-13 * path.range, rtol=1e-13))
        return CycleEdge(HALVING, found, last)
    return None


def is_of_half(orbit: Any) -> bool:
    """Return True if a cycle of a rigid body is back where it began after half of its period already."""
    if not isinstance(orbit, Orbit):
        return False
    history = orbit.closed.history
    met = crossings(history, orbit.section.at_onset)
    if not len(met.time):
        return False
    away = np.abs(met.time - 0.5 * orbit.period)
    nearest = int(away.argmin())
    if away[nearest] > NEAR_HALF * orbit.period:
        return False
    at = Positions.inside(met.piece[nearest : nearest + 1], met.place[nearest : nearest + 1])
    place = coordinates(values_at(history, at), orbit.section.at_onset)[:, 0]
    return bool(np.all(np.abs(place - orbit.place) <= HALVES_ALIKE * orbit.extent))
