"""The loop of the engine: it delivers the load piece by piece, moves the contact, and leaps over rest.

One loop serves both bodies. The load of a slab is the wave that left the contact one round trip ago, reflected by the driver,
plus what the driver sends; the load of a block is the force of its spring. A piece of load is a polynomial in xi on [0, 1]. The
contact sticks or slips along it in steps, each of which is appended to the history, and the history of one round trip of a slab
is the load of the next.

States of the loop, with the function or the event that leads from one to the next:

    from          to            by
    ----          --            --
    start         no load       start of the run
    no load       delivered     next_piece
    no load       no load       end_row, which closes the round trip and may leap over rest
    no load       creep leap    return of PAUSED to the caller
    creep leap    no load       next call: the leap has landed, or there was nothing to leap over
    no load       end           last round trip done, or contact locked
    delivered     stick, slip   arrive
    stick         slip          onset of slip
    stick, slip   no load       end of the piece of load
    stick, slip   end           end of the run on this piece, or a breach: the contact equation cannot be obeyed
    slip          stick         arrest
    slip          near a fold   approach_fold or depart_from_fold
    near a fold   near a fold   step in the root of time
    near a fold   slip, stick   leave_fold_piece, to a branch or to rest

The loop knows its state by these fields:

    no load       counts.ready is Incoming.NONE
    delivered     counts.ready is Incoming.BROUGHT
    stick         counts.ready is Incoming.MET and counts.mode is 0
    slip          counts.ready is Incoming.MET and counts.mode is +1 or -1
    near a fold   counts.at_fold is APPROACHING, DEPARTING or PASSING (`contact_step.fold`)

Where folds move with slip, counts.leaving = 1 says that a branch has ended: the loop returns NEED_BRANCHES, unless the table of
branches already holds at this slip, and then takes another branch or rest.
"""

from __future__ import annotations

import math

from stickslip.engine.codegen.compiler import call_step, kernel
from stickslip.engine.contact_step.append_segment import note_degree, xi_at
from stickslip.engine.contact_step.contact_equation import needs_branches, rest_limit
from stickslip.engine.contact_step.fold import leave_fold_piece, leave_moving_branch
from stickslip.engine.contact_step.radau_step import is_implicit
from stickslip.engine.contact_step.stick import arrive, stick
from stickslip.engine.contact_step.taylor_step import slip
from stickslip.engine.series.polynomial import fill, maximum, mean_of, total
from stickslip.engine.state.layout import TERMS, Cause, Incoming, Integers, Stop
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.echo_queue import FOREVER, NOTHING, end_trip, next_echo, pays, plant
from stickslip.engine.waves.varying_forcing import has_faded, rows_withstood, take_part

ROOM = 8
"""Least number of free rows in the history (1) for another pass of the loop, which appends fewer."""
LARGEST_STALL = 200
"""Number of steps in a row that take no time (1), beyond which a run ends: they would continue without end."""
LARGEST_STORM = 10_000
"""Excess (1) of slips too short to be resolved over all other slips, beyond which a run ends: they would continue without end."""


@kernel
def rows_leaped(run: Run, n: int) -> int:
    """Return the number of round trips that were leaped over between that of piece n of the history and the present one."""
    return run.counts.row - run.history[n].row - 1


@kernel
def first_piece(run: Run) -> bool:
    """Bring the next piece of load of the first round trip, or of any period of a block; return False if none is left."""
    source = run.counts.source
    if source >= run.loads - 1:
        return False
    first = run.first_load[source]
    run.state.theta_from, run.state.theta_to = first.theta, run.first_load[source + 1].theta
    run.state.speed, run.state.bend = run.state.theta_to - run.state.theta_from, 0.0
    fill(run.load, 0.0)
    run.load[0] = first.load
    run.load[1] = first.slope * run.state.speed
    if run.counts.is_block == 1 and run.counts.row > 0:
        run.load[0] = run.state.load_now + rows_leaped(run, run.counts.length - 1) * run.par.ramp
    run.counts.echo_of = -1
    # from theta = h/c on, the load of a slab's first round trip holds the initial state, reflected by the driver
    run.state.amplified = (
        math.nan if run.counts.is_block == 1 else 1.0 if run.state.theta_from < 0.5 * run.par.row_time else abs(run.par.reflection)
    )
    run.counts.arriving = Cause.NO_CAUSE
    if run.counts.row == 0 and source == 0:
        run.counts.arriving = Cause.START
    elif run.counts.row == 0 and first.jump == 1.0:
        run.counts.arriving = Cause.LOADING
    return True


