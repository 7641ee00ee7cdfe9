"""The integral term of a position loop: a force that grows by ki e per second, with the lag e = r - u of slip behind the reference.

The load of the engine is what the contact would feel if it stayed where it is from now on: kp e, the integral, and the gain of the
derivative. On a piece of load at rest it is a cubic in time, with a tone if the reference has one. Slip q since the start of a step
takes kp q from it, as a spring does, and ki Q, with Q the integral of q over time; after the step q goes on to take ki q per second.
Pieces of load of a rigid body are straight in time (`State.bend` is 0).
"""

from __future__ import annotations

import math

from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel

SERIES_PASSES = (TERMS + 2) // 3
"""Number of passes (1) after which a series has all its terms: the integral of slip makes those of v three orders higher right."""


@kernel
def lag_at_start(run: Run, since: float) -> float:
    """Return the lag (m) where the present piece of load begins, a time `since` (s) after its segment of the loading began."""
    one, params = run.loading[run.counts.segment], run.params
    reference = one.pulled + since * (one.pull + 0.5 * since * one.pull_slope)
    if params.pull_tone != 0.0:
        half = 0.5 * params.tone_frequency * (run.counts.trip * params.round_trip_time + run.state.phase_from)
        reference += params.pull_tone * 2.0 / params.tone_frequency * math.sin(half) * math.sin(half + params.pull_phase)
    return params.first_lag + reference - run.state.slip_now


@kernel
def wind_up(run: Run, since: float) -> None:
    """Add to a piece of load what the integral term gains on it while the contact rests; `since` as in `lag_at_start`."""
    params, pace, one = run.params, run.state.speed, run.loading[run.counts.segment]
    run.load[1] += params.winding * pace * lag_at_start(run, since)
    run.load[2] += params.winding * pace * pace * 0.5 * (one.pull + one.pull_slope * since)
    run.load[3] += params.winding * pace * pace * pace * one.pull_slope / 6.0
    if params.pull_tone != 0.0:
        time = run.counts.trip * params.round_trip_time + run.state.phase_from
        turn = params.tone_frequency * pace
        tone_along(params.pull_tone, (params.tone_frequency * time + params.pull_phase, turn, 0.0), run.spare, run.trial)
        for k in range(2, TERMS):
            run.load[k] += params.winding * pace * pace * run.spare[k - 2] / (k * (k - 1))


@kernel
def feel_slip(run: Run, rate: Floats) -> None:
    """Write the load along slip (`load_ahead`) anew, less what slip at a rate (m/s, a series in its unit) takes of the integral."""
    taken, direction = run.params.winding * run.k.speed * run.k.speed, run.counts.mode
    for k in range(2, TERMS):
        run.load_along_slip[k] = direction * run.local[k] - taken * rate[k - 2] / (k * (k - 1))


@kernel
def unwind(run: Run, rate: Floats, duration: float, grown: float, to: float) -> None:
    """Take the integral of slip from the load of a step, and from the rest of the piece of load after it.

    The slip rate's magnitude `rate` (m/s) and the load in the next free row of the history are polynomials on the step, which lasts
    `duration` (s) and ends at xi = to. `grown` is the slip (m) in it.
    """
    load, pace, taken = run.history[run.counts.length].load, run.state.speed, run.counts.mode * run.params.winding
    whole = 0.0
    for k in range(TERMS - 1, -1, -1):
        part = rate[k] / ((k + 1) * (k + 2))
        whole += part
        if k + 2 < TERMS:
            load[k + 2] -= taken * duration * duration * part
    run.load[0] -= taken * (whole * duration * duration - grown * pace * to)
    run.load[1] -= taken * grown * pace
