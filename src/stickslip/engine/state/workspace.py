"""The memory of one run in progress: a record that the caller lends to the engine.

The record holds pointers and not arrays: compiled code counts the references of every array that it passes on, which would cost
more than the work itself in functions as small as these.
"""

from __future__ import annotations

from ctypes import addressof, c_char
from typing import Any

import numpy as np

from stickslip.engine.state.layout import (
    STATES,
    TERMS,
    Ball,
    BranchRow,
    Counts,
    EchoNode,
    FirstLoad,
    Floats,
    Friction,
    HistoryPiece,
    Integers,
    LadderCell,
    LawPiece,
    LawValue,
    LoadingSegment,
    Params,
    SeriesInput,
    Setup,
    State,
    Store,
)
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.pointers import record_at
from stickslip.foundation.kernels.memory.records import MemoryRecord, floats_at, floats_inside, inside, records_at
from stickslip.foundation.kernels.uncompiled import UNCOMPILED, lend_memory

ROOM = 8
"""Free rows that the history needs for another pass of the loop (1); a pass appends fewer."""
FIRST_ROW = 2
"""First row of waves (1) that belongs to the history: before it come those of the piece of load, and of one that is set aside."""
MATRIX_ROWS = 110
"""Rows of TERMS numbers (1) that the matrix and the right-hand side of the equations of an implicit step fill."""


class Run(MemoryRecord):
    """Hold one run: the addresses and lengths of the problem's tables and of the history, the state, and scratch space."""

    law: LawPiece = records_at(LawPiece)  # the tables of `Setup`
    constants: Floats = floats_at()
    branch_table: BranchRow = records_at(BranchRow)
    first_load: FirstLoad = records_at(FirstLoad)
    loading: LoadingSegment = records_at(LoadingSegment)
    ladder_cells: LadderCell = records_at(LadderCell)
    history: HistoryPiece = records_at(HistoryPiece)  # the tables of the history (`Store`)
    history_state: Floats = floats_at()
    echoes: EchoNode = records_at(EchoNode)  # the trees of echoes (`waves.echo_queue`)
    waves: Floats = floats_at()  # the rows of waves of a body of layers (`waves.ladder`)

    pieces: int  # number of pieces of the law
    size: int  # number of constants of a piece of the law
    branches: int  # number of branches in the table
    loads: int  # number of pieces of the first load, plus 1
    segments: int  # number of segments of the loading
    capacity: int  # number of pieces that fit into the history
    implicit_steps: int  # addresses of the parts that are compiled apart (see `on_demand`), 0 until the run needs them
    loading_history: int
    echo_queue: int
    moving_folds: int
    driver: int
    ladder: int
    folds: int
    negative_friction: int
    play: int
    wave_rows: int  # number of rows of waves that fit, besides those of the piece of load
    missing: int  # the part that the engine has asked for, as a code of `Part`

    params: Params = inside(Params)
    state: State = inside(State)
    counts: Counts = inside(Counts)

    load: Floats = floats_inside(TERMS)  # Pa or N: the present piece of load, as a polynomial in xi
    local: Floats = floats_inside(TERMS)  # Pa or N: load from the present place on, in units of the series; zero beyond the degree
    load_along_slip: Floats = floats_inside(TERMS)  # Pa or N: the same in the direction of slip, minus the reference strength
    state_jet: Floats = floats_inside(STATES * TERMS)  # behind it, series of the states over an explicit step, or an implicit one
    jet: Floats = floats_inside(TERMS)  # m/s: series of the magnitude of the slip rate, in units of the series
    centres: Floats = floats_inside(TERMS)  # values that the series writes right after itself, for `radii`
    powers: Floats = floats_inside(TERMS)  # powers of the length of the step, in units of the series
    k: SeriesInput = inside(SeriesInput, TERMS)  # input of the series
    value: LawValue = inside(LawValue, 2 * TERMS)  # latest result of the law's formula
    ball: Ball = inside(Ball, TERMS)  # discs of slip, slip rate and state, and the radius of friction on them
    friction: Friction = inside(Friction, TERMS)  # friction at the contact, as last evaluated
    saved_load: Floats = floats_inside(TERMS)  # Pa or N: the piece of load that is continued after a fold
    saved: State = inside(State, 2 * TERMS)  # the first SAVED fields of the state that belong to it
    trial: Floats = floats_inside(TERMS)  # room for polynomials that are only tested
    spare: Floats = floats_inside(TERMS)  # further room of this kind
    machine_force: Floats = floats_inside(TERMS)  # Pa: series of the push on a driver that is a machine, but for its own motion
    machine_pull: Floats = floats_inside(TERMS)  # m/s: of its pull rate
    machine_rate: Floats = floats_inside(TERMS)  # m/s: of its rate
    machine_push: Floats = floats_inside(TERMS)  # Pa: of the force of its integral gain
    ground_rate: Floats = floats_inside(TERMS)  # m/s: series of the velocity of the ground under layers (`waves.shaken_ladder`)
    ground_push: Floats = floats_inside(TERMS)  # Pa: of its acceleration times the mass of the contact
    stage_rate: Floats = floats_inside(TERMS)  # m/s: slip rate at Radau's points of an implicit step
    stage_state: Floats = floats_inside(STATES * TERMS)  # states of the law at these points
    some_state: Floats = floats_inside(TERMS)  # states of the law at one place
    state_error: Floats = floats_inside(TERMS)  # units of the states: residual of each in an implicit step, or its bound
    state_noise: Floats = floats_inside(TERMS)  # units of the states: their errors in a step through rounding in the law
    matrix: Floats = floats_inside(MATRIX_ROWS * TERMS)  # equations of an implicit step


