"""Changes of blocks: where in a step the first one is, and what it does.

All changes at the bit-equal first place of a step happen together: loads and strengths are those before any of them, and lists are
worked through from the first block to the last.
"""

from __future__ import annotations

import math

from stickslip.engine import TERMS
from stickslip.engine.series.polynomial import NONE, first_descent
from stickslip.extensions.chains.compiled.loads import (
    growth_of_load,
    load_on,
    piece_of,
    put_to_rest,
    sliding_strength,
    static_step,
    time_of,
)
from stickslip.extensions.chains.compiled.memory import (
    ARREST,
    AT_STRENGTH,
    BACKWARD,
    CHANGE_BLOCK,
    CHANGE_KIND,
    CHANGE_ROWS,
    CHANGE_SINCE,
    CHANGE_SLIP,
    CHANGE_TIME,
    COUNT_OF_CHANGES,
    COUNTED,
    COUNTS_NET,
    FORWARD,
    HEALS,
    KNOT,
    LARGEST_RATE,
    MODE,
    MOVING,
    ONSET,
    PIECE,
    RATE_NOW,
    SINCE,
    SLIP,
    STRENGTH,
    TURN,
    WATCHED,
    WITHOUT_FRICTION,
    ChainNumbers,
    KeptRows,
    Now,
    StepRoom,
)
from stickslip.extensions.chains.compiled.series import write_load
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact, kernel
from stickslip.foundation.kernels.memory.addresses import room_for

ONSET_BACK = 4
"""Kind of change inside a step, besides those that are kept: a block at rest begins to slip back."""

ROUNDED, ROUNDED_FORCE = 1e-13, 4e-15
"""Slip that begins at rest, and whose rate falls below 0 by no more than the first share (1) of its size in the step and what a
force of the second share (1) of the strength makes of it, has not ended: that is rounding."""
TOUCH = 1e-11
"""If static friction is sliding friction, a slip rate whose minimum is above 0 by no more than this share (1) of the event's
largest touches 0: that is an arrest, as of a single block."""
REFINEMENTS = 8
"""Newton's steps to the place of a minimum (1): its start is next to it."""
BRIEF = 1e-5
"""A rest that would be over, without healing, within this phase (rad) of the fastest motion is a touch in passing (1): the law
does not heal. It is next to the root of `TOUCH`, as in the engine (`engine.contact_step.stick_or_slip.is_arrest`)."""


@kernel
def note_change(state: Now, room: StepRoom, kept: KeptRows, j: int, kind: int) -> None:
    """Count a change, and keep it if there is room."""
    state.now[COUNT_OF_CHANGES] += 1.0
    n = room.counts[CHANGE_ROWS]
    if n < len(kept.changes):
        row = kept.changes[n]
        row[CHANGE_TIME], row[CHANGE_SINCE] = time_of(state), state.now[SINCE]
        row[CHANGE_BLOCK], row[CHANGE_KIND], row[CHANGE_SLIP] = j, kind, state.blocks[SLIP, j]
        room.counts[CHANGE_ROWS] = n + 1


