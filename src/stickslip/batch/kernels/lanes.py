"""Take one explicit step of slip for several members at once, side by side in lanes of the processor's registers.

The series of a step is a long chain in which each coefficient waits for those before it, so that one run alone leaves most of a
processor idle. Control flow runs per member, with the functions of single runs. Arithmetic runs on all lanes at once, with the same
functions and identical bits. A step in which slip may end, or which meets a knot of the law, is left to the engine.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Any

from stickslip.engine.codegen.compiler import ahead, call_jet, call_radii, call_values, inlined, kernel
from stickslip.engine.codegen.lane_records import all_lanes, floats_of, one_lane
from stickslip.engine.codegen.records import Record, floats_inside, inside
from stickslip.engine.codegen.simd import WIDTH
from stickslip.engine.contact.contact_equation import constants_of
from stickslip.engine.contact.stiffness import judge_stiffness
from stickslip.engine.contact_step.certificate import (
    RATIOS,
    SHRUNK,
    SHRUNK_SLOPE,
    SMALLEST,
    allowed,
    begin_step,
    force_on_disc,
    imbalance,
    is_negative,
    load_at_end,
    load_on_disc,
    missed_by_motion,
    missed_by_rate,
    note_residual,
    proven_length,
    put_discs,
    rough,
    size_at_end,
    size_of_rate,
    slope_on_disc,
)
from stickslip.engine.contact_step.keep_step import move
from stickslip.engine.contact_step.negative_friction import goes_below_zero
from stickslip.engine.contact_step.step_events import knot_crossing
from stickslip.engine.contact_step.taylor_step import first_guess, length_to, note_shock, prepare_series, settle_length
from stickslip.engine.loop import ROOM
from stickslip.engine.series.polynomial import NONE, bound_below, fill, moment, multiply, powers_of, total
from stickslip.engine.series.step_size import FAR_FROM_GUESS, length_at, usable_length
from stickslip.engine.state.layout import TERMS, Ball, Floats, Integers, LawValue, SeriesInput
from stickslip.engine.state.workspace import RUN_SIZE, Run, borrow


class Block(Record):
    """Hold the numbers of a step in lanes; each place holds one number for every lane."""

    k: SeriesInput = inside(SeriesInput)  # input of the series
    load_along_slip: Floats = floats_inside(TERMS)  # as in `engine.state.workspace.Run`
    local: Floats = floats_inside(TERMS)
    jet: Floats = floats_inside(TERMS)  # the law's functions write `centres` right after it
    centres: Floats = floats_inside(TERMS)
    disc_powers: Floats = floats_inside(TERMS)  # powers of the radius of the disc on which a step is proven, in guesses
    ball: Ball = inside(Ball)  # radii on that disc
    ratio: float  # 1: radius of that disc, in lengths of the step
    shrunk: float  # 1: factor by which what the step misses is smaller on the step than on that disc
    disc: float  # 1: number of the disc that served the step before
    share: float  # 1: bound of what the step misses, as a share (`contact_step.certificate`)
    powers: Floats = floats_inside(TERMS)
    rate: Floats = floats_inside(TERMS)  # m/s: slip rate over the step, as a polynomial on [0, 1]
    load: Floats = floats_inside(TERMS)  # Pa or N: load over the step
    usable: float  # length that the error allows the step, in guesses
    length: float  # length of the step, in guesses
    bound: float  # m/s: lower bound of the slip rate
    grown: float  # m: slip in the step
    last: float  # m/s: slip rate at the end of the step
    guess: float  # 1: unit of the series, in xi
    reached: float  # 1 if the step reaches the target of the run, else 0
    last_step: float  # s: length that the error allowed the step before to have
    unbalanced: float  # Pa or N: force that the step ignores at its start
    place: Floats = floats_inside(2)  # m, m/s: slip of the law and slip rate at the end of the step
    value: LawValue = inside(LawValue)  # friction there
    size: float  # m/s: size of the slip rate, with which errors at the end are compared
    missed: float  # m/s: what the contact equation lacks there, in terms of the slip rate
    tolerance: float  # 1: local error allowed to the step
    constants: Floats = floats_inside(0)  # constants of the law, as many as it has


block_in_all_lanes: Any = all_lanes(Block)
"""Function for compiled code that sees the block at an address in all lanes at once."""
block_in_one_lane: Any = one_lane(Block)
"""Function for compiled code that sees the block at an address in lane 0."""


PARTS = 3
"""Number of functions of a formula that work on lanes."""


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
    formulas' series, radii and values, in turn for each piece of the law; block is the address of the numbers in lanes.
    """
    for lane in range(WIDTH):
        if waits[lane] == Waits.FRESH or waits[lane] == Waits.SLIPPING:
            waits[lane] = -waits[lane]
    for lane in range(WIDTH):
        if waits[lane] < 0:
            step_under(ahead(jets, PARTS * piece_of(table, lane)), table, waits, jets, block)


