"""Let a run settle under a law with states, and look for the stable cycle to which it leads as soon as it comes nearer to one."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.limit_cycle import is_stable
from stickslip.extensions.cycles.near import NEAR_THE_RUN, Leads, meetings
from stickslip.extensions.cycles.newton import closed_beyond
from stickslip.extensions.cycles.orbit import Orbit
from stickslip.extensions.cycles.section import Crossings, Section, coordinates, passages, places_of
from stickslip.extensions.cycles.short_runs import ROUGH_RTOL, advanced, begun
from stickslip.extensions.cycles.tangent import values_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem, Stop
from stickslip.run import TextProgress
from stickslip.run.study import MAX_PIECES

SHARE_OF_FIRST, MOST_LOOKS = 0.5, 30
"""A run is looked at each time it has gone on for this share (1) of the time of its first part, at most so often."""
NEARLY_CLOSES, SURELY_CLOSES = 0.03, 1e-3
"""A run that comes back this close (1, share of its extent) is taken to close there; with the second it need not come nearer."""
MOST_STEPS_AWAY = 4.0
"""The cycle to which a run leads is no farther from there than a share of the extent, or than so many of its last steps (1)."""
PASSES_BETWEEN = 16
"""Number of passes of the engine's loop (1) between which the time of a run is looked at."""


def settled(problem: Problem, times: tuple[float, float], rtol: float, tell: TextProgress) -> Orbit | None:
    """Return the stable cycle to which a run of a rigid body under a law with states settles, as soon as it comes nearer.

    The run only has to lead there, so that it is rough. `times` (s) are that before the motion begins, and that of a first part
    behind it. None is returned under other laws, and if the run takes long.
    """
    if not problem.friction.states:
        return None
    section, (wait, lasts) = Section(problem, at_onset=False, rtol=rtol), times
    step = SHARE_OF_FIRST * lasts
    run = begun(problem, wait + MOST_LOOKS * step, max(rtol, ROUGH_RTOL), MAX_PIECES)
    seen = 0
    for look in range(1, MOST_LOOKS + 1):
        code = None
        while code is None and run.time < wait + look * step:
            code = advanced(run, PASSES_BETWEEN)
        if code not in (None, Stop.FINISHED):
            return None
        tell(f"run of {brief(run.time, 's')}")
        history = run.history()
        met = passages(history)
        if len(met.time) > max(2, seen):
            seen = len(met.time)
            found = _closed(section, history, met)
            if found is not None:
                return found
        if code is not None:
            return None
    return None


def _closed(section: Section, history: History, met: Crossings) -> Orbit | None:
    """Return the stable cycle next to where the last passages of a run lead; None if they lead nowhere, or none is there."""
    places, last = places_of(history, met), int(met.piece[-1])
    pieces = np.repeat(np.arange(int(met.piece[-3]), last + 1), 2)
    extent = np.ptp(coordinates(values_at(history, Positions.inside(pieces, np.tile([0.0, 1.0], len(pieces) // 2))), False), axis=1)
    leads = Leads(section, places, met.time, extent, meetings(places, extent, NEARLY_CLOSES) or 1)
    if not (leads.last_share <= SURELY_CLOSES or (leads.is_regular and _comes_nearer(places[:, :: -leads.every], extent))):
        return None
    try:
        now = leads.at_limit() or leads.at_last()
        multipliers: Any = np.linalg.eigvals(now.about)
        if not is_stable(multipliers):
            return None
        found, near = closed_beyond(section, now, leads.period, leads.misses), now.start
    except InputError:
        return None
    steps = np.abs(places[:, -1] - places[:, -2])
    is_near = bool(np.all(np.abs(found.place - near) <= np.maximum(NEAR_THE_RUN * found.extent, MOST_STEPS_AWAY * steps)))
    return found if is_near and is_stable(found.multipliers) else None


def _comes_nearer(backwards: Floats, extent: Floats) -> bool:
    """Return True if the last step of a sequence, which comes first, is shorter than the one before it, in load and all states."""
    steps = np.abs(np.diff(backwards[:, :3], axis=1)) / extent[:, None]
    return steps.shape[1] == 2 and bool(np.all(steps[:, 0] < steps[:, 1]))
