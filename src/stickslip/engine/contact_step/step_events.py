"""Find the event that ends a step of slip early, an arrest or a knot of the law, and carry it out."""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.engine.contact.contact_equation import TIE, first_piece, last_piece
from stickslip.engine.contact.law_knots import pass_rate_knot, rate_knot_crossing
from stickslip.engine.contact_step.hard_stop import meet_stop, way_to_stop
from stickslip.engine.contact_step.stick_or_slip import come_to_rest
from stickslip.engine.folds.fold import reach_end
from stickslip.engine.series.polynomial import NONE, first_descent, integral, magnitude, multiply, powers_of
from stickslip.engine.state.layout import Floats, StepEvent, Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.addresses import call_part


class Cut(NamedTuple):
    """Say where a step is cut, and by what."""

    event: int  # as a code of `StepEvent`
    turn: int  # direction of passing a knot: 1 upwards, -1 downwards, 0 without a knot
    end: float  # share of the step up to the event, 1 without one


@inlined
def stretch(run: Run, length: float, rate: Floats) -> None:
    """Write the slip rate's magnitude over a step of the given length (in units) into `rate`, as a polynomial on [0, 1]."""
    powers_of(length, run.powers)
    multiply(run.jet, run.powers, rate)


@inlined
def growth(run: Run, rate: Floats, length: float, end: float) -> float:
    """Return the slip (m, unsigned) in a step of the given length (in units) up to the place `end` on [0, 1].

    It is the integral of the rate over dphase = (A + B eta) d eta.
    """
    straight = run.k.speed * length * integral(rate, end, 1)
    if run.k.bend == 0.0:
        return straight
    return straight + run.k.bend * length * length * integral(rate, end, 2)


@kernel
def knot_crossing(run: Run, rate: Floats, length: float, end: float) -> float:
    """Return where on [0, end] slip reaches the next knot of the law, or NONE if it does not.

    The rate does not change its sign before `end`, so slip is monotone and bisection finds the place.
    """
    grown = run.k.chi * growth(run, rate, length, end)
    next_knot = run.counts.piece if grown > 0.0 else run.counts.piece - 1
    if next_knot < first_piece(run) or next_knot >= last_piece(run):
        return NONE
    return place_of_slip(run, rate, length, end, abs(run.law[next_knot].knot - run.state.law_slip))


@kernel
def place_of_slip(run: Run, rate: Floats, length: float, end: float, distance: float) -> float:
    """Return where on [0, end] slip in the step reaches a distance (m), or NONE if it does not."""
    if distance >= abs(growth(run, rate, length, end)):
        return NONE
    low, high = 0.0, end
    for _ in range(60):
        middle = 0.5 * (low + high)
        if abs(growth(run, rate, length, middle)) < distance:
            low = middle
        else:
            high = middle
    return high


@kernel
def next_knot(run: Run, rate: Floats, length: float, end: float) -> tuple[float, int]:
    """Return where on [0, end] the step leaves the present piece of the law, and whether upwards (1) or downwards (-1).

    The place is NONE if the step stays in the piece.
    """
    if run.counts.knots_in_rate == 1:
        return rate_knot_crossing(run, rate)
    return knot_crossing(run, rate, length, end), 1 if run.k.chi > 0.0 else -1


@kernel
def pass_knot(run: Run, turn: int) -> None:
    """Enter the next piece of the law, upwards (turn is 1) or downwards (-1), or end the branch where g falls in that piece."""
    if run.counts.knots_in_rate == 0:
        run.counts.piece += turn
    elif not pass_rate_knot(run, turn):
        reach_end(run)


@kernel
def cut_at_first_event(run: Run, rate: Floats, length: float) -> Cut:
    """Find the first event in a step of the given length (in units), and cut its slip rate, a polynomial on [0, 1], there."""
    arrest = NONE
    if (run.counts.is_algebraic == 0 or run.counts.folds_move == 1) and rate[0] <= magnitude(rate):
        arrest = first_descent(rate, run.spare)
    knot, turn = next_knot(run, rate, length, min(arrest, 1.0)) if run.pieces > 1 else (NONE, 0)
    way = way_to_stop(run)
    stop = place_of_slip(run, rate, length, min(arrest, 1.0), way) if way < math.inf else NONE
    edge = call_part(run.play, run, Task.EDGE_IN_SLIP, length) if run.params.play > 0.0 else NONE
    end = min(arrest, knot, stop, edge)
    if end > 1.0 - TIE:
        return Cut(StepEvent.NONE, 0, 1.0)
    if end < 1.0:
        stretch(run, length * end, rate)
    other = StepEvent.STOP if stop == end else StepEvent.EDGE
    return Cut(StepEvent.ARREST if arrest == end else StepEvent.KNOT if knot == end else other, turn, end)


@kernel
def resolve(run: Run, cut: Cut) -> None:
    """Carry out the event that has cut a step: come to rest, pass a knot of the law, meet a stop, or an edge of the play."""
    if cut.event == StepEvent.ARREST:
        come_to_rest(run)
    elif cut.event == StepEvent.KNOT:
        pass_knot(run, cut.turn)
    elif cut.event == StepEvent.STOP:
        meet_stop(run)
    elif cut.event == StepEvent.EDGE:
        call_part(run.play, run, Task.CHANGE_SIDE, 0.0)
