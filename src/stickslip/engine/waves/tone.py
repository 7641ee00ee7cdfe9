"""The Taylor series of a tone along a piece of load."""

from __future__ import annotations

import math

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.series.polynomial import RECIPROCAL
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run


@kernel
def tone_series(run: Run, amplitude: float, phase: float, time: float) -> None:
    """Write into run.spare the coefficients in xi of amplitude sin(frequency t + phase) on a piece that begins at `time` (s).

    They follow from s' = frequency t' c and c' = -frequency t' s for the sine s and the cosine c.
    """
    frequency = run.params.tone_frequency
    turn, bend = frequency * run.state.speed, 2.0 * frequency * run.state.bend
    angle = frequency * time + phase
    sine, cosine = run.spare, run.trial
    sine[0], cosine[0] = amplitude * math.sin(angle), amplitude * math.cos(angle)
    for k in range(TERMS - 1):
        before = k - 1 if k > 0 else 0
        bent = bend if k > 0 else 0.0
        sine[k + 1] = RECIPROCAL[k + 1] * (turn * cosine[k] + bent * cosine[before])
        cosine[k + 1] = -RECIPROCAL[k + 1] * (turn * sine[k] + bent * sine[before])
