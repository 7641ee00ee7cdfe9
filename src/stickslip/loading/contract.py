"""What every loading history has in common: a value that runs straight from break to break, and at most one tone on top of it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import is_dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.friction.parameters import check_fields

VARYING = "m/s or Pa"
"""Unit of what varies: m/s for a pull rate, Pa for a far stress."""


class Segment(NamedTuple):
    """From a time (s) on: a value there and its slope (in a second), up to the next segment or for ever."""

    start: float
    value: float
    slope: float

    def at(self, time: float) -> float:
        """The value at a time (s)."""
        return self.value + self.slope * (time - self.start)


class Tone(NamedTuple):
    """amplitude sin(frequency t + phase), with the frequency in rad/s."""

    amplitude: float
    frequency: float
    phase: float


SILENT = Tone(0.0, 1.0, 0.0)


class LoadingHistory(ABC):
    """A pull rate (m/s) or far stress (Pa) as a function of time (s) since the start of the run.

    Before the start it was what it is there. Its breaking points are met exactly. A subclass is a frozen dataclass with a `kind`;
    for scenario files and saved runs its fields are declared as those here are, it has an `example`, and it stands in HISTORIES.
    """

    kind: ClassVar[str]
    example: ClassVar[dict[str, Any]]

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    @abstractmethod
    def segments(self) -> tuple[Segment, ...]:
        """The straight parts, the first from 0 s on."""

    @property
    def tone(self) -> Tone:
        """What swings on top of them; silent by default."""
        return SILENT

    def check(self) -> None:
        """Raises InputError where it cannot be followed: only one of your own can fail."""
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

    def at(self, t: ArrayLike) -> NDArray[np.float64]:
        """The value at times t (s); behind a jump where t is at it, that of the start before 0 s."""
        time = np.maximum(np.asarray(t, float), 0.0)
        start, value, slope = self._table
        n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
        amplitude, frequency, phase = self.tone
        return np.asarray(value[n] + slope[n] * (time - start[n]) + amplitude * np.sin(frequency * time + phase))
