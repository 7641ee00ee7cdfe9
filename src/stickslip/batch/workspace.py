"""What a thread of a batch works in: one state, one history, whatever members come."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.batch.kernels.points import POINTS_PER_PIECE, Points, new_points
from stickslip.batch.setups import Setups
from stickslip.evolution import layout as at
from stickslip.evolution.echoes import Echoes, new_echoes
from stickslip.evolution.echoes import resized as with_room
from stickslip.evolution.layout import Floats, Integers, Setup, Store
from stickslip.evolution.setup import NOT_VARYING
from stickslip.evolution.workspace import (
    BRANCH_AT,
    CONSTANTS_AT,
    COUNTS,
    FIRST_AT,
    LAW_AT,
    PAR_AT,
    STATES,
    WORK_ROWS,
    lend,
)

FIRST_CAPACITY, LARGEST_CAPACITY = 512, 32_768
"""Pieces of history for which a thread has room; a member that needs more is run by itself."""


class Workspace(NamedTuple):
    """What one thread needs, whatever members come."""

    state: Floats
    counts: Integers
    scratch: Floats
    store: Store
    echoes: Echoes
    points: Points

    @property
    def capacity(self) -> int:
        """Pieces of history for which there is room."""
        return len(self.store.whole)

    def larger(self) -> Workspace:
        """With room for four times as many pieces; the history so far is kept."""
        length, capacity = int(self.counts[at.LENGTH]), min(4 * self.capacity, LARGEST_CAPACITY)
        store, echoes = at.resized(self.store, length, capacity), with_room(self.echoes, length, capacity)
        return self._replace(store=store, echoes=echoes, points=new_points(POINTS_PER_PIECE * capacity))

    def with_more_points(self) -> Workspace:
        """With twice the room for turning points."""
        return self._replace(points=new_points(2 * len(self.points.xi)))


def new_workspace() -> Workspace:
    """For one thread."""
    store, points = at.new_store(FIRST_CAPACITY), new_points(POINTS_PER_PIECE * FIRST_CAPACITY)
    scratch = np.zeros((WORK_ROWS, at.TERMS))
    return Workspace(np.zeros(STATES), np.zeros(COUNTS, np.int64), scratch, store, new_echoes(FIRST_CAPACITY), points)


def table_of(setups: Setups, work: Workspace) -> tuple[Integers, Integers]:
    """The engine's table for the first member, and what to add to it from one member to the next."""
    own = Setup(setups.par[0], setups.address, setups.constants[0], setups.law[0], setups.branch[:1], setups.first[0], NOT_VARYING)
    table = lend(own, work.state, work.counts, work.scratch, work.store, work.echoes)
    stride = np.zeros(len(table), np.int64)
    own_rows = {PAR_AT: setups.par, CONSTANTS_AT: setups.constants, LAW_AT: setups.law, BRANCH_AT: setups.branch}
    for place, rows in (own_rows | {FIRST_AT: setups.first}).items():
        stride[place] = rows.strides[0] if len(rows) > 1 else 0
    return table, stride
