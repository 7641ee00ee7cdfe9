"""Arrays: their type for annotations, and what many members have in common."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def shared(numbers: Any) -> Any:
    """Return a single number if all members have the same one, so that what depends on it is calculated only once."""
    found = np.asarray(numbers)
    return found.flat[0] if found.ndim and (found == found.flat[0]).all() else numbers
