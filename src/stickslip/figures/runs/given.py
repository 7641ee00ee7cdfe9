"""Loading histories as they are drawn."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem import MAY_VARY, LoadingHistory

if TYPE_CHECKING:
    from stickslip.problem import Problem

PERIODS = 60.0
"""A tone with more periods than this is drawn as a band of its amplitude: single periods could not be seen."""
POINTS_OF_TONE = 32
"""Points in a period of a tone, enough for a smooth line."""


def varying(problem: Problem) -> dict[str, LoadingHistory]:
    """Return the fields of a problem that vary in time, by name."""
    fields = {name: getattr(problem, name) for name in MAY_VARY}
    return {name: field for name, field in fields.items() if isinstance(field, LoadingHistory)}


def curve_of(history: LoadingHistory, start: float, end: float) -> tuple[Floats, Floats, float]:
    """Return times (s since t = 0) and values of a history between two times, with both limits at jumps, and half a band.

    The band is that of a tone of more periods than can be seen, which the values then leave out; else it is 0.
    """
    tone, swing = history.tone, abs(history.tone.amplitude)
    turns = (end - start) * tone.frequency / (2.0 * np.pi) if swing > 0.0 else 0.0
    if turns > PERIODS:
        return *_straight(history, start, end, 0.0), swing
    time, values = _straight(history, start, end, turns)
    return time, values + tone.amplitude * np.sin(tone.frequency * time + tone.phase), 0.0


def _straight(history: LoadingHistory, start: float, end: float, turns: float) -> tuple[Floats, Floats]:
    """Return times (s since t = 0) and values of the straight segments between two times, with both limits at jumps.

    The points are dense enough to add a tone that makes the given number of `turns` between the two times.
    """
    begins = history.parts[0, 1:]
    edges = [start, *begins[(start < begins) & (begins < end)].tolist(), end]
    first = int(np.searchsorted(begins, start, side="right"))
    parts = history.parts[:, first : first + len(edges) - 1].T.tolist()
    dense = [
        np.linspace(low, high, 2 + int(POINTS_OF_TONE * turns * (high - low) / (end - start))) for low, high in pairwise(edges)
    ]
    values = [value + slope * (time - begin) for (begin, value, slope), time in zip(parts, dense, strict=True)]
    return np.concatenate(dense), np.concatenate(values)
