"""The engine: brings the load round trip after round trip, lets the contact answer, and leaps over rest.

One loop serves both bodies. A slab's load is what left the contact one round trip ago, reflected by the driver, plus what the
driver sends; a block's is its spring. Pieces of load arrive one by one and are split wherever the contact needs it.
"""

from __future__ import annotations

import math

from stickslip.evolution.compiled import kernel
from stickslip.evolution.contact_step import arrive, end_branch, rest_limit, slip, stick
from stickslip.evolution.layout import (
    ARRIVING,
    AT_FOLD,
    BEND,
    ECHO,
    FAILED,
    FINISHED,
    FULL,
    IMPEDANCE,
    INFLOW,
    INFLOW_RATE,
    IS_BLOCK,
    JUMP,
    LEAP,
    LENGTH,
    LOAD_NOW,
    LOADING,
    LOCKED,
    MODE,
    MOVED,
    NO_CAUSE,
    PREVIOUS_FROM,
    PREVIOUS_TO,
    RAMP,
    LAST_STEP,
    LAW_SLIP,
    RATE_NOW,
    READY,
    SLIP_NOW,
    REFERENCE,
    REFLECTION,
    ROW,
    ROW_FROM,
    ROW_TIME,
    SOURCE,
    SPEED,
    STALLED,
    START,
    STORM,
    STUCK_ROWS,
    TERMS,
    THETA_FROM,
    THETA_TO,
    XI,
    Floats,
    Integers,
    Setup,
    Store,
    Work,
)
from stickslip.evolution.polynomial import maximum

ROOM = 8
LARGEST_STALL = 200
FOREVER = 2**62
FORGOTTEN = 1e-17


@kernel
def first_piece(setup: Setup, state: Floats, count: Integers, work: Work) -> bool:
    """The next piece of load of a first round trip, or of any period of a block; False when there is none left."""
    source = count[SOURCE]
    if source >= len(setup.first_load):
        return False
    state[THETA_FROM], state[THETA_TO] = setup.first_theta[source], setup.first_theta[source + 1]
    state[SPEED], state[BEND] = state[THETA_TO] - state[THETA_FROM], 0.0
    work.load[:] = 0.0
    work.load[0] = setup.first_load[source]
    work.load[1] = setup.first_slope[source] * state[SPEED]
    if count[IS_BLOCK] == 1 and count[ROW] > 0:
        work.load[0] = state[LOAD_NOW] + count[LEAP] * setup.par[RAMP]
    count[ARRIVING] = NO_CAUSE
    if count[ROW] == 0 and source == 0:
        count[ARRIVING] = START
    elif count[ROW] == 0 and setup.first_jump[source] == 1:
        count[ARRIVING] = LOADING
    return True


@kernel
def echo_piece(setup: Setup, state: Floats, count: Integers, work: Work, store: Store) -> bool:
    """The next piece of load that returns from the driver; False when the round trip is complete."""
    source = count[PREVIOUS_FROM] + count[SOURCE]
    if source >= count[PREVIOUS_TO]:
        return False
    par = setup.par
    state[THETA_FROM], state[THETA_TO] = store.theta_from[source], store.theta_to[source]
    state[SPEED], state[BEND] = store.speed[source], store.bend[source]
    for k in range(TERMS):
        leaving = 2.0 * par[IMPEDANCE] * store.rate[source, k] - store.load[source, k]
        work.load[k] = par[REFLECTION] * leaving
    time = count[ROW] * par[ROW_TIME] + state[THETA_FROM]
    work.load[0] += par[INFLOW] + par[INFLOW_RATE] * time - par[REFLECTION] * count[LEAP] * par[RAMP]
    work.load[1] += par[INFLOW_RATE] * state[SPEED]
    work.load[2] += par[INFLOW_RATE] * state[BEND]
    count[ARRIVING] = ECHO if store.jump[source] == 1 and par[REFLECTION] != 0.0 else NO_CAUSE
    return True


@kernel
def next_piece(setup: Setup, state: Floats, count: Integers, work: Work, store: Store) -> bool:
    """Bring the next piece of load and let the contact meet its start; False at the end of the round trip."""
    first = count[IS_BLOCK] == 1 or count[ROW] == 0
    if not (first_piece(setup, state, count, work) if first else echo_piece(setup, state, count, work, store)):
        return False
    count[SOURCE] += 1
    state[XI] = 0.0
    count[JUMP] = 1 if count[ARRIVING] != NO_CAUSE else count[JUMP]
    count[READY] = 1
    arrive(setup, state, count, work)
    return True


