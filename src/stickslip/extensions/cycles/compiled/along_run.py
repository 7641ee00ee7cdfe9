"""Numbers of a run for compiled code, what its law says at a place in it, and how fast load, rate, states and lag change there.

The lag is how far slip is behind the end of the spring, or behind the reference of a position loop. It matters to a loop whose
integral winds up, at hard stops, and in a play. Elsewhere load, slip rate and states are all that there is.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from stickslip.engine import TERMS, HistoryPiece
from stickslip.foundation.arrays import Floats, Floats1, Floats3, Integers1, Integers2
from stickslip.foundation.kernels.kernels import entry, inlined, kernel
from stickslip.foundation.kernels.memory.addresses import call_state_value, call_value, floats, room_for
from stickslip.foundation.kernels.memory.pointers import record_at

LOAD_ROW, RATE_ROW, FIRST_STATE_ROW = range(3)
"""Places of load, slip rate and the first state in a disturbance; the lag, if there is one, is behind the last state."""
MOST_OF_FORMULA = 4
"""Number of states for which a formula's answer has room (1)."""
MOST_DISTURBED = 5
"""Load, slip rate, two states and the lag (1)."""
BY_RATE, BY_STATE, CHANGE_OF_STATE, CHANGE_BY_RATE = 1, 3, 3 + MOST_OF_FORMULA, 3 + 2 * MOST_OF_FORMULA
"""Places in a formula's answer: derivatives of mu by slip rate and states, the states' rates of change, and those by slip rate."""
CHANGE_BY_STATE = 3 + 4 * MOST_OF_FORMULA
"""Place in a formula's answer of the derivatives of the states' rates of change by the states, in a row for each."""
ROOM_OF_ANSWER = 48
"""Room for the answer of a formula (numbers)."""
pieces_of: Any = record_at(HistoryPiece)
"""Function for compiled code that returns the first piece of a history's table."""


class RunNumbers(NamedTuple):
    """A run of a rigid body under a steady pull."""

    pieces: Integers2
    """The table of the history's pieces."""
    states: Floats3
    """The series of the states in each piece; no rows for a law without states."""
    stiffness: float
    """Of the spring, N/m."""
    damping: float
    """Of ground and driver together, N s/m."""
    inertia: float
    """Mass, kg."""
    normal: float
    """Normal load, N."""
    pull: float
    """Pull rate, m/s."""
    calls: Integers1
    """Addresses of the formula of each piece of the law: of its value, or with states of `state_value`."""
    constants: Integers1
    """Addresses of their constants."""
    reverses: Floats1
    """For each state 1 if it changes its sign where slip turns back, else 0."""
    sticks: int
    """1 if the contact rests below a static strength."""
    has_knots: int
    """1 if the formula changes at slip rates."""
    lags: Floats1
    """How far (m) slip is behind the end of the spring, or the reference, where each piece begins; none if that does not matter."""
    winding: float
    """Integral gain of a position loop, N/(m s)."""
    play: float
    """Half the play beside the spring, m."""
    stop_ahead: float
    """Slip (m) where a hard stop bars the way forwards; inf without one."""
    stop_behind: float
    """Slip (m) where another bars the way backwards; -inf without one."""
    restitution: float
    """Share of the slip rate (1) with which the body bounces off a stop."""


@inlined
def value_and_slope(series: Floats, place: float) -> tuple[float, float]:
    """Return a polynomial and its derivative at a place (1), by Horner's rule."""
    value, slope = 0.0, 0.0
    for k in range(TERMS - 1, -1, -1):
        slope = slope * place + value
        value = value * place + series[k]
    return value, slope


@inlined
def sign_of_state(run: RunNumbers, n: int, direction: int) -> float:
    """Return -1 for a state that the formulas see with another sign in this direction."""
    return -1.0 if direction < 0 and run.reverses[n] != 0.0 else 1.0


@inlined
def count_of(run: RunNumbers) -> int:
    """Return the number of load, slip rate, states and lag."""
    return FIRST_STATE_ROW + len(run.reverses) + (1 if len(run.lags) > 0 else 0)


@kernel
def lag_at(run: RunNumbers, piece: int, place: float) -> float:
    """Return the lag (m) at a place (1) in a piece."""
    one, way = pieces_of(run.pieces)[piece], 0.0
    for k in range(TERMS - 1, -1, -1):
        way = way * place + one.rate[k] / (k + 1)
    lag: float = run.lags[piece] + one.speed * place * (run.pull - way)
    return lag


@kernel
def stiffness_in(run: RunNumbers, piece: int) -> float:
    """Return the stiffness (N/m) that a piece feels: 0 in a play."""
    return 0.0 if run.play > 0.0 and abs(lag_at(run, piece, 0.5)) < run.play else run.stiffness


@kernel
def look(run: RunNumbers, piece: int, place: float, answer: Floats) -> float:
    """Write what the law says at a place (1) in a piece; return the slip rate (m/s) there."""
    one = pieces_of(run.pieces)[piece]
    rate = value_and_slope(one.rate, place)[0]
    look_at_rate(run, (piece, one.law_piece, one.mode), place, abs(rate), answer)
    return rate


@kernel
def look_at_rate(run: RunNumbers, where: tuple[int, int, int], place: float, rate: float, answer: Floats) -> None:
    """Write what the law says at a slip rate (m/s) and at the states at a place (1) in a piece.

    `where` has the piece, the piece of the law, and the direction of slip.
    """
    piece, law, direction = where
    if len(run.reverses) == 0:
        call_value(run.calls[law], floats(run.constants[law]), 0.0, rate, answer)
        return
    states = room_for(MOST_OF_FORMULA)
    for n in range(len(run.reverses)):
        states[n] = sign_of_state(run, n, direction) * value_and_slope(run.states[piece, n], place)[0]
    call_state_value(run.calls[law], floats(run.constants[law]), 0.0, rate, states, answer)


@kernel
def write_pace(run: RunNumbers, piece: int, place: float, pace: Floats) -> None:
    """Write dy/dt at a place (1) in a piece.

    That of the slip rate is the derivative of its polynomial: a difference of load and friction loses digits in slow slip.
    """
    one, answer = pieces_of(run.pieces)[piece], room_for(ROOM_OF_ANSWER)
    rate, grows = look(run, piece, place, answer), 0.0
    if one.mode != 0:
        grows = value_and_slope(one.rate, place)[1] / (one.speed + 2.0 * one.bend * place)
    pace[LOAD_ROW], pace[RATE_ROW] = run.stiffness * (run.pull - rate), grows
    for n in range(len(run.reverses)):
        pace[FIRST_STATE_ROW + n] = sign_of_state(run, n, one.mode) * answer[CHANGE_OF_STATE + n]
    if len(run.lags) > 0:
        pace[LOAD_ROW] = stiffness_in(run, piece) * (run.pull - rate) + run.winding * lag_at(run, piece, place)
        pace[count_of(run) - 1] = run.pull - rate


@entry
def pace_in_piece(run: RunNumbers, piece: int, place: float, pace: Floats1) -> None:
    """Write dy/dt at a place (1) in a piece, for Python."""
    found = room_for(MOST_DISTURBED)
    write_pace(run, piece, place, found)
    for n in range(len(pace)):
        pace[n] = found[n]
