"""A force on a rigid body that is given in time: what it adds to the load.

The load of the engine grows by F' per second, and jumps where F jumps: at the start, too, because no force acts before it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import LoadingHistory, Tone

NO_JUMP_OF_FORCE = 1e-14
"""A change of the force below this share of the largest one (1) is rounding and no jump."""


def pushed(inflow: Inflow, force: LoadingHistory) -> Inflow:
    """Return the growth of the load of a rigid body (N/s) that a force acts on, too."""
    begin, _, slope = force.parts
    start = np.union1d(inflow.start, begin)
    of = inflow.segment(start)
    value = inflow.value[of] + inflow.slope[of] * (start - inflow.start[of])
    value += slope[np.searchsorted(begin, start, side="right") - 1]
    amplitude, frequency, phase = force.tone
    tone = Tone(amplitude * frequency, frequency, phase + 0.5 * math.pi) if amplitude != 0.0 else inflow.tone
    return replace(
        inflow, start=start, value=value, slope=inflow.slope[of], tone=tone, reflection=inflow.reflection[of], gain=inflow.gain[of]
    )


def jumps_of_force(force: LoadingHistory) -> list[tuple[float, float]]:
    """Return the times (s) when a force jumps, the start among them, and by how much (N)."""
    start, value, slope = force.parts
    jump = np.append(force.first, value[1:] - (value[:-1] + slope[:-1] * np.diff(start)))
    jump[1:][np.abs(jump[1:]) <= NO_JUMP_OF_FORCE * np.abs(value).max()] = 0.0
    return [(time, step) for time, step in zip(start.tolist(), jump.tolist(), strict=True) if step != 0.0]
