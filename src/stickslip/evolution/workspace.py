"""What the engine works on: one run in progress, as a record of pointers.

The caller lends its arrays as one table of addresses. Pointers and not arrays, because compiled code counts references of every
array that it hands on, which costs more than the work in functions as small as these.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.evolution import layout as at
from stickslip.evolution.compiled import ahead, floats, inlined, integers
from stickslip.evolution.layout import TERMS, Floats, Integers, Setup, Store

# ---- more of the state, behind what `layout` names --------------------------------------------------------------------------
EXIT = at.STATES  # xi at which an algebraic contact leaves its branch (inf: not on this piece); nan where it is not known yet
STATES = at.STATES + 1
DEGREE = at.COUNTS  # of the piece of load: its coefficients beyond are zero
COUNTS = at.COUNTS + 1

WHOLE, REAL = 6, 8
"""Columns of the history's tables."""

# ---- places in the table of `lend`: addresses of arrays, and lengths ----------------------------------------------------------
PAR_AT, ADDRESS_AT, CONSTANTS_AT, LAW_AT, BRANCH_AT, FIRST_AT, LOADING_AT, STATES_AT, COUNTS_AT, SCRATCH_AT = range(10)
WHOLE_AT, REAL_AT, LOAD_AT, RATE_AT, STORED_STATE_AT = range(10, 15)
PIECES, SIZE, BRANCHES, LOADS, SEGMENTS, CAPACITY, NODE_AT, HEIGHTS_AT = range(15, 23)
PLACES = 23

MATRIX_ROWS = 18
"""Equations of an implicit step: their matrix and right-hand side fill so many rows of TERMS numbers."""
WORK_ROWS = 15 + MATRIX_ROWS


class Run(NamedTuple):
    """One run: the problem, the state, the history, and scratch space. Every field but the numbers at the end is a pointer."""

    par: Floats
    value_at: Integers  # by piece of the law
    jet_at: Integers
    state_at: Integers
    guards_at: Integers
    guard_count: Integers
    constants: Floats
    slip_shift: Floats
    offset: Floats
    knot: Floats
    rate_from: Floats  # by branch
    rate_to: Floats
    keep_from: Floats
    keep_to: Floats
    excess_from: Floats
    excess_to: Floats
    first_theta: Floats  # by piece of the first load
    first_load: Floats
    first_slope: Floats
    first_jump: Floats
    from_row: Floats  # by segment of the loading
    from_offset: Floats
    from_value: Floats
    from_slope: Floats
    from_jump: Floats

    state: Floats
    counts: Integers

    whole: Integers  # the history, row after row
    real: Floats
    stored_load: Floats
    stored_rate: Floats
    stored_state: Floats

    load: Floats  # the present piece of load, in xi
    local: Floats  # of the step at hand, in units of the guess; zero beyond the degree of the piece
    seen: Floats  # the same in the direction of slip, minus the reference
    jet: Floats
    reach: Floats  # the bound that the jet of a formula with guards leaves behind the series
    powers: Floats
    k: Floats
    value: Floats
    kept_load: Floats  # the piece that goes on behind a fold
    kept: Floats  # and the state there
    part: Floats  # for tests on load and rate
    spare: Floats
    state_jet: Floats  # of an implicit step: the state's polynomial
    stage_rate: Floats  # and the values at its points
    stage_state: Floats
    matrix: Floats

    node: Integers  # the trees of echoes
    heights: Floats

    pieces: int
    size: int  # of the constants of a piece
    branches: int
    loads: int
    segments: int
    capacity: int


def lend(setup: Setup, state: Floats, count: Integers, scratch: Floats, store: Store, trees: tuple[Integers, Floats]) -> Integers:
    """The table for `advance`. The caller keeps the arrays alive; a store that has grown needs a new table."""
    arrays = (*setup, state, count, scratch, *store)
    assert all(array.flags.c_contiguous for array in (*arrays, *trees))
    assert scratch.shape == (WORK_ROWS, TERMS)
    tables = setup.branch, setup.first, setup.loading
    lengths = (*setup.constants.shape, *(table.shape[1] for table in tables), len(store.whole))
    return np.array([*(array.ctypes.data for array in arrays), *lengths, *(tree.ctypes.data for tree in trees)], np.int64)


@inlined
def borrow(table: Integers) -> Run:
    """The run in a table of `lend`."""
    address, law, branch = integers(table[ADDRESS_AT]), floats(table[LAW_AT]), floats(table[BRANCH_AT])
    first, loading, work = floats(table[FIRST_AT]), floats(table[LOADING_AT]), floats(table[SCRATCH_AT])
    pieces, branches, loads, segments = table[PIECES], table[BRANCHES], table[LOADS], table[SEGMENTS]
    return Run(
        floats(table[PAR_AT]),
        address,
        ahead(address, pieces),
        ahead(address, 2 * pieces),
        ahead(address, 3 * pieces),
        ahead(address, 4 * pieces),
        floats(table[CONSTANTS_AT]),
        law,
        ahead(law, pieces),
        ahead(law, 2 * pieces),
        branch,
        ahead(branch, branches),
        ahead(branch, 2 * branches),
        ahead(branch, 3 * branches),
        ahead(branch, 4 * branches),
        ahead(branch, 5 * branches),
        first,
        ahead(first, loads),
        ahead(first, 2 * loads),
        ahead(first, 3 * loads),
        loading,
        ahead(loading, segments),
        ahead(loading, 2 * segments),
        ahead(loading, 3 * segments),
        ahead(loading, 4 * segments),
        floats(table[STATES_AT]),
        integers(table[COUNTS_AT]),
        integers(table[WHOLE_AT]),
        floats(table[REAL_AT]),
        floats(table[LOAD_AT]),
        floats(table[RATE_AT]),
        floats(table[STORED_STATE_AT]),
        work,
        ahead(work, TERMS),
        ahead(work, 2 * TERMS),
        ahead(work, 3 * TERMS),
        ahead(work, 4 * TERMS),
        ahead(work, 5 * TERMS),
        ahead(work, 6 * TERMS),
        ahead(work, 7 * TERMS),
        ahead(work, 8 * TERMS),
        ahead(work, 9 * TERMS),
        ahead(work, 10 * TERMS),
        ahead(work, 11 * TERMS),
        ahead(work, 12 * TERMS),
        ahead(work, 13 * TERMS),
        ahead(work, 14 * TERMS),
        ahead(work, 15 * TERMS),
        integers(table[NODE_AT]),
        floats(table[HEIGHTS_AT]),
        pieces,
        table[SIZE],
        branches,
        loads,
        segments,
        table[CAPACITY],
    )
