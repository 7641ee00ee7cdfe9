"""The record of an accelerometer as a loading history: samples at even times, as its file has them."""

from __future__ import annotations

from collections import ChainMap
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from typing_extensions import override

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.conversion import Number, Numbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.foundation.quantities import MOST_SAMPLES, NumberSeries, Quantity, Text, declare, quantity
from stickslip.foundation.show import brief
from stickslip.problem.loading import HISTORIES
from stickslip.problem.loading_history import InParts, LoadingHistory, fixed

LONGEST_ORIGIN = 300
"""Largest number of characters of what a record says of its file."""
ACCELERATION = si_unit("slip_acceleration").partition(" or ")[0]
"""Unit of the samples: the ground under a record does not turn."""


@dataclass(frozen=True)
class Accelerogram(InParts):
    """Acceleration of the ground as it was recorded: a straight line from sample to sample, and 0 after the last one.

    The ground keeps the velocity that it has at the end. What counts is polarity times scale times (values less offset): a load on
    a block gains -m times that, so that with polarity 1 a positive acceleration slides the block backwards.
    """

    kind = "accelerogram"
    example: ClassVar = {"values": [0.0, "0.1 g", "-0.2 g", "0.05 g", 0.0], "interval": "0.01 s"}
    columns: ClassVar = {"time": "times", "value": "values"}
    is_recorded: ClassVar[bool] = True

    values: Numbers = declare(NumberSeries(Quantity(ACCELERATION, "samples"), most=MOST_SAMPLES, sampled=True))
    interval: Number = quantity("s", "time between two samples", above=0)
    scale: Number = quantity("1", "factor on the samples", above=0, default=1.0)
    polarity: Number = quantity("1", "1 as recorded, -1 for the opposite direction", whole=True, default=1.0)
    offset: Number = quantity(ACCELERATION, "what is taken off each sample, as an instrument's offset", default=0.0)
    origin: str = declare(Text("the file that it comes from, and what that says", LONGEST_ORIGIN), "")

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "unit", ACCELERATION)
        if abs(self.polarity) != 1.0:
            raise InputError(f"Accelerogram: polarity must be 1 or -1, got {self.polarity:g}")

    @cached_property
    def samples(self) -> Floats:
        """The acceleration (m/s^2) that counts at each sample: an array that must not be changed."""
        return fixed(self.polarity * self.scale * (np.array(self.values, float) - self.offset))

    @property
    def duration(self) -> float:
        """The time (s) from the first sample to the last."""
        return (len(self.values) - 1) * self.interval

    @property
    def about(self) -> str:
        """How many samples it has, how far apart, and the largest, in words."""
        peak = brief(float(np.abs(self.samples).max()) / GRAVITY, "g", 4)
        return f"{len(self.values)} samples every {brief(self.interval, 's')}, {peak} at most"

    @override
    def scaled(self, factor: float) -> Self:
        return replace(self, scale=self.scale * abs(factor), polarity=self.polarity * (1.0 if factor > 0.0 else -1.0))

    @cached_property
    @override
    def parts(self) -> Floats:
        values = self.samples
        begins, slopes = np.append(values[:-1], 0.0), np.append(np.diff(values) / self.interval, 0.0)
        return fixed(np.array([self.interval * np.arange(len(values)), begins, slopes]))


ALL_HISTORIES: ChainMap[str, type[LoadingHistory]] = ChainMap(HISTORIES, {Accelerogram.kind: Accelerogram})
"""Every history that a scenario file may have, those of users in HISTORIES too."""
