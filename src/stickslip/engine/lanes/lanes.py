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

from stickslip.engine.contact.pieces import note_slip
from stickslip.engine.contact.stiffness import STEPS_BETWEEN_CHECKS, judge_stiffness
from stickslip.engine.contact_step.certificate import (
    ALLOWED,
    ALLOWED_SLOPE,
    NEARLY_SMALL,
    NEGLIGIBLE_FRICTION,
    ROUGH,
    ROUGH_SLOPE,
    SMALLEST_RATE,
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
)
from stickslip.engine.contact_step.keep_step import unload_bent, unload_straight
from stickslip.engine.contact_step.negative_friction import goes_below_zero
from stickslip.engine.contact_step.step_events import knot_crossing
from stickslip.engine.contact_step.taylor_step import duration_of, note_shock, unit_from
from stickslip.engine.history.turning_points import NEAR_THRESHOLD, Known
from stickslip.engine.lanes.lane_block import (
    LaneBlock,
    block_in_all_lanes,
    block_in_one_lane,
    lend_rate,
    lend_step,
    note_disc,
    put_in,
    take_out,
)
from stickslip.engine.series.polynomial import (
    NONE,
    bound_below,
    bound_of_slope,
    moment,
    multiply,
    powers_of,
    scale_low,
    shift_low,
    total,
)
from stickslip.engine.series.step_size import FAR_FROM_GUESS, length_at, usable_length
from stickslip.engine.state.layout import TERMS, HistoryPiece, Integers, State
from stickslip.engine.state.workspace import ROOM, RUN_SIZE, Run, borrow
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, call_jet, call_radii, call_values, integers
from stickslip.foundation.kernels.memory.pointers import numbers_of, rows_of
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH, chosen, first_of, store_across

FUNCTIONS_OF_FORMULA = 3
"""Number of functions of a formula that work on lanes."""
ROW = HistoryPiece.total
"""Number of places of a piece of the history."""
FIRST_FLOAT = HistoryPiece.places["phase_from"].first
"""First place of a piece of the history that is a float, as all that follow."""
HISTORY, TARGETS, NOWHERE = Run.places["history"].first, LaneBlock.places["targets"].first, LaneBlock.places["nowhere"].first
"""Places of these fields."""
ALL_LANES = 2**SIMD_WIDTH - 1
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
    for lane in range(SIMD_WIDTH):
        if waits[lane] == Waits.FRESH or waits[lane] == Waits.SLIPPING:
            waits[lane] = -waits[lane]
    for lane in range(SIMD_WIDTH):
        if waits[lane] < 0:
            step_under(ahead(side.jets, FUNCTIONS_OF_FORMULA * run_in(side.table, lane).counts.piece), side)


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
    lanes, lane_0, taking, fresh, degree = block_in_all_lanes(block), block_in_one_lane(block), 0, 0, 1
    targets, moves, is_block = integers(block + 8 * SIMD_WIDTH * TARGETS), False, False
    for lane in range(SIMD_WIDTH):
        run, targets[lane] = run_in(table, lane), block + 8 * SIMD_WIDTH * NOWHERE
        if waits[lane] < 0 and jets[FUNCTIONS_OF_FORMULA * run.counts.piece] == formula[0]:
            if waits[lane] == -Waits.FRESH:
                put_in(run, lane_0[lane])
                fresh |= 1 << lane
            moves, is_block, degree = run.counts.has_inertia == 1, run.counts.is_block == 1, max(degree, run.counts.degree)
            targets[lane] = table[lane * RUN_SIZE + HISTORY] + 8 * ROW * run.counts.length
            lane_0[lane].disc, waits[lane], taking = run.counts.disc, Waits.SLIPPING, taking | 1 << lane
    choose_length(formula, LaneStep(table, block, taking, moves, degree))
    reached = settle(lanes)
    calculate(lanes, taking)
    sound = check_end(lanes, formula[2], moves, degree)
    move(lanes, reached, is_block)
    store(lanes, targets)
    kept, rest = 0, sound & taking
    while rest != 0:
        lane, rest = first_of(rest), rest & (rest - 1)
        if is_simple(run_in(table, lane), lane_0[lane]):
            kept |= 1 << lane
    keep(lanes, kept)
    rising, falling = inspect(lanes) if inspects else (0, 0)
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
    lanes, lane_0 = block_in_all_lanes(block), block_in_one_lane(block)
    begin(lanes, degree)
    call_jet(formula[0], numbers_of(lanes.constants), numbers_of(lanes.k), numbers_of(lanes.load_along_slip), numbers_of(lanes.jet))
    lanes.usable = length_at(lanes.jet, lanes.tolerance, 0.5)
    odd = taking & ~((lanes.usable >= FAR_FROM_GUESS) & ~(lanes.jet[TERMS - 1] == 0.0))
    while odd != 0:
        lane, odd = first_of(odd), odd & (odd - 1)
        lend_step(run_in(table, lane), lane_0[lane])
        lane_0[lane].usable = usable_length(run_in(table, lane).jet, lane_0[lane].tolerance)
    lanes.limit = (lanes.state.target - lanes.state.xi) / lanes.unit
    lanes.length = min(lanes.usable, lanes.limit)
    prove(lanes, formula[1], moves, degree)
    largest = ALLOWED_SLOPE if moves else ALLOWED
    odd = taking & ~(lanes.share <= largest)
    near = odd & (lanes.share <= largest * NEARLY_SMALL)
    if near != 0:  # as the search for a single run begins
        lanes.length = chosen(near, shortened(lanes.length, lanes.share, largest), lanes.length)
        prove(lanes, formula[1], moves, degree)
        odd = taking & ~(lanes.share <= largest)
        lanes.usable = chosen(near & ~odd, lanes.length, lanes.usable)
    odd |= taking & ~(lanes.k.free == 1.0)
    while odd != 0:
        lane, odd = first_of(odd), odd & (odd - 1)
        prove_alone(run_in(table, lane), lane_0[lane])


