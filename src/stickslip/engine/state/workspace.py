"""The memory of one run in progress: a record that the caller lends to the engine.

The record holds pointers and not arrays: compiled code counts the references of every array that it passes on, which would cost
more than the work itself in functions as small as these.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine.codegen.records import Record, floats_at, inside, integers_at, record_at, row
from stickslip.engine.codegen.uncompiled import lend_memory
from stickslip.engine.state.layout import TERMS, Counts, Floats, Integers, Params, Series, Setup, State, Store

WHOLE, REAL = 6, 8
"""Number of columns of the history's tables `whole` and `real`."""

MATRIX_ROWS = 18
"""Rows of TERMS numbers (1) that the matrix and the right-hand side of the equations of an implicit step fill."""


class Run(Record):
    """Hold one run: the addresses and lengths of the problem's tables and of the history, the state, and scratch space."""

    value_at: Integers = integers_at()  # up to `knot`: indexed by the piece of the law (`Setup.address`, `constants`, `law`)
    jet_at: Integers = integers_at()
    state_at: Integers = integers_at()
    guards_at: Integers = integers_at()
    guard_count: Integers = integers_at()
    constants: Floats = floats_at()
    slip_shift: Floats = floats_at()
    offset: Floats = floats_at()
    knot: Floats = floats_at()
    rate_from: Floats = floats_at()  # up to `excess_to`: indexed by the branch (`Setup.branch`)
    rate_to: Floats = floats_at()
    keep_from: Floats = floats_at()
    keep_to: Floats = floats_at()
    excess_from: Floats = floats_at()
    excess_to: Floats = floats_at()
    first_theta: Floats = floats_at()  # up to `first_jump`: indexed by the piece of the first load (`Setup.first`)
    first_load: Floats = floats_at()
    first_slope: Floats = floats_at()
    first_jump: Floats = floats_at()
    from_row: Floats = floats_at()  # up to `from_jump`: indexed by the segment of the loading (`Setup.loading`)
    from_offset: Floats = floats_at()
    from_value: Floats = floats_at()
    from_slope: Floats = floats_at()
    from_jump: Floats = floats_at()

    whole: Integers = integers_at()  # up to `stored_state`: the tables of the history (`Store`), piece after piece
    real: Floats = floats_at()
    stored_load: Floats = floats_at()
    stored_rate: Floats = floats_at()
    stored_state: Floats = floats_at()

    node: Integers = integers_at()  # with `heights`: the trees of echoes (`waves.echo_queue`)
    heights: Floats = floats_at()

    pieces: int  # number of pieces of the law
    size: int  # number of constants of a piece of the law
    branches: int  # number of branches in the table
    loads: int  # number of pieces of the first load, plus 1
    segments: int  # number of segments of the loading
    capacity: int  # number of pieces for which the history has room
    implicit_step: int  # addresses of the steps that are compiled apart (see `on_demand`), 0 until the run needs them
    implicit_rest: int

    par: Params = inside(Params)
    state: State = inside(State)
    counts: Counts = inside(Counts)

    load: Floats = row(TERMS)  # Pa or N: the present piece of load, as a polynomial in xi
    local: Floats = row(TERMS)  # Pa or N: load from the present place on, in units of the guess; zero beyond the degree
    seen: Floats = row(TERMS)  # Pa or N: the same as seen in the direction of slip, minus the reference strength
    jet: Floats = row(TERMS)  # m/s: series of the magnitude of the slip rate, in units of the guess
    reach: Floats = row(TERMS)  # bound that a formula with guards writes right after its series: the step ends where its sum is 1
    powers: Floats = row(TERMS)  # powers of the length of the step, in guesses
    k: Series = inside(Series, TERMS)  # input of the series
    value: Floats = row(TERMS)  # friction and its derivatives, as last evaluated
    kept_load: Floats = row(TERMS)  # Pa or N: the piece of load that is continued after a fold
    kept: State = inside(State, TERMS)  # the first KEPT fields of the state that belong to it
    part: Floats = row(TERMS)  # room for polynomials that are only tested
    spare: Floats = row(TERMS)  # further room of this kind
    state_jet: Floats = row(TERMS)  # polynomial of the law's state over an implicit step
    stage_rate: Floats = row(TERMS)  # m/s: slip rate at Radau's points of an implicit step
    stage_state: Floats = row(TERMS)  # state of the law at these points
    matrix: Floats = row(MATRIX_ROWS * TERMS)  # equations of an implicit step


PLACES = Run.total
"""Length of the memory of a run, in places of 8 bytes."""
ADDRESSES = Run.places["pieces"].first
"""Number of places that hold addresses; the lengths of the tables follow them."""
SCRATCH = Run.places["load"].first
"""First place of scratch space in a run's memory; it extends to the end."""
WORK_ROWS = (PLACES - SCRATCH) // TERMS
"""Length of scratch space, in rows of TERMS numbers."""

borrow: Any = record_at(Run)
"""Function for compiled code that returns the run in memory that `lend` has filled."""


def memory_of(par: Params, state: State, counts: Counts) -> Integers:
    """Return the memory of a run with these numbers, state and counts; its tables must still be lent."""
    memory = np.zeros(PLACES, np.int64)
    params_in(memory).numbers[:], state_in(memory).numbers[:] = par.numbers, state.numbers
    counts_in(memory).numbers[:] = counts.numbers
    return memory


def params_in(memory: Integers) -> Params:
    """Return the problem's numbers in the memory of a run; the record shares that memory."""
    place = Run.places["par"]
    return Params(memory[..., place.first : place.first + place.size].view(np.float64))


def state_in(memory: Integers) -> State:
    """Return the state in the memory of a run, or of many runs if the array has a row for each; the record shares that memory."""
    place = Run.places["state"]
    return State(memory[..., place.first : place.first + place.size].view(np.float64))


def counts_in(memory: Integers) -> Counts:
    """Return the counts in the memory of a run; the record shares that memory."""
    place = Run.places["counts"]
    return Counts(memory[..., place.first : place.first + place.size])


def scratch_in(memory: Integers) -> Floats:
    """Return the scratch space in the memory of a run, in rows of TERMS numbers, as a view."""
    return memory[SCRATCH:].view(np.float64).reshape(WORK_ROWS, TERMS)


def lend(memory: Integers, setup: Setup, store: Store, trees: tuple[Integers, Floats]) -> None:
    """Write the addresses and lengths of its tables into the memory of a run.

    The caller keeps the tables alive, and lends them again if the history has grown or moved.
    """
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
