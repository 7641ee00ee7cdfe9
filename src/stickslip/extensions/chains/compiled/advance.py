"""Let a chain go on in time: over rest at once, and through slip step by step, each cut at the first change in it."""

from __future__ import annotations

import math

from stickslip.engine.series.polynomial import NONE
from stickslip.extensions.chains.compiled.accounts import begin_event, end_event, note_slipping, pull_of_driver
from stickslip.extensions.chains.compiled.changes import (
    ONSET_BACK,
    arrest,
    begin_slip,
    first_place,
    note_change,
    pass_knot,
    set_moving_at_start,
)
from stickslip.extensions.chains.compiled.lists import find_lists, first_due, moves_from_now, rests_from_now, rubbing
from stickslip.extensions.chains.compiled.loads import set_due, time_of
from stickslip.extensions.chains.compiled.memory import (
    ARREST,
    BACKWARD,
    CHANGE_ROWS,
    DEFECT,
    DONE,
    DUE,
    EVENT_ROWS,
    FIRST_DUE,
    FORWARD,
    GOES_ON,
    HANGS,
    IN_EVENT,
    KNOT,
    LAST_STEP,
    MODE,
    MOVING,
    NOT_FINITE,
    ONSET,
    ORIGIN,
    PULL,
    REST,
    SINCE,
    WATCHED,
    WORK,
    ChainNumbers,
    KeptRows,
    Limits,
    Now,
    StepRoom,
)
from stickslip.extensions.chains.compiled.series import remainder_of_step
from stickslip.extensions.chains.compiled.steps import commit, expand, measure_end, take_samples
from stickslip.foundation.kernels.kernels import entry, kernel

MOST_AT_ONCE = 10_000
"""If so many changes follow each other without any time between them, the solver gives up."""
SCAN = 16
"""To look at so many blocks costs about as much as a step of one."""


@kernel
def change_blocks(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, place: float) -> int:
    """Carry out all changes at a place of the step that has been taken; return how many there are."""
    found = 0
    for n in range(room.counts[MOVING]):
        j = room.moving[n]
        if room.places[j] == place:
            room.changed[found] = j
            found += 1
    for n in range(room.counts[WATCHED]):
        j = room.watched[n]
        if room.places[j] == place:
            room.changed[found] = j
            found += 1
    sort_changed(room, found)
    for n in range(found):
        j = room.changed[n]
        kind = room.kinds[j]
        if kind == KNOT:
            pass_knot(chain, state, j)
            note_change(state, room, kept, j, KNOT)
        elif kind == ARREST:
            note_change(state, room, kept, j, arrest(chain, state, j))
        else:
            begin_slip(state, room, kept, j, BACKWARD if kind == ONSET_BACK else FORWARD)
    for n in range(found):
        j = room.changed[n]
        if room.kinds[j] == ARREST and state.whole[MODE, j] == REST:
            rests_from_now(chain, state, room, j)
        elif room.kinds[j] == ONSET or room.kinds[j] == ONSET_BACK:
            moves_from_now(chain, state, room, j)
    return found


@kernel
def sort_changed(room: StepRoom, count: int) -> None:
    """Sort the blocks that change, so that their order does not depend on that of the lists, which a resumed run makes anew."""
    for n in range(1, count):
        j, place = room.changed[n], n
        while place > 0 and room.changed[place - 1] > j:
            room.changed[place] = room.changed[place - 1]
            place -= 1
        room.changed[place] = j


@kernel
def begin_due(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, time: float) -> None:
    """Let blocks slip that are due at a time (s), which is now, in the event in progress or in a new one."""
    if state.now[IN_EVENT] == 0.0:
        state.now[ORIGIN], state.now[SINCE] = time, 0.0
        begin_event(chain, state, room.counts[FIRST_DUE])
    start_due(chain, state, room, kept, time)


@kernel
def start_due(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, time: float) -> int:
    """Let all blocks slip that are due at a time (s), which is now; return how many there are."""
    found = 0
    for j in range(len(state.blocks[DUE])):
        if state.blocks[DUE, j] <= time:
            room.changed[found] = j
            found += 1
    for n in range(found):
        begin_slip(state, room, kept, room.changed[n], FORWARD if chain.pull_rate > 0.0 else BACKWARD)
    for n in range(found):
        moves_from_now(chain, state, room, room.changed[n])
    return found