@kernel
def rows_at_rest(setup: Setup, count: Integers, store: Store, limit: float) -> int:
    """Whole round trips that a contact at rest stays there for certain, judged from the one just past."""
    par = setup.par
    ramp = par[RAMP]
    if not is_ramp(setup, count):
        return 0
    top, bottom = -math.inf, -math.inf
    for n in range(count[ROW_FROM], count[LENGTH]):
        top = max(top, maximum(store.load[n]))
        bottom = max(bottom, maximum(-store.load[n]))
    if ramp == 0.0:
        return FOREVER
    room = limit - top if ramp > 0.0 else limit - (bottom - 2.0 * par[REFERENCE])
    rows = math.floor(room / abs(ramp)) - 1.0
    return min(max(int(rows), 0), FOREVER) if rows < 9e18 else FOREVER


@kernel
def is_ramp(setup: Setup, count: Integers) -> bool:
    """Whether the load of the next round trips is that of the last one plus a ramp."""
    if count[IS_BLOCK] == 1:
        return True
    reflection = setup.par[REFLECTION]
    if reflection == -1.0:
        return True
    if reflection == 1.0:
        return setup.par[RAMP] == 0.0 and count[STUCK_ROWS] >= 2
    return abs(reflection) ** count[STUCK_ROWS] < FORGOTTEN


@kernel
def end_row(setup: Setup, state: Floats, count: Integers, store: Store, limit: float, end_row: int) -> int:
    """Close a round trip; leap over the following ones while nothing can happen in them. Returns FULL to go on, or LOCKED."""
    outcome = FULL
    leap = 0
    if count[MOVED] == 0:
        count[STUCK_ROWS] += 1
        leap = rows_at_rest(setup, count, store, limit)
        if leap == FOREVER:
            outcome = LOCKED
        leap = min(leap, end_row - count[ROW] - 1)
        leap = max(leap, 0)
    else:
        count[STUCK_ROWS] = 0
    if count[IS_BLOCK] == 1:
        state[LOAD_NOW] = store.load[count[LENGTH] - 1].sum()
    count[LEAP] = leap
    count[ROW] += 1 + leap
    count[PREVIOUS_FROM], count[PREVIOUS_TO] = count[ROW_FROM], count[LENGTH]
    count[ROW_FROM] = count[LENGTH]
    count[SOURCE] = count[MOVED] = 0
    return outcome


@kernel
def xi_at(state: Floats, theta: float) -> float:
    """Where in the present piece the offset theta lies."""
    rest = theta - state[THETA_FROM]
    root = math.sqrt(max(state[SPEED] * state[SPEED] + 4.0 * state[BEND] * rest, 0.0))
    return 2.0 * rest / (state[SPEED] + root)


@kernel
def leave_fold_piece(setup: Setup, state: Floats, count: Integers, work: Work) -> None:
    """The fold is reached: take up the piece of load where it was left, and jump."""
    rate, slipped, law_slip, last = state[RATE_NOW], state[SLIP_NOW], state[LAW_SLIP], state[LAST_STEP]
    state[:] = work.kept
    state[RATE_NOW], state[SLIP_NOW], state[LAW_SLIP], state[LAST_STEP] = rate, slipped, law_slip, last
    work.load[:] = work.kept_load
    count[AT_FOLD] = 0
    end_branch(setup, state, count, work)


@kernel
def advance(
    setup: Setup, state: Floats, count: Integers, work: Work, store: Store, last_row: int, last_theta: float, budget: int
) -> int:
    """Run to the offset last_theta of round trip last_row, for `budget` steps, or until the store is full; says which it was."""
    locked = False
    while True:
        if count[LENGTH] + ROOM > len(store.row):
            return FULL
        if count[STALLED] > LARGEST_STALL:
            return STORM
        budget -= 1
        if budget < 0:
            return -1
        if count[READY] == 0:
            if count[ROW] > last_row:
                return LOCKED if locked else FINISHED
            if not next_piece(setup, state, count, work, store):
                limit = rest_limit(setup, state, count, work)
                locked = end_row(setup, state, count, store, limit, last_row) == LOCKED
                continue
        is_last = count[ROW] == last_row and count[AT_FOLD] == 0 and state[THETA_TO] >= last_theta
        xi_to = min(xi_at(state, last_theta), 1.0) if is_last and state[THETA_TO] > last_theta else 1.0
        if state[XI] < xi_to:
            if count[MODE] == 0:
                stick(setup, state, count, work, store, xi_to)
            else:
                slip(setup, state, count, work, store, xi_to)
            if not math.isfinite(state[RATE_NOW]):
                return FAILED
        elif count[AT_FOLD] == 1:
            leave_fold_piece(setup, state, count, work)
        elif is_last:
            return LOCKED if locked else FINISHED
        else:
            count[READY] = 0

