"""Events of a run of a uniform body with waves: what they multiply disturbances by, and by how much they move."""

from __future__ import annotations

from stickslip.extensions.cycles.compiled.along_run import (
    BY_STATE,
    FIRST_STATE_ROW,
    LOAD_ROW,
    MOST_OF_FORMULA,
    RATE_ROW,
    ROOM_OF_ANSWER,
    look_at_rate,
    pieces_of,
    value_and_slope,
    write_pace,
)
from stickslip.extensions.cycles.compiled.echo_parts import (
    SAME_MOMENT,
    WAVE_POINTS,
    PartsOfRun,
    WavesOfRun,
    add_row,
    echo_behind,
    set_row,
    write_interpolation,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import room_for

NO_EVENT, RELEASE, AT_RATE = range(3)
"""What happens between two pieces: nothing, an onset of slip after a rest, or an event at a slip rate, such as an arrest."""


@kernel
def event_before(waves: WavesOfRun, piece: int) -> int:
    """Return what happens where a piece begins."""
    run = waves.run
    one, past = pieces_of(run.pieces)[piece], pieces_of(run.pieces)[piece - 1]
    if piece == waves.first or follows_rest(waves, piece):
        return RELEASE if one.mode != 0 and (piece > waves.first or waves.at_onset == 1) else NO_EVENT
    if one.mode == past.mode and (one.mode == 0 or run.has_knots == 0 or one.law_piece == past.law_piece):
        return NO_EVENT
    if one.mode == -past.mode and run.sticks == 0:  # friction passes smoothly through rest
        return NO_EVENT
    return RELEASE if past.mode == 0 else AT_RATE


@kernel
def follows_rest(waves: WavesOfRun, piece: int) -> bool:
    """Return True if there is a rest that was not recorded before a piece."""
    gap: float = waves.starts[piece] - waves.starts[piece - 1] - waves.lasts[piece - 1]
    return gap > SAME_MOMENT * waves.trip


@kernel
def write_side(waves: WavesOfRun, piece: int, place: float, pace: Floats) -> None:
    """Write how fast load, slip rate and states change at a place (1) in a piece."""
    write_pace(waves.run, piece, place, pace)
    pace[LOAD_ROW] = value_and_slope(pieces_of(waves.run.pieces)[piece].load, place)[1] / waves.lasts[piece]


@kernel
def write_sides(waves: WavesOfRun, piece: int, low: Floats, high: Floats) -> None:
    """Write these paces before and after the moment when a piece begins."""
    write_side(waves, piece, 0.0, high)
    if piece > waves.first and not follows_rest(waves, piece):
        write_side(waves, piece - 1, 1.0, low)
        return
    for n in range(FIRST_STATE_ROW + len(waves.run.reverses)):
        low[n] = 0.0 if n == RATE_ROW else high[n]  # a rest was before


@kernel
def write_moved(waves: WavesOfRun, parts: PartsOfRun, count: int, piece: int, event: int) -> None:
    """Write by how much an event where a piece begins comes earlier. `low` of `write_sides` is how fast its condition is met."""
    run, low, high = waves.run, room_for(MOST_OF_FORMULA), room_for(MOST_OF_FORMULA)
    write_sides(waves, piece, low, high)
    if event == AT_RATE:
        set_row(parts.moved, 1.0 / low[RATE_ROW], parts.now[RATE_ROW])
        return
    one, answer, weights = pieces_of(run.pieces)[piece], room_for(ROOM_OF_ANSWER), room_for(WAVE_POINTS)
    look_at_rate(run, (piece, one.law_piece, one.mode), 0.0, 0.0, answer)
    meets = low[LOAD_ROW]
    for n in range(len(run.reverses)):
        meets -= one.mode * run.normal * answer[BY_STATE + n] * low[FIRST_STATE_ROW + n]
    echo = echo_behind(waves, parts.ends, count, waves.starts[piece], waves.trip)
    begin = parts.ends[echo.part, 0]
    write_interpolation((waves.starts[piece] - echo.delay - begin) / (parts.ends[echo.part, 1] - begin), weights)
    set_row(parts.moved, waves.back * echo.share * weights[0] / meets, parts.waves[echo.part * WAVE_POINTS])
    for k in range(1, WAVE_POINTS):
        add_row(parts.moved, waves.back * echo.share * weights[k] / meets, parts.waves[echo.part * WAVE_POINTS + k])
    for n in range(len(run.reverses)):
        add_row(parts.moved, -one.mode * run.normal * answer[BY_STATE + n] / meets, parts.now[FIRST_STATE_ROW + n])


@kernel
def pass_wave_event(waves: WavesOfRun, parts: PartsOfRun, count: int, piece: int) -> None:
    """Multiply disturbances by the factor at the event where a piece begins, if there is one."""
    event = event_before(waves, piece)
    if event == NO_EVENT:
        return
    low, high = room_for(MOST_OF_FORMULA), room_for(MOST_OF_FORMULA)
    write_moved(waves, parts, count, piece, event)
    write_sides(waves, piece, low, high)
    if event == RELEASE:
        set_row(parts.now[RATE_ROW], 0.0, parts.now[RATE_ROW])
    for n in range(RATE_ROW, FIRST_STATE_ROW + len(waves.run.reverses)):
        add_row(parts.now[n], high[n] - low[n], parts.moved)