@inlined
def begin(lanes: LaneBlock, degree: int) -> None:
    """Calculate the input of the series in all lanes, as `taylor_step.prepare_series` does.

    `degree` is the largest of the loads' degrees, here and below.
    """
    state, k, local, seen = lanes.state, lanes.k, lanes.local, lanes.load_along_slip
    pace = state.speed + 2.0 * state.bend * state.xi
    lanes.unit = unit_from(state.target - state.xi, pace, state.last_step)
    for n in range(degree + 1):
        local[n] = lanes.load[n]
    if (state.xi == 0.0) != ALL_LANES:
        shift_low(local, degree, state.xi)
    scale_low(local, degree, lanes.unit)
    for n in range(1, degree + 1):
        seen[n] = lanes.direction * local[n]
    for n in range(degree + 1, TERMS):
        local[n] = seen[n] = 0.0
    seen[0] = chosen(lanes.direction > 0.0, local[0], -local[0] - 2.0 * lanes.reference)
    k.speed, k.bend = pace * lanes.unit, 2.0 * state.bend * lanes.unit * lanes.unit
    k.slip, k.rate = state.law_slip + lanes.slip_shift, abs(state.rate_now)


@inlined
def prove(lanes: LaneBlock, radii: int, moves: bool, degree: int) -> None:
    """Calculate in all lanes what a step may miss, as `certificate.share_at` does; with inertia if the contact `moves`."""
    stretch(lanes)
    put_discs(lanes.k, lanes.rate, lanes.ratio, lanes.length, lanes.ball)
    call_radii(radii, numbers_of(lanes.constants), numbers_of(lanes.jet), numbers_of(lanes.ball))
    force = force_on_disc(lanes.k, lanes.ball, load_on_disc(lanes.load_along_slip, lanes.powers, lanes.ratio, degree))
    size = lanes.tolerance * size_of_rate(lanes.rate)
    if moves:
        slope = bound_of_slope(lanes.rate, lanes.ratio)
        missed = (lanes.length * abs(lanes.k.speed) / lanes.k.inertia * force + slope) * lanes.shrunk
        resistance = lanes.k.inertia / (lanes.length * abs(lanes.k.speed))
    else:
        missed = force / lanes.k.damping * lanes.shrunk
        resistance = lanes.k.damping
    lanes.share = missed / max(size, SMALLEST_RATE)
    lanes.state.residual = resistance * lanes.share * lanes.tolerance * size_of_rate(lanes.rate)
    lanes.state.unbalanced = 0.0


@inlined
def stretch(lanes: LaneBlock) -> None:
    """Calculate the powers of the steps' lengths, and the slip rate over the steps, as `step_events.stretch` does."""
    powers_of(lanes.length, lanes.powers)
    multiply(lanes.jet, lanes.powers, lanes.rate)


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
def settle(lanes: LaneBlock) -> int:
    """Choose the lengths of proven steps, as `taylor_step.settle_length` does; return the lanes that reach their target."""
    lanes.last_step = duration_of(lanes.k, lanes.usable)
    reached = lanes.usable >= lanes.limit
    half = 0.5 * lanes.limit
    lanes.length = chosen(reached, lanes.limit, chosen(lanes.usable > half, half, lanes.usable))
    return reached


@inlined
def calculate(lanes: LaneBlock, taking: int) -> None:
    """Calculate slip rate and load over the step that some lanes are taking, slip in it, and the slip rate at its end.

    The calculations are those of `step_events.stretch` and `keep_step.keep_step`.
    """
    length, rate, load = lanes.length, lanes.rate, lanes.row.load
    if (length == lanes.powers[1]) & taking != taking:  # some steps have another length than that which was tried last
        stretch(lanes)
    multiply(lanes.local, lanes.powers, load)
    straight = lanes.k.speed * length * moment(rate, 1)
    lanes.grown = straight + lanes.k.bend * length * length * moment(rate, 2)
    lanes.rate_end = total(rate)


