"""Define a sinusoidal loading history, for tides, pressure cycles and dynamic triggering."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.quantities import quantity
from stickslip.loading.contract import VARYING, LoadingHistory, Segment, Tone


@dataclass(frozen=True)
class Sinusoidal(LoadingHistory):
    """mean + amplitude sin(2 pi t / period + phase).

    Parameters
    ----------
    mean
        Mean value (m/s or Pa).
    amplitude
        Amplitude of the oscillation (m/s or Pa).
    period
        Period of the oscillation (s).
    phase
        Phase of the oscillation at the start of the run (rad).
    """

    kind: ClassVar[str] = "sinusoidal"
    example: ClassVar[dict[str, Any]] = {"mean": 1e-9, "amplitude": 1e-9, "period": "12.42 h"}

    mean: float = quantity(VARYING, "mean value")
    amplitude: float = quantity(VARYING, "amplitude of the oscillation")
    period: float = quantity("s", "period of the oscillation", above=0)
    phase: float = quantity("rad", "phase of the oscillation at the start", default=0.0)

    @property
    def segments(self) -> tuple[Segment, ...]:
        return (Segment(0.0, self.mean, 0.0),)

    @property
    def tone(self) -> Tone:
        return Tone(self.amplitude, 2.0 * math.pi / self.period, self.phase)