RUN_SIZE = Run.total
"""Length of the memory of a run, in places of 8 bytes."""
ADDRESSES = Run.places["pieces"].first
"""Number of places that hold addresses; the lengths of the tables follow them."""
PROBLEM, HISTORY = slice(0, Run.places["history"].first), slice(Run.places["history"].first, ADDRESSES)
"""Places of the addresses of the problem's tables (`Setup`), and of those of the history (`Store`, `EchoNode`)."""
PARAMS, STATE, COUNTS = (
    slice(place.first, place.first + place.size) for place in (Run.places[name] for name in ("params", "state", "counts"))
)
"""Places of the problem's numbers, of the state and of the counts."""
SCRATCH = Run.places["load"].first
"""First place of scratch space in a run's memory; it extends to the end."""
NO_WAVES = np.zeros((0, 0, TERMS))
"""Rows of waves of a body without layers: there are none."""
WORK_ROWS = (RUN_SIZE - SCRATCH) // TERMS
"""Length of scratch space, in rows of TERMS numbers."""

borrow: Any = record_at(Run)
"""Function for compiled code that returns the run in memory that `lend` has filled."""
branches_in: Any = record_at(BranchRow)
"""Function for compiled code that returns the first record of a table of branches."""
pieces_in: Any = record_at(HistoryPiece)
"""Function for compiled code that returns the first piece of a history's table."""


def memory_of(params: Params, state: State, counts: Counts) -> Integers:
    """Return the memory of a run with these numbers, state and counts; its tables must still be lent."""
    memory = np.zeros(RUN_SIZE, np.int64)
    params_in(memory).numbers[:], state_in(memory).numbers[:] = params.numbers, state.numbers
    counts_in(memory).numbers[:] = counts.numbers
    return memory


def params_in(memory: Integers) -> Params:
    """Return the problem's numbers in the memory of a run; the record shares that memory."""
    return Params(memory[..., PARAMS].view(np.float64))


def state_in(memory: Integers) -> State:
    """Return the state in the memory of a run, or of many runs if the array has a row for each; the record shares that memory."""
    return State(memory[..., STATE].view(np.float64))


def counts_in(memory: Integers) -> Counts:
    """Return the counts in the memory of a run; the record shares that memory."""
    return Counts(memory[..., COUNTS])


def scratch_in(memory: Integers) -> Floats:
    """Return the scratch space in the memory of a run, in rows of TERMS numbers, as a view."""
    return memory[SCRATCH:].view(np.float64).reshape(WORK_ROWS, TERMS)


def lend(memory: Integers, setup: Setup, store: Store, echoes: Integers, waves: Floats = NO_WAVES) -> None:
    """Write the addresses and lengths of all tables into the memory of a run.

    The caller keeps the tables alive, and lends them again if they have moved.
    """
    lend_problem(memory, setup)
    lend_history(memory, store, echoes, waves)


def lend_problem(memory: Integers, setup: Setup) -> None:
    """Write the addresses and lengths of the problem's tables into the memory of a run."""
    tables = setup[1:]
    if UNCOMPILED:
        lend_memory(*tables)
    assert all(table.flags.c_contiguous for table in tables)
    memory[PROBLEM] = [table.__array_interface__["data"][0] for table in tables]
    run = Run(memory)
    run.pieces, run.size = setup.constants.shape
    run.branches, run.loads, run.segments = len(setup.branches), len(setup.first_load), len(setup.loading)


def lend_history(memory: Integers, store: Store, echoes: Integers, waves: Floats = NO_WAVES) -> None:
    """Write the addresses of the tables of the history and their lengths into the memory of a run."""
    tables = (*store, echoes, waves)
    if UNCOMPILED:
        lend_memory(*tables)
    memory[HISTORY] = [addressof(_START.from_buffer(table.data)) for table in tables]
    run = Run(memory)
    run.capacity, run.wave_rows = len(store.pieces), len(waves) - FIRST_ROW


_START = c_char * 0
"""Type of the start of a table. It gives the address in a quarter of the time, and only if the table can be written to."""


@kernel
def lacks_rows(run: Run) -> bool:
    """Return True if a body of layers needs more rows of waves than there are, for this round trip and the one before."""
    return run.counts.cells > 0 and run.counts.length - run.counts.previous_from + ROOM > run.wave_rows


def are_rows_short(counts: Counts, waves: Floats) -> bool:
    """Return what `lacks_rows` returns, for a caller in Python."""
    return bool(counts.cells > 0 and counts.length - counts.previous_from + ROOM > len(waves) - FIRST_ROW)


def with_more_rows(waves: Floats, counts: Counts, rows: int) -> Floats:
    """Return room for so many rows of waves of the history, with those that this round trip and the one before have."""
    before, more = len(waves) - FIRST_ROW, np.zeros((FIRST_ROW + rows, *waves.shape[1:]))
    more[:FIRST_ROW] = waves[:FIRST_ROW]
    kept = np.arange(int(counts.previous_from), int(counts.length)) + int(counts.wave_shift)
    more[FIRST_ROW + kept % rows] = waves[FIRST_ROW + kept % before]
    return more


def count_from(counts: Counts, place: Integers, dropped: int) -> None:
    """Have counts refer to a history without its first pieces, so many of them; `place` is the new place of each."""
    counts.echo_of = place[counts.echo_of]
    for name in ("length", "trip_from", "previous_from", "previous_to", "new_from", "smooth_to"):
        setattr(counts, name, getattr(counts, name) - dropped)
    counts.wave_shift += dropped
