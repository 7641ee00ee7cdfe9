"""stickslip's kernel: the compiled engine on arrays that are already there."""

from __future__ import annotations

import math
from collections.abc import Callable

from benchmarks.problems import Case, Floats, arrest_of
from benchmarks.runner import Runner
from stickslip.evolution import layout as at
from stickslip.evolution.drive import split_time
from stickslip.evolution.echoes import new_echoes
from stickslip.evolution.engine import advance
from stickslip.evolution.history import History
from stickslip.evolution.inflow import row_time
from stickslip.evolution.setup import prepare
from stickslip.evolution.solution import Solution
from stickslip.evolution.status import STATUSES
from stickslip.evolution.workspace import counts_in, lend, memory_of

CAPACITY = 2048
BUDGET = 1_000_000


def runner(case: Case, tolerance: float, kernel: Callable[..., int] = advance) -> Runner:
    """Run `kernel`, which reads the engine's table: the engine itself, or its copy in C."""
    setup, state, count = prepare(case.problem, tolerance)
    count.to_the_end = 1  # nothing goes on behind it
    store, echoes = at.new_store(CAPACITY, case.problem.friction.state is not None), new_echoes(CAPACITY)
    memory = memory_of(setup.par, state, count)
    lend(memory, setup, store, echoes)
    first, count = memory.copy(), counts_in(memory)
    last_row, last_theta = split_time(case.duration, row_time(case.problem))

    lent = (setup, store, echoes)  # the memory holds their addresses only: they live as long as the runner

    def run() -> None:
        assert lent
        memory[:] = first
        code = kernel(memory, last_row, last_theta, BUDGET)
        assert STATUSES[code].ok, STATUSES[code]

    def solution() -> Solution:
        history = History(
            at.trimmed(store, int(count.length)),
            case.problem,
            row_time(case.problem),
            float(setup.par.ramp),
            case.duration,
        )
        return Solution(case.problem, case.duration, tolerance, STATUSES[at.FINISHED], history)

    def slip(times: Floats) -> Floats:
        return solution().slip(times) - case.problem.initial_slip

    def arrest() -> float:
        return arrest_of(solution()) if case.arrests else math.nan

    return Runner(case, tolerance, run, slip, lambda: int(count.length), arrest)
