"""The engine: brings the load round trip after round trip, lets the contact answer, and leaps over rest.

One loop serves both bodies. A slab's load is what left the contact one round trip ago, reflected by the driver, plus what the
driver sends; a block's is its spring. Pieces of load arrive one by one and are split wherever the contact needs it.
"""

from __future__ import annotations

import math

from stickslip.evolution import layout as at
from stickslip.evolution.branch import needs_branches, rest_limit
from stickslip.evolution.compiled import ahead, inlined, kernel
from stickslip.evolution.echoes import FOREVER, NOTHING, end_trip, next_echo, pays, plant
from stickslip.evolution.fold import leave_fold_piece, leave_moving_branch
from stickslip.evolution.implicit import is_implicit
from stickslip.evolution.layout import TERMS, Integers
from stickslip.evolution.loading import has_faded, rows_withstood, take_part
from stickslip.evolution.polynomial import fill, maximum, mean_of, total
from stickslip.evolution.record import note_degree, xi_at
from stickslip.evolution.slip import slip, slip_implicitly
from stickslip.evolution.stick import arrive, stick
from stickslip.evolution.workspace import EXIT, REAL, WHOLE, Run, borrow

ROOM = 8
LARGEST_STALL = 200
LARGEST_STORM = 10_000
"""So many more slips that are too short to be resolved than others end a run: they would go on without end."""


@inlined
def rows_leaped(run: Run, n: int) -> int:
    """Whole rows at rest between the one of a piece of the history and the present one."""
    return run.counts[at.ROW] - run.whole[WHOLE * n + at.S_ROW] - 1


@inlined
def first_piece(run: Run) -> bool:
    """The next piece of load of a first round trip, or of any period of a block; False when there is none left."""
    source = run.counts[at.SOURCE]
    if source >= run.loads - 1:
        return False
    run.state[at.THETA_FROM], run.state[at.THETA_TO] = run.first_theta[source], run.first_theta[source + 1]
    run.state[at.SPEED], run.state[at.BEND] = run.state[at.THETA_TO] - run.state[at.THETA_FROM], 0.0
    fill(run.load, 0.0)
    run.load[0] = run.first_load[source]
    run.load[1] = run.first_slope[source] * run.state[at.SPEED]
    if run.counts[at.IS_BLOCK] == 1 and run.counts[at.ROW] > 0:
        run.load[0] = run.state[at.LOAD_NOW] + rows_leaped(run, run.counts[at.LENGTH] - 1) * run.par[at.RAMP]
    run.counts[at.ECHO_OF] = -1
    # in the first round trip of a slab the start itself comes back from the driver, from half of it on
    run.state[at.AMPLIFIED] = (
        math.nan
        if run.counts[at.IS_BLOCK] == 1
        else 1.0
        if run.state[at.THETA_FROM] < 0.5 * run.par[at.ROW_TIME]
        else abs(run.par[at.REFLECTION])
    )
    run.counts[at.ARRIVING] = at.NO_CAUSE
    if run.counts[at.ROW] == 0 and source == 0:
        run.counts[at.ARRIVING] = at.START
    elif run.counts[at.ROW] == 0 and run.first_jump[source] == 1.0:
        run.counts[at.ARRIVING] = at.LOADING
    return True


@inlined
def echo_piece(run: Run) -> bool:
    """The next piece of load that returns from the driver; False when the round trip is complete."""
    if run.counts[at.SPARSE] == 1:
        source = next_echo(run)
        if source == NOTHING:
            return False
    else:
        source = run.counts[at.PREVIOUS_FROM] + run.counts[at.SOURCE]
        if source >= run.counts[at.PREVIOUS_TO]:
            return False
    run.counts[at.ECHO_OF] = source
    par = run.par
    real, rate, load = (
        ahead(run.real, REAL * source),
        ahead(run.stored_rate, TERMS * source),
        ahead(run.stored_load, TERMS * source),
    )
    run.state[at.THETA_FROM], run.state[at.THETA_TO] = real[at.S_THETA_FROM], real[at.S_THETA_TO]
    run.state[at.SPEED], run.state[at.BEND] = real[at.S_SPEED], real[at.S_BEND]
    run.state[at.AMPLIFIED] = real[at.S_AMPLIFIED] * real[at.S_GAIN]
    for k in range(TERMS):
        run.load[k] = par[at.REFLECTION] * (2.0 * par[at.IMPEDANCE] * rate[k] - load[k])
    time = run.counts[at.ROW] * par[at.ROW_TIME] + run.state[at.THETA_FROM]
    run.load[0] += par[at.INFLOW] + par[at.INFLOW_RATE] * time - par[at.REFLECTION] * rows_leaped(run, source) * par[at.RAMP]
    run.load[1] += par[at.INFLOW_RATE] * run.state[at.SPEED]
    run.load[2] += par[at.INFLOW_RATE] * run.state[at.BEND]
    jumps = run.whole[WHOLE * source + at.S_JUMP] == 1 or run.counts[at.LUMPED] == 1
    run.counts[at.LUMPED] = 1 if run.counts[at.LUMPS] == 1 and width_of(run) < par[at.SHORTEST] else 0
    if run.counts[at.LUMPED] == 1:
        lump(run)
    run.counts[at.ARRIVING] = at.ECHO if (jumps or run.counts[at.LUMPED] == 1) and par[at.REFLECTION] != 0.0 else at.NO_CAUSE
    return True


