"""What a thread of a batch works in: lanes, each with a state and a history, whatever members come."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeVar

import numpy as np

from stickslip.batch.kernels.lanes import AWAY, CONSTANTS
from stickslip.batch.kernels.points import POINTS_PER_PIECE, Points, new_points
from stickslip.batch.kernels.runs import FREE
from stickslip.batch.setups import Setups
from stickslip.engine.codegen.simd import WIDTH
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Floats, Integers, Params, Setup, Store
from stickslip.engine.state.workspace import ADDRESSES, PLACES, Run, lend
from stickslip.engine.waves.echo_queue import Echoes, new_echoes
from stickslip.engine_input.prepare import NOT_VARYING

FIRST_CAPACITY, LARGEST_CAPACITY = 512, 32_768
"""Pieces of history for which a lane has room; a member that needs more is run by itself."""
LINE = 16
"""Numbers in two cache lines, which processors fetch together; addresses of lanes must be multiples of one."""


class Workspace(NamedTuple):
    """What one thread needs, whatever members come: of each table, one for each lane."""

    store: Store
    echoes: Echoes
    points: Points
    numbers: Floats  # room for the block of `kernels.lanes`, and the block's address
    block: Integers
    stage: Integers  # of each lane, see `kernels.runs`
    waits: Integers
    member: Integers  # the one in each lane
    code: Integers  # what its run has come to
    table: Integers  # the memory of its run
    upcoming: Integers  # the next member to be taken

    @property
    def capacity(self) -> int:
        """Pieces of history for which each lane has room."""
        return self.store.whole.shape[1]

    def ready_for(self, constants: int) -> Workspace:
        """All lanes free, for members from the first one on of a law with so many constants."""
        self.stage[:], self.waits[:], self.upcoming[:] = FREE, AWAY, 0
        numbers, block = new_block(constants)
        return self._replace(numbers=numbers, block=block)

    def larger(self) -> Workspace:
        """With room for four times as many pieces; the histories so far are kept."""
        capacity = min(4 * self.capacity, LARGEST_CAPACITY)
        store, echoes = in_lanes(at.new_store(WIDTH * capacity)), in_lanes(new_echoes(WIDTH * capacity))
        for old, new in zip((*self.store, *self.echoes), (*store, *echoes), strict=True):
            new[:, : old.shape[1]] = old
        return self._replace(store=store, echoes=echoes, points=new_points(POINTS_PER_PIECE * capacity))

    def with_more_points(self) -> Workspace:
        """With twice the room for turning points."""
        return self._replace(points=new_points(2 * len(self.points.xi)))


Tables = TypeVar("Tables", Store, Echoes)


def in_lanes(tables: Tables) -> Tables:
    """The rows of tables, shared out among the lanes."""
    shared: list[Any] = [table.reshape(WIDTH, len(table) // WIDTH, table.shape[1]) for table in tables]
    return type(tables)(*shared)


def lane_of(tables: Tables, n: int) -> Tables:
    """The tables of one lane."""
    return type(tables)(*[table[n] for table in tables])


def apart(*shape: int, dtype: type = float) -> Any:
    """Zeros that no other array's cache lines touch: what another thread writes next to them would be fetched again and again."""
    count = math.prod(shape)
    room: Any = np.zeros(count + 2 * LINE, dtype)
    first = -(room.ctypes.data // room.itemsize) % LINE
    return room[first : first + count].reshape(shape)


def new_block(constants: int) -> tuple[Floats, Integers]:
    """For a law of so many constants: see `Workspace.numbers`."""
    numbers = apart(WIDTH * (CONSTANTS + constants))
    return numbers, np.array([numbers.ctypes.data])


def new_workspace() -> Workspace:
    """For one thread."""
    stage, waits, member, code = apart(4, WIDTH, dtype=np.int64)
    return Workspace(
        in_lanes(at.new_store(WIDTH * FIRST_CAPACITY)),
        in_lanes(new_echoes(WIDTH * FIRST_CAPACITY)),
        new_points(POINTS_PER_PIECE * FIRST_CAPACITY),
        *new_block(0),
        stage,
        waits,
        member,
        code,
        apart(WIDTH, PLACES, dtype=np.int64),
        apart(1, dtype=np.int64),
    )


def table_of(setups: Setups, work: Workspace) -> tuple[Integers, Integers]:
    """The addresses that each lane lends its run for the first member, and what to add to them from one member to the next."""
    par, branch = Params(setups.par[0]), setups.branch[0].reshape(6, -1)
    own = Setup(par, setups.address, setups.constants[0], setups.law[0], branch, setups.first[0], NOT_VARYING)
    addresses = np.empty((WIDTH, ADDRESSES), np.int64)
    for n in range(WIDTH):
        lend(work.table[n], own, lane_of(work.store, n), lane_of(work.echoes, n))
        addresses[n] = work.table[n, :ADDRESSES]
    stride = np.zeros(ADDRESSES, np.int64)
    own_rows = {
        ("constants",): setups.constants,
        ("slip_shift", "offset", "knot"): setups.law,
        ("rate_from",): setups.branch,
        ("first_theta", "first_load", "first_slope", "first_jump"): setups.first,
    }
    for names, rows in own_rows.items():
        for name in names:
            stride[Run.places[name].first] = rows.strides[0] if len(rows) > 1 else 0
    return addresses, stride
