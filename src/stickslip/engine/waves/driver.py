"""A driver that is a machine: a mass with a proportional and an integral gain, which the waves of the slab move.

    M dVd/dt = kp (V0 - Vd) + q + s - sigma,    dq/dt = ki (V0 - Vd),    sigma = Z Vd - w

w = 2 Z v - beta is the wave that left the contact h/c ago, s the far stress. What the machine sends is the load at the contact h/c
later, beta = 2 Z Vd - w. The equations are linear with constant coefficients, so that the wave's polynomial gives the Taylor
series of Vd and of q term by term. The series of a piece of load ends with its last term K; the sum of what it leaves out is at
most the next term over 1 - A / (K + 2), where A = ((kp + Z) / M + sqrt(ki / M)) dt, or ki dt / (kp + Z) without mass, is kept
below 1. Where the load would be off by more than the tolerance, the piece of load is cut.

Behind layers, w is the wave that left the last cell, the driver is an even number of cells away from the contact, and what it sends
joins the waves in the last cell at once. Its rate goes with the rows of waves, as if it were a cell beyond the last one.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.pressing import tone_series
from stickslip.engine.series.polynomial import RECIPROCAL, copy, total
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.damper import damp
from stickslip.engine.waves.driver_at_rest import settled_rate
from stickslip.engine.waves.varying_forcing import shorten
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead

HALVINGS_OF_LOAD = 60
"""Halve a piece of load at most this many times (1)."""


@kernel
def drive(run: Run) -> float:
    """Add what the machine sends to the wave that a rigid driver would send back; return the share of the piece that is kept."""
    if run.params.damper_pace > 0.0:
        return damp(run)
    leap(run)
    pace, met, doubled = pace_of(run), wave_at_driver(run), 2.0 * impedance_at_driver(run)
    share = 1.0 / max(math.ceil(pace * (abs(run.state.speed) + 2.0 * abs(run.state.bend))), 1.0)
    shorten(run, share)
    for _ in range(HALVINGS_OF_LOAD):
        force_machine(run)
        if move_machine(run, pace):
            break
        share *= 0.5
        shorten(run, 0.5)
    settled, swing = settled_rate(run, run.counts.segment), 0.0
    for k in range(TERMS):
        met[k] += doubled * run.machine_rate[k]
        swing += abs(run.machine_rate[k] - (settled if k == 0 else 0.0))
    run.state.driver_swing = max(run.state.driver_swing, swing)
    run.state.driver_rate, run.state.driver_push = total(run.machine_rate), total(run.machine_push)
    if run.counts.cells > 0:
        copy(run.machine_rate, ahead(run.waves, run.counts.cells * TERMS), TERMS)
    return share


@kernel
def wave_at_driver(run: Run) -> Floats:
    """Return the series of the wave that comes back from the machine (Pa): the load of a slab, or the wave in the last cell."""
    return ahead(run.waves, (run.counts.first_side - 1) * TERMS) if run.counts.cells > 0 else run.load


@kernel
def impedance_at_driver(run: Run) -> float:
    """Return the impedance before the machine (Pa s/m)."""
    return run.ladder_cells[run.counts.first_side - 1].impedance if run.counts.cells > 0 else run.params.impedance


@kernel
def leap(run: Run) -> None:
    """Carry the echo and the machine over the round trips at rest that were leaped over, after the machine had settled."""
    if run.counts.trip == 0:
        return
    params, before = run.params, run.counts.trip_segment
    settled = settled_rate(run, before)
    leaped = float(run.counts.trip - 1 - run.history[run.counts.echo_of].trip)
    if run.counts.cells == 0:  # waves in layers have been carried over them by the ladder
        run.load[0] += 2.0 * params.impedance * settled * leaped
    if run.counts.driver_trip < run.counts.trip:
        trips = float(run.counts.trip - 1 - run.counts.driver_trip)
        run.state.driver_push += params.driver_gain * (run.loading[before].pull - settled) * trips * params.round_trip_time
        run.counts.driver_trip, run.state.driver_swing = run.counts.trip, 0.0


@kernel
def pace_of(run: Run) -> float:
    """Return how fast (1/s) the motion of a machine may change by its own size."""
    params, before = run.params, impedance_at_driver(run)
    if params.driver_inertia == 0.0:
        return params.driver_gain / (params.driver_impedance + before)
    damped = (params.driver_impedance + before) / params.driver_inertia
    return damped + math.sqrt(params.driver_gain / params.driver_inertia)


@kernel
def force_machine(run: Run) -> None:
    """Write the series of the push on the machine, without its own motion, and of its pull rate, along the piece of load."""
    params, segment = run.params, run.loading[run.counts.segment]
    since = (run.counts.trip - segment.trip) * params.round_trip_time + (run.state.phase_from - segment.offset)
    force, pull, met = run.machine_force, run.machine_pull, wave_at_driver(run)
    for k in range(TERMS):
        force[k], pull[k] = -met[k], 0.0
    force[0] += segment.value + segment.slope * since
    force[1] += segment.slope * run.state.speed
    force[2] += segment.slope * run.state.bend
    pull[0] = segment.pull + segment.pull_slope * since
    pull[1], pull[2] = segment.pull_slope * run.state.speed, segment.pull_slope * run.state.bend
    if segment.tone != 0.0:
        tone_series(run, segment.tone, segment.tone_phase, run.counts.trip * params.round_trip_time + run.state.phase_from)
        for k in range(TERMS):
            force[k] += run.spare[k]
            pull[k] += params.pull_share * run.spare[k]


@kernel
def move_machine(run: Run, pace: float) -> bool:
    """Write the series of the machine's rate and of its integral force along the piece; return False if they end too early."""
    params, speed, bend = run.params, run.state.speed, 2.0 * run.state.bend
    force, pull, rate, push = run.machine_force, run.machine_pull, run.machine_rate, run.machine_push
    before, met = impedance_at_driver(run), wave_at_driver(run)
    weight, resists = params.driver_inertia, params.driver_impedance + before
    rate[0], push[0] = run.state.driver_rate, run.state.driver_push
    faster = faster_before = growth = growth_before = 0.0
    for k in range(TERMS):
        if weight == 0.0:
            rate[k] = (force[k] + push[k]) / resists
        growth_before, growth = growth, params.driver_gain * (pull[k] - rate[k])
        pushed = RECIPROCAL[k + 1] * (speed * growth + bend * growth_before)
        faster_before, faster = faster, (force[k] + push[k] - resists * rate[k]) / weight if weight > 0.0 else 0.0
        quicker = RECIPROCAL[k + 1] * (speed * faster + bend * faster_before)
        if k + 1 < TERMS:
            push[k + 1] = pushed
            if weight > 0.0:
                rate[k + 1] = quicker
    stiff = math.sqrt(params.driver_gain * weight) if weight > 0.0 else resists
    next_term = abs(quicker) + (abs(pushed) / stiff if stiff > 0.0 else 0.0)
    along = pace * (abs(speed) + abs(bend)) / (TERMS + 1)
    changes = 0.0
    for k in range(1, TERMS):
        changes += abs(met[k]) + 2.0 * before * abs(rate[k])
    return 2.0 * before * next_term <= (1.0 - along) * params.tolerance * changes


@entry
def driver(memory: int, task: int, number: float) -> float:
    """Add what a machine sends to the piece of load; return the share of the piece that is kept."""
    return drive(borrow(memory))