@kernel
def step(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, limits: Limits) -> int:
    """Take a step of the moving blocks, and the changes at its end; return DONE if it would lead beyond the time to reach."""
    now, length = state.now, expand(chain, state, room)
    if length == math.inf:
        return NOT_FINITE
    left = (limits.until - now[ORIGIN]) - now[SINCE]
    place = first_place(chain, state, room)
    due = first_due(state, room)
    due_place = max(0.0, ((due - now[ORIGIN]) - now[SINCE]) / length) if due < math.inf else NONE
    end = min(1.0, min(place, due_place))
    if end * length > left:
        take_samples(state, room, kept, length, left)
        if limits.is_cut == 1:
            commit(chain, state, room, length, left / length)
        return DONE
    take_samples(state, room, kept, length, end * length)
    lacks = remainder_of_step(room, length * chain.fastest) if chain.all_straight == 1 else room.span[1]
    now[DEFECT] = max(now[DEFECT], lacks)
    commit(chain, state, room, length, end)
    now[LAST_STEP] = length
    if chain.all_straight == 0:
        measure_end(chain, state, room, length, end)
    if place == end:
        change_blocks(chain, state, room, kept, end)
    if due_place == end:
        begin_due(chain, state, room, kept, due)
    if now[IN_EVENT] == 1.0 and rubbing(state, room) == 0:
        finish_event(chain, state, room, kept)
    return GOES_ON


@kernel
def finish_event(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows) -> None:
    """Write the row of the event that ends, and count time from here on as one number."""
    end_event(chain, state, room, kept)
    state.now[ORIGIN], state.now[SINCE] = time_of(state), 0.0


@kernel
def pass_rest(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, limits: Limits) -> int:
    """Pass over rest of all blocks at once, to the next onset; return DONE if it lies beyond the time to reach."""
    now = state.now
    due, here = first_due(state, room), time_of(state)
    beyond = not due <= limits.until
    to = limits.until if beyond else due
    take_samples(state, room, kept, 0.0, (to - now[ORIGIN]) - now[SINCE])
    if beyond and limits.is_cut == 0:
        return DONE
    wait = max(0.0, to - here)
    gained = chain.all_stiffness * chain.pull_rate * wait
    now[WORK] += chain.pull_rate * (now[PULL] + 0.5 * gained) * wait
    now[PULL] += gained
    now[ORIGIN], now[SINCE] = to, 0.0
    if beyond:
        return DONE
    begin_due(chain, state, room, kept, due)
    return GOES_ON


@entry
def begin(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows) -> None:
    """Set up the state at t = 0, from the slip of all blocks."""
    count = len(chain.blocks.mass)
    state.now[PULL] = pull_of_driver(chain, state)
    for j in range(count):
        set_moving_at_start(chain, state, j)
        state.blocks[DUE, j] = math.inf
    find_lists(chain, state, room)
    first = -1
    for j in range(count):
        if state.whole[MODE, j] == REST and room.near[j] == 0:
            set_due(chain, state, j)
        elif state.whole[MODE, j] == FORWARD or state.whole[MODE, j] == BACKWARD:
            first = j if first < 0 else first
    if first >= 0:
        begin_event(chain, state, first)
    for j in range(count):
        if state.whole[MODE, j] == FORWARD or state.whole[MODE, j] == BACKWARD:
            note_change(state, room, kept, j, ONSET)
            note_slipping(state, room, j)


@entry
def advance(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows, limits: Limits) -> int:
    """Let a chain go on until a time, or until the budget or the room for rows is used up."""
    find_lists(chain, state, room)
    room.counts[CHANGE_ROWS] = room.counts[EVENT_ROWS] = 0
    spent, count, repeated = 0, len(chain.blocks.mass), 0
    while spent < limits.budget:
        if room.counts[EVENT_ROWS] >= len(kept.events) or (
            len(kept.changes) > 0 and room.counts[CHANGE_ROWS] + 2 * count > len(kept.changes)
        ):
            return GOES_ON
        before = state.now[SINCE]
        if room.counts[MOVING] == 0:
            answer = pass_rest(chain, state, room, kept, limits)
            spent += 1 + count // SCAN
        else:
            answer = step(chain, state, room, kept, limits)
            spent += room.counts[MOVING] + 1
        if answer != GOES_ON:
            return answer
        repeated = repeated + 1 if state.now[SINCE] == before else 0
        if repeated > MOST_AT_ONCE:
            return HANGS
    return GOES_ON
