"""Replay the waves in a body of layers at several phases of a round trip together, from the slip rate of its contact.

The cells, the times T and 2 T, and the way of the waves are those of `engine.waves.ladder`. E(s) is the wave in each cell that
leaves its even place at time s, a load minus that of the reference strength; where sides are joined, each bears its share of that
(`engine_input.ladder`). A step of 2 T follows from the slip rate alone. The integral of E from the start of a round trip obeys the
same recursion, and gives displacements without a quadrature.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.compile.kernels import kernel
from stickslip.engine.state.layout import Floats, Integers

Flags = NDArray[np.bool_]

VALUE, TOTAL, PULL = 0, 1, 2
"""What drivers send: a load where it joins the waves (Pa), its integral in the round trip (Pa s), and the driver's rate (m/s)."""
MOVED, MOVED_IN_TRIP, WORK, RADIATED, DRAGGED = range(5)
"""Sums of a replay: how far the face of the second side has moved (m), since the start and since that of the round trip, and the
work of the drivers, the energy radiated through them, and what drag has taken (J/m^2), integrated over time at one phase:
J/(m^2 s). Drag acts at odd places, T before the phase.
"""
SUMS = 5
"""Number of these sums (1)."""


class SlipPieces(NamedTuple):
    """The slip of the contact, as arrays over the pieces of the history: see `layout.Store`."""

    trip: Integers
    phase_from: Floats
    phase_to: Floats
    speed: Floats
    bend: Floats
    rate: Floats
    grown: Floats
    """Slip in the whole piece (m)."""
    moves: Flags
    """False for rest."""


class LadderCells(NamedTuple):
    """The cells, as arrays; see `layout.LadderCell`."""

    impedance: Floats
    reflection: Floats
    beyond: Floats
    """That for waves from the other side."""
    drag: Floats
    """Stress over velocity (Pa s/m) that drag takes at the far end of each cell."""
    ramp: Floats
    """Growth of the wave in a round trip of a settled rest (Pa)."""
    wave: Floats
    growth: Floats
    starts: Integers
    """First cell of each side, and the number of cells."""
    driver: Floats
    """Impedance of the driver of each side (Pa s/m)."""
    strength: Floats
    """Reference strength (Pa) of each side."""
    joined: int
    delay: float
    """Time (s) from the driver to the place where waves are followed."""
    time: float
    """Time (s) of a cell."""


class FollowedTrips(NamedTuple):
    """Round trips that are replayed one by one, at several phases (s) together."""

    phase: Floats
    trip: Integers
    sent: Floats
    """What drivers send: array over sides, VALUE, TOTAL and PULL, round trips and phases."""


class WaveQueries(NamedTuple):
    """What is asked of a replay, and where the answers go."""

    asked: Integers
    """Round trip (at least -1) of each query, in order."""
    which: Integers
    """Phase of each query."""
    rows: Floats
    """E in each cell, and its integral, for each query; none if they are not asked for."""
    sums: Floats


class FollowedWaves(NamedTuple):
    """How far a replay has come: arrays whose last axis is that of the phases."""

    wave: Floats
    """E in each cell, and its integral behind it if that is followed, too."""
    sums: Floats
    growth: Floats
    """What each round trip of a settled rest adds to the sums."""
    slope: Floats
    """By how much the power of the drivers grows in each of these round trips."""
    slip: Floats
    """Slip rate of the contact (m/s), and its slip since the start of the round trip (m)."""
    counts: Integers
    """Round trip, next piece of the history, next query."""


@kernel
def replay(contact: SlipPieces, ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves, queries: WaveQueries) -> None:
    """Follow the waves through the round trips given, and answer what is asked before them."""
    for k in range(len(steps.trip)):
        trip = steps.trip[k]
        answer(ladder, steps, place, queries, trip)
        more = float(trip - 1 - place.counts[0])
        if more > 0.0:
            rest(ladder, steps, place, more)
        place.counts[0] = trip
        move(contact, steps, place)
        step(ladder, place, steps.sent[:, :, k])
        if trip == 0:
            leave_out(ladder, steps, place)
        place.sums[MOVED_IN_TRIP] = 0.0
        place.sums[:] += place.growth
        place.growth[MOVED_IN_TRIP] = 0.0