@inlined
def piece_of(table: Integers, lane: int) -> int:
    """Return the piece of the law under which the member in a lane slips."""
    return borrow(ahead(table, lane * RUN_SIZE)).counts.piece


@kernel
def step_under(formula: Integers, table: Integers, waits: Integers, jets: Integers, block: int) -> None:
    """Take one step in the lanes under a formula that have not taken theirs, which a negative `waits` marks.

    `formula` points to the addresses of its series, of its radii and of its values.
    """
    rows, lane_0, taking, moves, degree = block_in_all_lanes(block), block_in_one_lane(block), 0, False, 1
    for lane in range(WIDTH):
        if waits[lane] < 0 and jets[PARTS * piece_of(table, lane)] == formula[0]:
            moves = borrow(ahead(table, lane * RUN_SIZE)).counts.has_inertia == 1
            put_in(borrow(ahead(table, lane * RUN_SIZE)), lane_0[lane], -waits[lane] == Waits.FRESH)
            degree = max(degree, borrow(ahead(table, lane * RUN_SIZE)).counts.degree)
            waits[lane], taking = Waits.SLIPPING, taking | 1 << lane
    call_jet(formula[0], floats_of(rows.constants), floats_of(rows.k), floats_of(rows.load_along_slip), floats_of(rows.jet))
    rows.length = length_at(rows.jet, rows.tolerance, 0.5)
    for lane in range(WIDTH):
        if taking >> lane & 1:
            take_length(borrow(ahead(table, lane * RUN_SIZE)), lane_0[lane])
    prove(rows, formula[1], moves, degree)
    for lane in range(WIDTH):
        if taking >> lane & 1:
            settle(borrow(ahead(table, lane * RUN_SIZE)), lane_0[lane])
    calculate(rows, degree)
    check_end(rows, formula[2], moves, degree)
    for lane in range(WIDTH):
        if taking >> lane & 1:
            waits[lane] = take_out(borrow(ahead(table, lane * RUN_SIZE)), lane_0[lane])


@inlined
def put_in(run: Run, own: Block, fresh: bool) -> None:
    """Copy the input of a run's series into its lane of the block; if `fresh`, also what is constant on a piece of load."""
    guess = first_guess(run, run.state.target - run.state.xi)
    prepare_series(run, guess)
    k, last, own.guess = run.k, run.counts.degree, guess
    own.k.speed, own.k.bend, own.k.slip = k.speed, k.bend, k.slip
    own.k.rate, own.k.free, own.k.force = k.rate, k.free, k.force
    if fresh:
        own.k.damping, own.k.normal, own.k.chi = k.damping, k.normal, k.chi
        own.k.offset, own.k.inertia, own.k.stiffness = k.offset, k.inertia, k.stiffness
        own.tolerance, last = run.params.tolerance, TERMS - 1
        constants = constants_of(run, run.counts.piece)
        for n in range(run.size):
            own.constants[n] = constants[n]
    for n in range(last + 1):
        own.load_along_slip[n] = run.load_along_slip[n]
        own.local[n] = run.local[n]


@inlined
def take_length(run: Run, own: Block) -> None:
    """Store the length of a run's step that must be proven, in units of the guess, in the run's lane of the block."""
    usable = own.length
    if not usable >= FAR_FROM_GUESS or own.jet[TERMS - 1] == 0.0:  # `length_at` alone does not decide here
        for k in range(TERMS):
            run.jet[k] = own.jet[k]
        usable = usable_length(run.jet, run.params.tolerance)
    own.usable, own.length = usable, min(usable, length_to(run, run.state.target, own.guess))
    moves, disc = run.counts.has_inertia == 1, run.counts.disc
    own.ratio, own.shrunk = RATIOS[disc], SHRUNK_SLOPE[disc] if moves else SHRUNK[disc]


@inlined
def prove(rows: Block, radii: int, moves: bool, degree: int) -> None:
    """Calculate in all lanes what a step may miss, as `certificate.share_on_disc` does; with inertia if the contact `moves`.

    `degree` is the largest of the loads' degrees, here and below.
    """
    powers = rows.disc_powers
    powers_of(rows.ratio * rows.length, powers)
    put_discs(rows.k, rows.jet, powers, rows.ball)
    call_radii(radii, floats_of(rows.constants), floats_of(rows.jet), floats_of(rows.ball))
    force = force_on_disc(rows.k, rows.ball, load_on_disc(rows.load_along_slip, powers, degree))
    if moves:
        missed = rows.length * (abs(rows.k.speed) / rows.k.inertia * force + slope_on_disc(rows.jet, powers)) * rows.shrunk
    else:
        missed = force / rows.k.damping * rows.shrunk
    rows.share = missed / max(rows.tolerance * size_of_rate(rows.jet, rows.length), SMALLEST)


