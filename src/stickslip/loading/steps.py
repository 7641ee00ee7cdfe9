"""Define a loading history of jumps between constant values, such as velocity steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.friction.parameters import Series, declare
from stickslip.loading.contract import VARYING, LoadingHistory, Segment


@dataclass(frozen=True)
class Steps(LoadingHistory):
    """Jumps to the next value at each given time, and constant values between them: one velocity step, or several.

    Parameters
    ----------
    times
        Times from which each value holds (s since the start of the run), ascending from 0, shape (n,) with n >= 2.
    values
        Values from these times on (m/s or Pa), shape (n,).

    Raises
    ------
    InputError
        If the numbers of times and values differ, or the times do not begin with 0 and ascend.
    """

    kind: ClassVar[str] = "steps"
    example: ClassVar[dict[str, Any]] = {"times": [0.0, "10 s", "20 s"], "values": [1e-6, 1e-5, 1e-6]}
    columns: ClassVar[dict[str, str]] = {"time": "times", "value": "values"}

    times: tuple[float, ...] = declare(
        Series(Quantity("s", "times from which each value holds, the first 0", at_least=0), ascending=True)
    )
    values: tuple[float, ...] = declare(Series(Quantity(VARYING, "the values")))

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.times) != len(self.values):
            raise InputError(f"Steps: {len(self.times)} times but {len(self.values)} values")
        if self.times[0] != 0.0:
            raise InputError(f"Steps: times must begin with 0, from which the first value holds, got {self.times[0]:g}")

    @property
    def segments(self) -> tuple[Segment, ...]:
        return tuple(Segment(time, value, 0.0) for time, value in zip(self.times, self.values, strict=True))
