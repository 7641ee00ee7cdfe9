"""A mass that hangs on the free top of a column through a dashpot, and damps its modes (`bodies.uniform.hysteretic`).

Let w = 2 Z v - beta be the wave that meets the top, with v absolute where the ground moves, and s the far stress. The top sends

    beta - s = r (w + s) + (1 - r) y,    dy/dt = q (w + s - y),    r = (Z - D) / (Z + D),    q = (Z D / mass) / (Z + D)

back: a share of the wave that comes, and what a filter of gain 1 lets pass. y/Z is the velocity of the mass. In the load of the
engine, whose v is relative to the ground, w is less by Z times the velocity of the ground one round trip ago. That and s are known
beforehand; they join what comes before it meets the filter.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import DEAD_LOAD
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.driver import inflow_of
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.lossy import LossyDriver
from stickslip.problem.problem import Problem


class DamperOfColumn(LossyDriver):
    """What a damper answers. Its inflow is what a free top sends that takes the share 1 - r of each wave away at once."""

    moves: ClassVar[bool] = True
    missing_for_leaps: ClassVar[str] = "a column that is not damped (damping_ratio 0)"

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return D s / (s + D/mass): that of a mass for slow motion, of a dashpot for fast motion."""
        column: Any = body
        dashpot, mass = column.dashpot_of_damper, column.mass_of_damper
        return DriverImpedance(np.array([0.0, dashpot * mass]), np.array([dashpot, mass]))

    def at_first(self, problem: Problem) -> tuple[float, float]:
        """Return the velocity of the mass (m/s) at the start, at which the top moves."""
        return problem.first_pull_rate, 0.0

    def first_share(self, problem: Problem, phases: Floats) -> Floats:
        """Return 1: the engine filters the wave itself."""
        return np.ones(len(phases))

    def first_sent(self, problem: Problem, time: float) -> float:
        """Return what comes beside all of the wave (Pa)."""
        body, r = problem.body, problem.body.reflection
        met = body.meets_driver_at_first(problem.excess, problem.rate, problem.initial_shear)
        mass = body.impedance * self.at_first(problem)[0]
        return float(inflow_of(problem).at(np.array(time)) + (1.0 - r) * (mass - met))

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return its pace and the share of a front that it sends back."""
        body: Any = problem.body
        return {"reflection": DEAD_LOAD, "damper_pace": body.pace_of_damper, "damper_share": body.reflection}

    def joining(self, problem: Problem, start: Floats, middle: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return what joins the waves before the filter, over Z (m/s), where they arrive at the contact at times (s).

        It is value, slope and curve at each time `start` of a parabola, and the phasor of a sinusoid, which hold at the time
        `middle`: the far stress over Z, and the velocity of the ground one round trip before.
        """
        body, trip, sent, ground = problem.body, problem.round_trip_time, inflow_of(problem), problem.ground
        n, whole = sent.segment(middle), (1.0 + body.reflection) * body.impedance
        value, slope = (sent.value[n] + sent.slope[n] * (start - sent.start[n])) / whole, sent.slope[n] / whole
        phasor, curve = sent.gain[n] * sent.tone.amplitude / whole * np.exp(1j * sent.tone.phase), np.zeros(len(start))
        if ground is not None:
            k = np.maximum(np.searchsorted(ground.start, middle - trip, side="right") - 1, 0)
            moves, since = middle >= trip, start - trip - ground.start[k]
            faster, jerk, tone = ground.acceleration[k], ground.jerk[k], ground.tone
            value = value + np.where(moves, ground.velocity[k] + since * (faster + 0.5 * since * jerk), 0.0)
            slope, curve = slope + np.where(moves, faster + since * jerk, 0.0), np.where(moves, 0.5 * jerk, 0.0)
            phasor = phasor + np.where(moves, tone.amplitude * np.exp(1j * (tone.phase - tone.frequency * trip)), 0.0)
        return value, slope, curve, phasor

    def put(self, problem: Problem, segments: Any, start: Floats, middle: Floats) -> None:
        """Write what joins the waves, as a velocity of the ground, and that waves come to the filter whole."""
        value, slope, curve, phasor = self.joining(problem, start, middle)
        segments.ground, segments.ground_slope, segments.ground_curve = value, slope, curve
        segments.ground_tone, segments.ground_phase = np.abs(phasor), np.angle(phasor)
        segments.reflection = DEAD_LOAD

    def changes_within(self, problem: Problem) -> float:
        """Return how long (s) the filter takes to answer."""
        body: Any = problem.body
        return 1.0 / float(body.pace_of_damper)


ANSWERS = DamperOfColumn()