@kernel
def echo_piece(run: Run) -> bool:
    """Bring the next piece of load that returns from the driver of a slab; return False if the round trip is complete."""
    if run.counts.sparse == 1:
        source = next_echo(run)
        if source == NOTHING:
            return False
    else:
        source = run.counts.previous_from + run.counts.source
        if source >= run.counts.previous_to:
            return False
    run.counts.echo_of = source
    par, left = run.par, run.history[source]
    rate, load = left.rate, left.load
    run.state.theta_from, run.state.theta_to = left.theta_from, left.theta_to
    run.state.speed, run.state.bend = left.speed, left.bend
    run.state.amplified = left.amplified * left.gain
    for k in range(TERMS):
        run.load[k] = par.reflection * (2.0 * par.impedance * rate[k] - load[k])
    time = run.counts.row * par.row_time + run.state.theta_from
    run.load[0] += par.inflow + par.inflow_rate * time - par.reflection * rows_leaped(run, source) * par.ramp
    run.load[1] += par.inflow_rate * run.state.speed
    run.load[2] += par.inflow_rate * run.state.bend
    # `lumped` still belongs to the piece of load before this one: there is a jump where its mean load ends
    jumps = left.jump == 1 or run.counts.lumped == 1
    run.counts.lumped = 1 if run.counts.lumps == 1 and width_of(run) < par.shortest else 0
    if run.counts.lumped == 1:
        lump(run)
    run.counts.arriving = Cause.ECHO if (jumps or run.counts.lumped == 1) and par.reflection != 0.0 else Cause.NO_CAUSE
    return True


@kernel
def width_of(run: Run) -> float:
    """Return the length (s) of the piece of load that has just been brought."""
    return run.state.theta_to - run.state.theta_from


@kernel
def lump(run: Run) -> None:
    """Replace the load of a piece that is too short to be resolved by its mean in time: it then slips as a whole or not at all."""
    mean = mean_of(run.load, run.state.speed, run.state.bend, run.state.theta_to - run.state.theta_from)
    fill(run.load, 0.0)
    run.load[0] = mean


@kernel
def next_piece(run: Run) -> bool:
    """Bring the next piece of load and set `ready` to BROUGHT; return False at the end of the round trip."""
    first = run.counts.is_block == 1 or run.counts.row == 0
    if not (first_piece(run) if first else echo_piece(run)):
        return False
    if run.counts.varies == 1:
        take_part(run)
    else:
        run.counts.source += 1
    run.state.xi, run.state.exit = 0.0, math.nan
    note_degree(run)
    run.counts.jump = 1 if run.counts.arriving != Cause.NO_CAUSE else run.counts.jump
    run.counts.ready = Incoming.BROUGHT
    return True


@kernel
def rows_at_rest(run: Run, limit: float) -> int:
    """Return the number of whole round trips for which a contact at rest is certain to stay there, judged from the one just past.

    `limit` is the load (Pa or N, minus the reference strength) at which rest ends. FOREVER means that it never ends.
    """
    par = run.par
    ramp = par.ramp
    if run.counts.varies == 1:
        return rows_withstood(run, limit)
    if not is_ramp(run):
        return 0
    top, bottom = -math.inf, -math.inf
    for n in range(run.counts.row_from, run.counts.length):
        load = run.history[n].load
        top = max(top, maximum(load))
        bottom = max(bottom, maximum(load, -1.0))
    if ramp == 0.0:
        return FOREVER
    room = limit - top if ramp > 0.0 else limit - (bottom - 2.0 * par.reference)
    rows = math.floor(room / abs(ramp)) - 1.0
    return min(max(int(rows), 0), FOREVER) if rows < 9e18 else FOREVER


@kernel
def is_ramp(run: Run) -> bool:
    """Return True if each of the next round trips at rest has the load of the one before it plus the ramp."""
    if run.counts.is_block == 1:
        return True
    if run.par.reflection == -1.0:
        return True
    return has_faded(run)


@kernel
def swings_for_ever(run: Run) -> bool:
    """Return True if a contact at rest has seen every load to come: under a dead load every second round trip is the same."""
    return run.counts.varies == 0 and run.par.reflection == 1.0 and run.par.ramp == 0.0 and run.counts.stuck_rows >= 2


@kernel
def end_row(run: Run, limit: float, last_row: int) -> bool:
    """Close a round trip, and leap over the following ones in which nothing can happen.

    `limit` is the load (Pa or N, minus the reference strength) at which rest ends, `last_row` the round trip in which the run
    ends. Return False, and leave the round trip open, if the end of the run would cut the leap and `to_the_end` is not set.
    """
    if run.counts.sparse == 1:
        end_trip(run)
        return True
    if run.counts.lumps == 0 and run.counts.length - run.counts.row_from > run.counts.lump_above:
        run.counts.lumps, run.counts.lumped_since = 1, run.counts.row + 1
    if pays(run):
        plant(run)
        return True
    leap, locked = 0, False
    if run.counts.moved == 0:
        run.counts.stuck_rows += 1
        leap = rows_at_rest(run, limit)
        locked = leap >= FOREVER or swings_for_ever(run)
        room = last_row - run.counts.row - 1
        if leap > room and run.counts.to_the_end == 0:
            run.counts.stuck_rows -= 1
            return False
        leap = max(min(leap, room), 0)
    else:
        run.counts.stuck_rows = 0
    run.counts.is_locked = 1 if locked else 0
    if run.counts.is_block == 1:
        run.state.load_now = total(run.history[run.counts.length - 1].load)
    run.counts.row += 1 + leap
    if run.counts.moved == 1:
        run.counts.creep_in -= 1
        if run.counts.creep_in == 0:
            run.counts.pause_at = run.counts.row
    run.counts.previous_from, run.counts.previous_to = run.counts.row_from, run.counts.length
    run.counts.row_from = run.counts.length
    run.counts.source = run.counts.moved = 0
    run.counts.row_segment = run.counts.segment
    return True


