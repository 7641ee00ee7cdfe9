"""The engine: brings the load round trip after round trip, lets the contact answer, and leaps over rest.

One loop serves both bodies. A slab's load is what left the contact one round trip ago, reflected by the driver, plus what the
driver sends; a block's is its spring. Pieces of load arrive one by one and are split wherever the contact needs it.
"""

from __future__ import annotations

import math

from stickslip.evolution import layout as at
from stickslip.evolution.compiled import floats, integers, kernel
from stickslip.evolution.contact_step import arrive, end_branch, rest_limit, slip, stick
from stickslip.evolution.layout import Floats, Integers, Setup, Store, Work
from stickslip.evolution.polynomial import copy, fill, maximum

ROOM = 8
LARGEST_STALL = 200
FOREVER = 2**62
FORGOTTEN = 1e-17


@kernel
def first_piece(setup: Setup, state: Floats, count: Integers, work: Work) -> bool:
    """The next piece of load of a first round trip, or of any period of a block; False when there is none left."""
    source = count[at.SOURCE]
    if source >= setup.first.shape[1] - 1:
        return False
    state[at.THETA_FROM], state[at.THETA_TO] = setup.first[at.FIRST_THETA, source], setup.first[at.FIRST_THETA, source + 1]
    state[at.SPEED], state[at.BEND] = state[at.THETA_TO] - state[at.THETA_FROM], 0.0
    fill(work.load, 0.0)
    work.load[0] = setup.first[at.FIRST_LOAD, source]
    work.load[1] = setup.first[at.FIRST_SLOPE, source] * state[at.SPEED]
    if count[at.IS_BLOCK] == 1 and count[at.ROW] > 0:
        work.load[0] = state[at.LOAD_NOW] + count[at.LEAP] * setup.par[at.RAMP]
    count[at.ARRIVING] = at.NO_CAUSE
    if count[at.ROW] == 0 and source == 0:
        count[at.ARRIVING] = at.START
    elif count[at.ROW] == 0 and setup.first[at.FIRST_JUMP, source] == 1.0:
        count[at.ARRIVING] = at.LOADING
    return True


@kernel
def echo_piece(setup: Setup, state: Floats, count: Integers, work: Work, store: Store) -> bool:
    """The next piece of load that returns from the driver; False when the round trip is complete."""
    source = count[at.PREVIOUS_FROM] + count[at.SOURCE]
    if source >= count[at.PREVIOUS_TO]:
        return False
    par = setup.par
    state[at.THETA_FROM], state[at.THETA_TO] = store.real[source, at.S_THETA_FROM], store.real[source, at.S_THETA_TO]
    state[at.SPEED], state[at.BEND] = store.real[source, at.S_SPEED], store.real[source, at.S_BEND]
    for k in range(at.TERMS):
        leaving = 2.0 * par[at.IMPEDANCE] * store.rate[source, k] - store.load[source, k]
        work.load[k] = par[at.REFLECTION] * leaving
    time = count[at.ROW] * par[at.ROW_TIME] + state[at.THETA_FROM]
    work.load[0] += par[at.INFLOW] + par[at.INFLOW_RATE] * time - par[at.REFLECTION] * count[at.LEAP] * par[at.RAMP]
    work.load[1] += par[at.INFLOW_RATE] * state[at.SPEED]
    work.load[2] += par[at.INFLOW_RATE] * state[at.BEND]
    count[at.ARRIVING] = at.ECHO if store.whole[source, at.S_JUMP] == 1 and par[at.REFLECTION] != 0.0 else at.NO_CAUSE
    return True


@kernel
def next_piece(setup: Setup, state: Floats, count: Integers, work: Work, store: Store) -> bool:
    """Bring the next piece of load and let the contact meet its start; False at the end of the round trip."""
    first = count[at.IS_BLOCK] == 1 or count[at.ROW] == 0
    if not (first_piece(setup, state, count, work) if first else echo_piece(setup, state, count, work, store)):
        return False
    count[at.SOURCE] += 1
    state[at.XI] = 0.0
    count[at.JUMP] = 1 if count[at.ARRIVING] != at.NO_CAUSE else count[at.JUMP]
    count[at.READY] = 1
    arrive(setup, state, count, work)
    return True


@kernel
def rows_at_rest(setup: Setup, count: Integers, store: Store, limit: float) -> int:
    """Whole round trips that a contact at rest stays there for certain, judged from the one just past."""
    par = setup.par
    ramp = par[at.RAMP]
    if not is_ramp(setup, count):
        return 0
    top, bottom = -math.inf, -math.inf
    for n in range(count[at.ROW_FROM], count[at.LENGTH]):
        top = max(top, maximum(store.load[n]))
        bottom = max(bottom, maximum(-store.load[n]))
    if ramp == 0.0:
        return FOREVER
    room = limit - top if ramp > 0.0 else limit - (bottom - 2.0 * par[at.REFERENCE])
    rows = math.floor(room / abs(ramp)) - 1.0
    return min(max(int(rows), 0), FOREVER) if rows < 9e18 else FOREVER


