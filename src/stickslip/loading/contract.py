"""Define the base class of loading histories: a piecewise linear function of time, plus at most one sinusoid."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import is_dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.brief_repr import Declared, brief_repr
from stickslip.foundation.conversion import unit_among
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, Series, check_fields, fields_of

VARYING = "m/s or Pa"
"""Unit of the varying quantity: m/s for a pull rate, Pa for a far stress."""


class Segment(NamedTuple):
    """A straight part of a history from a time `start` (s) on: a value there (m/s or Pa), and its change per second.

    It lasts until the next segment or for ever.
    """

    start: float
    value: float
    slope: float

    def at(self, time: float) -> float:
        """Return the value (m/s or Pa) at a time (s since the start of the run)."""
        return self.value + self.slope * (time - self.start)


class Tone(NamedTuple):
    """A sinusoid amplitude (m/s or Pa) sin(frequency t + phase), of an angular frequency (rad/s) > 0, beside the segments."""

    amplitude: float
    frequency: float
    phase: float


SILENT = Tone(0.0, 1.0, 0.0)
"""The tone of a history without oscillation; its frequency of 1 rad/s has no effect, but a frequency must be positive."""


class LoadingHistory(Declared, ABC):
    """A pull rate (m/s) or far stress (Pa) as a function of time (s) since the start of the run.

    Before the start of the run the value is the one at the start. A run meets the breaking points of the history exactly.

    Subclass this to add a history. A subclass is a frozen dataclass with a `kind`. To be usable in scenario files and saved runs it
    also declares its fields with `quantity` or `declare`, has an `example`, and is listed in HISTORIES. Its fields and its `source`
    are added to its docstring.
    """

    kind: ClassVar[str]
    """Name of the history in scenario files and in HISTORIES."""
    example: ClassVar[dict[str, Any]]
    """Plausible values of the fields, in the form of a scenario file."""

    unit: str = VARYING
    """Unit of the values, "m/s" or "Pa", if they were given with one; plain numbers fit both."""

    def __post_init__(self) -> None:
        units = [unit for value in self._varying() if (unit := unit_among(value, VARYING))]
        object.__setattr__(self, "unit", units[0] if units else VARYING)
        check_fields(self, units={VARYING: self.unit})

    def _varying(self) -> Iterator[Any]:
        for name, (declared, _) in fields_of(type(self)).items():
            item, value = declared.item if isinstance(declared, Series) else declared, getattr(self, name)
            if isinstance(item, Quantity) and item.unit == VARYING:
                yield from value if isinstance(declared, Series) and isinstance(value, list | tuple) else (value,)

    def __repr__(self) -> str:
        return brief_repr(self, {VARYING: self.unit})

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
        """The value (m/s or Pa) at 0 s."""
        return self.segments[0].value + self.tone.amplitude * math.sin(self.tone.phase)

    def at(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the values (m/s or Pa) of the history at times (s since the start of the run) of any shape.

        At a jump it is the value after the jump; before 0 s it is the value at 0 s.
        """
        time = np.maximum(np.asarray(t, float), 0.0)
        start, value, slope = self._table
        n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
        amplitude, frequency, phase = self.tone
        return np.asarray(value[n] + slope[n] * (time - start[n]) + amplitude * np.sin(frequency * time + phase))
