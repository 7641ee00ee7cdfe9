"""The load of the first round trip, as a table of straight pieces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import FirstLoad


def pieces_of(phase: Sequence[Any], load: Sequence[Any], slope: Sequence[Any], jump: Sequence[Any] | None = None) -> at.Floats:
    """Return a table of `FirstLoad`, or one for each member of a batch, from the edges of the pieces and from their numbers."""
    numbers = together([*phase, *load, 0.0, *slope, 0.0, *(jump or [0.0] * len(load)), 0.0])
    fields = numbers.reshape(FirstLoad.total, len(phase), *numbers.shape[1:])
    return np.ascontiguousarray(fields.transpose(*range(2, fields.ndim), 1, 0))


def together(numbers: Sequence[Any]) -> at.Floats:
    """Return one table of numbers; it has a column for each member if any of them is an array."""
    if np.ndarray in set(map(type, numbers)) and any(map(np.ndim, numbers)):
        return np.stack([np.asarray(number, float) for number in np.broadcast_arrays(*numbers)])
    return np.array(numbers, float)
