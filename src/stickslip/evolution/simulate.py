"""Run a problem."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stickslip.errors import InputError
from stickslip.evolution import layout as at
from stickslip.evolution.creep.leap import CreepLeaps
from stickslip.evolution.history import NO_LEAPS, History
from stickslip.evolution.moving_branches import OUT_OF_BUDGET, RuleFollower, renewed
from stickslip.evolution.setup import prepare, row_time
from stickslip.evolution.solution import Solution
from stickslip.evolution.status import FULL_HISTORY, INTERRUPTED, STATUSES
from stickslip.evolution.workspace import WORK_ROWS, lend
from stickslip.problem import Problem

STEPS_PER_CALL = 200_000
FIRST_CAPACITY = 512

Progress = Callable[[float, int, str], None]
"""Called now and then with the simulated time (s), the number of pieces so far, and what the contact does."""


def simulate(
    problem: Problem,
    duration: float,
    rtol: float = 1e-10,
    *,
    creep_rtol: float = 0.0,
    progress: Progress | None = None,
    max_pieces: int = 4_000_000,
) -> Solution:
    """Run a problem from t = 0 to `duration` (s) with relative tolerance `rtol` (1e-15 to 1e-2).

    A slab under a law of slip creeps for days between pulses, slipping a little in each round trip. With creep_rtol > 0 the run
    leaps over creep, with an error of slip of at most creep_rtol times the slip since the start (`solution.creep` lists the
    leaps), and is exact before and after; with 0 every round trip is run.

    Returns a Solution; what ended the run is its `status`. Ctrl-C ends the run with a valid solution up to that time.
    Raises InputError for a duration that is not positive and finite, an rtol out of range, a contact that cannot even start, or
    a creep_rtol for a problem in which there are no such leaps.
    """
    if not (math.isfinite(duration) and duration > 0):
        raise InputError(f"simulate: duration must be a positive time in s, got {duration!r}")
    if not 1e-15 <= rtol <= 1e-2:
        raise InputError(f"simulate: rtol must lie between 1e-15 and 1e-2, got {rtol!r}")
    setup, state, count = prepare(problem, rtol)
    scratch, store = np.zeros((WORK_ROWS, at.TERMS)), at.new_store(FIRST_CAPACITY, problem.friction.state is not None)
    last = split_time(duration, row_time(problem))
    table = lend(setup, state, count, scratch, store)
    leaps = CreepLeaps(problem, row_time(problem), creep_rtol) if creep_rtol != 0.0 else None
    if leaps is not None:
        count[at.PAUSE_AT] = 1
    follower = RuleFollower(problem, row_time(problem), state, count)
    try:
        while True:
            code = follower.advance(table, store, last, STEPS_PER_CALL)
            length = int(count[at.LENGTH])
            if progress is not None:
                time = count[at.ROW] * row_time(problem) + state[at.THETA_FROM]
                progress(float(time), length, "slips" if count[at.MODE] else "stuck")
            if code == at.FULL:
                if length >= max_pieces:
                    code = FULL_HISTORY
                    break
                store = at.resized(store, length, min(4 * len(store.whole), max_pieces + 16))
                table = lend(setup, state, count, scratch, store)
            elif code == at.NEED_BRANCHES:
                setup = renewed(problem, setup, state, count)
                table = lend(setup, state, count, scratch, store)
            elif code == at.PAUSED and leaps is not None:
                store = leaps.at_row_end(store, state, count, last[0])
                table = lend(setup, state, count, scratch, store)
            elif code != OUT_OF_BUDGET:
                break
    except KeyboardInterrupt:
        code = INTERRUPTED
    length = int(count[at.LENGTH])
    status, kept = STATUSES[code], at.trimmed(store, length)
    if length == 0:
        raise InputError(f"simulate: the run ends where it starts: {status.message}")
    reached = duration if status.ok else float(kept.row[-1] * row_time(problem) + kept.theta_to[-1])
    history = History(kept, problem, row_time(problem), float(setup.par[at.RAMP]), reached, leaps.table if leaps else NO_LEAPS)
    return Solution(problem, duration, rtol, status, history)


def split_time(time: float, row: float) -> tuple[int, float]:
    """A time as (whole rows, offset in the row), the offset in (0, row]."""
    rows = math.floor(time / row)
    offset = time - rows * row
    if offset <= 0.0 and rows > 0:
        return rows - 1, row
    return rows, min(offset, row)
