"""The loop of the engine: it delivers the load piece by piece, moves the contact, and leaps over rest.

One loop serves both bodies. The load of a slab is the wave that left the contact one round trip ago, reflected by the driver,
plus what the driver sends; the load of a block is the force of its spring. A piece of load is a polynomial in xi on [0, 1]. The
contact sticks or slips along it in steps, which are appended to the history. The history of one round trip of a slab is the load of
the next.

States of the loop, with the function or the event that leads from one to the next:

    from          to            by
    ----          --            --
    start         no load       start of the run
    no load       delivered     next_piece
    no load       no load       close_round_trip, which closes the round trip and may leap over rest
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
    near a fold   counts.at_fold is not NearFold.NONE (`folds.fold`)

If folds move with slip or with the normal load, a branch may have ended (counts.branch_ended is 1). The loop then returns
NEED_BRANCHES, unless the table of branches already holds there, and continues on another branch or at rest. It does the same where
slip begins, or the load or the normal load jumps, under a normal load that varies.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import needs_branches
from stickslip.engine.contact.pieces import xi_at
from stickslip.engine.contact.pressing import before_turn, own_states
from stickslip.engine.contact.stiffness import is_implicit
from stickslip.engine.contact_step.stick_or_slip import arrive, stick
from stickslip.engine.contact_step.taylor_step import slip
from stickslip.engine.folds.fold import leave_moving_branch
from stickslip.engine.series.polynomial import total
from stickslip.engine.state.layout import NO_DISC, EnginePart, Incoming, NearFold, Task
from stickslip.engine.state.workspace import ROOM, Run, borrow, lacks_rows
from stickslip.engine.waves.incoming_load import next_piece
from stickslip.engine.waves.round_trip import close_round_trip
from stickslip.foundation.arrays import Integers1
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import call_part
from stickslip.problem import Stop

LARGEST_STALL = 1000
"""A run ends after more than this many consecutive steps that take no time (1), because they would never stop. A contact that never
sticks may take hundreds as it comes to rest: its slip rate falls by tens of orders of magnitude in less time than is resolved."""
LARGEST_STORM = 10_000
"""A run ends if slips too short to be resolved outnumber all others by more than this (1), because they would never stop."""


@entry
def run_until(table: Integers1, last_trip: int, last_phase: float, passes: int) -> int:
    """Advance a run to the phase `last_phase` (s) of round trip `last_trip`, and return a code of `Stop`.

    Stop.NONE means that the loop has made the given number of passes. The other codes that end a call but not the run ask
    something of the caller before the next call:

    - FULL: lend a larger history.
    - NEED_BRANCHES: put the branches at the present law slip and normal load into the setup.
    - NEED_PART: lend the part of the engine that `missing` names.
    - END_AHEAD: set `to_the_end`. What comes next depends on where the run ends; up to here a longer run is the same.
    - PAUSED: look at the run. Round trip `pause_at`, or a later one, comes next.
    - SLIPS: take the explicit step of slip that a run with `waits` set leaves to the caller, up to `target`.

    `table` is the memory that `workspace.lend` has filled. Its scratch space must be kept between calls.
    """
    run = borrow(table)
    run.k.damping, run.k.normal = run.params.damping, run.params.normal
    if run.params.play > 0.0:
        run.params.stiffness = run.params.spring if run.counts.side != 0 else 0.0
    run.k.inertia, run.k.stiffness = run.params.inertia, run.params.stiffness
    if run.counts.disc == NO_DISC:
        run.counts.disc = int(run.params.first_disc)
    run.missing = missing_part(run)
    if run.missing != EnginePart.NONE:
        return Stop.NEED_PART
    for _ in range(passes):
        code = make_pass(run, last_trip, last_phase)
        if code != Stop.NONE:
            return code
    return Stop.NONE


@kernel
def make_pass(run: Run, last_trip: int, last_phase: float) -> int:
    """Make one pass of the loop: bring a piece of load, answer it, or take a step along it. Return Stop.NONE if it goes on."""
    code = obstacle(run)
    if code != Stop.NONE:
        return code
    if run.counts.branch_ended == 1:
        leave_moving_branch(run)
    if run.counts.ready == Incoming.NONE:
        code = bring_load(run, last_trip)
        if run.counts.ready == Incoming.NONE or run.counts.folds_move == 1 or run.counts.given > 0:
            return code  # where folds move, the answer to the piece of load may need branches first
    if run.counts.ready == Incoming.BROUGHT:
        if not math.isfinite(total(run.load)):
            return Stop.FAILED
        arrive(run)
        run.counts.ready = Incoming.MET
    return walk_along_load(run, last_trip, last_phase)


@kernel
def obstacle(run: Run) -> int:
    """Return the code of the reason why the run cannot go on, or Stop.NONE."""
    if run.counts.length + ROOM > run.capacity or lacks_rows(run):
        return Stop.FULL
    if run.counts.stalled > LARGEST_STALL or run.counts.unresolved_slips > LARGEST_STORM:
        return Stop.STORM
    return Stop.NEED_BRANCHES if needs_branches(run) else Stop.NONE


@kernel
def missing_part(run: Run) -> int:
    """Return a part that the run needs now, as its problem or its checkpoint says, and that has not been lent; or Part.NONE."""
    if run.loading_history == 0 and run.counts.varies == 1:
        return EnginePart.LOADING_HISTORY
    if run.driver == 0 and run.counts.driven == 1:
        return EnginePart.DRIVER
    if run.ladder == 0 and run.counts.cells > 0:
        return EnginePart.LADDER
    if run.moving_folds == 0 and (run.counts.folds_move == 1 or (run.counts.given > 0 and run.counts.is_algebraic == 1)):
        return EnginePart.MOVING_FOLDS
    if run.folds == 0 and run.counts.at_fold != NearFold.NONE:
        return EnginePart.FOLDS
    if run.negative_friction == 0 and run.params.can_be_negative != 0.0 and own_states(run) == 0:
        return EnginePart.NEGATIVE_FRICTION
    if run.play == 0 and run.params.play > 0.0:
        return EnginePart.PLAY
    return EnginePart.ECHO_QUEUE if run.echo_queue == 0 and run.counts.sparse == 1 else EnginePart.NONE


@kernel
def bring_load(run: Run, last_trip: int) -> int:
    """Bring the next piece of load, or close the round trip if there is none left."""
    if run.counts.trip > last_trip or (run.counts.sparse == 1 and run.counts.is_locked == 1):
        return end_of_run(run)
    if next_piece(run):
        return Stop.NONE
    code = close_round_trip(run, last_trip)
    return Stop.PAUSED if code == Stop.NONE and run.counts.trip >= run.counts.pause_at else code


@kernel
def walk_along_load(run: Run, last_trip: int, last_phase: float) -> int:
    """Take one step along the present piece of load, as far as the end of the run, or leave the piece at its end."""
    is_last = run.counts.trip == last_trip and run.counts.at_fold == NearFold.NONE and run.state.phase_to >= last_phase
    is_cut = is_last and run.state.phase_to > last_phase
    if is_cut and run.counts.to_the_end == 0:
        return Stop.END_AHEAD
    xi_to = min(xi_at(run, last_phase), 1.0) if is_cut else 1.0
    if run.state.xi < xi_to:
        return take_step(run, xi_to)
    if run.counts.at_fold != NearFold.NONE:
        call_part(run.folds, run, Task.LEAVE_FOLD, 0.0)
    elif is_last:
        return end_of_run(run)
    else:
        run.counts.ready = Incoming.NONE
    return Stop.NONE


@kernel
def take_step(run: Run, xi_to: float) -> int:
    """Stick or slip for one step, up to the place xi_to at most. A step that must not be kept is taken back and ends the run."""
    length, xi, state = run.counts.length, run.state.xi, run.state
    if run.implicit_steps == 0 and is_implicit(run):
        run.missing = EnginePart.IMPLICIT_STEPS
        return Stop.NEED_PART
    if run.params.play > 0.0:
        xi_to = call_part(run.play, run, Task.LEAD_TO_EDGE, xi_to)
    if xi_to == xi:
        pass  # it has changed its side of a play
    elif run.counts.mode == 0:
        if own_states(run) == 0 or call_part(run.implicit_steps, run, Task.STICK_WITH_STATE, xi_to) == 0.0:
            stick(run, before_turn(run, xi_to))
    elif is_implicit(run):
        call_part(run.implicit_steps, run, Task.SLIP_IMPLICITLY, xi_to)
    elif run.counts.waits == 1:
        run.state.target = xi_to
        return Stop.SLIPS
    else:
        slip(run, before_turn(run, xi_to))
    if run.missing != EnginePart.NONE:
        return Stop.NEED_PART
    if run.counts.breach == 0 and math.isfinite(state.rate_now + state.slip_now + state.state_now[0] + state.state_now[1]):
        return Stop.NONE
    take_back(run, length, xi)
    return run.counts.breach if run.counts.breach != 0 else Stop.FAILED


@kernel
def take_back(run: Run, length: int, xi: float) -> None:
    """Take a step back that started at `xi`, with `length` pieces in the history. Slip and law slip become those at its start."""
    if run.counts.length > length:
        run.state.slip_now, run.state.law_slip = run.history[length].slip, run.history[length].law_slip
        run.counts.length = length
    run.state.xi = xi


@kernel
def end_of_run(run: Run) -> int:
    """Return the code of a run that has come to its end: LOCKED if no load can move the contact again, else FINISHED."""
    return Stop.LOCKED if run.counts.is_locked == 1 else Stop.FINISHED
