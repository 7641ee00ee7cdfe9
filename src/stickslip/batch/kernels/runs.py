"""Many runs in compiled code: the engine on each member, and what is kept of it.

One thread has one workspace with a lane for each of a few members, and takes members as lanes become free. Members that slip under
a law of slip take their steps side by side; others run to their end one after the other, all in the first lane. No Python comes in
between, so threads run side by side; nor are references to arrays counted, but where a run has ended.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from numba import carray

from stickslip.batch.kernels.engine import advance_at
from stickslip.batch.kernels.lanes import ALONE, AWAY, FRESH, step_side_by_side
from stickslip.batch.kernels.pieces import Pieces
from stickslip.batch.kernels.points import find_events
from stickslip.batch.kernels.reduction import COLUMNS, fold_events, fold_first, fold_whole
from stickslip.engine.codegen.compiler import ahead, floats, integers, kernel
from stickslip.engine.codegen.records import numbers_of, whole_numbers_of
from stickslip.engine.codegen.simd import WIDTH
from stickslip.engine.state.layout import Floats, Integers, Stop, Store
from stickslip.engine.state.workspace import ADDRESSES, PLACES, Run, borrow
from stickslip.engine_input.branch_table import OUT_OF_BUDGET
from stickslip.trajectory.slip_events import NOT_YET
from stickslip.trajectory.status import BAD_PARAMETERS

if TYPE_CHECKING:
    from stickslip.batch.setups import Setups
    from stickslip.batch.workspace import Workspace

BUDGET = 200_000
"""Steps between two looks at whether the batch is to stop."""
FREE, UNDER_WAY, AT_END = range(3)
"""What a lane is at: no member; one that runs; one whose run has ended."""


class Lane(NamedTuple):
    """A lane of a workspace, by addresses; the engine's table is that of the member in it."""

    table: Integers
    base: Integers
    stride: Integers
    stage: Integers
    waits: Integers
    member: Integers
    code: Integers


@kernel
def run_group(
    engine: int,
    setups: Setups,
    base: Integers,
    stride: Integers,
    work: Workspace,
    wants_events: bool,
    stop: Integers,
    codes: Integers,
    out: Floats,
) -> int:
    """Run members, each in a lane of the workspace. `engine`: its address; `base`: its table in each lane, for the first member.

    Returns WIDTH when all are done, or `stop` is set; else the lane that has no room, or whose member has crept for so long
    (code PAUSED) that it is to be run alone. Called again, it goes on from there.
    """
    first = first_lane(work, base, stride)
    jets, block = integers(setups.jets.ctypes.data), work.block[0]
    for n in range(WIDTH):
        if nth(first, n).stage[0] != FREE:
            point_at(nth(first, n), setups, first.member[n])
    while True:
        waiting = 0
        for n in range(WIDTH):
            if first.waits[n] == AWAY or first.waits[n] == ALONE:
                if first.stage[n] == UNDER_WAY:
                    advance_member(engine, nth(first, n), setups, stop)
                if first.waits[n] == AWAY and not bring_on(engine, nth(first, n), setups, work, n, wants_events, stop, codes, out):
                    return n
            waiting += first.waits[n] != AWAY
        if waiting == 0 or stop[0] != 0:
            return WIDTH
        step_side_by_side(first.table, first.waits, jets, block)


@kernel
def first_lane(work: Workspace, base: Integers, stride: Integers) -> Lane:
    """The first lane."""
    flags = integers(work.stage.ctypes.data), integers(work.waits.ctypes.data)
    member, code = integers(work.member.ctypes.data), integers(work.code.ctypes.data)
    table, origin = integers(work.table.ctypes.data), integers(base.ctypes.data)
    return Lane(table, origin, integers(stride.ctypes.data), flags[0], flags[1], member, code)


@kernel
def nth(lane: Lane, n: int) -> Lane:
    """The lane n places further on."""
    table, base = ahead(lane.table, n * PLACES), ahead(lane.base, n * ADDRESSES)
    stage, waits, member, code = ahead(lane.stage, n), ahead(lane.waits, n), ahead(lane.member, n), ahead(lane.code, n)
    return Lane(table, base, lane.stride, stage, waits, member, code)


