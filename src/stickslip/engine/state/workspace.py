"""What the engine works on: one run in progress, as a record in memory that its caller lends.

Pointers and not arrays, because compiled code counts references of every array that it hands on, which costs more than the work
in functions as small as these.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine.codegen.records import Record, floats_at, inside, integers_at, record_at, row
from stickslip.engine.codegen.uncompiled import lend_memory
from stickslip.engine.state.layout import TERMS, Counts, Floats, Integers, Params, Series, Setup, State, Store

WHOLE, REAL = 6, 8
"""Columns of the history's tables."""

MATRIX_ROWS = 18
"""Equations of an implicit step: their matrix and right-hand side fill so many rows of TERMS numbers."""


class Run(Record):
    """One run: addresses of the problem's tables and of the history, how long they are, the state, and scratch space."""

    value_at: Integers = integers_at()  # by piece of the law
    jet_at: Integers = integers_at()
    state_at: Integers = integers_at()
    guards_at: Integers = integers_at()
    guard_count: Integers = integers_at()
    constants: Floats = floats_at()
    slip_shift: Floats = floats_at()
    offset: Floats = floats_at()
    knot: Floats = floats_at()
    rate_from: Floats = floats_at()  # by branch
    rate_to: Floats = floats_at()
    keep_from: Floats = floats_at()
    keep_to: Floats = floats_at()
    excess_from: Floats = floats_at()
    excess_to: Floats = floats_at()
    first_theta: Floats = floats_at()  # by piece of the first load
    first_load: Floats = floats_at()
    first_slope: Floats = floats_at()
    first_jump: Floats = floats_at()
    from_row: Floats = floats_at()  # by segment of the loading
    from_offset: Floats = floats_at()
    from_value: Floats = floats_at()
    from_slope: Floats = floats_at()
    from_jump: Floats = floats_at()

    whole: Integers = integers_at()  # the history, row after row
    real: Floats = floats_at()
    stored_load: Floats = floats_at()
    stored_rate: Floats = floats_at()
    stored_state: Floats = floats_at()

    node: Integers = integers_at()  # the trees of echoes
    heights: Floats = floats_at()

    pieces: int
    size: int  # of the constants of a piece
    branches: int
    loads: int
    segments: int
    capacity: int
    implicit_step: int  # addresses of functions that are compiled apart, 0 where the run has not needed them yet
    implicit_rest: int

    par: Params = inside(Params)
    state: State = inside(State)
    counts: Counts = inside(Counts)

    load: Floats = row(TERMS)  # the present piece of load, in xi
    local: Floats = row(TERMS)  # of the step at hand, in units of the guess; zero beyond the degree of the piece
    seen: Floats = row(TERMS)  # the same in the direction of slip, minus the reference
    jet: Floats = row(TERMS)
    reach: Floats = row(TERMS)  # the bound that the jet of a formula with guards leaves behind the series
    powers: Floats = row(TERMS)
    k: Series = inside(Series, TERMS)
    value: Floats = row(TERMS)
    kept_load: Floats = row(TERMS)  # the piece that goes on behind a fold
    kept: State = inside(State, TERMS)  # and the state there
    part: Floats = row(TERMS)  # for tests on load and rate
    spare: Floats = row(TERMS)
    state_jet: Floats = row(TERMS)  # of an implicit step: the state's polynomial
    stage_rate: Floats = row(TERMS)  # and the values at its points
    stage_state: Floats = row(TERMS)
    matrix: Floats = row(MATRIX_ROWS * TERMS)


PLACES = Run.total
ADDRESSES = Run.places["pieces"].first
"""Places with addresses; the numbers behind them say how long the tables are."""
SCRATCH = Run.places["load"].first
"""Where scratch space begins in a run's memory; it goes on to the end."""
WORK_ROWS = (PLACES - SCRATCH) // TERMS

borrow: Any = record_at(Run)
"""Compiled: the run in memory that `lend` has filled."""


def memory_of(par: Params, state: State, counts: Counts) -> Integers:
    """Return memory for a run that begins so; its tables are still to be lent."""
    memory = np.zeros(PLACES, np.int64)
    params_in(memory).numbers[:], state_in(memory).numbers[:] = par.numbers, state.numbers
    counts_in(memory).numbers[:] = counts.numbers
    return memory


def params_in(memory: Integers) -> Params:
    """Return the numbers of the problem in some memory."""
    place = Run.places["par"]
    return Params(memory[..., place.first : place.first + place.size].view(np.float64))


def state_in(memory: Integers) -> State:
    """Return the state of the run in some memory; of many runs, if the memory has a row for each."""
    place = Run.places["state"]
    return State(memory[..., place.first : place.first + place.size].view(np.float64))


def counts_in(memory: Integers) -> Counts:
    """Return the counts of the run in some memory."""
    place = Run.places["counts"]
    return Counts(memory[..., place.first : place.first + place.size])


def scratch_in(memory: Integers) -> Floats:
    """Return the scratch space of the run in some memory, in rows of TERMS numbers."""
    return memory[SCRATCH:].view(np.float64).reshape(WORK_ROWS, TERMS)


def lend(memory: Integers, setup: Setup, store: Store, trees: tuple[Integers, Floats]) -> None:
    """Write into a run's memory where its tables are. The caller keeps them alive; a store that has grown is lent again."""
    run = Run(memory)
    lend_memory(*setup[1:], *store, *trees)
    assert memory.shape == (PLACES,)
    assert memory.flags.c_contiguous
    assert all(table.flags.c_contiguous for table in (*setup[1:], *store, *trees))
    columns = (
        (setup.address, "value_at", "jet_at", "state_at", "guards_at", "guard_count"),
        (setup.constants.reshape(1, -1), "constants"),
        (setup.law, "slip_shift", "offset", "knot"),
        (setup.branch, "rate_from", "rate_to", "keep_from", "keep_to", "excess_from", "excess_to"),
        (setup.first, "first_theta", "first_load", "first_slope", "first_jump"),
        (setup.loading, "from_row", "from_offset", "from_value", "from_slope", "from_jump"),
    )
    for table, *names in columns:
        for n, name in enumerate(names):
            memory[Run.places[name].first] = table.ctypes.data + n * table.strides[0]
    for name, stored in zip(("whole", "real", "stored_load", "stored_rate", "stored_state"), store, strict=True):
        memory[Run.places[name].first] = stored.ctypes.data
    memory[Run.places["node"].first], memory[Run.places["heights"].first] = (tree.ctypes.data for tree in trees)
    run.pieces, run.size = setup.constants.shape
    run.branches, run.loads, run.segments = setup.branch.shape[1], setup.first.shape[1], setup.loading.shape[1]
    run.capacity = len(store.whole)
