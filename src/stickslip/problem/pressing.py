"""A normal load that varies, as the engine takes it: its growth since the start, as a share of the normal load there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem.drivers.segments import scaled
from stickslip.problem.loading_history import SILENT, Tone
from stickslip.problem.problem import Problem


class Pressing(NamedTuple):
    """A normal load that varies, as growth since the start, as a share of the normal load there (1)."""

    start: Floats  # s: when its straight parts begin
    value: Floats
    slope: Floats  # 1/s
    tone: Tone


def pressing_of(problem: Problem) -> Pressing:
    """Return the growth of a normal load; one part without growth if it is constant."""
    history = problem.normal_load
    if history is None:
        return Pressing(np.zeros(1), np.zeros(1), np.zeros(1), SILENT)
    (start, value, slope), tone = scaled(history, 1.0 / problem.normal)
    return Pressing(start, value - 1.0, slope, tone)