@inlined
def width_of(run: Run) -> float:
    """Return the length (s) of the piece of load that has just been brought."""
    return run.state[at.THETA_TO] - run.state[at.THETA_FROM]


@kernel
def lump(run: Run) -> None:
    """A piece too short to be resolved: its load is its mean, so that it slips as a whole or not at all."""
    mean = mean_of(run.load, run.state[at.SPEED], run.state[at.BEND], run.state[at.THETA_TO] - run.state[at.THETA_FROM])
    fill(run.load, 0.0)
    run.load[0] = mean


@inlined
def next_piece(run: Run) -> bool:
    """Bring the next piece of load; False at the end of the round trip."""
    first = run.counts[at.IS_BLOCK] == 1 or run.counts[at.ROW] == 0
    if not (first_piece(run) if first else echo_piece(run)):
        return False
    if run.counts[at.VARIES] == 1:
        take_part(run)
    else:
        run.counts[at.SOURCE] += 1
    run.state[at.XI], run.state[EXIT] = 0.0, math.nan
    note_degree(run)
    run.counts[at.JUMP] = 1 if run.counts[at.ARRIVING] != at.NO_CAUSE else run.counts[at.JUMP]
    run.counts[at.READY] = at.BROUGHT
    return True


@kernel
def rows_at_rest(run: Run, limit: float) -> int:
    """Whole round trips that a contact at rest stays there for certain, judged from the one just past."""
    par = run.par
    ramp = par[at.RAMP]
    if run.counts[at.VARIES] == 1:
        return rows_withstood(run, limit)
    if not is_ramp(run):
        return 0
    top, bottom = -math.inf, -math.inf
    for n in range(run.counts[at.ROW_FROM], run.counts[at.LENGTH]):
        load = ahead(run.stored_load, TERMS * n)
        top = max(top, maximum(load))
        bottom = max(bottom, maximum(load, -1.0))
    if ramp == 0.0:
        return FOREVER
    room = limit - top if ramp > 0.0 else limit - (bottom - 2.0 * par[at.REFERENCE])
    rows = math.floor(room / abs(ramp)) - 1.0
    return min(max(int(rows), 0), FOREVER) if rows < 9e18 else FOREVER


@kernel
def is_ramp(run: Run) -> bool:
    """Whether the load of the next round trips is that of the last one plus a ramp."""
    if run.counts[at.IS_BLOCK] == 1:
        return True
    if run.par[at.REFLECTION] == -1.0:
        return True
    return has_faded(run)


@kernel
def swings_for_ever(run: Run) -> bool:
    """Whether a contact at rest has seen all that will come: under a dead load every second round trip is the same."""
    return (
        run.counts[at.VARIES] == 0 and run.par[at.REFLECTION] == 1.0 and run.par[at.RAMP] == 0.0 and run.counts[at.STUCK_ROWS] >= 2
    )


@inlined
def end_row(run: Run, limit: float, last_row: int) -> bool:
    """Close a round trip; leap over the following ones while nothing can happen in them.

    False, and nothing done, where the end of the run would cut the leap and TO_THE_END is not set.
    """
    if run.counts[at.SPARSE] == 1:
        end_trip(run)
        return True
    if run.counts[at.LUMPS] == 0 and run.counts[at.LENGTH] - run.counts[at.ROW_FROM] > run.counts[at.LUMP_ABOVE]:
        run.counts[at.LUMPS], run.counts[at.LUMPED_SINCE] = 1, run.counts[at.ROW] + 1
    if pays(run):
        plant(run)
        return True
    leap, locked = 0, False
    if run.counts[at.MOVED] == 0:
        run.counts[at.STUCK_ROWS] += 1
        leap = rows_at_rest(run, limit)
        locked = leap >= FOREVER or swings_for_ever(run)
        room = last_row - run.counts[at.ROW] - 1
        if leap > room and run.counts[at.TO_THE_END] == 0:
            run.counts[at.STUCK_ROWS] -= 1
            return False
        leap = max(min(leap, room), 0)
    else:
        run.counts[at.STUCK_ROWS] = 0
    run.counts[at.IS_LOCKED] = 1 if locked else 0
    if run.counts[at.IS_BLOCK] == 1:
        run.state[at.LOAD_NOW] = total(ahead(run.stored_load, TERMS * (run.counts[at.LENGTH] - 1)))
    run.counts[at.ROW] += 1 + leap
    if run.counts[at.MOVED] == 1:
        run.counts[at.CREEP_IN] -= 1
        if run.counts[at.CREEP_IN] == 0:
            run.counts[at.PAUSE_AT] = run.counts[at.ROW]
    run.counts[at.PREVIOUS_FROM], run.counts[at.PREVIOUS_TO] = run.counts[at.ROW_FROM], run.counts[at.LENGTH]
    run.counts[at.ROW_FROM] = run.counts[at.LENGTH]
    run.counts[at.SOURCE] = run.counts[at.MOVED] = 0
    run.counts[at.ROW_SEGMENT] = run.counts[at.SEGMENT]
    return True