@inlined
def settle(run: Run, own: Block) -> None:
    """Choose the length of a run's step, now that it is proven or not, and store it in the run's lane of the block."""
    own.last_step, own.disc, length = run.state.last_step, run.counts.disc, own.usable
    if own.share <= allowed(run):
        run.jet[0], run.jet[1], run.jet[2], run.jet[3] = own.jet[0], own.jet[1], own.jet[2], own.jet[3]
        note_residual(run, own.length, own.share)
    else:
        for k in range(TERMS):
            run.jet[k], run.centres[k] = own.jet[k], own.centres[k]
        proven = proven_length(run, own.length)
        length = proven if proven < own.length else length
    length, reached = settle_length(run, run.state.target, own.guess, length)
    begin_step(run)
    own.length, own.reached, own.unbalanced = length, 1.0 if reached else 0.0, run.state.unbalanced


@inlined
def calculate(rows: Block, degree: int) -> None:
    """Calculate in all lanes slip rate and load over the step, slip in it, and the rate's value at the end and lower bound.

    The calculations are those of `step_events.stretch` and `keep_step.keep_step`.
    """
    length, rate = rows.length, rows.rate
    powers_of(length, rows.powers)
    multiply(rows.jet, rows.powers, rate)
    if degree == 1:
        rows.load[0], rows.load[1] = rows.local[0], rows.local[1] * rows.powers[1]
    else:
        multiply(rows.local, rows.powers, rows.load)
    straight = rows.k.speed * length * moment(rate, 1)
    rows.grown = straight + rows.k.bend * length * length * moment(rate, 2)
    rows.last = total(rate)
    rows.bound = bound_below(rate)


@inlined
def check_end(rows: Block, values: int, moves: bool, degree: int) -> None:
    """Put the end of a step into the contact equation in all lanes, as `certificate.measure_rounding` does."""
    k, rate, place, value = rows.k, rows.rate, rows.place, rows.value
    place[0], place[1] = k.slip + k.chi * rows.grown, rows.last
    call_values(values, floats_of(rows.constants), floats_of(place), floats_of(value))
    missing = imbalance(k, load_at_end(rows.load_along_slip, rows.powers, degree), value, rows.last, rows.unbalanced)
    rows.size = size_at_end(rate, rows.last)
    if moves:
        rows.missed = missed_by_motion(k, missing, rate, rows.length, rows.grown)
    else:
        rows.missed = missed_by_rate(k, missing, value)


@inlined
def take_out(run: Run, own: Block) -> int:
    """Append the step to the run's history if it is a simple one, and return what the lane waits for then.

    A step is simple if it is proven, rounding hides nothing at its end, slip rate and friction stay positive and no knot is met.
    Otherwise the step is dropped and Waits.ALONE is returned.
    """
    length, target = own.length, run.state.target
    rate, load = run.history[run.counts.length].rate, run.history[run.counts.length].load
    for k in range(TERMS):
        rate[k] = own.rate[k]
    if run.counts.degree == 1:
        fill(load, 0.0)
        load[0], load[1] = own.load[0], own.load[1]
    else:
        for k in range(TERMS):
            load[k] = own.load[k]
    simple = run.counts.breach == 0 and rate[0] > 0.0 and own.bound > 0.0 and math.isfinite(own.last)
    grown, rate_end, run.value.mu = own.grown, own.last, own.value.mu
    simple = simple and own.missed <= rough(run) * own.tolerance * own.size and not is_negative(run)
    if simple and run.params.can_be_negative != 0.0:
        powers_of(length, run.powers)
        simple = not goes_below_zero(run, rate, length)
    if not simple or (run.pieces > 1 and knot_crossing(run, rate, length, 1.0) != NONE):
        run.state.last_step, run.counts.disc, run.counts.breach = own.last_step, int(own.disc), 0
        return Waits.ALONE
    run.jet[0] = own.jet[0]
    note_shock(run)
    to = target if own.reached == 1.0 else run.state.xi + length * own.guess
    move(run, length, grown, rate_end, to)
    judge_stiffness(run)
    goes_on = run.state.xi < target and run.counts.stalled == 0 and run.counts.stiff == 0
    return Waits.SLIPPING if goes_on and run.counts.length + ROOM <= run.capacity else Waits.NONE