@kernel
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
                    queries.rows[q, level, cell] = place.wave[level, cell, u] + grown * ladder.ramp[cell]
        for n in range(SUMS):
            queries.sums[q, n] = place.sums[n, u] + more * place.growth[n, u]
        queries.sums[q, WORK] += 0.5 * more * (more + 1.0) * place.slope[u]
        q += 1
    place.counts[2] = q


@kernel
def rest(ladder: LadderCells, steps: FollowedTrips, place: FollowedWaves, more: float) -> None:
    """Leap over round trips of a settled rest."""
    for cell in range(place.wave.shape[1]):
        place.wave[VALUE, cell] += more * ladder.ramp[cell]
        if place.wave.shape[0] > TOTAL:
            place.wave[TOTAL, cell] += more * ladder.ramp[cell] * steps.phase
    place.sums[:] += more * place.growth
    place.sums[WORK] += 0.5 * more * (more + 1.0) * place.slope


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
def step(ladder: LadderCells, place: FollowedWaves, sent: Floats) -> None:
    """Let waves and integrals of one round trip ago cross two cells, and the contact answer with its slip rate and slip.

    Write the powers of the drivers (W/m^2) and of drag, the way (m) of the second side's face, and by how much the power of the
    drivers grows in each round trip of a settled rest.
    """
    place.growth[:] = 0.0
    place.slope[:] = 0.0
    for level in range(place.wave.shape[0]):
        wave = place.wave[level]
        for side in range(len(ladder.starts) - 1):
            first, past = ladder.starts[side], ladder.starts[side + 1]
            for parity in range(2):
                for cell in range(first + parity, past, 2):
                    if cell == past - 1:
                        meet_driver(ladder, place, level, side, sent[side])
                    else:
                        meet(ladder, wave[cell], wave[cell + 1], cell, place.growth[DRAGGED] if level == VALUE else wave[cell, :0])
        answer_of_contact(ladder, place, level)


@kernel
def meet(ladder: LadderCells, away: Floats, back: Floats, cell: int, dragged: Floats) -> None:
    """Let waves meet at the far end of a cell, and add the power of drag; not if there is no room for it."""
    share, beyond = ladder.reflection[cell], ladder.beyond[cell]
    if ladder.drag[cell] > 0.0 and len(dragged) > 0:
        weight = ladder.drag[cell] * (0.5 * (1.0 + share) / ladder.impedance[cell]) ** 2
        for u in range(len(away)):
            dragged[u] += weight * (away[u] + back[u]) ** 2
    for u in range(len(away)):
        outward, inward = away[u], back[u]
        away[u] = share * outward + (1.0 + share) * inward
        back[u] = (1.0 + beyond) * outward + beyond * inward


@kernel
def meet_driver(ladder: LadderCells, place: FollowedWaves, level: int, side: int, sent: Floats) -> None:
    """Let the wave in the last cell of a side meet its driver."""
    cell = ladder.starts[side + 1] - 1
    wave, share, doubled = place.wave[level, cell], ladder.reflection[cell], 2.0 * ladder.impedance[cell]
    if level == VALUE:
        grows = -abs(ladder.ramp[cell]) * np.sign(ladder.ramp[ladder.starts[side]])
        for u in range(len(wave)):
            back = share * wave[u] + sent[VALUE, u]
            velocity = (wave[u] + back) / doubled
            place.growth[WORK, u] += (0.5 * (back - wave[u]) + ladder.strength[side]) * velocity
            place.slope[u] += grows * velocity
            if ladder.driver[side] < np.inf:
                place.growth[RADIATED, u] += ladder.driver[side] * (velocity - sent[PULL, u]) ** 2
    for u in range(len(wave)):
        wave[u] = share * wave[u] + sent[level, u]


@kernel
def answer_of_contact(ladder: LadderCells, place: FollowedWaves, level: int) -> None:
    """Turn the waves that arrive at the contact into those that leave it."""
    wave, slip, first = place.wave[level], place.slip[level], ladder.impedance[0]
    if len(ladder.starts) == 2 or ladder.joined == 1:
        for side in range(len(ladder.starts) - 1):
            cell = ladder.starts[side]
            wave[cell] = 2.0 * ladder.impedance[cell] * slip - wave[cell]
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
