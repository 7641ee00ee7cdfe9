"""What is counted of a run: energies, and the rows of events."""

from __future__ import annotations

from numpy.polynomial.legendre import leggauss

from stickslip.engine import TERMS
from stickslip.engine.series.polynomial import extremes
from stickslip.extensions.chains.compiled.loads import driver_place, friction_at, time_of
from stickslip.extensions.chains.compiled.memory import (
    COUNTED,
    COUNTS_NET,
    DASHPOT,
    DASHPOT_BEFORE,
    EVENT_BLOCK,
    EVENT_DASHPOT,
    EVENT_DURATION,
    EVENT_HEAT,
    EVENT_MOMENT,
    EVENT_RATE,
    EVENT_ROWS,
    EVENT_SIZE,
    EVENT_SPRINGS_AFTER,
    EVENT_SPRINGS_BEFORE,
    EVENT_START,
    EVENT_TIME,
    EVENT_WORK,
    EVENTS,
    FIRST_BLOCK,
    HAVE_SLIPPED,
    HEAT,
    HEAT_BEFORE,
    IN_EVENT,
    LARGEST_RATE,
    MODE,
    SINCE,
    SLIP,
    SLIP_BEFORE,
    SLIPPED,
    SPRINGS_BEFORE,
    STRAIGHT,
    WORK,
    WORK_BEFORE,
    ChainNumbers,
    KeptRows,
    Now,
    StepRoom,
)
from stickslip.extensions.chains.compiled.series import moved, speed
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import room_for

GAUSS_PLACES, GAUSS_WEIGHTS = (0.5 * (one + shift) for one, shift in zip(leggauss(10), (1.0, 0.0), strict=True))
"""Places on [0, 1] and weights of Gauss's sum: with ten points it is exact for polynomials up to degree 19."""
TWICE = 2 * TERMS
"""Number of powers of x in a square of a series."""


@kernel
def energy_of_springs(chain: ChainNumbers, state: Now) -> float:
    """Return the energy in all springs (J)."""
    springs, slips, driver, found = chain.springs, state.blocks[SLIP], driver_place(chain, state), 0.0
    for j in range(len(slips)):
        own, pair = slips[j], 0.0
        for place in range(springs.starts[j], springs.starts[j + 1]):
            bent = slips[springs.neighbours[place]] - own
            pair += springs.springs[place] * bent * bent
        stretched = driver - own
        found += 0.25 * pair + 0.5 * (springs.walls[j] * own * own + chain.blocks.stiffness[j] * stretched * stretched)
    return found


@entry
def energies(chain: ChainNumbers, state: Now) -> float:
    """Return the energy in all springs (J), for Python."""
    return energy_of_springs(chain, state)


@kernel
def pull_of_driver(chain: ChainNumbers, state: Now) -> float:
    """Return the force (N) with which the driver pulls all blocks."""
    driver, found = driver_place(chain, state), 0.0
    for j in range(len(chain.blocks.mass)):
        found += chain.blocks.stiffness[j] * (driver - state.blocks[SLIP, j])
    return found


@kernel
def note_slipping(state: Now, room: StepRoom, j: int) -> None:
    """Write that a block slips in the event in progress."""
    if state.whole[SLIPPED, j] == 0:
        state.whole[SLIPPED, j] = 1
        state.blocks[SLIP_BEFORE, j] = state.blocks[SLIP, j]
        room.slipped[room.counts[HAVE_SLIPPED]] = j
        room.counts[HAVE_SLIPPED] += 1


@kernel
def begin_event(chain: ChainNumbers, state: Now, first: int) -> None:
    """Write that an event begins with the slip of a block."""
    now = state.now
    now[IN_EVENT], now[FIRST_BLOCK], now[EVENT_START], now[LARGEST_RATE] = 1.0, first, time_of(state), 0.0
    now[HEAT_BEFORE], now[DASHPOT_BEFORE], now[WORK_BEFORE] = now[HEAT], now[DASHPOT], now[WORK]
    now[SPRINGS_BEFORE] = energy_of_springs(chain, state)


