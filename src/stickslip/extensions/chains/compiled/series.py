"""Taylor series of all moving blocks together, order by order, under friction that is linear in slip.

Each row holds the coefficients of a block's slip since the start of the step (m) in powers of x, the time in units of a step. Rows
of blocks at rest are not used: their slip is constant. Because the system is linear, the remainder of the series has a bound: the
terms left out act as a force, under which no block moves further than force / mass times x^2 / 2 cosh(fastest x).
"""

from __future__ import annotations

import math

from stickslip.engine import TERMS
from stickslip.extensions.chains.compiled.loads import load_on, sliding_strength, static_step
from stickslip.extensions.chains.compiled.memory import (
    AT_STRENGTH,
    BACKWARD,
    COUNTED,
    COUNTS_NET,
    MODE,
    MOVING,
    PIECE,
    RATE_NOW,
    REST,
    STRAIGHT,
    WITHOUT_FRICTION,
    ChainNumbers,
    Now,
    StepRoom,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact, inlined, kernel
from stickslip.foundation.kernels.memory.addresses import call_jet, floats, room_for

UNIT = 2.0
"""The unit of series, times the bound of frequencies (1): next to the length of a step if the shortest wave is there."""
TOLERANCE_OF_SERIES = 2.0**-55
"""The last terms of a step as a share of its motion (1)."""
LONGEST = 1.5
"""A step has at most so many units (1): the bound of its remainder grows with cosh."""
PASSES = (TERMS - 1) // 2
"""Passes over all moving blocks until their series have all their terms: each makes two more orders right."""
ROOM_OF_INPUT, ROOM_OF_JET = 12, 2 * TERMS
"""Room for the input of a compiled series (`SeriesInput`), and for its answer (numbers)."""
SHORT = 0.5
"""For a step shorter than this (1) the size of the motion is determined again."""


@exact
def load_term(chain: ChainNumbers, state: Now, room: StepRoom, j: int, k: int) -> float:
    """Return the k-th coefficient (N), k > 0, of the force of the springs to other blocks and to walls."""
    springs, series, modes = chain.springs, room.series, state.whole[MODE]
    own, found = 0.0 if modes[j] == REST else series[j, k], 0.0
    first, last = springs.starts[j], springs.starts[j + 1]
    for place in range(first, last - 1, 2):
        a, b = springs.neighbours[place], springs.neighbours[place + 1]
        one = springs.springs[place] * ((0.0 if modes[a] == REST else series[a, k]) - own)
        other = springs.springs[place + 1] * ((0.0 if modes[b] == REST else series[b, k]) - own)
        found += one + other
    if (last - first) % 2 == 1:
        a = springs.neighbours[last - 1]
        found += springs.springs[last - 1] * ((0.0 if modes[a] == REST else series[a, k]) - own)
    return float(found - (springs.walls[j] + chain.blocks.stiffness[j]) * own)


@exact
def first_force(chain: ChainNumbers, state: Now, j: int) -> float:
    """Return the net force (N) on a moving block now; where it leaves rest at its strength, the step of its friction."""
    mode, edge = state.whole[MODE, j], state.whole[AT_STRENGTH, j]
    if edge != 0:
        return float(edge * static_step(chain, j))
    force = load_on(chain, state, j) - chain.blocks.damping[j] * state.blocks[RATE_NOW, j]
    if mode == WITHOUT_FRICTION:
        return float(force)
    friction = sliding_strength(chain, state, j)
    return float(force + friction if mode == BACKWARD else force - friction)


@exact
def weakening_of(chain: ChainNumbers, state: Now, j: int) -> float:
    """Return how friction (N) on a moving block, with its sign, changes with its slip (N/m)."""
    mode, law = state.whole[MODE, j], chain.blocks.law[j]
    if mode == WITHOUT_FRICTION:
        return 0.0
    slope = chain.blocks.normal[j] * chain.laws.slopes[law, state.whole[PIECE, j]]
    return float(-slope if mode == BACKWARD and chain.laws.rules[law, COUNTS_NET] == 1 else slope)


@exact
def begin_series(chain: ChainNumbers, state: Now, room: StepRoom, j: int, unit: float) -> None:
    """Write the orders of the series of a moving block that its state gives: slip, slip rate, and acceleration."""
    row = room.series[j]
    row[0] = 0.0
    row[1] = state.blocks[RATE_NOW, j] * unit
    row[2] = 0.5 * first_force(chain, state, j) / chain.blocks.mass[j] * (unit * unit)


@exact
def next_order(chain: ChainNumbers, state: Now, room: StepRoom, j: int, k: int) -> None:
    """Write order k + 2 of the series of a block whose friction is straight in slip."""
    blocks, row, unit = chain.blocks, room.series[j], room.span[0]
    force = load_term(chain, state, room, j, k) - weakening_of(chain, state, j) * row[k]
    if k == 1:
        force += blocks.stiffness[j] * chain.pull_rate * unit
    if blocks.damping[j] != 0.0:
        force -= blocks.damping[j] * (k + 1.0) * row[k + 1] / unit
    row[k + 2] = force / blocks.mass[j] * (unit * unit / ((k + 1.0) * (k + 2.0)))


@exact
def write_series(chain: ChainNumbers, state: Now, room: StepRoom, unit: float) -> None:
    """Write the series of all moving blocks, in powers of the time in units (s)."""
    count, room.span[0] = room.counts[MOVING], unit
    for n in range(count):
        begin_series(chain, state, room, room.moving[n], unit)
    if chain.all_straight == 1:
        for k in range(1, TERMS - 2):
            for n in range(count):
                next_order(chain, state, room, room.moving[n], k)
        return
    for n in range(count):
        for k in range(3, TERMS):
            room.series[room.moving[n], k] = 0.0
    for _ in range(PASSES):
        for n in range(count):
            j = room.moving[n]
            if state.whole[MODE, j] == WITHOUT_FRICTION or chain.laws.rules[chain.blocks.law[j], STRAIGHT] == 1:
                for k in range(1, TERMS - 2):
                    next_order(chain, state, room, j, k)
            else:
                series_of_formula(chain, state, room, j)


@exact
def series_of_formula(chain: ChainNumbers, state: Now, room: StepRoom, j: int) -> None:
    """Write the series of a moving block from the loads that the series of the last pass give, by its law's own formula."""
    rate, row, mode = room_for(ROOM_OF_JET), room.series[j], state.whole[MODE, j]
    write_jet(chain, state, room, j, rate)
    for k in range(1, TERMS):
        row[k] = mode * (rate[k - 1] * room.span[0] / k)


@exact
def write_jet(chain: ChainNumbers, state: Now, room: StepRoom, j: int, rate: Floats) -> None:
    """Write the series of a moving block's slip rate (m/s), under the loads of the series, and what the law's radii need of it."""
    given, load, unit = room_for(ROOM_OF_INPUT), room_for(TERMS), room.span[0]
    blocks, laws = chain.blocks, chain.laws
    law, piece, mode, edge = blocks.law[j], state.whole[PIECE, j], state.whole[MODE, j], state.whole[AT_STRENGTH, j]
    load[0] = mode * load_on(chain, state, j)
    for k in range(1, TERMS):
        load[k] = mode * load_term(chain, state, room, j, k)
    load[1] += mode * (blocks.stiffness[j] * chain.pull_rate * unit)
    given[0], given[1], given[2] = blocks.damping[j], blocks.normal[j], mode if laws.rules[law, COUNTS_NET] == 1 else 1.0
    given[3], given[4], given[5] = unit, 0.0, state.blocks[COUNTED, j] - laws.references[law, piece]
    given[6], given[7], given[8], given[9] = laws.levels[law, piece], blocks.mass[j], 0.0, abs(state.blocks[RATE_NOW, j])
    given[10], given[11] = 0.0 if edge != 0 else 1.0, static_step(chain, j) if edge != 0 else 0.0
    call_jet(laws.jets_at[law, piece], floats(laws.constants_at[law, piece]), given, load, rate)


@kernel
def length_of_step(room: StepRoom) -> float:
    """Return the length of a step (in units) after which the last terms of all series are below the tolerance."""
    last = before = first = second = third = 0.0
    for n in range(room.counts[MOVING]):
        j = room.moving[n]
        first, second, third = (
            max(first, abs(room.series[j, 1])),
            max(second, abs(room.series[j, 2])),
            max(third, abs(room.series[j, 3])),
        )
        last, before = max(last, abs(room.series[j, TERMS - 1])), max(before, abs(room.series[j, TERMS - 2]))
    length = 1.0
    for _ in range(4):
        size = length * max(first, length * max(second, length * third))
        allowed = math.log(TOLERANCE_OF_SERIES * (size if size > 0.0 else max(last, before, 1e-300)))
        longest = LONGEST
        if last > 0.0:
            longest = min(longest, math.exp((allowed - math.log(last)) / (TERMS - 1)))
        if before > 0.0:
            longest = min(longest, math.exp((allowed - math.log(before)) / (TERMS - 2)))
        length = longest
        if length > SHORT:
            break
    return float(length)


@exact
def stretch_series(room: StepRoom, length: float) -> None:
    """Make [0, 1] the step: replace x by `length` times x in all series."""
    for n in range(room.counts[MOVING]):
        row = room.series[room.moving[n]]
        power = length
        for k in range(1, TERMS):
            row[k] *= power
            power *= length


@kernel
def remainder_of_step(room: StepRoom, phase: float) -> float:
    """Return a bound of the remainder of the series over a step, as a share of its motion; `phase` is fastest times length."""
    motion = left_out = 0.0
    for n in range(room.counts[MOVING]):
        row = room.series[room.moving[n]]
        motion = max(motion, abs(row[1]) + abs(row[2]) + abs(row[3]))
        left_out = max(left_out, abs(row[TERMS - 2]) + abs(row[TERMS - 1]))
    return float(0.5 * phase * phase * math.cosh(phase) * left_out / motion if motion > 0.0 else 0.0)


@inlined
def moved(row: Floats, x: float) -> float:
    """Return the slip (m) since the start of the step at x."""
    value = row[TERMS - 1]
    for k in range(TERMS - 2, 0, -1):
        value = value * x + row[k]
    return float(value * x)


@inlined
def speed(row: Floats, x: float) -> float:
    """Return d slip/dx (m) at x."""
    value = (TERMS - 1.0) * row[TERMS - 1]
    for k in range(TERMS - 2, 0, -1):
        value = value * x + k * row[k]
    return float(value)


@exact
def write_load(chain: ChainNumbers, state: Now, room: StepRoom, j: int, out: Floats) -> None:
    """Write the series of the load (N) on a block at rest over the step."""
    out[0] = load_on(chain, state, j)
    for k in range(1, TERMS):
        out[k] = load_term(chain, state, room, j, k)
    out[1] += chain.blocks.stiffness[j] * chain.pull_rate * room.span[0]
