"""Replay the waves in a body of layers at several phases of a round trip together, from the slip rate of its contact.

The cells, the times T and 2 T, and the way of the waves are those of `engine.waves.ladder`. E(s) is the wave in each cell that
leaves its even place at time s, a load minus that of the reference strength; where sides are joined, each bears its share of that
(`engine.input.ladder`). A step of 2 T follows from the slip rate alone. The integral of E from the start of a round trip obeys the
same recursion, and gives displacements without a quadrature.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import cross
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.solution.observables.layer_records import (
    DRAGGED,
    MOVED,
    MOVED_IN_TRIP,
    PULL,
    RADIATED,
    SHARE,
    SUMS,
    TOTAL,
    VALUE,
    WORK,
    FollowedTrips,
    FollowedWaves,
    LadderCells,
    SlipPieces,
    WaveQueries,
)


@entry
def replay(contact: SlipPieces, ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves, queries: WaveQueries) -> None:
    """Follow the waves through the round trips given, and answer what is asked before them."""
    for k in range(len(steps.trip)):
        trip = steps.trip[k]
        place.ramp[0] = steps.ramp[k]
        answer(ladder, steps, place, queries, trip)
        more = float(trip - 1 - place.counts[0])
        if more > 0.0:
            rest(ladder, steps, place, more)
        place.counts[0] = trip
        move(contact, steps, place)
        if steps.ground.shape[1] > 0:
            for level in range(2):
                for u in range(len(steps.phase)):
                    place.slip[level, u] += steps.ground[level, k, u]
        first, past = first_change(steps.turned, trip), first_change(steps.turned, trip + 1)
        step(ladder, place, steps.sent[:, :, k], steps.turned[first:past])
        if trip == 0:
            leave_out(ladder, steps, place)
        place.sums[MOVED_IN_TRIP] = 0.0
        for n in range(SUMS):
            for u in range(len(steps.phase)):
                place.sums[n, u] += place.growth[n, u]
        place.growth[MOVED_IN_TRIP] = 0.0


@entry
def answer(ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves, queries: WaveQueries, before: int) -> None:
    """Answer the queries in round trips before one."""
    levels, cells = place.wave.shape[0], place.wave.shape[1]
    q = place.counts[2]
    while q < len(queries.asked) and queries.asked[q] < before:
        u, more = queries.which[q], float(queries.asked[q] - place.counts[0])
        if len(queries.rows) > 0:
            for level in range(levels):
                grown = more * (1.0 if level == VALUE else steps.phase[u])
                for cell in range(cells):
                    queries.rows[q, level, cell] = place.wave[level, cell, u] + grown * place.ramp[0] * ladder.ramp_share[cell]
        for n in range(SUMS):
            queries.sums[q, n] = place.sums[n, u] + more * place.growth[n, u]
        queries.sums[q, WORK] += 0.5 * more * (more + 1.0) * place.ramp[0] * place.slope[u]
        q += 1
    place.counts[2] = q


@kernel
def rest(ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves, more: float) -> None:
    """Leap over round trips of a settled rest."""
    for cell in range(place.wave.shape[1]):
        ramp = place.ramp[0] * ladder.ramp_share[cell]
        for u in range(len(steps.phase)):
            place.wave[VALUE, cell, u] += more * ramp
            if place.wave.shape[0] > TOTAL:
                place.wave[TOTAL, cell, u] += more * ramp * steps.phase[u]
    for u in range(len(steps.phase)):
        for n in range(SUMS):
            place.sums[n, u] += more * place.growth[n, u]
        place.sums[WORK, u] += 0.5 * more * (more + 1.0) * place.ramp[0] * place.slope[u]


@kernel
def leave_out(ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves) -> None:
    """Leave out of the first round trip what was before the start."""
    for u in range(len(steps.phase)):
        if steps.phase[u] < ladder.time:
            place.growth[DRAGGED, u] = 0.0
        if steps.phase[u] < ladder.delay:
            place.growth[WORK, u] = place.growth[RADIATED, u] = place.slope[u] = 0.0


@kernel
def move(contact: SlipPieces, steps: FollowedTrips, place: FollowedWaves) -> None:
    """Write the slip rate and the slip at each phase of the round trip."""
    place.slip[:] = 0.0
    trip, first = place.counts[0], place.counts[1]
    while first < len(contact.trip) and contact.trip[first] < trip:
        first += 1
    past, moves = first, False
    while past < len(contact.trip) and contact.trip[past] == trip:
        moves = moves or contact.moves[past]
        past += 1
    place.counts[1] = past
    if not moves:
        return
    for u in range(len(steps.phase)):
        phase, slipped = steps.phase[u], 0.0
        for piece in range(first, past):
            if contact.phase_from[piece] > phase:
                break
            if piece + 1 < past and contact.phase_from[piece + 1] <= phase:
                slipped += contact.grown[piece]
            elif contact.moves[piece]:
                place.slip[0, u], grown = motion(contact, piece, phase)
                slipped += grown
        place.slip[1, u] = slipped


@kernel
def motion(contact: SlipPieces, piece: int, phase: float) -> tuple[float, float]:
    """Return the slip rate (m/s) at a phase (s), 0 behind the end of the piece, and the slip (m) in the piece until then."""
    if phase >= contact.phase_to[piece]:
        return 0.0, contact.grown[piece]
    speed, bend, local = contact.speed[piece], contact.bend[piece], phase - contact.phase_from[piece]
    pace = speed + np.sqrt(max(speed * speed + 4.0 * bend * local, 0.0))
    xi = min(2.0 * local / pace, 1.0) if pace > 0.0 else 0.0
    rate, grown = 0.0, 0.0
    for k in range(contact.rate.shape[1] - 1, -1, -1):
        one = contact.rate[piece, k]
        rate = rate * xi + one
        grown = grown * xi + one * (speed / (k + 1.0) + 2.0 * bend * xi / (k + 2.0))
    return rate, grown * xi


@kernel
def first_change(turned: Floats, trip: int) -> int:
    """Return the first change of the first driver in a round trip or after it."""
    first, past = 0, len(turned)
    while first < past:
        middle = (first + past) // 2
        if turned[middle, 0] < trip:
            first = middle + 1
        else:
            past = middle
    return first


@kernel
def step(ladder: LadderCells, place: FollowedWaves, sent: Floats, turned: Floats) -> None:
    """Let waves and integrals of one round trip ago cross two cells, and the contact answer with its slip rate and slip.

    Write the powers of the drivers (W/m^2) and of drag, the way (m) of the second side's face, and by how much the power of the
    drivers grows in each round trip of a settled rest.
    """
    place.growth[:] = 0.0
    place.slope[:] = 0.0
    for level in range(place.wave.shape[0]):
        wave = place.wave[level]
        for side in range(len(ladder.starts) - 1):
            first, last = ladder.starts[side], ladder.starts[side + 1] - 1
            for parity in range(2):
                if level == VALUE:
                    take_drag(ladder, wave, place.growth[DRAGGED], first + parity, last)
                meet(ladder.reflection, ladder.beyond, wave, first + parity, last)
                if (last - first) % 2 == parity:
                    if level == TOTAL and side == 0:
                        meet_before(place, wave[last], turned)
                    meet_driver(ladder, place, level, side, sent[side])
                    if level == TOTAL and side == 0:
                        for u in range(len(place.phase)):
                            wave[last, u] += place.more[u]
        answer_of_contact(ladder, place, level)


@kernel
def meet(reflection: Floats, beyond: Floats, wave: Floats, first: int, last: int) -> None:
    """Let waves meet at the far end of every other cell from the first one on, before the last one of a side.

    The arrays are given one by one: a record of them for each cell would cost ten times as much as the work on it.
    """
    for cell in range(first, last, 2):
        share, back = reflection[cell], beyond[cell]
        for u in range(wave.shape[1]):
            wave[cell, u], wave[cell + 1, u] = cross(share, back, wave[cell, u], wave[cell + 1, u])


@kernel
def take_drag(ladder: LadderCells, wave: Floats, dragged: Floats, first: int, last: int) -> None:
    """Add the power of drag where the waves of these cells are about to meet."""
    drag, reflection, impedance = ladder.drag, ladder.reflection, ladder.impedance
    for cell in range(first, last, 2):
        if drag[cell] > 0.0:
            weight = drag[cell] * (0.5 * (1.0 + reflection[cell]) / impedance[cell]) ** 2
            for u in range(wave.shape[1]):
                dragged[u] += weight * (wave[cell, u] + wave[cell + 1, u]) ** 2


@kernel
def meet_before(place: FollowedWaves, wave: Floats, turned: Floats) -> None:
    """Write what changes of the driver in this round trip add to the integral of the echo, whose share is the last one.

    Up to a change, the share is the one before it. `wave` is the integral in the last cell.
    """
    place.more[:] = 0.0
    for n in range(len(turned)):
        at, by = int(turned[n, 1]), turned[n, 2]
        for u in range(len(wave)):
            if place.phase[u] >= place.phase[at]:
                place.more[u] += by * wave[at]


@kernel
def meet_driver(ladder: LadderCells, place: FollowedWaves, level: int, side: int, sent: Floats) -> None:
    """Let the wave in the last cell of a side meet its driver."""
    cell = ladder.starts[side + 1] - 1
    wave, share, doubled = place.wave[level, cell], sent[SHARE], 2.0 * ladder.impedance[cell]
    if level == VALUE:
        grows = -abs(ladder.ramp_share[cell]) * np.sign(ladder.ramp_share[ladder.starts[side]])
        for u in range(len(wave)):
            back = share[u] * wave[u] + sent[VALUE, u]
            velocity = (wave[u] + back) / doubled
            place.growth[WORK, u] += (0.5 * (back - wave[u]) + ladder.strength[side]) * velocity
            place.slope[u] += grows * velocity
            if share[u] > RIGID:
                driver = ladder.impedance[cell] * (1.0 - share[u]) / (1.0 + share[u])
                place.growth[RADIATED, u] += driver * (velocity - sent[PULL, u]) ** 2
            elif ladder.gain > 0.0:
                place.growth[RADIATED, u] += ladder.gain * (velocity - sent[PULL, u]) ** 2
    for u in range(len(wave)):
        wave[u] = share[u] * wave[u] + sent[level, u]


@kernel
def answer_of_contact(ladder: LadderCells, place: FollowedWaves, level: int) -> None:
    """Turn the waves that arrive at the contact into those that leave it."""
    wave, slip, first = place.wave[level], place.slip[level], ladder.impedance[0]
    if len(ladder.starts) == 2 or ladder.joined == 1:
        for side in range(len(ladder.starts) - 1):
            cell = ladder.starts[side]
            for u in range(len(slip)):
                wave[cell, u] = 2.0 * ladder.impedance[cell] * slip[u] - wave[cell, u]
        return
    other = ladder.starts[1]
    second = ladder.impedance[other]
    for u in range(len(slip)):
        # The stress at the contact is (Z2 g1 + Z1 g2 - Z1 Z2 v) / (Z1 + Z2).
        stress = (second * wave[0, u] + first * wave[other, u] - first * second * slip[u]) / (first + second)
        if level == TOTAL:
            place.growth[MOVED_IN_TRIP, u] = place.growth[MOVED, u] = (wave[other, u] - stress) / second
        wave[0, u] -= 2.0 * stress
        wave[other, u] -= 2.0 * stress
