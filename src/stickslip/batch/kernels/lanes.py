"""Take one explicit step of slip for several members at once, side by side in lanes of the processor's registers.

The series of a step is a long chain in which each coefficient waits for those before it, so that one run alone leaves most of a
processor idle. Arithmetic runs on all lanes at once, with the functions of single runs and identical bits, and so does what a step
leaves in the history. Only what few steps need runs per member: the search for a length that can be proven, and the force that a
step from rest ignores. A step in which slip may end, or which meets a knot of the law, is left to the engine.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

from stickslip.batch.kernels.lane_block import (
    LaneBlock,
    block_in_all_lanes,
    block_in_one_lane,
    lend_rate,
    lend_step,
    note_disc,
    put_in,
    take_out,
)
from stickslip.engine.compile.kernels import inlined, kernel
from stickslip.engine.contact.pieces import note_slip
from stickslip.engine.contact.stiffness import CHECKED, judge_stiffness
from stickslip.engine.contact_step.certificate import (
    ALLOWED,
    ALLOWED_SLOPE,
    NEAR,
    NEGLIGIBLE,
    ROUGH,
    ROUGH_SLOPE,
    SMALLEST,
    begin_step,
    force_of_slope,
    force_on_disc,
    imbalance,
    load_at_end,
    load_on_disc,
    missed_by_motion,
    missed_by_rate,
    proven_length,
    put_discs,
    shortened,
    size_at_end,
    size_of_rate,
    slope_on_disc,
)
from stickslip.engine.contact_step.keep_step import unload_bent, unload_straight
from stickslip.engine.contact_step.negative_friction import goes_below_zero
from stickslip.engine.contact_step.step_events import knot_crossing
from stickslip.engine.contact_step.taylor_step import duration_of, note_shock, unit_from
from stickslip.engine.loop import ROOM
from stickslip.engine.memory.addresses import ahead, call_jet, call_radii, call_values, integers
from stickslip.engine.memory.pointers import numbers_of, rows_of
from stickslip.engine.memory.simd import WIDTH, chosen, first_of, store_across
from stickslip.engine.series.polynomial import NONE, bound_below, moment, multiply, powers_of, scale_low, shift_low, total
from stickslip.engine.series.step_size import FAR_FROM_GUESS, length_at, usable_length
from stickslip.engine.state.layout import TERMS, HistoryPiece, Integers, State
from stickslip.engine.state.workspace import RUN_SIZE, Run, borrow
from stickslip.trajectory.turning_points import SAME, Known

PARTS = 3
"""Number of functions of a formula that work on lanes."""
ROW = HistoryPiece.total
"""Number of places of a piece of the history."""
FIRST_FLOAT = HistoryPiece.places["phase_from"].first
"""First place of a piece of the history that is a float, as all that follow."""
HISTORY, TARGETS, NOWHERE = Run.places["history"].first, LaneBlock.places["targets"].first, LaneBlock.places["nowhere"].first
"""Places of these fields."""
ALL_LANES = 2**WIDTH - 1
"""A bit for each lane."""


class Waits(IntEnum):
    """Say what a lane waits for."""

    NONE = 0
    FRESH = 1
    """Its first step side by side on a piece of load."""
    SLIPPING = 2
    """Another step side by side on the same piece of load."""
    ALONE = 3
    """A step that the engine must take."""


class Side(NamedTuple):
    """The runs in the lanes, as pointers."""

    table: Integers  # their memory
    waits: Integers  # what each lane waits for
    jets: Integers  # addresses of the formulas' series, radii and values, in turn for each piece of the law
    block: int  # address of the numbers in lanes
    known: Known  # what is known of each piece of the first lane's history
    inspects: bool  # True if pieces are to be inspected for that


class LaneStep(NamedTuple):
    """A step that some lanes take together."""

    table: Integers  # memory of the runs in the lanes
    block: int  # address of the numbers in lanes
    taking: int  # lanes that take the step, a bit for each
    moves: bool  # True if the contacts have inertia
    degree: int  # largest degree of their loads


@kernel
def step_side_by_side(side: Side) -> None:
    """Take one step in each lane that waits for one; lanes under the same formula of the law step together."""
    waits = side.waits
    for lane in range(WIDTH):
        if waits[lane] == Waits.FRESH or waits[lane] == Waits.SLIPPING:
            waits[lane] = -waits[lane]
    for lane in range(WIDTH):
        if waits[lane] < 0:
            step_under(ahead(side.jets, PARTS * run_in(side.table, lane).counts.piece), side)


@inlined
def run_in(table: Integers, lane: int) -> Run:
    """Return the run in a lane."""
    return borrow(ahead(table, lane * RUN_SIZE))


@kernel
def step_under(formula: Integers, side: Side) -> None:
    """Take one step in the lanes under a formula that have not taken theirs, which a negative `waits` marks.

    `formula` points to the addresses of its series, of its radii and of its values.
    """
    table, waits, jets, block, known, inspects = side
    rows, lane_0, taking, fresh, degree = block_in_all_lanes(block), block_in_one_lane(block), 0, 0, 1
    targets, moves, is_block = integers(block + 8 * WIDTH * TARGETS), False, False
    for lane in range(WIDTH):
        run, targets[lane] = run_in(table, lane), block + 8 * WIDTH * NOWHERE
        if waits[lane] < 0 and jets[PARTS * run.counts.piece] == formula[0]:
            if waits[lane] == -Waits.FRESH:
                put_in(run, lane_0[lane])
                fresh |= 1 << lane
            moves, is_block, degree = run.counts.has_inertia == 1, run.counts.is_block == 1, max(degree, run.counts.degree)
            targets[lane] = table[lane * RUN_SIZE + HISTORY] + 8 * ROW * run.counts.length
            lane_0[lane].disc, waits[lane], taking = run.counts.disc, Waits.SLIPPING, taking | 1 << lane
    choose_length(formula, LaneStep(table, block, taking, moves, degree))
    reached = settle(rows)
    calculate(rows, degree)
    sound = check_end(rows, formula[2], moves, degree)
    move(rows, reached, is_block)
    store(rows, targets)
    kept, rest = 0, sound & taking
    while rest != 0:
        lane, rest = first_of(rest), rest & (rest - 1)
        if is_simple(run_in(table, lane), lane_0[lane]):
            kept |= 1 << lane
    keep(rows, kept)
    rising, falling = inspect(rows) if inspects else (0, 0)
    while taking != 0:
        lane, taking = first_of(taking), taking & (taking - 1)
        run, own = run_in(table, lane), lane_0[lane]
        if kept >> lane & 1:
            if inspects:
                piece = known[lane * run.capacity + run.counts.length]
                piece.grown, piece.way = own.in_piece, (rising >> lane & 1) - (falling >> lane & 1)
                if fresh >> lane & 1:
                    piece.way = 0  # where a piece of load begins the slip rate may jump
            waits[lane] = append(run, own, fresh >> lane & 1 == 1)
        else:
            run.counts.disc, run.counts.breach, waits[lane] = int(own.disc), 0, Waits.ALONE
        if waits[lane] != Waits.SLIPPING:
            take_out(run, own)


@inlined
def choose_length(formula: Integers, step: LaneStep) -> None:
    """Expand the series in all lanes, and find the lengths that the error allows and that can be proven, as `usable`."""
    table, block, taking, moves, degree = step
    rows, lane_0 = block_in_all_lanes(block), block_in_one_lane(block)
    begin(rows, degree)
    call_jet(formula[0], numbers_of(rows.constants), numbers_of(rows.k), numbers_of(rows.load_along_slip), numbers_of(rows.jet))
    rows.usable = length_at(rows.jet, rows.tolerance, 0.5)
    odd = taking & ~((rows.usable >= FAR_FROM_GUESS) & ~(rows.jet[TERMS - 1] == 0.0))
    while odd != 0:
        lane, odd = first_of(odd), odd & (odd - 1)
        lend_step(run_in(table, lane), lane_0[lane])
        lane_0[lane].usable = usable_length(run_in(table, lane).jet, lane_0[lane].tolerance)
    rows.limit = (rows.state.target - rows.state.xi) / rows.unit
    rows.length = min(rows.usable, rows.limit)
    prove(rows, formula[1], moves, degree)
    largest = ALLOWED_SLOPE if moves else ALLOWED
    odd = taking & ~(rows.share <= largest)
    near = odd & (rows.share <= largest * NEAR)
    if near != 0:  # as the search for a single run begins
        rows.length = chosen(near, shortened(rows.length, rows.share, largest), rows.length)
        prove(rows, formula[1], moves, degree)
        odd = taking & ~(rows.share <= largest)
        rows.usable = chosen(near & ~odd, rows.length, rows.usable)
    odd |= taking & ~(rows.k.free == 1.0)
    while odd != 0:
        lane, odd = first_of(odd), odd & (odd - 1)
        prove_alone(run_in(table, lane), lane_0[lane])


@inlined
def begin(rows: LaneBlock, degree: int) -> None:
    """Calculate the input of the series in all lanes, as `taylor_step.prepare_series` does.

    `degree` is the largest of the loads' degrees, here and below.
    """
    state, k, local, seen = rows.state, rows.k, rows.local, rows.load_along_slip
    pace = state.speed + 2.0 * state.bend * state.xi
    rows.unit = unit_from(state.target - state.xi, pace, state.last_step)
    for n in range(degree + 1):
        local[n] = rows.load[n]
    if (state.xi == 0.0) != ALL_LANES:
        shift_low(local, degree, state.xi)
    scale_low(local, degree, rows.unit)
    for n in range(1, degree + 1):
        seen[n] = rows.direction * local[n]
    for n in range(degree + 1, TERMS):
        local[n] = seen[n] = 0.0
    seen[0] = chosen(rows.direction > 0.0, local[0], -local[0] - 2.0 * rows.reference)
    k.speed, k.bend = pace * rows.unit, 2.0 * state.bend * rows.unit * rows.unit
    k.slip, k.rate = state.law_slip + rows.slip_shift, abs(state.rate_now)


@inlined
def prove(rows: LaneBlock, radii: int, moves: bool, degree: int) -> None:
    """Calculate in all lanes what a step may miss, as `certificate.share_on_disc` does; with inertia if the contact `moves`."""
    powers = rows.disc_powers
    powers_of(rows.ratio * rows.length, powers)
    put_discs(rows.k, rows.jet, powers, rows.ball)
    call_radii(radii, numbers_of(rows.constants), numbers_of(rows.jet), numbers_of(rows.ball))
    force = force_on_disc(rows.k, rows.ball, load_on_disc(rows.load_along_slip, powers, degree))
    size = rows.tolerance * size_of_rate(rows.jet, rows.length)
    if moves:
        missed = rows.length * (abs(rows.k.speed) / rows.k.inertia * force + slope_on_disc(rows.jet, powers)) * rows.shrunk
        resistance = rows.k.inertia / (rows.length * abs(rows.k.speed))
    else:
        missed = force / rows.k.damping * rows.shrunk
        resistance = rows.k.damping
    rows.share = missed / max(size, SMALLEST)
    rows.state.residual = resistance * rows.share * rows.tolerance * size_of_rate(rows.jet, rows.length)
    rows.state.unbalanced = 0.0


@kernel
def prove_alone(run: Run, own: LaneBlock) -> None:
    """Find a length that can be proven for the step in a run's lane, and the force that it ignores at its start."""
    lend_step(run, own)
    length = min(own.usable, own.limit)
    proven = proven_length(run, length)
    if proven < length:
        own.usable = proven
    begin_step(run)
    own.state.residual, own.state.unbalanced = run.state.residual, run.state.unbalanced
    note_disc(run, own)