@inlined
def ended(run: Run) -> int:
    """What to say at the end of the run."""
    return at.LOCKED if run.counts[at.IS_LOCKED] == 1 else at.FINISHED


@inlined
def is_finite(run: Run) -> bool:
    """Return True if the contact's slip, slip rate and state are numbers."""
    return math.isfinite(run.state[at.RATE_NOW] + run.state[at.SLIP_NOW] + run.state[at.STATE_NOW])


@kernel
def take_back(run: Run, length: int, xi: float) -> None:
    """Drop the pieces that a step has added to a history of `length` pieces: they are not finite. The run ends before them."""
    if run.counts[at.LENGTH] > length:
        real = ahead(run.real, REAL * length)
        run.state[at.SLIP_NOW], run.state[at.LAW_SLIP] = real[at.S_SLIP], real[at.S_LAW_SLIP]
        run.counts[at.LENGTH] = length
    run.state[at.XI] = xi


@kernel
def advance(table: Integers, last_row: int, last_theta: float, budget: int) -> int:
    """The loop: bring a piece of load, let the contact stick or slip on it, close the round trip.

    Runs to the offset last_theta of round trip last_row, for `budget` steps, or until the store is full; says which it was.
    NEED_BRANCHES: the caller must put the branches at the present law slip into the setup before it goes on. END_AHEAD: what
    comes next depends on where the run ends; the caller sets TO_THE_END and goes on. Up to there a longer run is the same.
    PAUSED: row PAUSE_AT, or one behind it, comes next. SLIPS: a run that WAITS is to take an explicit step of slip.

    `table` comes from `workspace.lend`. Its scratch array is kept between calls.
    """
    run = borrow(table)
    run.k[at.K_IMPEDANCE], run.k[at.K_NORMAL] = run.par[at.IMPEDANCE], run.par[at.NORMAL]
    run.k[at.K_INERTIA], run.k[at.K_STIFFNESS] = run.par[at.INERTIA], run.par[at.STIFFNESS]
    while True:
        if run.counts[at.LENGTH] + ROOM > run.capacity:
            return at.FULL
        if run.counts[at.STALLED] > LARGEST_STALL or run.counts[at.TINY] > LARGEST_STORM:
            return at.STORM
        budget -= 1
        if budget < 0:
            return -1
        if run.counts[at.FOLDS_MOVE] == 1:
            if needs_branches(run):
                return at.NEED_BRANCHES
            if run.counts[at.LEAVING] == 1:
                leave_moving_branch(run)
        if run.counts[at.READY] == 0:
            if run.counts[at.ROW] > last_row or (run.counts[at.SPARSE] == 1 and run.counts[at.IS_LOCKED] == 1):
                return ended(run)
            if not next_piece(run):
                if not end_row(run, rest_limit(run), last_row):
                    return at.END_AHEAD
                if run.counts[at.ROW] >= run.counts[at.PAUSE_AT]:
                    return at.PAUSED
                continue
            if run.counts[at.FOLDS_MOVE] == 1:
                continue
        if run.counts[at.READY] == at.BROUGHT:
            arrive(run)
            run.counts[at.READY] = at.MET
            if run.counts[at.FOLDS_MOVE] == 1:
                continue  # a step that the caller may take back stands alone
        is_last = run.counts[at.ROW] == last_row and run.counts[at.AT_FOLD] == 0 and run.state[at.THETA_TO] >= last_theta
        is_cut = is_last and run.state[at.THETA_TO] > last_theta
        if is_cut and run.counts[at.TO_THE_END] == 0:
            return at.END_AHEAD
        xi_to = min(xi_at(run, last_theta), 1.0) if is_cut else 1.0
        if run.state[at.XI] < xi_to:
            length, xi = run.counts[at.LENGTH], run.state[at.XI]
            if run.counts[at.MODE] == 0:
                stick(run, xi_to)
            elif is_implicit(run):
                slip_implicitly(run, xi_to)
            elif run.counts[at.WAITS] == 1:
                run.state[at.TARGET] = xi_to
                return at.SLIPS
            else:
                slip(run, xi_to)
            if run.counts[at.BREACH] != 0 or not is_finite(run):
                take_back(run, length, xi)
                return run.counts[at.BREACH] if run.counts[at.BREACH] != 0 else at.FAILED
        elif run.counts[at.AT_FOLD] != 0:
            leave_fold_piece(run)
        elif is_last:
            return ended(run)
        else:
            run.counts[at.READY] = 0
