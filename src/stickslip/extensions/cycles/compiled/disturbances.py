"""The linear equation of disturbances along a run, by Radau's method on parts of its pieces, with factors at events.

On a part the unknowns are slip rate and states at Radau's points. Load and lag follow from the slip rate: they are eliminated, so
that the equations are fewer by a third or a half.
"""

from __future__ import annotations

from typing import NamedTuple

from stickslip.extensions.cycles.compiled.along_run import (
    BY_RATE,
    BY_STATE,
    CHANGE_BY_RATE,
    CHANGE_BY_STATE,
    LOAD_ROW,
    MOST_DISTURBED,
    MOST_OF_FORMULA,
    RATE_ROW,
    ROOM_OF_ANSWER,
    RunNumbers,
    count_of,
    look,
    pieces_of,
    sign_of_state,
    stiffness_in,
)
from stickslip.extensions.cycles.compiled.events import pass_event
from stickslip.extensions.cycles.compiled.radau import COEFFICIENTS, COMPARED, MOST_STAGES, RADAU_PLACES, STAGES, USED
from stickslip.foundation.arrays import Floats, Floats2
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, room_for

TOLERANCE, MOST_PARTS = 1e-11, 64
"""Pieces are divided until two methods differ by less than this share (1) of the largest so far, into no more parts than this."""
ROOM_OF_MATRIX = MOST_DISTURBED * MOST_DISTURBED
"""Room for a disturbance of load, slip rate, two states and lag for each of these (numbers)."""
ROOM_OF_SLOPES = 3 * 3 * MOST_STAGES
"""Room for the derivatives of slip rate and states by these at the points (numbers)."""
ROOM_OF_EQUATIONS = 3 * MOST_STAGES * (3 * MOST_STAGES + MOST_DISTURBED)
"""Room for the equations of a part, with a right-hand side for each disturbance at its start (numbers)."""


class PartOfPiece(NamedTuple):
    """A part of a piece."""

    piece: int
    begin: float
    """Where in the piece it begins (1)."""
    length: float
    """Its length (1)."""


@kernel
def write_slopes(run: RunNumbers, part: PartOfPiece, method: int, pace: Floats, slopes: Floats) -> None:
    """Write d time/d place (s) at the points of a part, and the derivatives of slip rate and states by these, times that.

    The rows and columns of slip rate and states have MOST_STAGES numbers each.
    """
    one, answer, stages = pieces_of(run.pieces)[part.piece], room_for(ROOM_OF_ANSWER), STAGES[method]
    many, mode = len(run.reverses), one.mode
    width = 1 + many
    for i in range(stages):
        place = part.begin + part.length * RADAU_PLACES[method, i]
        pace[i] = part.length * (one.speed + 2.0 * one.bend * place)
        look(run, part.piece, place, answer)
        by_force = pace[i] / run.inertia if mode != 0 else 0.0
        slopes[i] = -by_force * (run.damping + run.normal * answer[BY_RATE])
        for n in range(many):
            sign = sign_of_state(run, n, mode)
            slopes[(1 + n) * MOST_STAGES + i] = -by_force * mode * sign * run.normal * answer[BY_STATE + n]
            row = ahead(slopes, (1 + n) * width * MOST_STAGES)
            row[i] = pace[i] * sign * mode * answer[CHANGE_BY_RATE + n]
            for other in range(many):
                turned = sign * sign_of_state(run, other, mode)
                row[(1 + other) * MOST_STAGES + i] = pace[i] * turned * answer[CHANGE_BY_STATE + MOST_OF_FORMULA * n + other]


@kernel
def assemble(run: RunNumbers, part: PartOfPiece, method: int, before: Floats, equations: Floats) -> None:
    """Write the equations of slip rate and states at the points of a part, for each disturbance in `before`, a matrix."""
    pace, slopes = room_for(MOST_STAGES), room_for(ROOM_OF_SLOPES)
    write_slopes(run, part, method, pace, slopes)
    many, stages, moving = len(run.reverses), STAGES[method], pieces_of(run.pieces)[part.piece].mode != 0
    count, size = count_of(run), (1 + many) * stages
    width, spring = size + count, stiffness_in(run, part.piece) / run.inertia
    for i in range(stages):
        for r in range(1 + many):
            row = ahead(equations, (r * stages + i) * width)
            for c in range(1 + many):
                of = ahead(slopes, (r * (1 + many) + c) * MOST_STAGES)
                for j in range(stages):
                    row[c * stages + j] = -COEFFICIENTS[method, i, j] * of[j]
            row[r * stages + i] += 1.0
            for c in range(count):
                row[size + c] = before[(RATE_ROW + r) * count + c]
        if moving:
            row, passed = ahead(equations, i * width), 0.0
            for j in range(stages):
                share = COEFFICIENTS[method, i, j] * pace[j]
                passed += share
                for k in range(stages):
                    row[k] += spring * share * COEFFICIENTS[method, j, k] * pace[k]
            for c in range(count):
                row[size + c] += passed / run.inertia * before[LOAD_ROW * count + c]
    if moving and run.winding != 0.0:
        wind_up(run, method, pace, before, equations)


@kernel
def wind_up(run: RunNumbers, method: int, pace: Floats, before: Floats, equations: Floats) -> None:
    """Add what the integral of the lag does to the slip rate to the equations of a part; `pace` is d time/d place (s) there."""
    stages, count, twice = STAGES[method], count_of(run), room_for(MOST_STAGES)
    width, gain = (1 + len(run.reverses)) * stages + count, run.winding / run.inertia
    for i in range(stages):
        row, passed = ahead(equations, i * width), 0.0
        for j in range(stages):
            twice[j] = 0.0
            for k in range(stages):
                twice[j] += COEFFICIENTS[method, i, k] * pace[k] * COEFFICIENTS[method, k, j] * pace[j]
            passed += twice[j]
        for j in range(stages):
            for k in range(stages):
                row[k] += gain * twice[j] * COEFFICIENTS[method, j, k] * pace[k]
        for c in range(count):
            row[width - count + c] += gain * passed * before[(count - 1) * count + c]


