"""Curves of a run as they are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from stickslip.evolution.solution import Solution

Name = Literal["slip", "slip_rate", "traction", "load"]
FLAT = 0.02
"""Stresses that vary by less than this share of their size are drawn as changes from the start."""


def curve(
    solution: Solution, name: Name, start: float = 0.0, end: float | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """`solution.curve`, with the state before the start in front where it is drawn from t = 0: a shock there is drawn too."""
    time, values = solution.curve(name, start, end)
    if start > 0.0:
        return time, values
    before = solution.slip(0.0) if name == "slip" else getattr(solution, name)(0.0, side="left")
    return np.concatenate(([0.0], time)), np.concatenate((np.atleast_1d(before), values))


def nearly_flat(*stresses: NDArray[np.float64]) -> bool:
    """Whether stresses vary so little that only their change can be seen."""
    together = np.concatenate(stresses)
    return bool(np.ptp(together) < FLAT * np.abs(together).max())