@inlined
def check_end(lanes: LaneBlock, values: int, moves: bool, degree: int) -> int:
    """Return the lanes whose step is sound: slip rate and friction stay above zero, and rounding hides nothing at the end.

    The end is put into the contact equation, as `certificate.measure_end` does.
    """
    k, rate, place, value = lanes.k, lanes.rate, lanes.at_end, lanes.value
    place[0], place[1] = k.slip + k.chi * lanes.grown, lanes.rate_end
    call_values(values, numbers_of(lanes.constants), numbers_of(place), numbers_of(value))
    missing = imbalance(k, load_at_end(lanes.load_along_slip, lanes.powers, degree), value, lanes.rate_end, lanes.state.unbalanced)
    if moves:
        missed, rough = missed_by_motion(k, missing, rate, lanes.length, lanes.grown), ROUGH_SLOPE
        missing = missed * force_of_slope(k, lanes.length)
    else:
        missed, rough = missed_by_rate(k, missing, value), ROUGH
    lanes.state.residual = lanes.state.residual + abs(missing) + abs(lanes.state.unbalanced)
    sound = (missed <= rough * lanes.tolerance * size_at_end(rate, lanes.rate_end)) & (abs(lanes.rate_end) < math.inf)
    sound &= (rate[0] > 0.0) & (bound_below(rate) > 0.0)
    return sound & ~(lanes.reference + k.normal * (value.mu + k.offset) < -NEGLIGIBLE_FRICTION * k.normal)


@inlined
def move(lanes: LaneBlock, reached: int, is_block: bool) -> None:
    """Calculate what the step leaves in the history, as `keep_step.move` and `pieces.record` do."""
    state, k, row, length = lanes.state, lanes.k, lanes.row, lanes.length
    lanes.to = chosen(reached, state.target, state.xi + length * lanes.unit)
    width = lanes.to - state.xi
    row.phase_from = phase_in(state, state.xi)
    row.phase_to = phase_in(state, lanes.to)
    row.speed = (state.speed + 2.0 * state.bend * state.xi) * width
    row.bend = state.bend * width * width
    row.slip, row.law_slip, row.residual = state.slip_now, state.law_slip, state.residual
    row.gain = math.nan
    if is_block:
        unload_straight(lanes.direction * lanes.stiffness * (k.speed * length), lanes.rate, row.load)
        if (k.bend == 0.0) != ALL_LANES:
            unload_bent(lanes.direction * lanes.stiffness * (k.bend * length * length), lanes.rate, row.load)
    for n in range(TERMS):
        row.rate[n] = lanes.direction * lanes.rate[n]


@inlined
def phase_in(state: State, xi: float) -> float:
    """Return the phase (s) at the place xi of the piece of load in all lanes, as `pieces.phase_at` does."""
    return chosen(xi >= 1.0, state.phase_to, state.phase_from + xi * (state.speed + xi * state.bend))


@inlined
def store(lanes: LaneBlock, targets: Integers) -> None:
    """Write what the step leaves in the history there, but for whole numbers, where something else is left for `append`."""
    places = rows_of(lanes.row)
    for first in range(ROW - SIMD_WIDTH, FIRST_FLOAT - SIMD_WIDTH, -SIMD_WIDTH):
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
def keep(lanes: LaneBlock, kept: int) -> None:
    """Move to the end of the step in the lanes that keep it."""
    state, signed = lanes.state, lanes.direction * lanes.grown
    state.xi = chosen(kept, lanes.to, state.xi)
    state.slip_now = chosen(kept, state.slip_now + signed, state.slip_now)
    state.law_slip = chosen(kept, state.law_slip + lanes.k.chi * lanes.grown, state.law_slip)
    state.rate_now = chosen(kept, lanes.direction * max(lanes.rate_end, 0.0), state.rate_now)
    state.last_step = chosen(kept, lanes.last_step, state.last_step)
    state.largest_residual = chosen(kept, max(state.largest_residual, state.residual), state.largest_residual)
    lanes.load[0] = chosen(kept, lanes.load[0] - lanes.stiffness * signed, lanes.load[0])
    lanes.k.free, lanes.k.force = chosen(kept, 1.0, lanes.k.free), chosen(kept, 0.0, lanes.k.force)


@inlined
def inspect(lanes: LaneBlock) -> tuple[int, int]:
    """Return the lanes in which the slip rate is proven to rise throughout the step, and those in which it is proven to fall.

    Calculates the slip in the step from what it leaves in the history, as `reduction.grown` does.
    """
    row = lanes.row
    lanes.in_piece = chosen(row.bend == 0.0, row.speed * moment(row.rate, 1), math.nan)
    rate, slope, rises = lanes.rate, lanes.slope, lanes.rate[1] > 0.0
    way = chosen(rises, 1.0, -1.0)
    for n in range(TERMS - 1):
        slope[n] = (n + 1) * rate[n + 1] * way
    slope[TERMS - 1] = 0.0
    proven = (slope[0] > 0.0) & (bound_below(slope) > NEAR_THRESHOLD * slope[0])
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
    if counts.steps % STEPS_BETWEEN_CHECKS == STEPS_BETWEEN_CHECKS - 1:
        take_out(run, own)
        judge_stiffness(run)
    else:
        counts.steps += 1
    goes_on = own.state.xi < own.state.target and counts.stiff == 0 and n + 1 + ROOM <= run.capacity
    return Waits.SLIPPING if goes_on else Waits.NONE
