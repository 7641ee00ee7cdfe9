"""Ground that moves under a body of layers: what the contact meets less, and what its waves carry more.

The layers move with the slip and with the ground: at the contact, whose mass is m, m d(v + v_g)/dt + Z (v + v_g) + tau = g, with g
what arrives, v the slip rate and v_g the velocity of the ground, a parabola and a tone between breaks. The load of the engine is
g - Z v_g - m dv_g/dt; the waves in the layers are those of the absolute motion, so that the ground acts nowhere else.
"""

from __future__ import annotations

from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.series.polynomial import fill
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel


@kernel
def shakes(run: Run) -> bool:
    """Return True if the ground under the layers moves at present."""
    return run.counts.varies == 1 and run.loading[run.counts.segment].shakes == 1.0


@kernel
def follow_ground(run: Run, phase: float, speed: float, bend: float) -> None:
    """Write the series of the ground's velocity, and of its acceleration times the contact's mass, on a piece from a phase (s) on.

    The phase is in the present round trip, and `speed` and `bend` (s) are those of the piece.
    """
    params, segment = run.params, run.loading[run.counts.segment]
    rate, push = run.ground_rate, run.ground_push
    fill(rate, 0.0)
    fill(push, 0.0)
    if segment.ground_tone != 0.0:
        frequency, now = params.tone_frequency, run.counts.trip * params.round_trip_time + phase
        angle = frequency * now + segment.ground_phase
        tone_along(segment.ground_tone, (angle, frequency * speed, 2.0 * frequency * bend), rate, push)
        for k in range(TERMS):
            push[k] *= params.inertia * frequency
    since = (run.counts.trip - segment.trip) * params.round_trip_time + (phase - segment.offset)
    curve = segment.ground_curve
    slope = segment.ground_slope + 2.0 * curve * since
    rate[0] += segment.ground + since * (segment.ground_slope + curve * since)
    rate[1] += slope * speed
    rate[2] += slope * bend + curve * speed * speed
    rate[3] += 2.0 * curve * speed * bend
    rate[4] += curve * bend * bend
    push[0] += params.inertia * slope
    push[1] += 2.0 * params.inertia * curve * speed
    push[2] += 2.0 * params.inertia * curve * bend


@kernel
def shake(run: Run) -> None:
    """Take what the ground needs off the piece of load."""
    follow_ground(run, run.state.phase_from, run.state.speed, run.state.bend)
    for k in range(TERMS):
        run.load[k] -= run.params.impedance * run.ground_rate[k] + run.ground_push[k]