@kernel
def ended(run: Run) -> int:
    """Return the code of a run that has come to its end: LOCKED if no load can move the contact again, else FINISHED."""
    return Stop.LOCKED if run.counts.is_locked == 1 else Stop.FINISHED


@kernel
def is_finite(run: Run) -> bool:
    """Return True if the contact's slip, slip rate and state are finite."""
    return math.isfinite(run.state.rate_now + run.state.slip_now + run.state.state_now)


@kernel
def take_back(run: Run, length: int, xi: float) -> None:
    """Take a step back that started at `xi`, with `length` pieces in the history, because it cannot be kept.

    Slip and law slip become those at its start. The run ends there.
    """
    if run.counts.length > length:
        run.state.slip_now, run.state.law_slip = run.history[length].slip, run.history[length].law_slip
        run.counts.length = length
    run.state.xi = xi


@kernel
def advance(table: Integers, last_row: int, last_theta: float, budget: int) -> int:
    """Advance a run to the phase `last_theta` (s) of round trip `last_row`, and return a code of `Stop`, or -1.

    The code says why the call ended; -1 means that `budget` passes of the loop have been made. The codes that end a call but
    not the run ask something of the caller before the next call:

    - FULL: lend a larger history.
    - NEED_BRANCHES: put the branches at the present law slip into the setup.
    - END_AHEAD: set `to_the_end`. What comes next depends on where the run ends; up to here a longer run is the same.
    - PAUSED: look at the run. Round trip `pause_at`, or a later one, comes next.
    - SLIPS: take the explicit step of slip that a run with `waits` set leaves to the caller, up to `target`.

    `table` is the memory that `workspace.lend` has filled. Its scratch space must be kept between calls.
    """
    run = borrow(table)
    run.k.impedance, run.k.normal = run.par.impedance, run.par.normal
    run.k.inertia, run.k.stiffness = run.par.inertia, run.par.stiffness
    while True:
        if run.counts.length + ROOM > run.capacity:
            return Stop.FULL
        if run.counts.stalled > LARGEST_STALL or run.counts.tiny > LARGEST_STORM:
            return Stop.STORM
        budget -= 1
        if budget < 0:
            return -1
        if run.counts.folds_move == 1:
            if needs_branches(run):
                return Stop.NEED_BRANCHES
            if run.counts.leaving == 1:
                leave_moving_branch(run)
        if run.counts.ready == Incoming.NONE:
            if run.counts.row > last_row or (run.counts.sparse == 1 and run.counts.is_locked == 1):
                return ended(run)
            if not next_piece(run):
                if not end_row(run, rest_limit(run), last_row):
                    return Stop.END_AHEAD
                if run.counts.row >= run.counts.pause_at:
                    return Stop.PAUSED
                continue
            if run.counts.folds_move == 1:
                continue
        if run.counts.ready == Incoming.BROUGHT:
            arrive(run)
            run.counts.ready = Incoming.MET
            if run.counts.folds_move == 1:
                continue  # the caller may take back the step to come: make it in a pass of its own
        is_last = run.counts.row == last_row and run.counts.at_fold == 0 and run.state.theta_to >= last_theta
        is_cut = is_last and run.state.theta_to > last_theta
        if is_cut and run.counts.to_the_end == 0:
            return Stop.END_AHEAD
        xi_to = min(xi_at(run, last_theta), 1.0) if is_cut else 1.0
        if run.state.xi < xi_to:
            length, xi = run.counts.length, run.state.xi
            if run.implicit_step == 0 and is_implicit(run):
                return Stop.NEED_IMPLICIT_STEPS
            if run.counts.mode == 0:
                stick(run, xi_to)
            elif is_implicit(run):
                call_step(run.implicit_step, run, xi_to)
            elif run.counts.waits == 1:
                run.state.target = xi_to
                return Stop.SLIPS
            else:
                slip(run, xi_to)
            if run.counts.breach != 0 or not is_finite(run):
                take_back(run, length, xi)
                return run.counts.breach if run.counts.breach != 0 else Stop.FAILED
        elif run.counts.at_fold != 0:
            leave_fold_piece(run)
        elif is_last:
            return ended(run)
        else:
            run.counts.ready = Incoming.NONE
