"""The motion of the mass in the damper of a column over a whole run, from the waves that left the contact.

The equations are those of `engine.waves.damper`: y/Z is the velocity of the mass, and its acceleration is the force in the dashpot
over it. Every piece of the history is the wave that meets the damper h/c later. Times are seconds since the start of the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.history.machine_motion import MotionInParts, WavesLeft, parts_of, series_along
from stickslip.engine.history.series import horner
from stickslip.engine.state.layout import TERMS, Store
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, driver_of, tone_of


@dataclass(frozen=True, eq=False)
class DamperMotion(MotionInParts):
    """The velocity of the mass in parts of time."""

    def dissipated(self, begin: float, end: float) -> float:
        """Return the heat of the dashpot (J/m^2) between two times (s): the square of its force over its resistance."""
        body: Any = self.problem.body
        slopes = self.rate[:, 1:] * np.arange(1, TERMS)

        def squared(n: NDArray[np.intp], xi: Floats) -> Floats:
            return (horner(slopes[n], xi) / (self.speed[n] + 2.0 * self.bend[n] * xi)) ** 2

        return self.mass**2 / body.dashpot_of_damper * self.integrated(squared, begin, end)


def damper_motion(problem: Problem, store: Store, duration: float) -> DamperMotion:
    """Return the motion of the mass of a problem's column, to h/c after the end of a run.

    Raises InputError if the run has forgotten its first pieces.
    """
    body: Any = problem.body
    driver: Any = driver_of(problem)
    trip, pace = problem.round_trip_time, body.pace_of_damper
    parts = parts_of(problem, store, pace)
    gap = np.diff(parts.left, append=duration) - (parts.speed + parts.bend)
    rests = np.flatnonzero(gap > 1e-9 * trip)
    parts, first = parts.with_rests(rests, gap[rests]), body.impedance * driver.at_first(problem)[0]
    if store.trip[0] != 0 or store.phase_from[0] != 0.0:
        raise InputError("the motion of the damper of a column is not known in a part of a run that has forgotten what came before")
    arrives = parts.left + trip
    *straight, phasor = driver.joining(problem, arrives, arrives + 0.5 * (parts.speed + parts.bend))
    tone = np.abs(phasor), tone_of(problem).frequency, np.angle(phasor)
    met = parts.wave + body.impedance * series_along(straight, tone, arrives, parts)
    own, passed = _filtered(met, parts, pace), _filtered(np.zeros((1, TERMS)), parts, pace, 1.0)
    own[parts.rest], passed[parts.rest] = 0.0, 0.0
    starts, now = np.empty(len(own)), first
    for n, (grown, kept) in enumerate(zip(own.sum(axis=1).tolist(), passed.sum(axis=1).tolist(), strict=True)):
        starts[n], now = now, grown + kept * now
    rate = (own + starts[:, None] * passed) / body.impedance
    return DamperMotion(parts.left + 0.5 * trip, parts.speed, parts.bend, rate, body.mass_of_damper, problem)


def _filtered(met: Floats, parts: WavesLeft, pace: float, first: float = 0.0) -> Floats:
    """Return the series that passes the filter, beginning each part with the same value (Pa)."""
    met = np.broadcast_to(met, (len(parts.left), TERMS))
    slow, apart = np.zeros_like(met), np.zeros(len(met))
    slow[:, 0] = first
    for k in range(TERMS - 1):
        before, apart = apart, pace * (met[:, k] - slow[:, k])
        slow[:, k + 1] = (parts.speed * apart + 2.0 * parts.bend * before) / (k + 1)
    return slow
