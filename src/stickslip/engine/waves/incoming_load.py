"""Bring the load piece by piece: of the first round trip, of a block, or the echo that returns from the driver of a slab."""

from __future__ import annotations

import math

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.contact.pieces import note_degree
from stickslip.engine.memory.addresses import call_part
from stickslip.engine.series.polynomial import fill, mean_of
from stickslip.engine.state.layout import TERMS, Cause, Incoming, Task
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.echo_queue import NOTHING


@kernel
def trips_leaped(run: Run, n: int) -> int:
    """Return the number of round trips that were leaped over between that of piece n of the history and the present one."""
    return run.counts.trip - run.history[n].trip - 1


@kernel
def first_piece(run: Run) -> bool:
    """Bring the next piece of load of the first round trip, or of any period of a block; return False if none is left."""
    source = run.counts.source
    if source >= run.loads - 1:
        return False
    first = run.first_load[source]
    run.state.phase_from, run.state.phase_to = first.phase, run.first_load[source + 1].phase
    run.state.speed, run.state.bend = run.state.phase_to - run.state.phase_from, 0.0
    fill(run.load, 0.0)
    run.load[0] = first.load
    run.load[1] = first.slope * run.state.speed
    if run.counts.is_block == 1 and run.counts.trip > 0:
        run.load[0] = run.state.load_now + trips_leaped(run, run.counts.length - 1) * run.params.ramp
    run.counts.echo_of = -1
    # from theta = h/c on, the load of a slab's first round trip holds the initial state, reflected by the driver
    run.state.amplified = (
        math.nan
        if run.counts.is_block == 1
        else 1.0
        if run.state.phase_from < 0.5 * run.params.round_trip_time
        else abs(run.params.reflection)
    )
    run.counts.arriving = Cause.NO_CAUSE
    if run.counts.trip == 0 and source == 0:
        run.counts.arriving = Cause.START
    elif run.counts.trip == 0 and first.jump == 1.0:
        run.counts.arriving = Cause.LOADING
    return True


@kernel
def echo_piece(run: Run) -> bool:
    """Bring the next piece of load that returns from the driver of a slab; return False if the round trip is complete."""
    if run.counts.sparse == 1:
        source = int(call_part(run.echo_queue, run, Task.NEXT_ECHO, 0.0))
        if source == NOTHING:
            return False
    else:
        source = run.counts.previous_from + run.counts.source
        if source >= run.counts.previous_to:
            return False
    run.counts.echo_of = source
    params, left = run.params, run.history[source]
    rate, load = left.rate, left.load
    run.state.phase_from, run.state.phase_to = left.phase_from, left.phase_to
    run.state.speed, run.state.bend = left.speed, left.bend
    run.state.amplified = left.amplified * left.gain
    for k in range(TERMS):
        run.load[k] = params.reflection * (2.0 * params.impedance * rate[k] - load[k])
    time = run.counts.trip * params.round_trip_time + run.state.phase_from
    run.load[0] += params.inflow + params.inflow_rate * time - params.reflection * trips_leaped(run, source) * params.ramp
    run.load[1] += params.inflow_rate * run.state.speed
    run.load[2] += params.inflow_rate * run.state.bend
    # `lumped` still belongs to the piece of load before this one: there is a jump where its mean load ends
    jumps = left.jump == 1 or run.counts.lumped == 1
    run.counts.lumped = 1 if run.counts.lumps == 1 and width_of(run) < params.shortest else 0
    if run.counts.lumped == 1:
        lump(run)
    run.counts.arriving = Cause.ECHO if (jumps or run.counts.lumped == 1) and params.reflection != 0.0 else Cause.NO_CAUSE
    return True


@kernel
def width_of(run: Run) -> float:
    """Return the length (s) of the piece of load that has just been brought."""
    return run.state.phase_to - run.state.phase_from


@kernel
def lump(run: Run) -> None:
    """Replace the load of a piece that is too short to be resolved by its mean in time: it then slips as a whole or not at all."""
    mean = mean_of(run.load, run.state.speed, run.state.bend, run.state.phase_to - run.state.phase_from)
    fill(run.load, 0.0)
    run.load[0] = mean


@kernel
def next_piece(run: Run) -> bool:
    """Bring the next piece of load and set `ready` to BROUGHT; return False at the end of the round trip."""
    first = run.counts.is_block == 1 or run.counts.trip == 0
    if not (first_piece(run) if first else echo_piece(run)):
        return False
    if run.counts.varies == 1:
        call_part(run.loading_history, run, Task.TAKE_LOADING, 0.0)
    else:
        run.counts.source += 1
    run.state.xi, run.state.exit = 0.0, math.nan
    note_degree(run)
    run.counts.jump = 1 if run.counts.arriving != Cause.NO_CAUSE else run.counts.jump
    run.counts.ready = Incoming.BROUGHT
    return True