@inlined
def settle(rows: LaneBlock) -> int:
    """Choose the lengths of proven steps, as `taylor_step.settle_length` does; return the lanes that reach their target."""
    rows.last_step = duration_of(rows.k, rows.usable)
    reached = rows.usable >= rows.limit
    half = 0.5 * rows.limit
    rows.length = chosen(reached, rows.limit, chosen(rows.usable > half, half, rows.usable))
    return reached


@inlined
def calculate(rows: LaneBlock, degree: int) -> None:
    """Calculate slip rate and load over the step, slip in it, and the slip rate at its end.

    The calculations are those of `step_events.stretch` and `keep_step.keep_step`.
    """
    length, rate, load = rows.length, rows.rate, rows.row.load
    powers_of(length, rows.powers)
    multiply(rows.jet, rows.powers, rate)
    multiply(rows.local, rows.powers, load)
    straight = rows.k.speed * length * moment(rate, 1)
    rows.grown = straight + rows.k.bend * length * length * moment(rate, 2)
    rows.rate_end = total(rate)


@inlined
def check_end(rows: LaneBlock, values: int, moves: bool, degree: int) -> int:
    """Return the lanes whose step is sound: slip rate and friction stay above zero, and rounding hides nothing at the end.

    The end is put into the contact equation, as `certificate.measure_end` does.
    """
    k, rate, place, value = rows.k, rows.rate, rows.at_end, rows.value
    place[0], place[1] = k.slip + k.chi * rows.grown, rows.rate_end
    call_values(values, numbers_of(rows.constants), numbers_of(place), numbers_of(value))
    missing = imbalance(k, load_at_end(rows.load_along_slip, rows.powers, degree), value, rows.rate_end, rows.state.unbalanced)
    if moves:
        missed, rough = missed_by_motion(k, missing, rate, rows.length, rows.grown), ROUGH_SLOPE
        missing = missed * force_of_slope(k, rows.length)
    else:
        missed, rough = missed_by_rate(k, missing, value), ROUGH
    rows.state.residual = rows.state.residual + abs(missing) + abs(rows.state.unbalanced)
    sound = (missed <= rough * rows.tolerance * size_at_end(rate, rows.rate_end)) & (abs(rows.rate_end) < math.inf)
    sound &= (rate[0] > 0.0) & (bound_below(rate) > 0.0)
    return sound & ~(rows.reference + k.normal * (value.mu + k.offset) < -NEGLIGIBLE * k.normal)


