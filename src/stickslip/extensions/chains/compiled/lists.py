"""Lists of blocks: those that move, those at rest beside them, and when any other is due to slip.

All of them follow from the state, so that a run that is resumed makes them anew.
"""

from __future__ import annotations

import math

from stickslip.extensions.chains.compiled.accounts import note_slipping
from stickslip.extensions.chains.compiled.loads import set_due
from stickslip.extensions.chains.compiled.memory import (
    DUE,
    FIRST_DUE,
    HAVE_SLIPPED,
    MODE,
    MOVING,
    REST,
    SLIPPED,
    WATCHED,
    WITHOUT_FRICTION,
    ChainNumbers,
    Now,
    StepRoom,
)
from stickslip.foundation.kernels.kernels import kernel

UNKNOWN = -1
"""In place of the block that is due first: it is to be looked for."""


@kernel
def find_lists(chain: ChainNumbers, state: Now, room: StepRoom) -> None:
    """Make the lists of moving blocks, of those beside them, and of those that have slipped; they follow from the modes."""
    springs, count = chain.springs, len(chain.blocks.mass)
    room.counts[MOVING] = room.counts[WATCHED] = room.counts[HAVE_SLIPPED] = 0
    for j in range(count):
        room.near[j] = 0
    for j in range(count):
        if state.whole[SLIPPED, j] == 1:
            room.slipped[room.counts[HAVE_SLIPPED]] = j
            room.counts[HAVE_SLIPPED] += 1
        if state.whole[MODE, j] != REST:
            room.moving[room.counts[MOVING]] = j
            room.counts[MOVING] += 1
            for place in range(springs.starts[j], springs.starts[j + 1]):
                if springs.springs[place] != 0.0:
                    room.near[springs.neighbours[place]] += 1
    for j in range(count):
        if room.near[j] > 0 and state.whole[MODE, j] == REST:
            room.watched[room.counts[WATCHED]] = j
            room.counts[WATCHED] += 1
    find_first_due(state, room)


@kernel
def find_first_due(state: Now, room: StepRoom) -> None:
    """Look for the block that is due first."""
    first, least = 0, state.blocks[DUE, 0]
    for j in range(1, len(state.blocks[DUE])):
        if state.blocks[DUE, j] < least:
            first, least = j, state.blocks[DUE, j]
    room.counts[FIRST_DUE] = first


@kernel
def first_due(state: Now, room: StepRoom) -> float:
    """Return the time (s) when the block that is due first begins to slip."""
    if room.counts[FIRST_DUE] == UNKNOWN:
        find_first_due(state, room)
    return float(state.blocks[DUE, room.counts[FIRST_DUE]])


@kernel
def drop_due(state: Now, room: StepRoom, j: int) -> None:
    """Write that a block is not due at a known time any more."""
    state.blocks[DUE, j] = math.inf
    if room.counts[FIRST_DUE] == j:
        room.counts[FIRST_DUE] = UNKNOWN


@kernel
def insert_moving(room: StepRoom, j: int) -> None:
    """Put a block into the list of moving ones, which is sorted."""
    n = room.counts[MOVING]
    while n > 0 and room.moving[n - 1] > j:
        room.moving[n] = room.moving[n - 1]
        n -= 1
    room.moving[n] = j
    room.counts[MOVING] += 1


@kernel
def moves_from_now(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Put a block that has begun to slip into the lists, and its neighbours at rest among those that are watched."""
    springs = chain.springs
    insert_moving(room, j)
    note_slipping(state, room, j)
    drop_due(state, room, j)
    if room.near[j] > 0:
        forget_watched(room, j)
    for place in range(springs.starts[j], springs.starts[j + 1]):
        other = springs.neighbours[place]
        if springs.springs[place] != 0.0:
            room.near[other] += 1
            if room.near[other] == 1 and state.whole[MODE, other] == REST:
                room.watched[room.counts[WATCHED]] = other
                room.counts[WATCHED] += 1
                drop_due(state, room, other)


@kernel
def forget_watched(room: StepRoom, j: int) -> None:
    """Take a block from the list of those that are watched."""
    last = room.counts[WATCHED] - 1
    for n in range(last + 1):
        if room.watched[n] == j:
            room.watched[n] = room.watched[last]
            room.counts[WATCHED] = last
            return


@kernel
def rests_from_now(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Take a block that has come to rest from the list of moving ones, and let neighbours be that no moving block is beside."""
    springs, n = chain.springs, 0
    while room.moving[n] != j:
        n += 1
    for m in range(n + 1, room.counts[MOVING]):
        room.moving[m - 1] = room.moving[m]
    room.counts[MOVING] -= 1
    for place in range(springs.starts[j], springs.starts[j + 1]):
        other = springs.neighbours[place]
        if springs.springs[place] != 0.0:
            room.near[other] -= 1
            if room.near[other] == 0 and state.whole[MODE, other] == REST:
                forget_watched(room, other)
                becomes_quiet(chain, state, room, other)
    if room.near[j] > 0:
        room.watched[room.counts[WATCHED]] = j
        room.counts[WATCHED] += 1
    else:
        becomes_quiet(chain, state, room, j)


@kernel
def becomes_quiet(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Write when a block is due that rests among resting ones."""
    set_due(chain, state, j)
    first = room.counts[FIRST_DUE]
    if first != UNKNOWN and (
        state.blocks[DUE, j] < state.blocks[DUE, first] or (state.blocks[DUE, j] == state.blocks[DUE, first] and j < first)
    ):
        room.counts[FIRST_DUE] = j


@kernel
def rubbing(state: Now, room: StepRoom) -> int:
    """Return how many blocks slip against friction."""
    found = 0
    for n in range(room.counts[MOVING]):
        if state.whole[MODE, room.moving[n]] != WITHOUT_FRICTION:
            found += 1
    return found
