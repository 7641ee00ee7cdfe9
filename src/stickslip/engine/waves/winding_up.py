"""The integral term of a position loop: a force that grows by ki e per second, with the lag e = r - u of slip behind the reference.

The load of the engine is what the contact would feel if it stayed where it is from now on: kp e, the integral, and the gain of the
derivative. On a piece of load at rest it is a cubic in time, with a tone if the reference has one. Slip then takes its share
(`contact.winding`).
"""

from __future__ import annotations

import math

from stickslip.engine.contact.pressing import tone_along
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel


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