@kernel
def point_at(lane: Lane, setups: Setups, n: int) -> None:
    """The engine's table for the member n."""
    for k in range(ADDRESSES):
        lane.table[k] = lane.base[k] + n * lane.stride[k]
    run = borrow(lane.table)
    run.branches = setups.branches[n]
    run.rate_to, run.keep_from = ahead(run.rate_from, run.branches), ahead(run.rate_from, 2 * run.branches)
    run.keep_to, run.excess_from = ahead(run.rate_from, 3 * run.branches), ahead(run.rate_from, 4 * run.branches)
    run.excess_to = ahead(run.rate_from, 5 * run.branches)


@kernel
def start_member(run: Run, setups: Setups, n: int) -> None:
    """As at t = 0. Nobody will go on behind the end, so that it may cut pieces and leaps from the start."""
    par, state, counts = numbers_of(run.par), numbers_of(run.state), whole_numbers_of(run.counts)
    for k in range(setups.par.shape[1]):
        par[k] = setups.par[n if len(setups.par) > 1 else 0, k]
    for k in range(len(setups.state)):
        state[k] = setups.state[k]
    for k in range(len(setups.counts)):
        counts[k] = setups.counts[k]
    run.counts.to_the_end, run.counts.waits = 1, 1 if len(setups.jets) > 0 else 0


@kernel
def advance_member(engine: int, lane: Lane, setups: Setups, stop: Integers) -> None:
    """Let the engine run the lane's member until it is to take a step with others, ends or pauses, has no room, or all stops."""
    n, table, code = lane.member[0], carray(lane.table, (PLACES,)), OUT_OF_BUDGET
    if lane.waits[0] == ALONE:
        counts = borrow(lane.table).counts
        counts.waits = 0
        code = advance_at(engine, table, setups.last_row[n], setups.last_theta[n], 1)
        counts.waits = 1
    while code == OUT_OF_BUDGET and stop[0] == 0:
        code = advance_at(engine, table, setups.last_row[n], setups.last_theta[n], BUDGET)
    lane.code[0] = code
    lane.waits[0] = FRESH if code == Stop.SLIPS else AWAY
    if code != Stop.SLIPS and code != Stop.FULL and code != Stop.PAUSED and code != OUT_OF_BUDGET:
        lane.stage[0] = AT_END


@kernel
def bring_on(
    engine: int,
    lane: Lane,
    setups: Setups,
    work: Workspace,
    place: int,
    wants_events: bool,
    stop: Integers,
    codes: Integers,
    out: Floats,
) -> bool:
    """Run members in a lane until one is to take a step with others, or none is left; False where there is no room."""
    numbers = floats(out.ctypes.data)
    while lane.stage[0] != UNDER_WAY:
        n = lane.member[0]
        if lane.stage[0] == AT_END:
            run = borrow(lane.table)
            codes[n] = lane.code[0] if run.counts.length > 0 else BAD_PARAMETERS
            member = ahead(numbers, n * len(COLUMNS))
            if run.counts.length > 0 and not fold_member(run, setups, n, work, place, wants_events, codes[n], member):
                return False
            lane.stage[0] = FREE
        n = work.upcoming[0]
        if n == len(codes):
            return True
        work.upcoming[0] += 1
        if setups.branches[n] <= 0:
            codes[n] = BAD_PARAMETERS
            continue
        point_at(lane, setups, n)
        start_member(borrow(lane.table), setups, n)
        lane.stage[0], lane.member[0] = UNDER_WAY, n
        advance_member(engine, lane, setups, stop)
    return lane.code[0] == Stop.SLIPS


@kernel
def fold_member(run: Run, setups: Setups, n: int, work: Workspace, lane: int, wants_events: bool, code: int, out: Floats) -> bool:
    """Fold a run that has ended with a code; False where there is no room for its turning points."""
    pieces, length = Pieces(run.whole, run.real, run.stored_load, run.stored_rate), run.counts.length
    if wants_events:
        events = find_events(store_of(work, lane), length, setups.threshold[n], work.points)
        if events == NOT_YET:
            return False
        fold_events(run, pieces, work.points, events, out)
        if events > 0:
            fold_first(run, pieces, length, work.points, setups.excess[n], setups.stiffness[n], out)
    fold_whole(pieces, length, run.par.row_time, setups.duration[n], code, out)
    return True


@kernel
def store_of(work: Workspace, lane: int) -> Store:
    """The history in a lane."""
    store = work.store
    return Store(store.whole[lane], store.real[lane], store.load[lane], store.rate[lane], store.state[lane])
