"""Take one explicit step of slip for several members at once, side by side in lanes of the processor's registers.

The series of a step is a long chain in which each coefficient waits for those before it, so that one run alone leaves most of a
processor idle. Control flow runs per member, with the functions of single runs. Arithmetic runs on all lanes at once, with the same
functions and identical bits. A step in which slip may end, or which meets a knot of the law, is left to the engine.
"""

from __future__ import annotations

import math
from enum import IntEnum

from stickslip.engine.codegen.compiler import ahead, call_jet, floats, inlined, kernel
from stickslip.engine.codegen.records import numbers_of
from stickslip.engine.codegen.simd import WIDTH, lanes_at
from stickslip.engine.contact.contact_equation import constants_of
from stickslip.engine.contact.stiffness import judge_stiffness
from stickslip.engine.contact_step.keep_step import move
from stickslip.engine.contact_step.step_events import knot_crossing
from stickslip.engine.contact_step.taylor_step import choose_length, first_guess, note_shock, prepare_series
from stickslip.engine.contact_step.verify import begin_verification, is_negative, obeys_contact
from stickslip.engine.loop import ROOM
from stickslip.engine.series.polynomial import NONE, bound_below, fill, moment, multiply, powers_of, total
from stickslip.engine.series.step_size import FAR_FROM_GUESS, length_at, usable_length
from stickslip.engine.state.layout import TERMS, Floats, Integers, Series
from stickslip.engine.state.workspace import PLACES, Run, borrow

K_SPEED, K_BEND, K_SLIP, K_RATE, K_FREE, K_FORCE = (
    Series.places[name].first for name in ("speed", "bend", "slip", "rate", "free", "force")
)
"""Rows of the block that hold the fields of `run.k` (`Series`) that change from step to step."""
SERIES = Series.total
"""Number of the first rows of the block, which hold all fields of `run.k`."""
SEEN, LOCAL, JET, REACH, POWERS, RATE, LOAD = (Series.total + n * TERMS for n in range(7))
LENGTH, BOUND, GROWN, LAST, GUESS, REACHED, LAST_STEP, TOLERANCE = range(LOAD + TERMS, LOAD + TERMS + 8)
CONSTANTS = TOLERANCE + 1
"""First rows of the other contents of the block, which has WIDTH numbers in each row: polynomials of TERMS rows each (load as the
formula sees it, load, series of the rate, bound of the guards, powers of the length, rate and load over the step), then single
numbers (length, lower bound of the rate, slip in the step, rate at its end, guess, whether the target is reached, last step,
tolerance), and last the law's constants."""


class Waits(IntEnum):
    """Say what a lane waits for."""

    NONE = 0
    FRESH = 1
    """Its first step side by side on a piece of load."""
    SLIPPING = 2
    """Another step side by side on the same piece of load."""
    ALONE = 3
    """A step that the engine must take."""


@kernel
def step_side_by_side(table: Integers, waits: Integers, jets: Integers, block: int) -> None:
    """Take one step in each lane that waits for one; lanes under the same formula of the law step together.

    table points to the memory of the runs in the lanes, waits to what each lane waits for, and jets to the addresses of the
    formulas' series, one for each piece of the law; block is the address of the numbers in lanes.
    """
    for lane in range(WIDTH):
        if waits[lane] == Waits.FRESH or waits[lane] == Waits.SLIPPING:
            waits[lane] = -waits[lane]
    for lane in range(WIDTH):
        if waits[lane] < 0:
            step_under(jets[piece_of(table, lane)], table, waits, jets, block)


@inlined
def piece_of(table: Integers, lane: int) -> int:
    """Return the piece of the law under which the member in a lane slips."""
    return borrow(ahead(table, lane * PLACES)).counts.piece


@kernel
def step_under(address: int, table: Integers, waits: Integers, jets: Integers, block: int) -> None:
    """Take one step in the lanes under the formula at `address` that have not taken theirs, which a negative `waits` marks."""
    column, rows, taking = floats(block), lanes_at(block), 0
    for lane in range(WIDTH):
        if waits[lane] < 0 and jets[piece_of(table, lane)] == address:
            put_in(borrow(ahead(table, lane * PLACES)), ahead(column, lane), -waits[lane] == Waits.FRESH)
            waits[lane], taking = Waits.SLIPPING, taking | 1 << lane
    call_jet(address, floats(block + 64 * CONSTANTS), column, floats(block + 64 * SEEN), floats(block + 64 * JET))
    rows[LENGTH] = length_at(ahead(rows, JET), rows[TOLERANCE], 0.5)
    for lane in range(WIDTH):
        if taking >> lane & 1:
            take_length(borrow(ahead(table, lane * PLACES)), ahead(column, lane))
    calculate(rows)
    for lane in range(WIDTH):
        if taking >> lane & 1:
            waits[lane] = take_out(borrow(ahead(table, lane * PLACES)), ahead(column, lane))


