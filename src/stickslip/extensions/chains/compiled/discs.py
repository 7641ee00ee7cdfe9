"""Prove steps under laws that are not straight in slip, by bounds on complex discs, and shorten them where the proof needs it.

Let g be the force that the equation of a block lacks along a step, with the series of the step put in. Its first coefficients
vanish, because the series were made so; if |g| <= M on the disc |x| <= r, then |g| <= M r^-n on the step [0, 1], where n is their
number (Schwarz's lemma). M follows from the law's formula in ball arithmetic, as in `engine.contact_step.certificate`: whatever
hides in the law, such as a rise of friction that the series do not see, makes it large.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine import STATES, TERMS, quick_exp2, quick_log2
from stickslip.extensions.chains.compiled.memory import (
    COUNTED,
    MODE,
    MOVING,
    PIECE,
    RATE_NOW,
    STRAIGHT,
    STRENGTH,
    WITHOUT_FRICTION,
    ChainNumbers,
    Now,
    StepRoom,
)
from stickslip.extensions.chains.compiled.series import ROOM_OF_JET, stretch_series, weakening_of, write_jet, write_load
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import call_radii, floats, room_for

MOST_LACKING = 1e-12
"""Largest force that a step may lack, as a share of the block's strength (1)."""
RADII = np.array([3.3, 4.4, 2.5, 6.4, 1.9, 1.45, 1.2])
"""Radii of discs to try, in lengths of the step (1)."""
VANISH = TERMS - 2
"""So many coefficients of the force that lacks vanish."""
SHRUNK = RADII ** -float(VANISH)
"""On the step that force is smaller than on each of the discs by these factors (1)."""
MOST_ATTEMPTS = 60
"""Shorten a step at most this many times (1)."""
SHORTEST_DISC, LONGEST_DISC, SAFETY = 0.2, 0.9, 0.97
"""A step is shortened by a factor (1) between the first two, next to the estimated one times the third."""
HOPELESS_DISC = 1e100
"""A share above this (1) means that the law has a singularity on the disc."""
MARGIN = 1.01
"""Factor (1) that covers the rounding of bounds."""
ROOM_OF_BALL = 3 * STATES + 5
BALL_SLIP, BALL_RATE, BALL_FRICTION, BALL_AT_SLIP, BALL_AT_RATE = 0, 1, 2 + STATES, 3 + 2 * STATES, 4 + 2 * STATES
"""Places in the numbers of a `layout.Ball`."""


@kernel
def proven_length(chain: ChainNumbers, state: Now, room: StepRoom) -> float:
    """Shorten a step, whose series are made, until it is proven; return its length (s), or inf if no length can be proven."""
    for _ in range(MOST_ATTEMPTS):
        share = share_of_step(chain, state, room)
        room.span[1] = share
        if share <= MOST_LACKING:
            return float(room.span[0])
        shorter = min(
            LONGEST_DISC, max(SHORTEST_DISC, SAFETY * quick_exp2((quick_log2(MOST_LACKING) - quick_log2(share)) * (1.0 / VANISH)))
        )
        stretch_series(room, shorter)
        room.span[0] *= shorter
    return math.inf


@kernel
def share_of_step(chain: ChainNumbers, state: Now, room: StepRoom) -> float:
    """Return a bound of the force that the equation of any moving block lacks in a step, as a share of its strength."""
    largest = share = 0.0
    for n in range(room.counts[MOVING]):
        largest = max(largest, state.blocks[STRENGTH, room.moving[n]])
    for n in range(room.counts[MOVING]):
        j = room.moving[n]
        strength = state.blocks[STRENGTH, j]
        if state.whole[MODE, j] == WITHOUT_FRICTION or strength == 0.0:
            strength = largest
        if strength > 0.0:
            share = max(share, least_force(chain, state, room, j, strength) / strength)
    return share


@kernel
def least_force(chain: ChainNumbers, state: Now, room: StepRoom, j: int, strength: float) -> float:
    """Return the least bound (N) by any disc, or the first that is small beside the strength (N)."""
    load, jet, least = room_for(TERMS), room_for(ROOM_OF_JET), HOPELESS_DISC * strength
    write_load(chain, state, room, j, load)
    is_curved = state.whole[MODE, j] != WITHOUT_FRICTION and chain.laws.rules[chain.blocks.law[j], STRAIGHT] == 0
    if is_curved:
        write_jet(chain, state, room, j, jet)
    for n in range(len(RADII)):
        ratio = RADII[n]
        found = force_of_motion(chain, room, j, load, ratio)
        if is_curved:
            found += friction_on_disc(chain, state, room, j, (jet, ratio))
        else:
            found += abs(weakening_of(chain, state, j)) * slip_on_disc(room.series[j], ratio)
        found *= MARGIN * SHRUNK[n]
        if found < least:  # not if it is no number
            least = found
        if least <= MOST_LACKING * strength:
            break
    return least


@kernel
def force_of_motion(chain: ChainNumbers, room: StepRoom, j: int, load: Floats, ratio: float) -> float:
    """Return how far the forces (N) of inertia, dashpot and springs can be from those at the centre of a disc."""
    row, length, power = room.series[j], room.span[0], 1.0
    bend = rate = springs = 0.0
    for k in range(1, TERMS):
        if k > 2:
            bend += k * (k - 1.0) * abs(row[k]) * power / ratio
        if k > 1:
            rate += k * abs(row[k]) * power
        power *= ratio
        springs += abs(load[k]) * power
    return float(chain.blocks.mass[j] * bend / (length * length) + chain.blocks.damping[j] * rate / length + springs)


@kernel
def slip_on_disc(row: Floats, ratio: float) -> float:
    """Return how far slip (m) can be from that at the centre of a disc."""
    found = 0.0
    for k in range(TERMS - 1, 0, -1):
        found = (found + abs(row[k])) * ratio
    return found


@kernel
def rate_on_disc(row: Floats, ratio: float) -> float:
    """Return how far d slip/dx (m) can be from that at the centre of a disc."""
    found = 0.0
    for k in range(TERMS - 1, 1, -1):
        found = (found + k * abs(row[k])) * ratio
    return found


@kernel
def friction_on_disc(chain: ChainNumbers, state: Now, room: StepRoom, j: int, disc: tuple[Floats, float]) -> float:
    """Return how far friction (N) can be from that at the centre of a disc: what the law's jet has written, and a radius."""
    jet, ratio = disc
    laws, row, ball = chain.laws, room.series[j], room_for(ROOM_OF_BALL)
    law, piece = chain.blocks.law[j], state.whole[PIECE, j]
    ball[BALL_SLIP], ball[BALL_RATE] = slip_on_disc(row, ratio), rate_on_disc(row, ratio) / room.span[0]
    ball[BALL_FRICTION] = math.inf
    ball[BALL_AT_SLIP], ball[BALL_AT_RATE] = state.blocks[COUNTED, j] - laws.references[law, piece], abs(state.blocks[RATE_NOW, j])
    call_radii(laws.radii_at[law, piece], floats(laws.constants_at[law, piece]), jet, ball)
    return float(chain.blocks.normal[j] * ball[BALL_FRICTION])
