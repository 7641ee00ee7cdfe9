"""stickslip's kernel: the compiled engine on arrays that are already there."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

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
from stickslip.evolution.workspace import WORK_ROWS, lend

CAPACITY = 2048
BUDGET = 1_000_000


def runner(case: Case, tolerance: float, kernel: Callable[..., int] = advance) -> Runner:
    """Run `kernel`, which reads the engine's table: the engine itself, or its copy in C."""
    setup, state, count = prepare(case.problem, tolerance)
    count[at.TO_THE_END] = 1  # nothing goes on behind it
    first_state, first_count = state.copy(), count.copy()
    store, scratch = at.new_store(CAPACITY, case.problem.friction.state is not None), np.zeros((WORK_ROWS, at.TERMS))
    echoes = new_echoes(CAPACITY)
    table = lend(setup, state, count, scratch, store, echoes)
    last_row, last_theta = split_time(case.duration, row_time(case.problem))

    lent = (setup, state, count, scratch, store, echoes)  # the table holds their addresses only: they live as long as the runner

    def run() -> None:
        _, state, count, *_ = lent
        state[:] = first_state
        count[:] = first_count
        code = kernel(table, last_row, last_theta, BUDGET)
        assert STATUSES[code].ok, STATUSES[code]

    def solution() -> Solution:
        history = History(
            at.trimmed(store, int(count[at.LENGTH])),
            case.problem,
            row_time(case.problem),
            float(setup.par[at.RAMP]),
            case.duration,
        )
        return Solution(case.problem, case.duration, tolerance, STATUSES[at.FINISHED], history)

    def slip(times: Floats) -> Floats:
        return solution().slip(times) - case.problem.initial_slip

    def arrest() -> float:
        return arrest_of(solution()) if case.arrests else math.nan

    return Runner(case, tolerance, run, slip, lambda: int(count[at.LENGTH]), arrest)
