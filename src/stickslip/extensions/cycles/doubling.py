"""Cycles of twice the period: where they begin at an edge of a branch, and where they end in one of half their period."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from stickslip.extensions.cycles.edges import HALVING, CycleEdge
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch

BESIDE_DOUBLING = (1e-2, 3e-2, 3e-3)
"""Distances (1, shares of the extent) from an edge, along the disturbance that a period reverses, where a cycle is looked for."""
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
        if abs(found.orbit.period - 2.0 * orbit.period) < 0.5 * orbit.period and not found.orbit.is_of_half:
            return found if found.way @ along > 0.0 else replace(found, way=-found.way)
    return None


def end_of_doubling(path: Path, now: PlaceOnBranch, new: PlaceOnBranch) -> CycleEdge | None:
    """Return where a cycle becomes one of half its period between two places on a branch; None if it does not.

    There the cycle of half the period has the multiplier -1.
    """
    if not new.orbit.is_of_half or now.orbit.is_of_half:
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