@kernel
def find_in_moving(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Write where in the step a moving block first comes to rest or passes a knot of its law."""
    mode, row, line, spare = state.whole[MODE, j], room.series[j], room_for(TERMS), room_for(TERMS)
    room.places[j] = NONE
    if mode == WITHOUT_FRICTION:
        return
    for k in range(TERMS - 1):
        line[k] = mode * (k + 1.0) * row[k + 1]
    line[TERMS - 1] = 0.0
    room.places[j], room.kinds[j] = first_descent(line, spare), ARREST
    if room.places[j] < NONE and state.blocks[RATE_NOW, j] == 0.0:
        size, length = 0.0, room.span[0]
        for k in range(TERMS):
            size += abs(line[k])
        line[0] += ROUNDED * size + ROUNDED_FORCE * state.blocks[STRENGTH, j] / chain.blocks.mass[j] * length * length
        if first_descent(line, spare) == NONE:
            room.places[j] = NONE
    elif room.places[j] == NONE and static_step(chain, j) == 0.0:
        room.places[j] = place_of_touch(state, room, line, spare)
    law, piece, counted = chain.blocks.law[j], state.whole[PIECE, j], state.blocks[COUNTED, j]
    knots = chain.laws.knots[law]
    grows = mode if chain.laws.rules[law, COUNTS_NET] == 1 else 1
    ahead = math.inf
    if grows == 1 and piece + 1 < len(knots):
        ahead = knots[piece + 1] - counted
    elif grows == -1:
        ahead = counted - knots[piece]
    if ahead < math.inf:
        line[0] = ahead
        for k in range(1, TERMS):
            line[k] = -mode * row[k]
        place = first_descent(line, spare)
        if place < room.places[j]:
            room.places[j], room.kinds[j] = place, KNOT


@kernel
def place_of_touch(state: Now, room: StepRoom, line: Floats, spare: Floats) -> float:
    """Return the place of a minimum of a slip rate (m per step) in the step that is 0 but for rounding, or NONE."""
    size = TOUCH * state.now[LARGEST_RATE] * room.span[0]
    line[0] -= size
    place = 0.0 if line[0] <= 0.0 else first_descent(line, spare)
    line[0] += size
    if place == NONE:
        return NONE
    for n in range(REFINEMENTS):
        slope = bend = 0.0
        for k in range(TERMS - 1, 0, -1):
            bend = bend * place + slope
            slope = slope * place + k * line[k]
        if bend <= 0.0 or (n == 0 and slope >= 0.0):
            return NONE  # it rises from 0, or falls on
        place -= slope / bend
        if not 0.0 < place <= 1.0:
            return NONE
    return place


@kernel
def find_at_rest(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Write where in the step a block at rest beside moving ones first reaches its strength."""
    load, margin, spare = room_for(TERMS), room_for(TERMS), room_for(TERMS)
    strength, edge = state.blocks[STRENGTH, j], state.whole[AT_STRENGTH, j]
    write_load(chain, state, room, j, load)
    for k in range(1, TERMS):
        margin[k] = -load[k]
    margin[0] = 0.0 if edge == 1 else strength - load[0]
    room.places[j], room.kinds[j] = first_descent(margin, spare), ONSET
    if chain.forward_only == 0:
        margin[0] = 0.0 if edge == -1 else strength + load[0]
        for k in range(1, TERMS):
            margin[k] = load[k]
        place = first_descent(margin, spare)
        if place < room.places[j]:
            room.places[j], room.kinds[j] = place, ONSET_BACK


@kernel
def first_place(chain: ChainNumbers, state: Now, room: StepRoom) -> float:
    """Look for changes of moving blocks and those beside them in a step, and return the first place of one in [0, 1]; NONE."""
    first = NONE
    for n in range(room.counts[MOVING]):
        find_in_moving(chain, state, room, room.moving[n])
        first = min(first, room.places[room.moving[n]])
    for n in range(room.counts[WATCHED]):
        find_at_rest(chain, state, room, room.watched[n])
        first = min(first, room.places[room.watched[n]])
    return first


@kernel
def begin_slip(state: Now, room: StepRoom, kept: KeptRows, j: int, mode: int) -> None:
    """Let a block leave rest exactly at its strength."""
    state.whole[MODE, j], state.whole[AT_STRENGTH, j] = mode, mode
    state.blocks[RATE_NOW, j] = 0.0
    note_change(state, room, kept, j, ONSET)


@kernel
def pass_knot(chain: ChainNumbers, state: Now, j: int) -> None:
    """Let the law of a block go on with its next piece."""
    law, piece = chain.blocks.law[j], state.whole[PIECE, j]
    grows = state.whole[MODE, j] if chain.laws.rules[law, COUNTS_NET] == 1 else 1
    state.blocks[COUNTED, j] = chain.laws.knots[law, piece + 1 if grows == 1 else piece]
    state.whole[PIECE, j] = piece + 1 if grows == 1 else piece - 1


@exact
def is_brief(chain: ChainNumbers, state: Now, j: int, margin: float) -> bool:
    """Return True if the load makes up for a margin (N), as it grows now, so soon that rest is a touch in passing."""
    growth = state.whole[MODE, j] * growth_of_load(chain, state, j)
    return bool(margin * chain.fastest <= BRIEF * growth)


@exact
def arrest(chain: ChainNumbers, state: Now, j: int) -> int:
    """Bring a block to rest, or let it go on in the other direction; return the kind of change."""
    mode = state.whole[MODE, j]
    state.blocks[RATE_NOW, j], state.whole[AT_STRENGTH, j] = 0.0, 0
    ahead = mode * load_on(chain, state, j)
    before_rest = sliding_strength(chain, state, j) + static_step(chain, j)
    if ahead < -before_rest and chain.forward_only == 0:
        state.whole[MODE, j] = -mode
        law = chain.blocks.law[j]
        if chain.laws.rules[law, COUNTS_NET] == 1:
            state.whole[PIECE, j] = piece_of(chain, law, state.blocks[COUNTED, j], state.whole[PIECE, j])
        return TURN
    heals = chain.laws.rules[chain.blocks.law[j], HEALS] == 1 and not is_brief(chain, state, j, before_rest - ahead)
    put_to_rest(chain, state, j, heals)
    if ahead >= state.blocks[STRENGTH, j]:
        if not heals:
            state.whole[AT_STRENGTH, j] = mode  # beyond its strength by rounding only: exactly at it
        else:
            state.whole[MODE, j] = mode  # it heals to less than its load, and slips again at once
            return TURN
    return ARREST


@kernel
def set_moving_at_start(chain: ChainNumbers, state: Now, j: int) -> int:
    """Let a block slip at t = 0 if its load is beyond its strength; return its mode."""
    if chain.blocks.normal[j] == 0.0:
        state.whole[MODE, j] = WITHOUT_FRICTION
        return WITHOUT_FRICTION
    put_to_rest(chain, state, j, chain.laws.rules[chain.blocks.law[j], HEALS] == 1)
    load, strength = load_on(chain, state, j), state.blocks[STRENGTH, j]
    if load > strength:
        state.whole[MODE, j] = FORWARD
    elif load < -strength and chain.forward_only == 0:
        state.whole[MODE, j] = BACKWARD
    return int(state.whole[MODE, j])
