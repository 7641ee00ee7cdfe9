"""A tone of the loading: its Taylor series along a piece of load, and its sum over round trips."""

from __future__ import annotations

import math

from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import entry, kernel


@kernel
def tone_series(run: Run, amplitude: float, phase: float, time: float) -> None:
    """Write into run.spare the coefficients in xi of amplitude sin(frequency t + phase) on a piece that begins at `time` (s)."""
    frequency = run.params.tone_frequency
    turn, bend = frequency * run.state.speed, 2.0 * frequency * run.state.bend
    tone_along(amplitude, (frequency * time + phase, turn, bend), run.spare, run.trial)


@entry
def dirichlet(count: float, step: float) -> float:
    """Return the sum of `count` unit phasors that are `step` (rad) apart, along their mean: sin(count step/2) / sin(step/2)."""
    turns = math.floor(step / (2.0 * math.pi) + 0.5)
    rest = 0.5 * step - turns * math.pi  # in [-pi/2, pi/2]
    value = count if rest == 0.0 else math.sin(count * rest) / math.sin(rest)
    return -value if (turns * (count - 1.0)) % 2.0 == 1.0 else value
