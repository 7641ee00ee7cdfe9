"""Let a run settle under a law with states, part by part, and look for the stable cycle next to it as soon as it comes back."""

from __future__ import annotations

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.limit_cycle import is_stable
from stickslip.extensions.cycles.orbit import Orbit, closed, meetings, places_of
from stickslip.extensions.cycles.section import Crossings, Section, coordinates, passages
from stickslip.extensions.cycles.tangent import values_at
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run import TextProgress, uninterrupted
from stickslip.run.simulate import simulate
from stickslip.run.study import MAX_PIECES

PARTS = 4
"""Largest number of parts of the run (1); each lasts twice as long as the one before it."""
NEARLY_CLOSES = 0.03
"""From this close (1, share of its extent) Newton's iteration is tried."""
NEAR_THE_RUN = 0.25
"""A cycle is that to which a run settles if it is no farther (1, share of its extent) from the end of the run."""


def settled(problem: Problem, times: tuple[float, float], rtol: float, tell: TextProgress) -> Orbit | None:
    """Return the stable cycle to which a run of a rigid body under a law with states settles, as soon as it has.

    The run is made in parts, each from the last passage of the one before it, until two passages in it are close to each other, and
    Newton's iteration leads from there to a stable cycle next to the run. `times` (s) are that before the motion begins, and that
    of the first part behind it. None is returned under other laws, and if the run takes long.
    """
    if not problem.friction.states:
        return None
    section, start, (wait, lasts) = Section(problem, at_onset=False, rtol=rtol), problem, times
    for _ in range(PARTS):
        run = uninterrupted(simulate(start, wait + lasts, rtol, max_pieces=MAX_PIECES))
        if not run.status.ok:
            return None
        tell(f"run of {brief(wait + lasts, 's')}")
        met, lasts = passages(run.history), 2.0 * lasts
        found = _closed(section, run.history, met) if len(met.time) > 2 else None
        if found is not None and is_stable(found.multipliers):
            return found
        if len(met.time):
            start, wait = section.start_at(places_of(run.history, met)[:, -1]), 0.0
    return None


def _closed(section: Section, history: History, met: Crossings) -> Orbit | None:
    """Return the cycle next to the last passages of a run, if these are close to each other; None if none is near."""
    places, last = places_of(history, met), int(met.piece[-1])
    pieces = np.repeat(np.arange(int(met.piece[-3]), last + 1), 2)
    extent = np.ptp(coordinates(values_at(history, Positions.inside(pieces, np.tile([0.0, 1.0], len(pieces) // 2))), False), axis=1)
    every = meetings(places, extent, NEARLY_CLOSES)
    if not every:
        return None
    try:
        found = closed(section, places[:, -1], float(met.time[-1] - met.time[-1 - every]))
    except InputError:
        return None
    return found if np.all(np.abs(found.place - places[:, -1]) <= NEAR_THE_RUN * found.extent) else None
