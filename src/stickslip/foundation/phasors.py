"""Sums of phasors: what a sinusoid gathers over many round trips."""

from __future__ import annotations

import math

from stickslip.foundation.kernels.kernels import entry


@entry
def dirichlet(count: float, step: float) -> float:
    """Return the sum of `count` unit phasors that are `step` (rad) apart, along their mean: sin(count step/2) / sin(step/2)."""
    turns = math.floor(step / (2.0 * math.pi) + 0.5)
    rest = 0.5 * step - turns * math.pi  # in [-pi/2, pi/2]
    value = count if rest == 0.0 else math.sin(count * rest) / math.sin(rest)
    return -value if (turns * (count - 1.0)) % 2.0 == 1.0 else value
