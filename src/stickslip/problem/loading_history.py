"""What every loading history is: straight parts in time and at most one sinusoid; the kinds themselves are in `loading`."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import is_dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike
from typing_extensions import override

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import unit_among
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.foundation.quantities import NumberSeries, Quantity, check_fields, fields_of
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
    rests_before: ClassVar[bool] = False
    """True if the value is 0 before the start of the run, whatever it is at the start."""
    example: ClassVar[dict[str, Any]]
    """Plausible values of the fields, in the form of a scenario file."""

    is_recorded: ClassVar[bool] = False
    """True for samples of a recorder, which come from a file in a format of their own."""

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
                several = isinstance(declared, NumberSeries) and isinstance(value, list | tuple)
                yield from (value if any(map(_may_have_unit, set(map(type, value)))) else ()) if several else (value,)

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

    def __init_subclass__(cls, **other: Any) -> None:
        super().__init_subclass__(**other)
        if "segments" in vars(cls) and "parts" not in vars(cls):  # one that says its segments has no other parts
            cls.parts = LoadingHistory.parts  # type: ignore[method-assign]

    @cached_property
    def parts(self) -> Floats:
        """Starts (s), values and slopes (per second) of the straight parts, as the rows of an array that must not be changed.

        A history with very many parts gives them at once, in place of `segments`.
        """
        return fixed(np.array(self.segments, float).reshape(-1, 3).T)

    def check(self) -> None:
        """Raise InputError if a run cannot follow this history; only a subclass written by a user can fail."""
        name = type(self).__name__
        if not is_dataclass(self) or type(self).__hash__ is None or not hasattr(self, "kind"):
            raise InputError(f"{name}: a loading history must be a frozen dataclass with a kind")
        starts = self.parts[0]
        if not len(starts) or starts[0] != 0.0 or not (np.diff(starts) > 0.0).all():
            raise InputError(f"{name}: segments must begin with one at 0 s and ascend, got starts {ascii(starts.tolist())[:60]}")
        if not (np.isfinite(self.parts).all() and np.isfinite(self.tone).all() and self.tone.frequency > 0.0):
            raise InputError(f"{name}: segments and tone must be finite, and the tone's frequency above 0 rad/s")

    @property
    def first(self) -> float:
        """The value at 0 s."""
        return float(self.parts[1, 0]) + self.tone.amplitude * math.sin(self.tone.phase)

    @property
    def lowest(self) -> float:
        """A lower bound of the values: the least of the straight parts, less the amplitude of the sinusoid."""
        return float(min(self.parts[1].min(), self._at_ends.min())) - abs(self.tone.amplitude)

    @property
    def highest(self) -> float:
        """An upper bound of the values."""
        return float(max(self.parts[1].max(), self._at_ends.max())) + abs(self.tone.amplitude)

    @property
    def is_stepped(self) -> bool:
        """True if the value changes by jumps only."""
        return self.tone.amplitude == 0.0 and not self.parts[2].any()

    @property
    def _at_ends(self) -> Floats:
        """The values at the ends of the straight parts; the last lasts for ever, which counts only if the value changes."""
        start, value, slope = self.parts
        return np.append(value[:-1] + slope[:-1] * np.diff(start), value[-1] + slope[-1] * (math.inf if slope[-1] else 0.0))

    def at(self, t: ArrayLike) -> Floats:
        """Return the values of the history at times (s since the start of the run) of any shape.

        At a jump it is the value after the jump; before 0 s it is the value at 0 s.
        """
        time = np.maximum(np.asarray(t, float), 0.0)
        start, value, slope = self.parts
        n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
        amplitude, frequency, phase = self.tone
        return np.asarray(value[n] + slope[n] * (time - start[n]) + amplitude * np.sin(frequency * time + phase))


class InParts(LoadingHistory):
    """A history that gives its straight parts as an array, because they may be very many; its segments follow."""

    @property
    @abstractmethod
    def parts(self) -> Floats:
        """Starts (s), values and slopes (per second) of the straight parts, as for any history."""

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        return tuple(Segment(*one) for one in self.parts.T.tolist())


def fixed(array: Floats) -> Floats:
    """Return an array that nobody can change: the parts of a history are shared by all problems that have it."""
    array.flags.writeable = False
    return array


def _may_have_unit(kind: type) -> bool:
    return kind is not float and (issubclass(kind, str) or hasattr(kind, "magnitude"))
