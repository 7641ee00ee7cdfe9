"""Many runs in compiled code: the engine on each member, and what is kept of it.

One thread has one workspace with a lane for each of a few members, and takes members as lanes become free. Members that slip under
a law of slip take their steps side by side; others run to their end one after the other, all in the first lane. No Python comes in
between, so threads run side by side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.batch.kernels.engine import advance_at
from stickslip.batch.kernels.lanes import ALONE, AWAY, FRESH, step_side_by_side
from stickslip.batch.kernels.points import find_events
from stickslip.batch.kernels.reduction import fold_events, fold_first, fold_whole, reached
from stickslip.evolution import layout as at
from stickslip.evolution.compiled import inlined, kernel
from stickslip.evolution.events import NOT_YET
from stickslip.evolution.lanes import WIDTH
from stickslip.evolution.layout import Floats, Integers, Store
from stickslip.evolution.moving_branches import OUT_OF_BUDGET
from stickslip.evolution.status import BAD_PARAMETERS
from stickslip.evolution.workspace import BRANCHES, Run, borrow

if TYPE_CHECKING:
    from stickslip.batch.setups import Setups
    from stickslip.batch.workspace import Workspace

BUDGET = 200_000
"""Steps between two looks at whether the batch is to stop."""
FREE, UNDER_WAY, AT_END = range(3)
"""What a lane is at: no member; one that runs; one whose run has ended."""


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

    Returns WIDTH when all are done, or `stop` is set; else the lane that has no room. Called again, it goes on from there.
    """
    tables, waits, jets, block = base.copy(), work.waits, setups.jets, work.block[0]
    for lane in range(WIDTH):
        if work.stage[lane] != FREE:
            point_at(tables[lane], base[lane], stride, setups, work.member[lane])
    while True:
        waiting = 0
        for lane in range(WIDTH):
            due = waits[lane] == AWAY or waits[lane] == ALONE
            if due and not bring_on(engine, tables[lane], base[lane], stride, setups, work, lane, wants_events, stop, codes, out):
                return lane
            waiting += waits[lane] != AWAY
        if waiting == 0 or stop[0] != 0:
            return WIDTH
        step_side_by_side(tables, waits, jets, block)


@kernel
def bring_on(
    engine: int,
    table: Integers,
    base: Integers,
    stride: Integers,
    setups: Setups,
    work: Workspace,
    lane: int,
    wants_events: bool,
    stop: Integers,
    codes: Integers,
    out: Floats,
) -> bool:
    """Run members in a lane until one is to slip in step with others, or none is left; False where there is no room."""
    while True:
        if work.stage[lane] == FREE:
            n = work.upcoming[0]
            if n == len(codes):
                return True
            work.upcoming[0] += 1
            if setups.branches[n] <= 0:
                codes[n] = BAD_PARAMETERS
                continue
            point_at(table, base, stride, setups, n)
            start_member(setups, work.state[lane], work.counts[lane], work.scratch[lane])
            work.stage[lane], work.member[lane] = UNDER_WAY, n
        n = work.member[lane]
        if work.stage[lane] == UNDER_WAY:
            code = work.code[lane] = advance_member(engine, table, setups, work, lane, stop)
            work.waits[lane] = FRESH if code == at.SLIPS else AWAY
            if code == at.SLIPS:
                return True
            if code == at.FULL or code == OUT_OF_BUDGET:
                return False
            work.stage[lane] = AT_END
        has_run = work.counts[lane, at.LENGTH] > 0
        codes[n] = work.code[lane] if has_run else BAD_PARAMETERS
        if has_run and not fold_member(borrow(table), setups, n, work, store_of(work, lane), wants_events, codes[n], out[n]):
            return False
        work.stage[lane] = FREE


@inlined
def point_at(table: Integers, base: Integers, stride: Integers, setups: Setups, n: int) -> None:
    """The engine's table for the member n."""
    for k in range(len(base)):
        table[k] = base[k] + n * stride[k]
    table[BRANCHES] = setups.branches[n]


@inlined
def start_member(setups: Setups, state: Floats, count: Integers, scratch: Floats) -> None:
    """As at t = 0. Nobody will go on behind the end, so that it may cut pieces and leaps from the start."""
    for k in range(len(state)):
        state[k] = setups.state[k]
    for k in range(len(count)):
        count[k] = setups.counts[k]
    count[at.TO_THE_END], count[at.WAITS] = 1, 1 if len(setups.jets) > 0 else 0
    scratch[:] = 0.0


@inlined
def store_of(work: Workspace, lane: int) -> Store:
    """The history in a lane."""
    store = work.store
    return Store(store.whole[lane], store.real[lane], store.load[lane], store.rate[lane], store.state[lane])


@kernel
def advance_member(engine: int, table: Integers, setups: Setups, work: Workspace, lane: int, stop: Integers) -> int:
    """Run a member until it slips, ends, its history is full, or the batch is stopped; says which, as `engine.advance`."""
    n = work.member[lane]
    if work.waits[lane] == ALONE:
        work.counts[lane, at.WAITS] = 0
        code = advance_at(engine, table, setups.last_row[n], setups.last_theta[n], 1)
        work.counts[lane, at.WAITS] = 1
        if code != OUT_OF_BUDGET:
            return code
    while True:
        code = advance_at(engine, table, setups.last_row[n], setups.last_theta[n], BUDGET)
        if code != OUT_OF_BUDGET or stop[0] != 0:
            return code


@kernel
def fold_member(
    run: Run, setups: Setups, n: int, work: Workspace, store: Store, wants_events: bool, code: int, out: Floats
) -> bool:
    """Fold a run that has ended with a code; False where there is no room for its turning points."""
    length = run.counts[at.LENGTH]
    if wants_events:
        events = find_events(store, length, setups.threshold[n], work.points)
        if events == NOT_YET:
            return False
        fold_events(run, store, work.points, events, out)
        if events > 0:
            fold_first(run, store, length, work.points, setups.excess[n], setups.stiffness[n], out)
    fold_whole(run, store, length, reached(setups.duration[n], code, run.par[at.ROW_TIME], store, length), out)
    return True
