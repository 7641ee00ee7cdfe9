"""Define a loading history of jumps between constant values, such as velocity steps."""

from dataclasses import dataclass

from typing_extensions import override

from stickslip.foundation.conversion import Numbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, Series, declare
from stickslip.loading.contract import VARYING, Segment
from stickslip.loading.piecewise_linear import PiecewiseLinear


@dataclass(frozen=True)
class Steps(PiecewiseLinear):
    """Jumps to the next value at each given time, and constant values between them: one velocity step, or several."""

    kind = "steps"

    times: Numbers = declare(Series(Quantity("s", "times from which each value holds, the first 0", at_least=0), ascending=True))
    values: Numbers = declare(Series(Quantity(VARYING, "the values")))

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.times[0] != 0.0:
            raise InputError(f"Steps: times must begin with 0, from which the first value holds, got {self.times[0]:g}")

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        return tuple(Segment(time, value, 0.0) for time, value in zip(self.times, self.values, strict=True))
