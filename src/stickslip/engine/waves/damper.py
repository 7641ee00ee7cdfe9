"""The damper of a column: a filter in the way of each wave that the free top sends back (`problem.drivers.damper`).

What meets it is x, the wave that left the contact with what joins it. It sends back r x + (1 - r) y, with dy/dt = q (x - y): the
series of x gives that of y term by term. A piece of load is cut so that q dt is at most 1 on it, and then until the first term that
the series of y leaves out is within the tolerance; the sum of those that follow is at most that over 1 - q dt / (TERMS + 1).
"""

from __future__ import annotations

import math

from stickslip.engine.series.polynomial import RECIPROCAL, total
from stickslip.engine.state.layout import TERMS
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.shaken_ladder import follow_ground
from stickslip.engine.waves.varying_forcing import add_loading, shorten
from stickslip.foundation.kernels.kernels import kernel

HALVINGS = 60
"""Halve a piece of load at most this many times (1)."""


@kernel
def damp(run: Run) -> float:
    """Replace a wave that has come back whole by what the damper sends, add the inflow, and return the share of it that is kept."""
    params, state, counts = run.params, run.state, run.counts
    if counts.trip == 0 and state.phase_from < 0.5 * params.round_trip_time:
        add_loading(run)  # the top is not heard yet, but the ground is
        return 1.0
    if counts.driver_trip < counts.trip:
        counts.driver_trip, state.driver_swing = counts.trip, 0.0
    share = 1.0 / max(math.ceil(params.damper_pace * (abs(state.speed) + 2.0 * abs(state.bend))), 1.0)
    shorten(run, share)
    for _ in range(HALVINGS):
        if passes_filter(run):
            break
        share *= 0.5
        shorten(run, 0.5)
    kept, met, slow, swing = params.damper_share, run.machine_force, run.machine_rate, 0.0
    for k in range(TERMS):
        swing += abs(met[k]) + abs(slow[k])
        run.load[k] = kept * run.load[k] + (1.0 - kept) * slow[k]
    state.driver_rate = total(slow) / params.impedance
    state.driver_swing = max(state.driver_swing, 0.5 * swing / params.impedance)
    add_loading(run)
    return share


@kernel
def passes_filter(run: Run) -> bool:
    """Write the series of the wave that meets the filter, and of the one that passes; return False if the latter ends too early."""
    params, speed, bend = run.params, run.state.speed, 2.0 * run.state.bend
    met, slow, load = run.machine_force, run.machine_rate, run.load
    follow_ground(run, run.state.phase_from, speed, run.state.bend)
    slow[0] = params.impedance * run.state.driver_rate
    before = apart = changes = 0.0
    for k in range(TERMS):
        met[k] = load[k] + params.impedance * run.ground_rate[k]
        before, apart = apart, params.damper_pace * (met[k] - slow[k])
        grown = RECIPROCAL[k + 1] * (speed * apart + bend * before)
        changes += abs(met[k]) + abs(slow[k]) if k > 0 else abs(grown)
        if k + 1 < TERMS:
            slow[k + 1] = grown
    along = params.damper_pace * (abs(speed) + abs(bend)) / (TERMS + 1)
    return abs(grown) <= (1.0 - along) * params.tolerance * changes
