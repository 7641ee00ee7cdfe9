"""Define a sinusoidal loading history, for tides, pressure cycles and dynamic triggering."""

import math
from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.loading.contract import VARYING, LoadingHistory, Segment, Tone


@dataclass(frozen=True)
class Sinusoidal(LoadingHistory):
    """mean + amplitude sin(2 pi t / period + phase)."""

    kind = "sinusoidal"
    example: ClassVar = {"mean": 1e-9, "amplitude": 1e-9, "period": "12.42 h"}

    mean: Number = quantity(VARYING, "mean value")
    amplitude: Number = quantity(VARYING, "amplitude of the oscillation")
    period: Number = quantity("s", "period of the oscillation", above=0)
    phase: Number = quantity("rad", "phase of the oscillation at the start", default=0.0)

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        return (Segment(0.0, self.mean, 0.0),)

    @property
    @override
    def tone(self) -> Tone:
        return Tone(self.amplitude, 2.0 * math.pi / self.period, self.phase)
