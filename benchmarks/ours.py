"""stickslip's kernel: the compiled engine on arrays that are already there."""

from __future__ import annotations

import math
from collections.abc import Callable

from benchmarks.problems import Case, Floats, arrest_of
from benchmarks.runner import Runner
from stickslip.engine.history.history import History
from stickslip.engine.input.limits import split_time
from stickslip.engine.input.prepare import prepare
from stickslip.engine.loop import run_until
from stickslip.engine.on_demand import lend_parts_of_batch
from stickslip.engine.state import layout as at
from stickslip.engine.state.workspace import counts_in, lend_history
from stickslip.problem.run_codes import Stop
from stickslip.problem.run_options import RunOptions
from stickslip.problem.run_status import STATUSES
from stickslip.solution.solution import Solution

CAPACITY = 2048
BUDGET = 1_000_000


def runner(case: Case, tolerance: float, kernel: Callable[..., int] = run_until) -> Runner:
    """Run `kernel`, which reads the engine's table: the engine itself, or its copy in C."""
    setup, memory = prepare(case.problem, tolerance)
    count = counts_in(memory)
    count.to_the_end = 1  # nothing goes on behind it
    store, echoes = at.new_store(CAPACITY, len(case.problem.friction.states)), at.EchoNode.table(CAPACITY)
    lend_history(memory, store, echoes)
    lend_parts_of_batch(memory, setup.params, count)
    first = memory.copy()
    last_trip, last_phase = split_time(case.duration, case.problem.round_trip_time)

    lent = (setup, store, echoes)  # the memory holds their addresses only: they live as long as the runner

    def run() -> None:
        assert lent
        memory[:] = first
        code = kernel(memory, last_trip, last_phase, BUDGET)
        assert STATUSES[code].ok, STATUSES[code]

    def solution() -> Solution:
        history = History(
            at.trimmed(store, int(count.length)),
            case.problem,
            case.problem.round_trip_time,
            float(setup.params.ramp),
            case.duration,
        )
        return Solution(case.problem, RunOptions(case.duration, tolerance), STATUSES[Stop.FINISHED], history)

    def slip(times: Floats) -> Floats:
        return solution().slip(times) - case.problem.initial_slip

    def arrest() -> float:
        return arrest_of(solution()) if case.arrests else math.nan

    return Runner(case, tolerance, run, slip, lambda: int(count.length), arrest)
