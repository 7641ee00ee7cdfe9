"""Motion of the ground on which a body lies, from a loading history of its velocity or of its acceleration.

The ground is at rest before the start of a run. From then on it moves by pieces of cubics, and at most one sinusoid (tone) of the
velocity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.arrays import Floats
from stickslip.problem.loading_history import SILENT, LoadingHistory, Tone


@dataclass(frozen=True, eq=False)
class Ground:
    """Pieces of the ground's motion: what holds where each begins, without the tone, and the constant jerk on it."""

    start: Floats  # s: times at which the pieces begin, the first 0
    moved: Floats  # m
    velocity: Floats  # m/s
    acceleration: Floats  # m/s^2
    jerk: Floats  # m/s^3
    tone: Tone  # of the velocity, m/s

    @classmethod
    def of(cls, velocity: LoadingHistory | None, acceleration: LoadingHistory | None) -> Ground | None:
        """Return the motion that a history of velocity (m/s) or of acceleration (m/s^2) describes; None if there is neither."""
        if acceleration is not None:
            start, a, jerk = acceleration.parts
            size, frequency, phase = acceleration.tone
            lasting = np.diff(start)
            gained = lasting * (a[:-1] + 0.5 * jerk[:-1] * lasting)
            v = np.append(0.0, np.cumsum(gained)) + size / frequency * math.cos(phase)  # the tone's integral begins at 0
            tone = Tone(size / frequency, frequency, phase - 0.5 * math.pi)
        elif velocity is not None:
            start, v, a = velocity.parts
            jerk, tone = np.zeros(len(start)), velocity.tone
        else:
            return None
        lasting = np.diff(start)
        gained = lasting * (v[:-1] + lasting * (0.5 * a[:-1] + lasting * jerk[:-1] / 6.0))
        moved = np.append(0.0, np.cumsum(gained)) + tone.amplitude / tone.frequency * math.cos(tone.phase)
        return cls(start, moved, v, a, jerk, tone if tone.amplitude != 0.0 else SILENT)

    def displacement_at(self, t: ArrayLike) -> Floats:
        """Return how far the ground has moved since the start (m) at times (s) of any shape."""
        time, n, since = self._place(t)
        straight = self.moved[n] + since * (self.velocity[n] + since * (0.5 * self.acceleration[n] + since * self.jerk[n] / 6.0))
        amplitude, frequency, phase = self.tone
        return np.asarray(np.where(time < 0.0, 0.0, straight - amplitude / frequency * np.cos(frequency * time + phase)))

    def velocity_at(self, t: ArrayLike, inside: ArrayLike | None = None) -> Floats:
        """Return the velocity of the ground (m/s) at times (s) of any shape; at a jump it is the one after it.

        With `inside`, times inside intervals without a jump to which `t` belong, it is the limit in them.
        """
        time, n, since = self._place(t, inside)
        straight = self.velocity[n] + since * (self.acceleration[n] + 0.5 * since * self.jerk[n])
        amplitude, frequency, phase = self.tone
        return np.asarray(np.where(time < 0.0, 0.0, straight + amplitude * np.sin(frequency * time + phase)))

    def acceleration_at(self, t: ArrayLike, inside: ArrayLike | None = None) -> Floats:
        """Return the acceleration of the ground (m/s^2) at times (s) of any shape; `inside` is as for `velocity_at`."""
        time, n, since = self._place(t, inside)
        amplitude, frequency, phase = self.tone
        swing = amplitude * frequency * np.cos(frequency * time + phase)
        return np.asarray(np.where(time < 0.0, 0.0, self.acceleration[n] + since * self.jerk[n] + swing))

    @property
    def velocity_jumps(self) -> bool:
        """True if the velocity jumps, at the start or later."""
        first = self.velocity[0] + self.tone.amplitude * math.sin(self.tone.phase)
        lasting = np.diff(self.start)
        ends = self.velocity[:-1] + lasting * (self.acceleration[:-1] + 0.5 * self.jerk[:-1] * lasting)
        scale = np.abs(self.velocity).max() + abs(self.tone.amplitude)
        return bool(abs(first) > NO_JUMP_OF_GROUND * scale or (np.abs(self.velocity[1:] - ends) > NO_JUMP_OF_GROUND * scale).any())

    def _place(self, t: ArrayLike, inside: ArrayLike | None = None) -> tuple[Floats, NDArray[np.intp], Floats]:
        time = np.asarray(t, float)
        n = np.maximum(np.searchsorted(self.start, time if inside is None else inside, side="right") - 1, 0)
        return time, n, time - self.start[n]


NO_JUMP_OF_GROUND = 1e-12
"""A change of the ground's velocity below this share of the largest one (1) is rounding and no jump."""
