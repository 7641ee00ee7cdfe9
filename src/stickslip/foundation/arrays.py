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


def shared(numbers: Any) -> Any:
    """Return a single number if all members have the same one, so that what depends on it is calculated only once."""
    found = np.asarray(numbers)
    return found.flat[0] if found.ndim and (found == found.flat[0]).all() else numbers
