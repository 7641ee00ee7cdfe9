"""Waves in a body of layers: a ladder of cells, each of which a wave crosses in the same time T (Goupillaud 1961).

A round trip of the engine lasts 2 T here, after which the first cell answers. In units of load, f = Z v - sigma travels away from
the contact and g = Z v + sigma towards it. Where two cells meet, with r = (Z - Z') / (Z + Z'), the nearer cell gets r f + (1 + r) g
back, and the farther one (1 - r) f - r g. The last cell gets back r f and what its driver sends. Where drag takes the stress d v,
r = (Z - Z' - d) / (Z + Z' + d), and the farther cell gets (1 + r') f + r' g with r' = (Z' - Z - d) / (Z + Z' + d).

Places where cells meet are counted from the contact, which is place 0. At each phase of a round trip, one wave in each cell leaves
its *even* place; T later these waves meet at the odd places, and 2 T later at the even ones again. They are a row: a polynomial in
xi for each cell, on a piece of the history as its load is. The piece of load that the contact meets has a row of its own, the air.
There the first wave is the one that arrives; in the row of a piece of the history it is the one that leaves the contact.

Rows are kept for the pieces of the present round trip and of the one before: that of piece n is n + `wave_shift`, modulo their
number. A second side of the contact has its cells behind those of the first. Either slip is between the sides, which bear the same
stress, or the sides are joined, slip alike, and share the stress.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.pieces import span_of_load
from stickslip.engine.series.polynomial import copy, fill, restrict, total
from stickslip.engine.state.layout import TERMS, Floats, Task
from stickslip.engine.state.workspace import Run, borrow
from stickslip.engine.waves.driver_at_rest import ramp_of_machine
from stickslip.engine.waves.interface import cross
from stickslip.engine.waves.ladder_rows import (
    AIR,
    ASIDE,
    cut_waves,
    row_of,
    share_of_waves,
    side_of,
    wave_in,
    write_from_fold,
    write_to_fold,
)
from stickslip.engine.waves.merged_pieces import gather, plan_merging
from stickslip.engine.waves.shaken_ladder import follow_ground, shake, shakes
from stickslip.foundation.constants import RIGID
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead

STILL_WAVES = 4e-15
"""Waves have settled when they differ from those one round trip ago, but for the ramp, by less than this share (1) of the loads."""
JUMP = 1e-12
"""The load jumps between two pieces if it changes by more than this share (1) of itself and of the reference strength."""


@kernel
def serve(run: Run, task: int, number: float) -> float:
    """Do one task; `number` is a place or a width in xi."""
    if task == Task.CROSS_CELLS:
        return 1.0 if cross_cells(run) else 0.0
    if task == Task.KEEP_WAVES:
        keep_waves(run, number)
    elif task == Task.SEND_IN:
        send_in(run)
    elif task == Task.CUT_WAVES:
        cut_waves(run, number)
    elif task == Task.SHARE_DESCRIBED:
        return share_of_waves(run, number)
    elif task == Task.WAVES_TO_FOLD:
        write_to_fold(run, number)
    elif task == Task.WAVES_FROM_FOLD:
        write_from_fold(run, number)
    elif task == Task.WAVES_GO_ON:
        copy(wave_in(run, ASIDE, 0), wave_in(run, AIR, 0), run.counts.slots * TERMS)
    elif task == Task.PLAN_MERGING:
        plan_merging(run)
    else:
        return 1.0 if is_settled(run) else 0.0
    return 0.0


# ---- what arrives -----------------------------------------------------------------------------------------------------------


@kernel
def cross_cells(run: Run) -> bool:
    """Let the waves of one round trip ago cross two cells, and bring what arrives; return True if the load jumps to it.

    Until a driver is heard the load of the first round trip is that of the start, which is known without rounding.
    """
    load, slope = run.load[0], run.load[1]
    if run.counts.trip == 0:
        for cell in range(run.counts.cells):
            one, wave = run.ladder_cells[cell], wave_in(run, AIR, cell)
            fill(wave, 0.0)
            wave[0] = one.wave + one.growth * run.state.phase_from
            wave[1] = one.growth * run.state.speed
    else:
        source = run.counts.echo_of
        gather(run, source)
        leaped = run.counts.trip - run.history[source].trip - 1
        if leaped > 0:
            ramp = ramp_at_rest(run, run.counts.trip_segment)
            for cell in range(run.counts.cells):
                wave_in(run, AIR, cell)[0] += run.ladder_cells[cell].ramp_share * leaped * ramp
    for side in range(2):
        first, past = side_of(run, side)
        meet(run, first, past, 0)
        meet(run, first, past, 1)
    arrive_at_contact(run)
    if run.counts.trip == 0 and math.isfinite(load):
        fill(run.load, 0.0)
        run.load[0], run.load[1] = load, slope
        if run.counts.first_side == run.counts.cells:
            copy(run.load, wave_in(run, AIR, 0), TERMS)
    return jumps_here(run)


@kernel
def meet(run: Run, first: int, past: int, parity: int) -> None:
    """Let the waves of a side, from cell `first` on, meet at its odd places (parity 0) or at its even ones (parity 1)."""
    for cell in range(first + parity, past, 2):
        away, share = wave_in(run, AIR, cell), run.ladder_cells[cell].reflection
        beyond = run.ladder_cells[cell].reflection_beyond
        if run.ladder_cells[cell].is_last == 1.0:
            meet_driver(run, cell)
            continue
        back = wave_in(run, AIR, cell + 1)
        for k in range(TERMS):
            away[k], back[k] = cross(share, beyond, away[k], back[k])


@kernel
def meet_driver(run: Run, cell: int) -> None:
    """Let the wave in the last cell meet the driver, which at first keeps the initial state as it is.

    The driver of the first side may change (`far_end`).
    """
    wave, one = wave_in(run, AIR, cell), run.ladder_cells[cell]
    begins = run.counts.trip == 0 and run.state.phase_from < run.params.inflow_from
    share = RIGID if begins else run.params.reflection if cell < run.counts.first_side else one.reflection
    for k in range(TERMS):
        wave[k] *= share
    if begins:
        wave[0] += one.inflow_before
        return
    wave[0] += one.inflow + one.inflow_rate * (run.counts.trip * run.params.round_trip_time + run.state.phase_from)
    wave[1] += one.inflow_rate * run.state.speed
    wave[2] += one.inflow_rate * run.state.bend


@kernel
def send_in(run: Run) -> None:
    """Put an inflow among the waves, which stands in place of the load, as far as they have already crossed the cells."""
    sent = run.trial
    copy(run.load, sent, TERMS)
    for side in range(2):
        first, past = side_of(run, side)
        if past > first:
            put_in(run, first, past - 1, sent)
    arrive_at_contact(run)
    if shakes(run):
        shake(run)


@kernel
def put_in(run: Run, first: int, last: int, sent: Floats) -> None:
    """Add an inflow to the waves of the side whose cells are `first` to `last`."""
    weight = run.ladder_cells[last].pulled
    one = wave_in(run, AIR, last)
    if (last - first) % 2 == 1 or last == first:  # the driver is at an even place, or next to the contact
        for k in range(TERMS):
            one[k] += weight * sent[k]
        return
    share, before = run.ladder_cells[last - 1].reflection, wave_in(run, AIR, last - 1)
    for k in range(TERMS):
        before[k] += (1.0 + share) * weight * sent[k]
        one[k] -= share * weight * sent[k]


@kernel
def arrive_at_contact(run: Run) -> None:
    """Write the load that the waves bring to the contact, from one side or both."""
    first = wave_in(run, AIR, 0)
    if run.counts.first_side == run.counts.cells:
        copy(first, run.load, TERMS)
        return
    second, shares = wave_in(run, AIR, run.counts.first_side), (1.0, 1.0)
    if run.counts.joined == 0:
        impedance = run.params.impedance
        shares = (impedance / run.ladder_cells[0].impedance, impedance / run.ladder_cells[run.counts.first_side].impedance)
    for k in range(TERMS):
        run.load[k] = shares[0] * first[k] + shares[1] * second[k]


@kernel
def jumps_here(run: Run) -> bool:
    """Return True if the load at the start of the piece that has arrived is not that at the end of the last piece."""
    last = run.counts.length - 1
    if last < 0 or run.history[last].trip < run.counts.trip - 1:
        return False
    before, now = total(run.history[last].load), run.load[0]
    if shakes(run):  # the load of the last piece is without what the ground needs
        follow_ground(run, run.state.phase_from, 0.0, 0.0)
        now -= run.params.impedance * run.ground_rate[0] + run.ground_push[0]
    return abs(now - before) > JUMP * max(abs(now), abs(before), abs(run.params.reference))


# ---- what leaves ------------------------------------------------------------------------------------------------------------


@kernel
def keep_waves(run: Run, xi_to: float) -> None:
    """Keep the waves from the present place up to `xi_to` with the piece of the history that is being written."""
    n = run.counts.length
    row, xi, piece = row_of(run, n), run.state.xi, run.history[n]
    for slot in range(run.counts.slots):
        restrict(wave_in(run, AIR, slot), xi, xi_to - xi, wave_in(run, row, slot))
    if run.counts.driven == 1:
        keep_machine(run, wave_in(run, row, run.counts.cells))
    load, rate, impedance = piece.load, piece.rate, run.params.impedance
    moved = shakes(run)
    if moved:
        follow_ground(run, piece.phase_from, piece.speed, piece.bend)
    for side in range(2):
        first, past = side_of(run, side)
        if past == first:
            continue
        wave = wave_in(run, row, first)
        if run.counts.joined == 1:
            own = 2.0 * run.ladder_cells[first].impedance
            for k in range(TERMS):
                wave[k] = own * rate[k] - wave[k]
            if moved:
                for k in range(TERMS):
                    wave[k] += own * run.ground_rate[k]
        else:
            for k in range(TERMS):
                wave[k] -= 2.0 * (load[k] - impedance * rate[k])
            if moved:
                for k in range(TERMS):
                    wave[k] -= 2.0 * run.ground_push[k]


@kernel
def keep_machine(run: Run, rate: Floats) -> None:
    """Keep the rate of a machine with the piece of the history that is being written, behind the states of the law."""
    row = (run.counts.states + 1) * run.counts.length + run.counts.states
    copy(rate, ahead(run.history_state, TERMS * row), TERMS)


# ---- rest -------------------------------------------------------------------------------------------------------------------


@kernel
def ramp_at_rest(run: Run, segment: int) -> float:
    """Return the growth (Pa) of the load at rest in one round trip, under the loading of a segment."""
    return ramp_of_machine(run, segment) if run.counts.driven == 1 else run.params.ramp


@kernel
def is_settled(run: Run) -> bool:
    """Return True if all waves of the round trip at rest just past are those of the one before it, but for the ramp."""
    if run.counts.trips_at_rest < 2:
        return False
    least, most = span_of_load(run)
    largest, ramp = max(abs(run.params.reference), most, -least), ramp_at_rest(run, run.counts.segment)
    for n in range(run.counts.trip_from, run.counts.length):
        source = run.history[n].echo_of
        if source < run.counts.previous_from or run.history[source].phase_from != run.history[n].phase_from:
            return False
        if run.history[source].phase_to != run.history[n].phase_to or run.history[source].trip != run.counts.trip - 1:
            return False
        for cell in range(run.counts.cells):
            before, now = wave_in(run, row_of(run, source), cell), wave_in(run, row_of(run, n), cell)
            change = abs(now[0] - before[0] - run.ladder_cells[cell].ramp_share * ramp)
            for k in range(1, TERMS):
                change += abs(now[k] - before[k])
            if change > STILL_WAVES * largest:
                return False
    return True


@entry
def ladder(memory: int, task: int, number: float) -> float:
    """Serve a body of layers: see `Task`."""
    return serve(borrow(memory), task, number)
