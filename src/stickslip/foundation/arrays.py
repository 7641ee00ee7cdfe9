"""Arrays: their type for annotations, and what many members have in common."""

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Floats1 = Annotated[Floats, 1]
Floats2 = Annotated[Floats, 2]
Floats3 = Annotated[Floats, 3]
Floats4 = Annotated[Floats, 4]
Integers1 = Annotated[NDArray[np.int64], 1]
Integers2 = Annotated[NDArray[np.int64], 2]
Integers3 = Annotated[NDArray[np.int64], 3]
Flags1 = Annotated[NDArray[np.bool_], 1]
"""Arrays with their number of dimensions, which compiled code must know; their numbers lie without gaps, as in C."""


def everywhere(flags: Any) -> bool:
    """Return True if a flag is set, or all flags of many members; numpy takes fifty times as long for a single one."""
    return bool(np.all(flags) if isinstance(flags, np.ndarray) else flags)


def anywhere(flags: Any) -> bool:
    """Return True if a flag, or a number, is not 0, or any of those of many members; see `everywhere`."""
    return bool(np.any(flags) if isinstance(flags, np.ndarray) else flags)


def at_least(least: float, number: Any) -> Any:
    """Return the larger one of a bound and a number, or each of those of many members; a number that is NaN stays so."""
    return max(number, least) if isinstance(number, float) else np.maximum(number, least)


def shared(numbers: Any) -> Any:
    """Return a single number if all members have the same one, so that what depends on it is calculated only once."""
    found = np.asarray(numbers)
    return found.flat[0] if found.ndim and (found == found.flat[0]).all() else numbers
