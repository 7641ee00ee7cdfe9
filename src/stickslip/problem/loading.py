"""Loading histories: what varies in time, in straight lines and at most one sinusoid.

It may be a pull rate, a far stress, a normal load, or the velocity or acceleration of the ground.

To add one, add its class to this file and to HISTORIES.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from typing_extensions import override

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import Number, Numbers, unit_among
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import MOST_SAMPLES, NumberSeries, Quantity, check_fields, declare, quantity
from stickslip.problem.loading_history import VARYING, InParts, LoadingHistory, Segment, Tone, fixed

WAY = "m or rad"
"""Unit of a position: m where something slides, rad where something turns."""


@dataclass(frozen=True)
class PiecewiseLinear(InParts):
    """A straight line from point to point, constant before the first point and after the last."""

    kind = "piecewise-linear"
    example: ClassVar = {"times": [0.0, "10 s", "20 s"], "values": [1e-6, 1e-5, 1e-6]}
    columns: ClassVar = {"time": "times", "value": "values"}

    times: Numbers = declare(NumberSeries(Quantity("s", "times of the points", at_least=0), ascending=True, most=MOST_SAMPLES))
    values: Numbers = declare(NumberSeries(Quantity(VARYING, "values at these times"), most=MOST_SAMPLES))

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.times) != len(self.values):
            raise InputError(f"{type(self).__name__}: {len(self.times)} times but {len(self.values)} values")

    @cached_property
    @override
    def parts(self) -> Floats:
        times, values = np.array(self.times, float), np.array(self.values, float)
        with np.errstate(over="ignore"):  # `check` refuses a slope that is not finite
            parts = np.array([times, values, np.append(np.diff(values) / np.diff(times), 0.0)])
        return fixed(parts if times[0] == 0.0 else np.insert(parts, 0, (0.0, values[0], 0.0), axis=1))


@dataclass(frozen=True)
class Steps(PiecewiseLinear):
    """Jumps to the next value at each given time, and constant values between them: one velocity step, or several."""

    kind = "steps"

    times: Numbers = declare(
        NumberSeries(Quantity("s", "times from which each value holds, the first 0", at_least=0), ascending=True, most=MOST_SAMPLES)
    )
    values: Numbers = declare(NumberSeries(Quantity(VARYING, "the values"), most=MOST_SAMPLES))

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.times[0] != 0.0:
            raise InputError(f"Steps: times must begin with 0, from which the first value holds, got {self.times[0]:g}")

    @cached_property
    @override
    def parts(self) -> Floats:
        return fixed(np.array([self.times, self.values, np.zeros(len(self.times))], float))


@dataclass(frozen=True)
class Waypoints(InParts):
    """The rate of a straight way from position to position, at rest before the first and after the last: a reference of an axis."""

    kind = "waypoints"
    rests_before = True
    example: ClassVar = {"times": [0.0, "1 s", "3 s"], "positions": [0.0, 0.01, 0.01]}
    columns: ClassVar = {"time": "times", "position": "positions"}
    unit = " or ".join(f"{one}/s" for one in WAY.split(" or "))

    times: Numbers = declare(
        NumberSeries(Quantity("s", "times of the positions", at_least=0), ascending=True, least=2, most=MOST_SAMPLES)
    )
    positions: Numbers = declare(NumberSeries(Quantity(WAY, "positions at these times"), least=2, most=MOST_SAMPLES))

    def __post_init__(self) -> None:
        if isinstance(self.positions, list | tuple):
            given = [unit for one in self.positions if (unit := unit_among(one, WAY))]
            if given:
                object.__setattr__(self, "unit", f"{given[0]}/s")
        check_fields(self)
        if len(self.times) != len(self.positions):
            raise InputError(f"Waypoints: {len(self.times)} times but {len(self.positions)} positions")

    @override
    def scaled(self, factor: float) -> Self:
        return replace(self, positions=tuple(factor * one for one in self.positions))

    @cached_property
    @override
    def parts(self) -> Floats:
        times, ways = np.array(self.times, float), np.array(self.positions, float)
        with np.errstate(over="ignore"):  # `check` refuses a rate that is not finite
            rates = np.append(np.diff(ways) / np.diff(times), 0.0)
        parts = np.array([times, rates, np.zeros(len(times))])
        return fixed(parts if times[0] == 0.0 else np.insert(parts, 0, 0.0, axis=1))


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


@dataclass(frozen=True)
class HoldAndSlide(LoadingHistory):
    """Slides of one duration at one value, with holds of given durations between them; the last slide lasts for ever."""

    kind = "hold-and-slide"
    source = "Dieterich 1972, J. Geophys. Res. 77, 3690-3697 (time-dependent friction in slide-hold-slide tests)"
    example: ClassVar = {"slide": 1e-6, "slide_time": "100 s", "hold_times": ["10 s", "100 s", "1000 s"]}

    slide: Number = quantity(VARYING, "value during a slide")
    slide_time: Number = quantity("s", "duration of the slide before each hold", above=0)
    hold_times: Numbers = declare(NumberSeries(Quantity("s", "duration of each hold", above=0), least=1))
    hold: Number = quantity(VARYING, "value during a hold", default=0.0)

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        time, found = 0.0, [Segment(0.0, self.slide, 0.0)]
        for lasting in self.hold_times:
            begin = time + self.slide_time
            time = begin + lasting
            found += [Segment(begin, self.hold, 0.0), Segment(time, self.slide, 0.0)]
        return tuple(found)


HISTORIES: dict[str, type[LoadingHistory]] = {
    history.kind: history for history in (PiecewiseLinear, Sinusoidal, Steps, Waypoints, HoldAndSlide)
}
"""Every built-in loading history by its name in scenario files."""
__all__ = [
    "HISTORIES",
    "VARYING",
    "HoldAndSlide",
    "LoadingHistory",
    "PiecewiseLinear",
    "Segment",
    "Sinusoidal",
    "Steps",
    "Tone",
    "Waypoints",
]