@inlined
def move(rows: LaneBlock, reached: int, is_block: bool) -> None:
    """Calculate what the step leaves in the history, as `keep_step.move` and `pieces.record` do."""
    state, k, row, length = rows.state, rows.k, rows.row, rows.length
    rows.to = chosen(reached, state.target, state.xi + length * rows.unit)
    width = rows.to - state.xi
    row.phase_from = phase_in(state, state.xi)
    row.phase_to = phase_in(state, rows.to)
    row.speed = (state.speed + 2.0 * state.bend * state.xi) * width
    row.bend = state.bend * width * width
    row.slip, row.law_slip, row.residual = state.slip_now, state.law_slip, state.residual
    row.gain = math.nan
    if is_block:
        unload_straight(rows.direction * rows.stiffness * (k.speed * length), rows.rate, row.load)
        if (k.bend == 0.0) != ALL_LANES:
            unload_bent(rows.direction * rows.stiffness * (k.bend * length * length), rows.rate, row.load)
    for n in range(TERMS):
        row.rate[n] = rows.direction * rows.rate[n]


@inlined
def phase_in(state: State, xi: float) -> float:
    """Return the phase (s) at the place xi of the piece of load in all lanes, as `pieces.phase_at` does."""
    return chosen(xi >= 1.0, state.phase_to, state.phase_from + xi * (state.speed + xi * state.bend))