@kernel
def end_event(chain: ChainNumbers, state: Now, room: StepRoom, kept: KeptRows) -> None:
    """Write the row of the event that ends now."""
    now, count, moment = state.now, room.counts[HAVE_SLIPPED], 0.0
    for j in range(len(chain.blocks.mass)):  # in the order of blocks: that of the list depends on calls
        if state.whole[SLIPPED, j] == 1:
            moment += state.blocks[SLIP, j] - state.blocks[SLIP_BEFORE, j]
            state.whole[SLIPPED, j] = 0
    row = kept.events[room.counts[EVENT_ROWS]]
    room.counts[EVENT_ROWS] += 1
    room.counts[HAVE_SLIPPED] = 0
    row[EVENT_TIME], row[EVENT_BLOCK], row[EVENT_SIZE], row[EVENT_MOMENT] = now[EVENT_START], now[FIRST_BLOCK], count, moment
    row[EVENT_DURATION], row[EVENT_RATE] = now[SINCE], now[LARGEST_RATE]
    row[EVENT_HEAT], row[EVENT_DASHPOT] = now[HEAT] - now[HEAT_BEFORE], now[DASHPOT] - now[DASHPOT_BEFORE]
    row[EVENT_WORK], row[EVENT_SPRINGS_BEFORE] = now[WORK] - now[WORK_BEFORE], now[SPRINGS_BEFORE]
    row[EVENT_SPRINGS_AFTER] = energy_of_springs(chain, state)
    now[IN_EVENT] = 0.0
    now[EVENTS] += 1.0


@kernel
def note_rate(state: Now, room: StepRoom, j: int, place: float, length: float) -> None:
    """Keep the largest slip rate (m/s) of a block over a step up to a place, if it is the largest of the event so far."""
    row, largest, power = room.series[j], 0.0, 1.0
    for k in range(1, TERMS):
        largest += k * abs(row[k]) * power
        power *= place
    if largest <= state.now[LARGEST_RATE] * length:
        return
    line = room_for(TERMS)
    power = 1.0
    for k in range(TERMS - 1):
        line[k] = (k + 1.0) * row[k + 1] * power
        power *= place
    line[TERMS - 1] = 0.0
    low, high = extremes(line)
    state.now[LARGEST_RATE] = max(state.now[LARGEST_RATE], max(-low, high) / length)


@kernel
def dissipated(room: StepRoom, j: int, place: float) -> float:
    """Return the integral of (d slip/dx)^2 from 0 to a place."""
    row, found = room.series[j], 0.0
    powers = room_for(TWICE)
    powers[0] = 1.0
    for k in range(1, 2 * TERMS):
        powers[k] = powers[k - 1] * place
    for i in range(1, TERMS):
        for k in range(1, TERMS):
            found += i * k * row[i] * row[k] * powers[i + k - 1] / (i + k - 1.0)
    return found


@kernel
def integral_of_slip(room: StepRoom, j: int, place: float) -> float:
    """Return the integral of a block's slip since the start of the step from 0 to a place."""
    row, value = room.series[j], 0.0
    for k in range(TERMS - 1, 0, -1):
        value = value * place + row[k] / (k + 1.0)
    return value * place * place


@kernel
def heat_of_step(chain: ChainNumbers, state: Now, room: StepRoom, j: int, span: tuple[float, float]) -> float:
    """Return the heat (J) of a block's friction over a step, before the block is moved; `span` is its length (s) and its end.

    It is exact for friction that is straight in slip; for any other law it is the sum of Gauss over the law's own values.
    """
    row, law, counted = room.series[j], chain.blocks.law[j], state.blocks[COUNTED, j]
    way = state.whole[MODE, j] if chain.laws.rules[law, COUNTS_NET] == 1 else 1
    length, place = span
    if chain.laws.rules[law, STRAIGHT] == 1:
        slip = abs(moved(row, place))
        return slip * friction_at(chain, state, j, counted + 0.5 * way * slip, 0.0)
    found = 0.0
    for n in range(len(GAUSS_PLACES)):
        x = place * GAUSS_PLACES[n]
        fast = abs(speed(row, x))
        found += GAUSS_WEIGHTS[n] * fast * friction_at(chain, state, j, counted + way * abs(moved(row, x)), fast / length)
    return found * place
