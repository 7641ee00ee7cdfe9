"""Close a round trip, and leap over those that follow at rest."""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import is_barred, limit_towards, rest_limit
from stickslip.engine.contact.far_end import has_faded, is_dead_load, is_rigid
from stickslip.engine.contact.pieces import span_of_load
from stickslip.engine.series.polynomial import total
from stickslip.engine.state.layout import NEVER, EnginePart, Task
from stickslip.engine.state.workspace import Run
from stickslip.engine.waves.echo_queue import NO_PIECE, is_slip_law, patience_spent, start_of_slide, worth_building
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import call_part
from stickslip.problem import Stop


@kernel
def trips_certain_at_rest(run: Run, limit: float) -> int:
    """Return the number of whole round trips for which a contact at rest is certain to stay there, judged from the one just past.

    `limit` is the load (Pa or N, minus the reference strength) that ends rest. NEVER means that rest never ends.
    """
    params = run.params
    ramp = params.ramp
    if run.counts.varies == 1:
        return int(call_part(run.loading_history, run, Task.COUNT_TRIPS_AT_REST, limit))
    if not is_ramp(run):
        return 0
    if ramp == 0.0 or is_barred(run, 1 if ramp > 0.0 else -1):
        return NEVER
    least, largest = span_of_load(run)
    room = limit - largest if ramp > 0.0 else limit_towards(run, -1, limit) - (-least - 2.0 * params.reference)
    trips = math.floor(room / abs(ramp)) - 1.0
    return min(max(int(trips), 0), NEVER) if trips < 9e18 else NEVER


@kernel
def is_ramp(run: Run) -> bool:
    """Return True if each of the next round trips at rest has the load of the one before it plus the ramp."""
    return run.counts.is_block == 1 or is_rigid(run) or has_faded(run)


@kernel
def swings_for_ever(run: Run) -> bool:
    """Return True if a contact at rest has seen every load to come: under a dead load every second round trip is the same."""
    return run.counts.varies == 0 and is_dead_load(run) and run.params.ramp == 0.0 and run.counts.trips_at_rest >= 2


@kernel
def creeps(run: Run) -> bool:
    """Return True if slip is creep, for a slab under a law of slip alone, and for a block without states while it is slow.

    Any other contact must slide for a whole round trip to leap.
    """
    if run.counts.is_block == 1:
        return run.counts.states == 0 and is_slow(run)
    return is_slip_law(run)


@kernel
def is_slow(run: Run) -> bool:
    """Return True if no piece of this round trip begins or ends with a slip rate above that of creep."""
    for n in range(run.counts.trip_from, run.counts.length):
        rate = run.history[n].rate
        if max(abs(rate[0]), abs(total(rate))) > run.params.slow:
            return False
    return True


@kernel
def close_round_trip(run: Run, last_trip: int) -> int:
    """Close a round trip, and leap over the following ones if nothing can happen in them.

    The run ends in round trip `last_trip`. Return Stop.NONE, or a code if the caller must do something first: the round trip is
    then still open. The code is END_AHEAD if the end of the run would cut the leap and `to_the_end` is not set.
    """
    if run.counts.lumps == 0 and run.counts.length - run.counts.trip_from > run.counts.lump_above:
        run.counts.lumps, run.counts.lumped_since = 1, run.counts.trip + 1
    if run.counts.sparse == 1:
        call_part(run.echo_queue, run, Task.END_TRIP, 0.0)
        return Stop.NONE
    if worth_building(run):
        if run.echo_queue == 0:
            run.missing = EnginePart.ECHO_QUEUE
            return Stop.NEED_PART
        call_part(run.echo_queue, run, Task.BUILD_QUEUE, 0.0)
        return Stop.NONE
    leap, locked = 0, False
    if run.counts.moved == 0:
        run.counts.trips_at_rest += 1
        leap = trips_certain_at_rest(run, rest_limit(run, 1))
        locked = leap >= NEVER or swings_for_ever(run)
        room = last_trip - run.counts.trip - 1
        if leap > room and run.counts.to_the_end == 0:
            run.counts.trips_at_rest -= 1
            return Stop.END_AHEAD
        leap = max(min(leap, room), 0)
    else:
        run.counts.trips_at_rest = 0
    run.counts.is_locked = 1 if locked else 0
    counts = run.counts.creep_in > 0 and run.counts.moved == 1 and (creeps(run) or start_of_slide(run) != NO_PIECE)
    if run.counts.is_block == 1:
        run.state.load_now = total(run.history[run.counts.length - 1].load)
    run.counts.trip += 1 + leap
    if counts:
        run.counts.creep_in -= patience_spent(run) if is_slip_law(run) else 1
        if run.counts.creep_in == 0:
            run.counts.pause_at = run.counts.trip
    run.counts.previous_from, run.counts.previous_to = run.counts.trip_from, run.counts.length
    run.counts.trip_from = run.counts.length
    run.counts.source = run.counts.moved = 0
    run.counts.trip_segment = run.counts.segment
    if run.counts.cells > 0:
        call_part(run.ladder, run, Task.PLAN_MERGING, 0.0)
    elif run.counts.varies == 1 and run.params.reflection != 0.0:
        call_part(run.loading_history, run, Task.PLAN_MERGING, 0.0)
    return Stop.NONE