@inlined
def store(rows: LaneBlock, targets: Integers) -> None:
    """Write what the step leaves in the history there, but for whole numbers, where something else is left for `append`."""
    places = rows_of(rows.row)
    for first in range(ROW - WIDTH, FIRST_FLOAT - WIDTH, -WIDTH):
        store_across(places, targets, max(first, 0))


@inlined
def is_simple(run: Run, own: LaneBlock) -> bool:
    """Return True if a sound step in a run's lane may be kept: it takes time, is proven and meets no knot of the law."""
    if run.counts.breach != 0 or not own.row.phase_to > own.row.phase_from:
        return False
    if run.params.can_be_negative != 0.0 and goes_below_zero(run, lend_rate(run, own), own.length):
        return False
    return run.pieces == 1 or knot_crossing(run, lend_rate(run, own), own.length, 1.0) == NONE


@inlined
def keep(rows: LaneBlock, kept: int) -> None:
    """Move to the end of the step in the lanes that keep it."""
    state, signed = rows.state, rows.direction * rows.grown
    state.xi = chosen(kept, rows.to, state.xi)
    state.slip_now = chosen(kept, state.slip_now + signed, state.slip_now)
    state.law_slip = chosen(kept, state.law_slip + rows.k.chi * rows.grown, state.law_slip)
    state.rate_now = chosen(kept, rows.direction * max(rows.rate_end, 0.0), state.rate_now)
    state.last_step = chosen(kept, rows.last_step, state.last_step)
    state.largest_residual = chosen(kept, max(state.largest_residual, state.residual), state.largest_residual)
    rows.load[0] = chosen(kept, rows.load[0] - rows.stiffness * signed, rows.load[0])
    rows.k.free, rows.k.force = chosen(kept, 1.0, rows.k.free), chosen(kept, 0.0, rows.k.force)


