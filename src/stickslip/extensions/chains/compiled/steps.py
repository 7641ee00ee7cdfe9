"""One step of the moving blocks: their series over its length, and their state and energies at its end."""

from __future__ import annotations

import math

from stickslip.engine import TERMS
from stickslip.extensions.chains.compiled.accounts import dissipated, heat_of_step, integral_of_slip, note_rate
from stickslip.extensions.chains.compiled.discs import proven_length
from stickslip.extensions.chains.compiled.memory import (
    AT_STRENGTH,
    BLOCK_STEPS,
    COUNT_OF_STEPS,
    COUNTED,
    COUNTS_NET,
    DASHPOT,
    FORWARD,
    HEAT,
    LAST_STEP,
    MODE,
    MOVING,
    ORIGIN,
    PULL,
    RATE_NOW,
    RESIDUAL,
    SAMPLES,
    SINCE,
    SLIP,
    STRENGTH,
    WATCHED,
    WITHOUT_FRICTION,
    WORK,
    ChainNumbers,
    KeptRows,
    Now,
    StepRoom,
)
from stickslip.extensions.chains.compiled.series import (
    UNIT,
    first_force,
    length_of_step,
    moved,
    speed,
    stretch_series,
    write_series,
)
from stickslip.foundation.kernels.kernels import kernel

LONGER_NEXT, SHORTER_NEXT, SHORTEST_OF_STEPS = 2.0, 1e-3, 1e-300
"""Under laws that are not straight in slip: the unit of a series over the length of the last step (1), by what it is made shorter
if a term overflows (1), and the shortest unit (s)."""


@kernel
def expand(chain: ChainNumbers, state: Now, room: StepRoom) -> float:
    """Write the series of the moving blocks over a step, and return its length (s); inf if a term is no number."""
    unit, last = UNIT / chain.fastest, state.now[LAST_STEP]
    if chain.all_straight == 0 and last > 0.0:
        unit = min(unit, LONGER_NEXT * last)
    write_series(chain, state, room, unit)
    while not is_finite(room) and unit > SHORTEST_OF_STEPS:
        unit *= SHORTER_NEXT
        write_series(chain, state, room, unit)
    share = length_of_step(room)
    if not (is_finite(room) and share > 0.0):
        return math.inf
    stretch_series(room, share)
    room.span[0] = share * unit
    return share * unit if chain.all_straight == 1 else proven_length(chain, state, room)


@kernel
def is_finite(room: StepRoom) -> bool:
    """Return True if the last terms of all series are numbers."""
    total = 0.0
    for n in range(room.counts[MOVING]):
        total += abs(room.series[room.moving[n], TERMS - 1])
    return total < math.inf


@kernel
def take_samples(state: Now, room: StepRoom, kept: KeptRows, length: float, reach: float) -> None:
    """Write slip and slip rate at the times that lie within a reach (s) from now, of a step of a length (s), or of rest: 0."""
    while room.counts[SAMPLES] < len(kept.sample_times):
        n = room.counts[SAMPLES]
        after = (kept.sample_times[n] - state.now[ORIGIN]) - state.now[SINCE]
        if not after <= reach:
            return
        for j in range(len(state.blocks[SLIP])):
            kept.sampled_slip[n, j], kept.sampled_rate[n, j] = state.blocks[SLIP, j], 0.0
        if length > 0.0:
            place = min(1.0, max(0.0, after / length))
            for m in range(room.counts[MOVING]):
                j = room.moving[m]
                kept.sampled_slip[n, j] = state.blocks[SLIP, j] + moved(room.series[j], place)
                kept.sampled_rate[n, j] = speed(room.series[j], place) / length
        room.counts[SAMPLES] = n + 1


@kernel
def commit(chain: ChainNumbers, state: Now, room: StepRoom, length: float, place: float) -> None:
    """Move all moving blocks to a place in the step, of a length in s, and count energies."""
    now, blocks, duration = state.now, state.blocks, length * place
    lost = given = 0.0
    for n in range(room.counts[MOVING]):
        j = room.moving[n]
        row, mode = room.series[j], state.whole[MODE, j]
        slip, rate = moved(row, place), speed(row, place) / length
        stiffness, damping = chain.blocks.stiffness[j], chain.blocks.damping[j]
        lost += stiffness * integral_of_slip(room, j, place)
        given += stiffness * slip
        if damping != 0.0:
            now[DASHPOT] += damping * dissipated(room, j, place) / length
        if mode != WITHOUT_FRICTION:
            note_rate(state, room, j, place, length)
            slip, rate = (max(slip, 0.0), max(rate, 0.0)) if mode == FORWARD else (min(slip, 0.0), min(rate, 0.0))
            way = mode if chain.laws.rules[chain.blocks.law[j], COUNTS_NET] == 1 else 1
            now[HEAT] += heat_of_step(chain, state, room, j, (length, place))
            blocks[COUNTED, j] += way * abs(slip)
        blocks[SLIP, j] += slip
        blocks[RATE_NOW, j] = rate
        if duration > 0.0:
            state.whole[AT_STRENGTH, j] = 0
    if duration > 0.0:
        for n in range(room.counts[WATCHED]):
            state.whole[AT_STRENGTH, room.watched[n]] = 0
    gained = chain.all_stiffness * chain.pull_rate * duration
    now[WORK] += chain.pull_rate * ((now[PULL] + 0.5 * gained) * duration - lost * length)
    now[PULL] += gained - given
    now[SINCE] += duration
    now[COUNT_OF_STEPS] += 1.0
    now[BLOCK_STEPS] += room.counts[MOVING]


@kernel
def measure_end(chain: ChainNumbers, state: Now, room: StepRoom, length: float, place: float) -> None:
    """Keep how far the acceleration at the end of a step is from that of the force there, as a share of the strength."""
    for n in range(room.counts[MOVING]):
        j = room.moving[n]
        if state.whole[MODE, j] != WITHOUT_FRICTION and state.whole[AT_STRENGTH, j] == 0:
            row, bend = room.series[j], 0.0
            for k in range(TERMS - 1, 1, -1):
                bend = bend * place + k * (k - 1.0) * row[k]
            lacks = abs(chain.blocks.mass[j] * bend / (length * length) - first_force(chain, state, j))
            state.now[RESIDUAL] = max(state.now[RESIDUAL], lacks / (lacks + state.blocks[STRENGTH, j]))
