"""Where two runs may be compared: away from the shocks."""

from __future__ import annotations

import numpy as np

import stickslip as ss


def away_from_jumps(run: ss.Solution, times: np.ndarray) -> np.ndarray:
    """Return which times are not within a hair of a shock, where the two may stand on different sides."""
    shocks = run.shocks.time.to_numpy()
    if len(shocks) == 0:
        return np.ones(len(times), bool)
    return np.abs(times[:, None] - shocks).min(axis=1) > 1e-6 * run.duration
