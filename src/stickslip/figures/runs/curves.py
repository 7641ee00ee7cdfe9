"""What is drawn of a run, and how stresses that hardly change are shown."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Name = Literal["slip", "slip_rate", "traction", "load"]
FLAT = 0.02
"""Stresses that vary by less than this share of their size are drawn as changes from the start."""


def nearly_flat(*stresses: NDArray[np.float64]) -> bool:
    """Whether stresses vary so little that only their change can be seen."""
    together = np.concatenate(stresses)
    return bool(np.ptp(together) < FLAT * np.abs(together).max())
