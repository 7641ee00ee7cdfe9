"""Define a loading history that is linear between given points: ramps, and measured histories."""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Numbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, Series, declare
from stickslip.loading.contract import VARYING, LoadingHistory, Segment


@dataclass(frozen=True)
class PiecewiseLinear(LoadingHistory):
    """A straight line from point to point, constant before the first point and after the last."""

    kind = "piecewise-linear"
    example: ClassVar = {"times": [0.0, "10 s", "20 s"], "values": [1e-6, 1e-5, 1e-6]}
    columns: ClassVar = {"time": "times", "value": "values"}

    times: Numbers = declare(Series(Quantity("s", "times of the points", at_least=0), ascending=True))
    values: Numbers = declare(Series(Quantity(VARYING, "values at these times")))

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.times) != len(self.values):
            raise InputError(f"{type(self).__name__}: {len(self.times)} times but {len(self.values)} values")

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        points = list(zip(self.times, self.values, strict=True))
        straight = [Segment(t, v, (later - v) / (end - t)) for (t, v), (end, later) in pairwise(points)]
        before = [Segment(0.0, self.values[0], 0.0)] if self.times[0] > 0.0 else []
        return (*before, *straight, Segment(self.times[-1], self.values[-1], 0.0))
