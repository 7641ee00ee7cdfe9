"""A tone of the loading: its Taylor series along a piece of load."""

from __future__ import annotations

from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel


@kernel
def tone_series(run: Run, amplitude: float, phase: float, time: float) -> None:
    """Write into run.spare the coefficients in xi of amplitude sin(frequency t + phase) on a piece that begins at `time` (s)."""
    frequency = run.params.tone_frequency
    turn, bend = frequency * run.state.speed, 2.0 * frequency * run.state.bend
    tone_along(amplitude, (frequency * time + phase, turn, bend), run.spare, run.trial)
