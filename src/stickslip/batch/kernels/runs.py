"""Many runs one after the other in compiled code: the engine on each member, and what is kept of it.

One thread has one workspace, which serves all its members. No Python comes in between, so threads run side by side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.batch.kernels.engine import advance_at
from stickslip.batch.kernels.pieces import Pieces, pieces_of
from stickslip.batch.kernels.points import find_events
from stickslip.batch.kernels.reduction import COLUMNS, fold_events, fold_first, fold_whole
from stickslip.evolution import layout as at
from stickslip.evolution.compiled import ahead, floats, inlined, integers, kernel
from stickslip.evolution.events import NOT_YET
from stickslip.evolution.layout import Floats, Integers
from stickslip.evolution.moving_branches import OUT_OF_BUDGET
from stickslip.evolution.status import BAD_PARAMETERS
from stickslip.evolution.workspace import BRANCHES, PAR_AT, Run, borrow

if TYPE_CHECKING:
    from stickslip.batch.setups import Setups
    from stickslip.batch.workspace import Workspace

BUDGET = 200_000
"""Steps between two looks at whether the batch is to stop."""
AT_START, UNDER_WAY, AT_END = range(3)
"""How far the member is at which `run_group` goes on."""


@inlined
def start_member(setups: Setups, state: Floats, count: Integers) -> None:
    """As at t = 0. Nobody will go on behind the end, so that it may cut pieces and leaps from the start."""
    for k in range(len(setups.state)):
        state[k] = setups.state[k]
    for k in range(len(setups.counts)):
        count[k] = setups.counts[k]
    count[at.TO_THE_END] = 1


@inlined
def fold_slip_events(run: Run, setups: Setups, n: int, work: Workspace, store: Pieces, out: Floats) -> bool:
    """Fold the slip events of a run that has ended; False where there is no room for its turning points."""
    length = run.counts[at.LENGTH]
    events = find_events(work.store, length, setups.threshold[n], work.points)
    if events == NOT_YET:
        return False
    fold_events(run, store, work.points, events, out)
    if events > 0:
        fold_first(run, store, length, work.points, setups.excess[n], setups.stiffness[n], out)
    return True


@kernel
def run_group(
    engine: int,
    setups: Setups,
    base: Integers,
    stride: Integers,
    work: Workspace,
    where: Integers,
    wants_events: bool,
    stop: Integers,
    codes: Integers,
    out: Floats,
) -> int:
    """Run members from where[0] on, of which the first is as far as where[1] says; where[2] keeps its code. `engine`: its address.

    Returns the number of members when all are done, else that at which there is no room (where says how to go on); less when
    `stop` is set.
    """
    state, count = floats(work.state.ctypes.data), integers(work.counts.ctypes.data)
    table, numbers, store = base.copy(), floats(out.ctypes.data), pieces_of(work.store)
    for n in range(where[0], len(codes)):
        for k in range(len(base)):
            table[k] = base[k] + n * stride[k]
        table[BRANCHES] = setups.branches[n]
        if where[1] == AT_START:
            if setups.branches[n] <= 0:
                codes[n] = BAD_PARAMETERS
                continue
            start_member(setups, state, count)
        if where[1] != AT_END:
            where[2] = to_the_end(engine, table, setups.last_row[n], setups.last_theta[n], stop)
            if where[2] == at.FULL or where[2] == OUT_OF_BUDGET:
                where[0], where[1] = n, UNDER_WAY
                return n
        codes[n] = where[2] if count[at.LENGTH] > 0 else BAD_PARAMETERS
        if count[at.LENGTH] > 0:
            member = ahead(numbers, n * len(COLUMNS))
            if wants_events and not fold_slip_events(borrow(table), setups, n, work, store, member):
                where[0], where[1] = n, AT_END
                return n
            row_time = floats(table[PAR_AT])[at.ROW_TIME]
            fold_whole(store, count[at.LENGTH], row_time, setups.duration[n], codes[n], member)
        where[1] = AT_START
    return len(codes)


@kernel
def to_the_end(engine: int, table: Integers, last_row: int, last_theta: float, stop: Integers) -> int:
    """Run one member until it ends, its history is full, or the batch is stopped; says which, as `engine.advance`."""
    while True:
        code = advance_at(engine, table, last_row, last_theta, BUDGET)
        if code != OUT_OF_BUDGET or stop[0] != 0:
            return code
