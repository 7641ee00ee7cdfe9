"""What kernels are given: the numbers of members, and the memory of a thread, whose lanes serve one member after another."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from stickslip.engine.history.slip_events import EventTurns
from stickslip.engine.history.turning_points import Known, Spare, Turn
from stickslip.engine.input.asked import NO_LADDER
from stickslip.engine.input.prepare import NOT_VARYING
from stickslip.engine.lanes.lane_block import LaneBlock
from stickslip.engine.lanes.lanes import Waits
from stickslip.engine.on_demand import lend_parts_of_batch
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, EchoNode, Floats, Integers, Params, Setup, Store
from stickslip.engine.state.workspace import ADDRESSES, RUN_SIZE, Run, lend
from stickslip.foundation.arrays import Floats1, Floats2, Floats3, Floats4, Integers1, Integers2, Integers3
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH

FIRST_CAPACITY, LARGEST_CAPACITY = 512, 32_768
"""Initial and largest room of a lane in pieces of history; a member that needs more is run by itself."""
TURNS_PER_PIECE = 8
"""Initial room for points of the slip rate (`engine.history.turning_points`), for each piece of history."""
NUMBERS_OF_TWO_LINES = 16
"""Numbers (of 8 bytes) in two cache lines, which processors fetch together. Addresses of lanes must be multiples of one line."""


class Setups(NamedTuple):
    """The input of the engine for members that differ in numbers only.

    The engine's tables (see `engine.state.layout.Setup`) have one row for each member, or a single row if all members share it.
    """

    params: Floats2  # (members, numbers of Params)
    jets: Integers1  # (3 pieces,): addresses of the formulas' series, radii and values in lanes; (0,) if members step alone
    constants: Floats3  # (members, pieces, size)
    law: Integers3  # (members, pieces of the law, LawPiece.total)
    branch_table: Floats3  # (members, largest number of branches, Branch.total); for member n the first branches[n] are filled
    first_load: Floats3  # (members, pieces of the first load + 1, FirstLoad.total)
    branches: Integers1  # (members,): number of branches; 0 if g does not rise at high rates, -1 if more than MOST_BRANCHES
    irregular: Floats1  # (members,): 1 if several slip rates solve the contact equation at some load, otherwise 0
    state: Floats1  # at t = 0, the same for all members
    counts: Integers1  # at t = 0, the same for all members
    last_trip: Integers1  # (members,): the last round trip of each run
    last_phase: Floats1  # (members,): the offset (s) of its end in this round trip
    duration: Floats1  # (members,), s
    threshold: Floats1  # (members,): slip above this rate (m/s) is an event
    stiffness: Floats1  # (members,): Pa/m for a slab, N/m for a block
    excess: Floats1  # (members,): initial load minus static strength, Pa or N


class LaneStage(IntEnum):
    """Say what a lane is doing."""

    FREE = 0
    """It has no member."""
    UNDER_WAY = 1
    """Its member is running."""
    AT_END = 2
    """The run of its member has ended and is not reduced yet."""


class LaneStore(NamedTuple):
    """Hold a `Store` for each lane."""

    pieces: Integers3
    state: Floats4


class Workspace(NamedTuple):
    """The memory of one thread, which serves all its members. The tables of a history have a first axis of lanes."""

    store: LaneStore
    echoes: Integers3
    known: Integers3  # tables of `engine.history.turning_points.Known`
    turns: Integers2  # table of `engine.history.turning_points.Turn`
    events: Integers2  # table of `engine.history.slip_events.EventTurns`
    spare: Floats2  # a `engine.history.turning_points.Spare`
    numbers: Floats1  # room for the block of `kernels.lanes`
    block: Integers1  # the address of this block
    stage: Integers1  # (SIMD_WIDTH,): codes of `tables.Stage`
    waits: Integers1  # (SIMD_WIDTH,): what the lane waits for, see `kernels.lanes`
    member: Integers1  # (SIMD_WIDTH,): index of the member in the lane
    code: Integers1  # (SIMD_WIDTH,): what the engine returned last for this member
    table: Integers2  # (SIMD_WIDTH, RUN_SIZE): the memory of its run, see `engine.state.workspace.Run`
    upcoming: Integers1  # (1,): index of the next member to start

    @property
    def capacity(self) -> int:
        """The number of pieces of history for which each lane has room."""
        return self.store.pieces.shape[1]

    def ready_for(self, constants: int) -> Workspace:
        """Free all lanes and begin with the first member of a group, whose law has the given number of constants."""
        self.stage[:], self.waits[:], self.upcoming[:] = LaneStage.FREE, Waits.NONE, 0
        numbers, block = new_block(constants)
        return self._replace(numbers=numbers, block=block)

    def larger(self) -> Workspace:
        """Return a workspace with room for four times as many pieces, up to LARGEST_CAPACITY, which keeps the histories so far."""
        capacity = min(4 * self.capacity, LARGEST_CAPACITY)
        store, echoes, known = (
            in_lanes(at.new_store(SIMD_WIDTH * capacity)),
            EchoNode.table(SIMD_WIDTH, capacity),
            Known.table(SIMD_WIDTH, capacity),
        )
        for old, new in zip((*self.store, self.echoes, self.known), (*store, echoes, known), strict=True):
            new[:, : old.shape[1]] = old
        return self._replace(store=store, echoes=echoes, known=known).with_turns(TURNS_PER_PIECE * capacity)

    def with_turns(self, room: int) -> Workspace:
        """Return a workspace with room for a number of points of the slip rate."""
        return self._replace(turns=Turn.table(room), events=EventTurns.table(room))


def in_lanes(store: Store) -> LaneStore:
    """Divide the rows of a history's tables equally among the lanes, which become a first axis."""
    tables: list[Any] = [table.reshape(SIMD_WIDTH, len(table) // SIMD_WIDTH, *table.shape[1:]) for table in store]
    return LaneStore(*tables)


def apart(*shape: int, dtype: type = float) -> Any:
    """Return zeros that share no cache line with other arrays.

    Otherwise the processor would have to fetch a line again whenever another thread writes to an array beside it.
    """
    count = math.prod(shape)
    room: Any = np.zeros(count + 2 * NUMBERS_OF_TWO_LINES, dtype)
    first = -(room.ctypes.data // room.itemsize) % NUMBERS_OF_TWO_LINES
    return room[first : first + count].reshape(shape)


def new_block(constants: int) -> tuple[Floats, Integers]:
    """Return `Workspace.numbers` and `Workspace.block` for a law with the given number of constants."""
    numbers = apart(SIMD_WIDTH * (LaneBlock.total + constants))
    return numbers, np.array([numbers.ctypes.data])


def new_workspace() -> Workspace:
    """Return the workspace of one thread."""
    stage, waits, member, code = apart(4, SIMD_WIDTH, dtype=np.int64)
    return Workspace(
        in_lanes(at.new_store(SIMD_WIDTH * FIRST_CAPACITY)),
        EchoNode.table(SIMD_WIDTH, FIRST_CAPACITY),
        Known.table(SIMD_WIDTH, FIRST_CAPACITY),
        Turn.table(TURNS_PER_PIECE * FIRST_CAPACITY),
        EventTurns.table(TURNS_PER_PIECE * FIRST_CAPACITY),
        Spare.table(1),
        *new_block(0),
        stage,
        waits,
        member,
        code,
        apart(SIMD_WIDTH, RUN_SIZE, dtype=np.int64),
        apart(1, dtype=np.int64),
    )


def table_of(setups: Setups, work: Workspace) -> tuple[Integers, Integers]:
    """Return the addresses of the tables that the first member uses in each lane, and their strides from member to member (bytes).

    The addresses have the shape (SIMD_WIDTH, ADDRESSES), the strides (ADDRESSES,). A stride is 0 if all members share the table.
    """
    params = Params(setups.params[0])
    own = Setup(params, setups.law[0], setups.constants[0], setups.branch_table[0], setups.first_load[0], NOT_VARYING, NO_LADDER)
    addresses = np.empty((SIMD_WIDTH, ADDRESSES), np.int64)
    for n in range(SIMD_WIDTH):
        lend(work.table[n], own, Store(*(table[n] for table in work.store)), work.echoes[n])
        lend_parts_of_batch(work.table[n], params, Counts(setups.counts))
        addresses[n] = work.table[n, :ADDRESSES]
    stride = np.zeros(ADDRESSES, np.int64)
    for name in ("law", "constants", "branch_table", "first_load"):
        table = getattr(setups, name)
        stride[Run.places[name].first] = table.strides[0] if len(table) > 1 else 0
    return addresses, stride
