"""Motions that tests make: none is a record of an earthquake."""

from __future__ import annotations

from functools import cache

import numpy as np

from stickslip.extensions.strong_motion.motion import GroundMotion


@cache
def made_motion(name: str = "made", scale: float = 1.0, frequency: float = 1.3) -> GroundMotion:
    """Return a motion of 10 s, 1001 samples, whose two polarities differ, with a peak of about 0.3 g times a scale."""
    time = 0.01 * np.arange(1001)
    swings = np.sin(2.0 * np.pi * frequency * time) + 0.4 * np.sin(2.0 * np.pi * 2.9 * time + 1.0)
    return GroundMotion(name, scale * 2.3 * np.sin(np.pi * time / 10.0) ** 2 * swings, 0.01)
