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

MATRIX_ROWS = 18
"""Equations of an implicit step: their matrix and right-hand side fill so many rows of TERMS numbers."""
WORK_ROWS = 14 + MATRIX_ROWS


class Run(NamedTuple):
    """One run: the problem, the state, the history, and scratch space. Every field but the numbers at the end is a pointer."""

    par: Floats
    value_at: Integers  # by piece of the law
    jet_at: Integers
    state_at: Integers
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
    address, law, branch, first, loading = (
        integers(table[1]),
        floats(table[3]),
        floats(table[4]),
        floats(table[5]),
        floats(table[6]),
    )
    work = floats(table[9])
    pieces, size, branches, loads, segments, capacity = table[15], table[16], table[17], table[18], table[19], table[20]
    return Run(
        floats(table[0]),
        address,
        ahead(address, pieces),
        ahead(address, 2 * pieces),
        floats(table[2]),
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
        floats(table[7]),
        integers(table[8]),
        integers(table[10]),
        floats(table[11]),
        floats(table[12]),
        floats(table[13]),
        floats(table[14]),
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
        integers(table[21]),
        floats(table[22]),
        pieces,
        size,
        branches,
        loads,
        segments,
        capacity,
    )