@inlined
def inspect(rows: LaneBlock) -> tuple[int, int]:
    """Return the lanes in which the slip rate is proven to rise throughout the step, and those in which it is proven to fall.

    Calculates the slip in the step from what it leaves in the history, as `reduction.grown` does.
    """
    row = rows.row
    rows.in_piece = chosen(row.bend == 0.0, row.speed * moment(row.rate, 1), math.nan)
    rate, slope, rises = rows.rate, rows.slope, rows.rate[1] > 0.0
    way = chosen(rises, 1.0, -1.0)
    for n in range(TERMS - 1):
        slope[n] = (n + 1) * rate[n + 1] * way
    slope[TERMS - 1] = 0.0
    proven = (slope[0] > 0.0) & (bound_below(slope) > SAME * slope[0])
    return proven & rises, proven & ~rises


@inlined
def append(run: Run, own: LaneBlock, first: bool) -> int:
    """Count the step in a run's lane, and write its whole numbers into the history; return what the lane waits for then.

    `first` is True if it is the first on its piece of load, and may be the first of a slip.
    """
    counts, n = run.counts, run.counts.length
    row = run.history[n]
    row.trip, row.mode, row.law_piece, row.echo_of = counts.trip, counts.mode, counts.piece, counts.echo_of
    row.jump = row.cause = 0
    if first:
        run.jet[0] = own.jet[0]
        note_shock(run)
        row.jump, row.cause = counts.jump, counts.cause
        note_slip(run, n, own.row.phase_from)
        counts.jump = counts.cause = counts.stalled = counts.leaving_rest = 0
        counts.moved = 1
    counts.length = n + 1
    if counts.steps % CHECKED == CHECKED - 1:
        take_out(run, own)
        judge_stiffness(run)
    else:
        counts.steps += 1
    goes_on = own.state.xi < own.state.target and counts.stiff == 0 and n + 1 + ROOM <= run.capacity
    return Waits.SLIPPING if goes_on else Waits.NONE
