"""Loading histories: what varies in time, in straight lines and at most one sinusoid.

It may be a pull rate, a far stress, a normal load, or the velocity or acceleration of the ground.

To add one, add its class to this file and to HISTORIES.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, is_dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number, Numbers, unit_among
from stickslip.foundation.errors import InputError
from stickslip.foundation.lazy_names import other_names
from stickslip.foundation.names import si_unit
from stickslip.foundation.quantities import NumberSeries, Quantity, check_fields, declare, fields_of, quantity
from stickslip.foundation.show import Declared, brief_repr

VARYING = f"{si_unit('slip_rate')} or {si_unit('slip_acceleration')} or {si_unit('load')}"
"""Unit of the varying quantity: m/s or rad/s for a pull rate or a velocity of the ground, m/s^2 or rad/s^2 for its acceleration,
and Pa, N or N m for a far stress or a normal load.
"""


class Segment(NamedTuple):
    """A straight part of a history from a time `start` (s) on: a value there, and its change per second.

    It lasts until the next segment or for ever.
    """

    start: float
    value: float
    slope: float

    def at(self, time: float) -> float:
        """Return the value at a time (s since the start of the run)."""
        return self.value + self.slope * (time - self.start)


class Tone(NamedTuple):
    """A sinusoid amplitude (in the unit of the values) sin(frequency t + phase), of an angular frequency (rad/s) > 0."""

    amplitude: float
    frequency: float
    phase: float


SILENT = Tone(0.0, 1.0, 0.0)
"""The tone of a history without oscillation; its frequency of 1 rad/s has no effect, but a frequency must be positive."""


class LoadingHistory(Declared, ABC):
    """A pull rate, far stress, normal load or motion of the ground as a function of time (s) since the start of the run.

    The values are in m/s or rad/s, m/s^2 or rad/s^2, Pa, N or N m: see `unit`. Before the start of the run the value is the one at
    the start. A run meets the breaking points of the history exactly.

    Subclass this to add a history. A subclass is a frozen dataclass with a `kind`. To be usable in scenario files and saved runs it
    also declares its fields with `quantity` or `declare`, has an `example`, and is listed in HISTORIES. Its fields and its `source`
    are added to its docstring.
    """

    kind: ClassVar[str]
    """Name of the history in scenario files and in HISTORIES."""
    example: ClassVar[dict[str, Any]]
    """Plausible values of the fields, in the form of a scenario file."""

    unit: str = VARYING
    """Unit of the values, such as "m/s" or "Pa", if they were given with one; plain numbers fit all."""

    def __post_init__(self) -> None:
        units = [unit for value in self._varying() if (unit := unit_among(value, VARYING))]
        object.__setattr__(self, "unit", units[0] if units else VARYING)
        check_fields(self, units={VARYING: self.unit})

    def _varying(self) -> Iterator[Any]:
        for name, (declared, _) in fields_of(type(self)).items():
            item, value = declared.item if isinstance(declared, NumberSeries) else declared, getattr(self, name)
            if isinstance(item, Quantity) and item.unit == VARYING:
                yield from value if isinstance(declared, NumberSeries) and isinstance(value, list | tuple) else (value,)

    def __repr__(self) -> str:
        return brief_repr(self, {VARYING: self.unit})

    def scaled(self, factor: float) -> Self:
        """Return the history with all its values times a factor; they are plain numbers then, without a unit."""
        fields: dict[str, Any] = {}
        for name, (declared, _) in fields_of(type(self)).items():
            one = getattr(self, name)
            if isinstance(declared, NumberSeries) and declared.item.unit == VARYING:
                fields[name] = tuple(factor * x for x in one)
            elif isinstance(declared, Quantity) and declared.unit == VARYING:
                fields[name] = factor * one
        return replace(self, **fields)  # type: ignore[type-var] # every history is a dataclass

    def in_unit(self, unit: str) -> Self:
        """Return the history with its values, which are plain numbers, taken to be in a unit."""
        found = replace(self)  # type: ignore[type-var] # every history is a dataclass
        object.__setattr__(found, "unit", unit)
        return found

    @property
    @abstractmethod
    def segments(self) -> tuple[Segment, ...]:
        """The straight parts in ascending order of time; the first begins at 0 s."""

    @property
    def tone(self) -> Tone:
        """The sinusoid that is added to the segments; by default its amplitude is 0."""
        return SILENT

    def check(self) -> None:
        """Raise InputError if a run cannot follow this history; only a subclass written by a user can fail."""
        name, starts = type(self).__name__, [one.start for one in self.segments]
        if not is_dataclass(self) or type(self).__hash__ is None or not hasattr(self, "kind"):
            raise InputError(f"{name}: a loading history must be a frozen dataclass with a kind")
        if not starts or starts[0] != 0.0 or any(not one < following for one, following in pairwise(starts)):
            raise InputError(f"{name}: segments must begin with one at 0 s and ascend, got starts {ascii(starts)[:60]}")
        if not np.isfinite([*self.segments, self.tone]).all() or not self.tone.frequency > 0.0:
            raise InputError(f"{name}: segments and tone must be finite, and the tone's frequency above 0 rad/s")

    @cached_property
    def _table(self) -> NDArray[np.float64]:
        return np.array(self.segments).T

    @property
    def first(self) -> float:
        """The value at 0 s."""
        return self.segments[0].value + self.tone.amplitude * math.sin(self.tone.phase)

    @property
    def lowest(self) -> float:
        """A lower bound of the values: the least of the straight parts, less the amplitude of the sinusoid."""
        ends = (one.at(end) for one, end in zip(self.segments, self._ends, strict=True))
        return min(*(one.value for one in self.segments), *ends) - abs(self.tone.amplitude)

    @property
    def highest(self) -> float:
        """An upper bound of the values."""
        ends = (one.at(end) for one, end in zip(self.segments, self._ends, strict=True))
        return max(*(one.value for one in self.segments), *ends) + abs(self.tone.amplitude)

    @property
    def is_stepped(self) -> bool:
        """True if the value changes by jumps only."""
        return self.tone.amplitude == 0.0 and all(one.slope == 0.0 for one in self.segments)

    @property
    def _ends(self) -> list[float]:
        """The times (s) at which the straight parts end; for ever counts only if the value changes."""
        return [*(one.start for one in self.segments[1:]), math.inf if self.segments[-1].slope else self.segments[-1].start]

    def at(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the values of the history at times (s since the start of the run) of any shape.

        At a jump it is the value after the jump; before 0 s it is the value at 0 s.
        """
        time = np.maximum(np.asarray(t, float), 0.0)
        start, value, slope = self._table
        n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
        amplitude, frequency, phase = self.tone
        return np.asarray(value[n] + slope[n] * (time - start[n]) + amplitude * np.sin(frequency * time + phase))


