"""Bring the load piece by piece: of the first round trip, of a block, or the echo that returns from the driver of a slab."""

from __future__ import annotations

import math

from stickslip.engine.contact.far_end import sent_back
from stickslip.engine.contact.pieces import note_degree
from stickslip.engine.series.polynomial import fill, mean_of
from stickslip.engine.state.layout import TERMS, Cause, Incoming, Task
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.echo_queue import NO_PIECE
from stickslip.engine.waves.merged_creep import continue_echo, lay_out_group
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import call_part


@kernel
def trips_leaped(run: Run, n: int) -> int:
    """Return the number of round trips that were leaped over between that of piece n of the history and the present one."""
    return run.counts.trip - run.history[n].trip - 1


@kernel
def find_first(run: Run) -> bool:
    """Find the next piece of load of the first round trip, or of any period of a block; return False if none is left."""
    source = run.counts.source
    if source >= run.loads - 1:
        return False
    run.counts.echo_of = NO_PIECE
    run.state.phase_from, run.state.phase_to = run.first_load[source].phase, run.first_load[source + 1].phase
    run.state.speed, run.state.bend = run.state.phase_to - run.state.phase_from, 0.0
    return True


@kernel
def find_echo(run: Run) -> bool:
    """Find the piece of the history whose echo comes next to the contact of a slab; return False if the round trip is complete."""
    if run.counts.sparse == 1:
        source = int(call_part(run.echo_queue, run, Task.NEXT_ECHO, 0.0))
        if source == NO_PIECE:
            return False
        if run.counts.merged > 0:
            lay_out_group(run)
            return True
    else:
        source = run.counts.previous_from + run.counts.source
        if source >= run.counts.previous_to:
            return False
    run.counts.echo_of, left = source, run.history[source]
    run.state.phase_from, run.state.phase_to = left.phase_from, left.phase_to
    run.state.speed, run.state.bend = left.speed, left.bend
    return True


@kernel
def amplified_at_first(run: Run) -> float:
    """Return by how much (1) the load of the first round trip multiplies an error of the start; not a number for a block."""
    if run.counts.is_block == 1:
        return math.nan
    reaches_driver = run.state.phase_from >= 0.5 * run.params.round_trip_time  # then the driver has sent the initial state back
    return abs(sent_back(run)) if reaches_driver else 1.0


@kernel
def bring_first(run: Run) -> None:
    """Bring the piece of load that has been found by `find_first`."""
    first = run.first_load[run.counts.source]
    fill(run.load, 0.0)
    run.load[0] = first.load
    run.load[1] = first.slope * run.state.speed
    if run.counts.cells > 0:
        call_part(run.ladder, run, Task.CROSS_CELLS, 0.0)
    if run.counts.is_block == 1 and run.counts.trip > 0:
        run.load[0] = run.state.load_now + trips_leaped(run, run.counts.length - 1) * run.params.ramp
    run.state.amplified = amplified_at_first(run)
    run.counts.arriving = Cause.NO_CAUSE
    if run.counts.trip == 0 and run.counts.source == 0:
        run.counts.arriving = Cause.START
    elif run.counts.trip == 0 and first.jump == 1.0:
        run.counts.arriving = Cause.LOADING


@kernel
def bring_echo(run: Run) -> None:
    """Bring the echo that `find_echo` has found: the wave that left the contact, as the driver sends it back."""
    source, params, share = run.counts.echo_of, run.params, sent_back(run)
    left = run.history[source]
    rate, load = left.rate, left.load
    run.state.amplified = left.amplified * left.gain
    if run.counts.cells > 0:
        jumps = call_part(run.ladder, run, Task.CROSS_CELLS, 0.0) == 1.0
        run.counts.arriving = Cause.ECHO if jumps else Cause.NO_CAUSE
        return
    if run.counts.varies == 1 and (run.counts.merging == 1 or run.counts.merged > 0):
        call_part(run.loading_history, run, Task.GATHER_WAVES, float(source))
        for k in range(TERMS):
            run.load[k] *= share
    else:
        for k in range(TERMS):
            run.load[k] = share * (2.0 * params.impedance * rate[k] - load[k])
    first = left
    if run.counts.sparse == 1 and run.counts.merged > 0:
        first = run.history[run.counts.merged_from]
        continue_echo(run, share)
    time = run.counts.trip * params.round_trip_time + run.state.phase_from
    run.load[0] += params.inflow + params.inflow_rate * time - share * trips_leaped(run, source) * params.ramp
    run.load[1] += params.inflow_rate * run.state.speed
    run.load[2] += params.inflow_rate * run.state.bend
    # `lumped` still belongs to the piece of load before this one: there is a jump where its mean load ends
    jumps = first.jump == 1 or run.counts.lumped == 1
    run.counts.lumped = 1 if run.counts.lumps == 1 and width_of(run) < params.shortest else 0
    if run.counts.lumped == 1:
        lump(run)
    run.counts.arriving = Cause.ECHO if (jumps or run.counts.lumped == 1) and share != 0.0 else Cause.NO_CAUSE


@kernel
def width_of(run: Run) -> float:
    """Return the length (s) of the piece of load that has just been brought."""
    return run.state.phase_to - run.state.phase_from


@kernel
def lump(run: Run) -> None:
    """If a piece is too short to be resolved, replace its load by the mean in time: it then slips as a whole or not at all."""
    mean = mean_of(run.load, run.state.speed, run.state.bend, run.state.phase_to - run.state.phase_from)
    fill(run.load, 0.0)
    run.load[0] = mean


@kernel
def next_piece(run: Run) -> bool:
    """Bring the next piece of load and set `ready` to BROUGHT; return False at the end of the round trip."""
    is_first, begin = run.counts.is_block == 1 or run.counts.trip == 0, run.state.taken
    if not (find_first(run) if is_first else find_echo(run)):
        return False
    # A segment of the loading is entered before an echo is multiplied: the far end is that of the segment.
    jumps = run.counts.varies == 1 and call_part(run.loading_history, run, Task.ENTER_SEGMENT, 0.0) == 1.0
    if is_first:
        bring_first(run)
    else:
        bring_echo(run)
    if run.counts.varies == 1:
        run.counts.arriving = Cause.LOADING if jumps else Cause.NO_CAUSE if begin > 0.0 else run.counts.arriving
        call_part(run.loading_history, run, Task.TAKE_LOADING, 0.0)
    else:
        run.counts.source += max(run.counts.merged, 1)
    run.state.xi, run.state.exit = 0.0, math.nan
    note_degree(run)
    run.counts.jump = 1 if run.counts.arriving != Cause.NO_CAUSE else run.counts.jump
    run.counts.ready = Incoming.BROUGHT
    return True
