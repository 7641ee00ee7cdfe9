"""Loads of blocks, their strengths, and when a block that rests among resting ones begins to slip.

The sums are rounded one by one, in pairs of opposite neighbours, so that a chain that is turned end for end has the same bits.
"""

from __future__ import annotations

import math

from stickslip.extensions.chains.compiled.memory import (
    AT_STRENGTH,
    COUNTED,
    DUE,
    MODE,
    ORIGIN,
    PIECE,
    RATE_NOW,
    REST,
    SINCE,
    SLIP,
    STRAIGHT,
    STRENGTH,
    ChainNumbers,
    Now,
)
from stickslip.foundation.kernels.kernels import exact
from stickslip.foundation.kernels.memory.addresses import call_value, floats, room_for

ROOM_OF_VALUE = 4
"""Room for the answer of a formula (numbers): mu and its derivatives."""


@exact
def time_of(state: Now) -> float:
    """Return the time (s)."""
    return float(state.now[ORIGIN] + state.now[SINCE])


@exact
def driver_place(chain: ChainNumbers, state: Now) -> float:
    """Return the place of the driver (m)."""
    return float(chain.pull_rate * state.now[ORIGIN] + chain.pull_rate * state.now[SINCE])


@exact
def load_on(chain: ChainNumbers, state: Now, j: int) -> float:
    """Return the force of all springs on a block (N)."""
    springs, slips = chain.springs, state.blocks[SLIP]
    own, found = slips[j], 0.0
    first, last = springs.starts[j], springs.starts[j + 1]
    for place in range(first, last - 1, 2):
        one = springs.springs[place] * (slips[springs.neighbours[place]] - own)
        other = springs.springs[place + 1] * (slips[springs.neighbours[place + 1]] - own)
        found += one + other
    if (last - first) % 2 == 1:
        found += springs.springs[last - 1] * (slips[springs.neighbours[last - 1]] - own)
    return float(found - springs.walls[j] * own + chain.blocks.stiffness[j] * (driver_place(chain, state) - own))


@exact
def growth_of_load(chain: ChainNumbers, state: Now, j: int) -> float:
    """Return how fast the load (N/s) on a block grows whose own slip rate is 0."""
    springs, rates, found = chain.springs, state.blocks[RATE_NOW], 0.0
    first, last = springs.starts[j], springs.starts[j + 1]
    for place in range(first, last - 1, 2):
        one = springs.springs[place] * rates[springs.neighbours[place]]
        other = springs.springs[place + 1] * rates[springs.neighbours[place + 1]]
        found += one + other
    if (last - first) % 2 == 1:
        found += springs.springs[last - 1] * rates[springs.neighbours[last - 1]]
    return float(found + chain.blocks.stiffness[j] * chain.pull_rate)


@exact
def friction_at(chain: ChainNumbers, state: Now, j: int, counted: float, rate: float) -> float:
    """Return the magnitude of friction (N) on a block at a slip that its law counts (m) and a slip rate (m/s), by its piece."""
    law, piece, laws = chain.blocks.law[j], state.whole[PIECE, j], chain.laws
    along = counted - laws.references[law, piece]
    if laws.rules[law, STRAIGHT] == 1:
        return float(chain.blocks.normal[j] * (laws.levels[law, piece] + laws.slopes[law, piece] * along))
    out = room_for(ROOM_OF_VALUE)
    call_value(laws.values_at[law, piece], floats(laws.constants_at[law, piece]), along, rate, out)
    return float(chain.blocks.normal[j] * (laws.levels[law, piece] + out[0]))


@exact
def sliding_strength(chain: ChainNumbers, state: Now, j: int) -> float:
    """Return the magnitude of friction (N) on a block that slips, at its slip and slip rate."""
    return float(friction_at(chain, state, j, state.blocks[COUNTED, j], abs(state.blocks[RATE_NOW, j])))


@exact
def static_step(chain: ChainNumbers, j: int) -> float:
    """Return the step (N) from static to sliding friction."""
    return float(chain.blocks.normal[j] * chain.laws.excess[chain.blocks.law[j]])


@exact
def set_due(chain: ChainNumbers, state: Now, j: int) -> None:
    """Write when a block that rests among resting ones begins to slip."""
    loading = chain.blocks.stiffness[j] * chain.pull_rate
    load, strength, wait = load_on(chain, state, j), state.blocks[STRENGTH, j], math.inf
    if loading > 0.0:
        wait = 0.0 if state.whole[AT_STRENGTH, j] == 1 else max(0.0, (strength - load) / loading)
    elif loading < 0.0:
        wait = 0.0 if state.whole[AT_STRENGTH, j] == -1 else max(0.0, (strength + load) / -loading)
    state.whole[AT_STRENGTH, j] = 0
    state.blocks[DUE, j] = time_of(state) + wait


@exact
def piece_of(chain: ChainNumbers, law: int, counted: float, piece: int) -> int:
    """Return the piece of a law that holds from a counted slip on, looked for from a piece."""
    knots = chain.laws.knots[law]
    while piece > 0 and counted < knots[piece]:
        piece -= 1
    while piece + 1 < len(knots) and counted >= knots[piece + 1]:
        piece += 1
    return piece


@exact
def put_to_rest(chain: ChainNumbers, state: Now, j: int, heals: bool) -> None:
    """Write that a block rests, with its strength, after its law has forgotten its slip if it heals."""
    law = chain.blocks.law[j]
    state.whole[MODE, j] = REST
    if heals:
        state.blocks[COUNTED, j] = 0.0
    state.whole[PIECE, j] = piece_of(chain, law, state.blocks[COUNTED, j], state.whole[PIECE, j])
    state.blocks[RATE_NOW, j] = 0.0
    state.blocks[STRENGTH, j] = sliding_strength(chain, state, j) + static_step(chain, j)
