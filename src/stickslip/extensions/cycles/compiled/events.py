"""What events of a run do to disturbances of it: rest begins and ends, the formula changes, a stop or an edge of a play is met.

An impact multiplies the slip rate by -r. Its factor is g + (f+ - g f-) n / (n f-) with g = diag(1, -r, 1 ...), and n is the row of
the lag, because a stop stands still. At a graze n f- is 0, and the factor is infinite (Nordmark 1991, J. Sound Vib. 145, 279).

Source: di Bernardo et al. 2008, Piecewise-smooth Dynamical Systems, section 2.5.
"""

from __future__ import annotations

from stickslip.extensions.cycles.compiled.along_run import (
    BY_STATE,
    FIRST_STATE_ROW,
    LOAD_ROW,
    MOST_DISTURBED,
    RATE_ROW,
    ROOM_OF_ANSWER,
    RunNumbers,
    count_of,
    look_at_rate,
    pieces_of,
    stiffness_in,
    write_pace,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import room_for


@kernel
def meets_stop(run: RunNumbers, piece: int) -> bool:
    """Return True if the body has met a hard stop where a piece begins."""
    one, past = pieces_of(run.pieces)[piece], pieces_of(run.pieces)[piece - 1]
    return bool((past.mode > 0 and one.slip == run.stop_ahead) or (past.mode < 0 and one.slip == run.stop_behind))


@kernel
def cross(run: RunNumbers, piece: int, normal: Floats, kept: float, now: Floats) -> None:
    """Multiply disturbances by the factor at an event where `normal` times y is constant, between a piece and the one before it.

    `kept` is what the event multiplies the slip rate by.
    """
    low, high, count, meets = room_for(MOST_DISTURBED), room_for(MOST_DISTURBED), count_of(run), 0.0
    write_pace(run, piece - 1, 1.0, low)
    write_pace(run, piece, 0.0, high)
    for n in range(count):
        meets += normal[n] * low[n]
    for c in range(count):
        moved = 0.0
        for n in range(count):
            moved += normal[n] * now[n * count + c]
        moved /= meets
        for n in range(count):
            share = kept if n == RATE_ROW else 1.0
            now[n * count + c] = share * now[n * count + c] + (high[n] - share * low[n]) * moved


@kernel
def pass_event(run: RunNumbers, piece: int, now: Floats) -> None:
    """Multiply disturbances by the factor at the event between a piece and the one before it, if there is one."""
    one, past, normal = pieces_of(run.pieces)[piece], pieces_of(run.pieces)[piece - 1], room_for(MOST_DISTURBED)
    for n in range(count_of(run)):
        normal[n] = 0.0
    if len(run.lags) > 0 and (meets_stop(run, piece) or stiffness_in(run, piece) != stiffness_in(run, piece - 1)):
        normal[count_of(run) - 1] = 1.0
        bounced = -run.restitution if one.mode != 0 else 0.0
        cross(run, piece, normal, bounced if meets_stop(run, piece) else 1.0, now)
        return
    if one.mode == past.mode and (run.has_knots == 0 or one.law_piece == past.law_piece):
        return
    if one.mode == -past.mode and run.sticks == 0:  # friction passes smoothly through rest
        return
    if past.mode == 0:  # no law that rests has a state that changes its sign
        answer = room_for(ROOM_OF_ANSWER)
        look_at_rate(run, (piece - 1, one.law_piece, one.mode), 1.0, 0.0, answer)
        normal[LOAD_ROW] = 1.0
        for n in range(len(run.reverses)):
            normal[FIRST_STATE_ROW + n] = -one.mode * run.normal * answer[BY_STATE + n]
    else:
        normal[RATE_ROW] = 1.0
    cross(run, piece, normal, 1.0, now)