@dataclass(frozen=True)
class PiecewiseLinear(LoadingHistory):
    """A straight line from point to point, constant before the first point and after the last."""

    kind = "piecewise-linear"
    example: ClassVar = {"times": [0.0, "10 s", "20 s"], "values": [1e-6, 1e-5, 1e-6]}
    columns: ClassVar = {"time": "times", "value": "values"}

    times: Numbers = declare(NumberSeries(Quantity("s", "times of the points", at_least=0), ascending=True))
    values: Numbers = declare(NumberSeries(Quantity(VARYING, "values at these times")))

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


@dataclass(frozen=True)
class Steps(PiecewiseLinear):
    """Jumps to the next value at each given time, and constant values between them: one velocity step, or several."""

    kind = "steps"

    times: Numbers = declare(
        NumberSeries(Quantity("s", "times from which each value holds, the first 0", at_least=0), ascending=True)
    )
    values: Numbers = declare(NumberSeries(Quantity(VARYING, "the values")))

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.times[0] != 0.0:
            raise InputError(f"Steps: times must begin with 0, from which the first value holds, got {self.times[0]:g}")

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        return tuple(Segment(time, value, 0.0) for time, value in zip(self.times, self.values, strict=True))


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
    history.kind: history for history in (PiecewiseLinear, Sinusoidal, Steps, HoldAndSlide)
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
]

if not TYPE_CHECKING:  # with it, type checkers would accept any name
    __getattr__ = other_names(__name__)
