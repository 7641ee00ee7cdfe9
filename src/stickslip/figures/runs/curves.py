"""The curves of a run that are drawn, and the test for stresses that hardly change."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Name = Literal["slip", "slip_rate", "traction", "load"]
"""Names of the curves, as `Solution.curve` takes them."""
FLAT = 0.02
"""Stresses whose range is less than this share of their largest magnitude are drawn as changes: else the line looks flat."""


def nearly_flat(*stresses: NDArray[np.float64]) -> bool:
    """Return True if stresses, taken together, vary so little that only their change can be seen in a figure."""
    together = np.concatenate(stresses)
    return bool(np.ptp(together) < FLAT * np.abs(together).max())