@kernel
def is_ramp(setup: Setup, count: Integers) -> bool:
    """Whether the load of the next round trips is that of the last one plus a ramp."""
    if count[at.IS_BLOCK] == 1:
        return True
    reflection = setup.par[at.REFLECTION]
    if reflection == -1.0:
        return True
    if reflection == 1.0:
        return setup.par[at.RAMP] == 0.0 and count[at.STUCK_ROWS] >= 2
    return abs(reflection) ** count[at.STUCK_ROWS] < FORGOTTEN


@kernel
def end_row(setup: Setup, state: Floats, count: Integers, store: Store, limit: float, end_row: int) -> int:
    """Close a round trip; leap over the following ones while nothing can happen in them. Returns at.FULL to go on, or at.LOCKED."""
    outcome = at.FULL
    leap = 0
    if count[at.MOVED] == 0:
        count[at.STUCK_ROWS] += 1
        leap = rows_at_rest(setup, count, store, limit)
        if leap == FOREVER:
            outcome = at.LOCKED
        leap = min(leap, end_row - count[at.ROW] - 1)
        leap = max(leap, 0)
    else:
        count[at.STUCK_ROWS] = 0
    if count[at.IS_BLOCK] == 1:
        state[at.LOAD_NOW] = store.load[count[at.LENGTH] - 1].sum()
    count[at.LEAP] = leap
    count[at.ROW] += 1 + leap
    count[at.PREVIOUS_FROM], count[at.PREVIOUS_TO] = count[at.ROW_FROM], count[at.LENGTH]
    count[at.ROW_FROM] = count[at.LENGTH]
    count[at.SOURCE] = count[at.MOVED] = 0
    return outcome


@kernel
def xi_at(state: Floats, theta: float) -> float:
    """Where in the present piece the offset theta lies."""
    rest = theta - state[at.THETA_FROM]
    root = math.sqrt(max(state[at.SPEED] * state[at.SPEED] + 4.0 * state[at.BEND] * rest, 0.0))
    return 2.0 * rest / (state[at.SPEED] + root)


@kernel
def leave_fold_piece(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The fold is reached: take up the piece of load where it was left, and jump."""
    rate, slipped, law_slip, last = state[at.RATE_NOW], state[at.SLIP_NOW], state[at.LAW_SLIP], state[at.LAST_STEP]
    copy(work.kept[: at.STATES], state)
    state[at.RATE_NOW], state[at.SLIP_NOW], state[at.LAW_SLIP], state[at.LAST_STEP] = rate, slipped, law_slip, last
    copy(work.kept_load, work.load)
    count[at.AT_FOLD] = 0
    end_branch(setup, state, count, work)


@kernel
def run(
    setup: Setup, state: Floats, count: Integers, work: Work, store: Store, last_row: int, last_theta: float, budget: int
) -> int:
    """The loop of `advance`: bring a piece of load, let the contact stick or slip on it, close the round trip."""
    locked = False
    while True:
        if count[at.LENGTH] + ROOM > len(store.whole):
            return at.FULL
        if count[at.STALLED] > LARGEST_STALL:
            return at.STORM
        budget -= 1
        if budget < 0:
            return -1
        if count[at.READY] == 0:
            if count[at.ROW] > last_row:
                return at.LOCKED if locked else at.FINISHED
            if not next_piece(setup, state, count, work, store):
                limit = rest_limit(setup, state, count, work)
                locked = end_row(setup, state, count, store, limit, last_row) == at.LOCKED
                continue
        is_last = count[at.ROW] == last_row and count[at.AT_FOLD] == 0 and state[at.THETA_TO] >= last_theta
        xi_to = min(xi_at(state, last_theta), 1.0) if is_last and state[at.THETA_TO] > last_theta else 1.0
        if state[at.XI] < xi_to:
            if count[at.MODE] == 0:
                stick(setup, state, count, work, store, xi_to)
            else:
                slip(setup, state, count, work, store, xi_to)
            if not math.isfinite(state[at.RATE_NOW]):
                return at.FAILED
        elif count[at.AT_FOLD] == 1:
            leave_fold_piece(setup, state, count, work)
        elif is_last:
            return at.LOCKED if locked else at.FINISHED
        else:
            count[at.READY] = 0


@kernel
def advance(
    setup: Setup, state: Floats, count: Integers, scratch: Floats, store: Store, last_row: int, last_theta: float, budget: int
) -> int:
    """Run to the offset last_theta of round trip last_row, for `budget` steps, or until the store is full; says which it was.

    scratch is an array of WORK_ROWS rows and TERMS columns, zero at the start of a run and kept between calls.
    """
    lent = floats(scratch)
    work = Work(lent[0], lent[1], lent[2], lent[3], lent[4], lent[5], lent[6], lent[7], lent[8], lent[9])
    lent_setup = Setup(
        floats(setup.par),
        integers(setup.address),
        floats(setup.constants),
        floats(setup.law),
        floats(setup.branch),
        floats(setup.first),
    )
    lent_store = Store(integers(store.whole), floats(store.real), floats(store.load), floats(store.rate))
    return run(lent_setup, floats(state), integers(count), work, lent_store, last_row, last_theta, budget)