@inlined
def put_in(run: Run, own: Floats, fresh: bool) -> None:
    """Copy the input of a run's series into its column of the block; if `fresh`, also what is constant on a piece of load."""
    guess = first_guess(run, run.state.target - run.state.xi)
    prepare_series(run, guess)
    own[WIDTH * GUESS] = guess
    for k in (K_SPEED, K_BEND, K_SLIP, K_RATE, K_FREE, K_FORCE):
        own[WIDTH * k] = numbers_of(run.k)[k]
    last = run.counts.degree
    if fresh:
        constants, last = constants_of(run, run.counts.piece), TERMS - 1
        for k in range(SERIES):
            own[WIDTH * k] = numbers_of(run.k)[k]
        own[WIDTH * TOLERANCE] = run.params.tolerance
        for k in range(run.size):
            own[WIDTH * (CONSTANTS + k)] = constants[k]
    for k in range(last + 1):
        own[WIDTH * (SEEN + k)] = run.load_along_slip[k]
        own[WIDTH * (LOCAL + k)] = run.local[k]


@inlined
def take_length(run: Run, own: Floats) -> None:
    """Choose the length of a run's step, in units of the guess, and store it in the run's column of the block."""
    usable = own[WIDTH * LENGTH]
    if not usable >= FAR_FROM_GUESS or own[WIDTH * (JET + TERMS - 1)] == 0.0:  # `length_at` alone does not decide here
        for k in range(TERMS):
            run.jet[k] = own[WIDTH * (JET + k)]
        usable = usable_length(run.jet, run.params.tolerance)
    if run.law[run.counts.piece].guard_count > 0:
        for k in range(TERMS):
            run.reach[k] = own[WIDTH * (REACH + k)]
    own[WIDTH * LAST_STEP] = run.state.last_step
    length, reached = choose_length(run, run.state.target, own[WIDTH * GUESS], usable)
    own[WIDTH * LENGTH], own[WIDTH * REACHED] = length, 1.0 if reached else 0.0


@inlined
def calculate(rows: Floats) -> None:
    """Calculate in all lanes slip rate and load over the step, slip in it, and the rate's value at the end and lower bound.

    The calculations are those of `taylor_step.stretch` and `taylor_step.keep_step`.
    """
    length, rate, powers = rows[LENGTH], ahead(rows, RATE), ahead(rows, POWERS)
    powers_of(length, powers)
    multiply(ahead(rows, JET), powers, rate)
    multiply(ahead(rows, LOCAL), powers, ahead(rows, LOAD))
    straight = rows[K_SPEED] * length * moment(rate, 1)
    rows[GROWN] = straight + rows[K_BEND] * length * length * moment(rate, 2)
    rows[LAST] = total(rate)
    rows[BOUND] = bound_below(rate)


@inlined
def take_out(run: Run, own: Floats) -> int:
    """Append the step to the run's history if it is a simple one, and return what the lane waits for then.

    A step is simple if the rate stays positive, the contact equation is obeyed and no knot is met. Otherwise the step is dropped
    and Waits.ALONE is returned.
    """
    length, target = own[WIDTH * LENGTH], run.state.target
    rate, load = run.history[run.counts.length].rate, run.history[run.counts.length].load
    for k in range(TERMS):
        rate[k] = own[WIDTH * (RATE + k)]
    if run.counts.degree == 1:
        fill(load, 0.0)
        load[0], load[1] = own[WIDTH * LOAD], own[WIDTH * (LOAD + 1)]
    else:
        for k in range(TERMS):
            load[k] = own[WIDTH * (LOAD + k)]
    simple = rate[0] > 0.0 and own[WIDTH * BOUND] > 0.0 and math.isfinite(own[WIDTH * LAST])
    grown, rate_end = own[WIDTH * GROWN], own[WIDTH * LAST]
    if simple:
        powers_of(length, run.powers)
        begin_verification(run)
        simple = obeys_contact(run, rate, length, grown, rate_end) and not is_negative(run)
    if not simple or (run.pieces > 1 and knot_crossing(run, rate, length, 1.0) != NONE):
        run.state.last_step = own[WIDTH * LAST_STEP]
        return Waits.ALONE
    run.jet[0] = own[WIDTH * JET]
    note_shock(run)
    to = target if own[WIDTH * REACHED] == 1.0 else run.state.xi + length * own[WIDTH * GUESS]
    move(run, length, grown, rate_end, to)
    if run.counts.has_inertia == 1:
        judge_stiffness(run)
    goes_on = run.state.xi < target and run.counts.stalled == 0 and run.counts.stiff == 0
    return Waits.SLIPPING if goes_on and run.counts.length + ROOM <= run.capacity else Waits.NONE