@kernel
def eliminate(equations: Floats, size: int, width: int) -> None:
    """Solve linear equations for all their right-hand sides, which the solutions replace."""
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(equations[width * i + k]) > abs(equations[width * pivot + k]):
                pivot = i
        top, low = ahead(equations, width * k), ahead(equations, width * pivot)
        if pivot != k:
            for j in range(k, width):
                top[j], low[j] = low[j], top[j]
        for i in range(k + 1, size):
            row = ahead(equations, width * i)
            if row[k] != 0.0:
                factor = row[k] / top[k]
                for j in range(k + 1, width):
                    row[j] -= factor * top[j]
    for i in range(size - 1, -1, -1):
        row = ahead(equations, width * i)
        for j in range(i + 1, size):
            factor, known = row[j], ahead(equations, width * j)
            for c in range(size, width):
                row[c] -= factor * known[c]
        for c in range(size, width):
            row[c] /= row[i]


@kernel
def pass_part(run: RunNumbers, part: PartOfPiece, method: int, before: Floats, after: Floats) -> None:
    """Write what disturbances at the start of a part have become at its end."""
    equations, one = room_for(ROOM_OF_EQUATIONS), pieces_of(run.pieces)[part.piece]
    assemble(run, part, method, before, equations)
    many, stages = len(run.reverses), STAGES[method]
    count, size = count_of(run), (1 + many) * stages
    width = size + count
    eliminate(equations, size, width)
    for c in range(count):
        after[c] = before[c]
        for r in range(1 + many):
            after[(RATE_ROW + r) * count + c] = equations[((r + 1) * stages - 1) * width + size + c]
    if one.mode != 0:
        stiffness = stiffness_in(run, part.piece)
        for k in range(stages):
            place = part.begin + part.length * RADAU_PLACES[method, k]
            pace = part.length * (one.speed + 2.0 * one.bend * place)
            factor = stiffness * COEFFICIENTS[method, stages - 1, k] * pace
            for c in range(count):
                after[c] -= factor * equations[k * width + size + c]
    if len(run.lags) > 0:
        pass_lag(run, part, method, (before, equations), after)


@kernel
def pass_lag(run: RunNumbers, part: PartOfPiece, method: int, known: tuple[Floats, Floats], after: Floats) -> None:
    """Write what disturbances of the lag have become at the end of a part, and add what its integral does to the load.

    `known` has the disturbances before the part, and the solved equations.
    """
    before, equations = known
    one, stages, count = pieces_of(run.pieces)[part.piece], STAGES[method], count_of(run)
    width, last = (1 + len(run.reverses)) * stages + count, count - 1
    for c in range(count):
        for j in range(stages):
            lag = before[last * count + c]
            for k in range(stages):
                place = part.begin + part.length * RADAU_PLACES[method, k]
                pace = part.length * (one.speed + 2.0 * one.bend * place)
                if one.mode != 0:
                    lag -= COEFFICIENTS[method, j, k] * pace * equations[k * width + width - count + c]
            place = part.begin + part.length * RADAU_PLACES[method, j]
            pace = part.length * (one.speed + 2.0 * one.bend * place)
            after[c] += run.winding * COEFFICIENTS[method, stages - 1, j] * pace * lag
            after[last * count + c] = lag


@kernel
def is_rough(used: Floats, compared: Floats, largest: Floats, size: int) -> bool:
    """Return True if two methods differ by more than is allowed; `largest` has the sizes so far."""
    rough = 0
    for n in range(size):
        if not abs(used[n] - compared[n]) <= TOLERANCE * max(largest[n], abs(used[n])):
            rough += 1
    return rough > 0


@kernel
def pass_piece(run: RunNumbers, span: tuple[int, float], exactly: bool, now: Floats, largest: Floats) -> None:
    """Carry disturbances over a piece, up to a place (1) in it, in parts where one is not exact enough."""
    used, compared = room_for(ROOM_OF_MATRIX), room_for(ROOM_OF_MATRIX)
    piece, whole = span
    size = count_of(run) ** 2
    begin, length = 0.0, 1.0  # shares of the piece; powers of 2 are exact
    for _ in range(4 * MOST_PARTS):
        part = PartOfPiece(piece, whole * begin, whole * length)
        pass_part(run, part, USED, now, used)
        if exactly and length * MOST_PARTS > 1.0:
            pass_part(run, part, COMPARED, now, compared)
            if is_rough(used, compared, largest, size):
                length *= 0.5
                continue
        for n in range(size):
            now[n] = used[n]
            largest[n] = max(largest[n], abs(now[n]))
        begin += length
        if begin == 1.0:
            return
        if begin % (2.0 * length) == 0.0:
            length *= 2.0


@entry
def grow(run: RunNumbers, last: int, place: float, exactly: bool, found: Floats2) -> None:
    """Write by what matrix a disturbance at the start of a run is multiplied up to a place (1) in a piece, the last."""
    now, largest, count = room_for(ROOM_OF_MATRIX), room_for(ROOM_OF_MATRIX), len(found)
    for i in range(count):
        for j in range(count):
            now[i * count + j] = 1.0 if i == j else 0.0
            largest[i * count + j] = 0.0
    for piece in range(last + 1):
        if piece > 0:
            pass_event(run, piece, now)
        pass_piece(run, (piece, place if piece == last else 1.0), exactly, now, largest)
    for i in range(count):
        for j in range(count):
            found[i, j] = now[i * count + j]
