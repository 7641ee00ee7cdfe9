"""Handle knots of a law in slip rate: find the piece of a rate, and the place where a step passes from one piece to the next."""

from __future__ import annotations

from stickslip.engine.contact.contact_equation import (
    NEAR_KNOT,
    first_piece,
    friction_of,
    is_knot,
    last_piece,
    piece_at,
)
from stickslip.engine.series.polynomial import NONE, first_descent
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel


@kernel
def settle_piece(run: Run, rate: float) -> None:
    """Set the piece of the law that holds at the slip rate (m/s, magnitude).

    At a knot the present piece is kept, because the contact has reached the knot along it. If a branch of an algebraic contact
    starts or ends at the knot, the piece with rising g is taken.
    """
    piece = run.counts.piece
    below = piece > first_piece(run) and rate < run.law[piece - 1].knot * (1.0 - NEAR_KNOT)
    if below or rate > run.law[piece].knot * (1.0 + NEAR_KNOT):
        piece = piece_at(run, rate)
    if run.counts.is_algebraic == 1 and is_knot(run, rate):
        friction_of(run, piece, run.state.law_slip, rate)
        if run.params.damping + run.friction.by_rate <= 0.0:
            piece += 1 if abs(run.law[piece].knot - rate) <= NEAR_KNOT * rate else -1
    run.counts.piece = piece


@kernel
def is_end_of_branch(run: Run, rate: float) -> bool:
    """Return True if a branch that does not move with slip ends at this knot (m/s): its end is found from the load instead."""
    if run.counts.is_algebraic == 0 or run.counts.folds_move == 1:
        return False
    branch, room = run.counts.branch, NEAR_KNOT * rate
    return abs(run.branch_table[branch].rate_to - rate) <= room or abs(run.branch_table[branch].rate_from - rate) <= room


@kernel
def rate_knot_crossing(run: Run, rate: Floats) -> tuple[float, int]:
    """Return where on [0, 1] the slip rate leaves the present piece of the law, and whether upwards (1) or downwards (-1).

    The place is NONE if the rate stays in the piece.
    """
    first, turn, part = NONE, 1, run.trial
    for way in (1, -1):
        knot = run.counts.piece if way == 1 else run.counts.piece - 1
        if knot < first_piece(run) or knot >= last_piece(run) or is_end_of_branch(run, run.law[knot].knot):
            continue
        for k in range(at.TERMS):
            part[k] = -way * rate[k]
        room = way * (run.law[knot].knot - rate[0])
        part[0] = 0.0 if abs(room) <= NEAR_KNOT * run.law[knot].knot else room
        crossing = first_descent(part, run.spare)
        if crossing < first:
            first, turn = crossing, way
    return first, turn


@kernel
def pass_rate_knot(run: Run, turn: int) -> bool:
    """Put the slip rate at the knot and enter the next piece of the law, upwards (turn is 1) or downwards (-1).

    Return False if folds move and the resistance g falls in that piece: then the branch ends at the knot.
    """
    piece = run.counts.piece
    knot = run.law[piece].knot if turn > 0 else run.law[piece - 1].knot
    run.state.rate_now = run.counts.mode * knot
    if run.counts.folds_move == 1:
        friction_of(run, piece + turn, run.state.law_slip, knot)
        if run.params.damping + run.friction.by_rate <= 0.0:
            return False
    run.counts.piece = piece + turn
    return True
