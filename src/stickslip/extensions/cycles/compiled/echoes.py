"""The linear equation of disturbances of a uniform body with waves: one pass along a run carries all columns at once.

A disturbance of the load b at the contact obeys, with d = 1 in forward and -1 in backward slip and D the damping,

    m dv' = db - D dv - d S (mu_v d|v| + mu_w dw)      dw' = f_v d|v| + f_w dw

or, without a mass, the first equation with 0 on its left; at rest dv = 0. It is solved by Radau's method on parts of the pieces.
What leaves the contact is 2 Z dv - db, and comes back after a round trip times r. At an event whose condition is n y = const, with
y = (load, slip rate, states), a disturbance is multiplied by I + (f+ - f-) n / (n f-), f being dy/dt. The wave itself needs no
factor: a mass, or a law of states, makes the slip rate continuous, and then a moved event moves only a kink of the wave. At a fixed
moment beside the event that is an effect of second order. A return that comes earlier sees the wave change as fast as it does.

Source: di Bernardo et al. 2008, Piecewise-smooth Dynamical Systems, section 2.5, for the factor at events.
"""

from __future__ import annotations

from typing import NamedTuple

from stickslip.extensions.cycles.compiled.along_run import (
    BY_RATE,
    BY_STATE,
    CHANGE_BY_RATE,
    CHANGE_BY_STATE,
    FIRST_STATE_ROW,
    LOAD_ROW,
    MOST_OF_FORMULA,
    RATE_ROW,
    ROOM_OF_ANSWER,
    look,
    pieces_of,
    sign_of_state,
    value_and_slope,
)
from stickslip.extensions.cycles.compiled.disturbances import eliminate
from stickslip.extensions.cycles.compiled.echo_events import RELEASE, pass_wave_event, write_moved, write_side, write_sides
from stickslip.extensions.cycles.compiled.echo_parts import (
    LAST_TERM,
    SAME_MOMENT,
    WAVE_COEFFICIENTS,
    WAVE_PLACES,
    WAVE_POINTS,
    PartHeard,
    PartsOfRun,
    WavesOfRun,
    add_row,
    echo_behind,
    set_row,
    write_interpolation,
)
from stickslip.foundation.arrays import Floats, Floats2
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, room_for

RESOLVED_MOTION, MOST_IN_A_PIECE = 1e-9, 64
"""Parts are halved until the motion's last term on them is below this share (1) of it, into no more for each piece than this."""
ROOM_OF_PART_SLOPES = 3 * 3 * WAVE_POINTS
"""Room for the derivatives of slip rate and states by these at the points (numbers)."""
ROOM_OF_PART = 3 * WAVE_POINTS * (4 * WAVE_POINTS + 3)
"""Room for the equations of a part (numbers)."""
NO_ROOM = -1
"""The answer if there are more parts than there is room for."""


class PartInTime(NamedTuple):
    """A part of a piece of a run."""

    piece: int
    begin: float
    """When it begins, s."""
    end: float
    """When it ends, s."""


@kernel
def write_part_slopes(waves: WavesOfRun, part: PartInTime, slopes: Floats) -> None:
    """Write the derivatives of the paces of slip rate and states by these at the points of a part; rows of WAVE_POINTS numbers.

    Without a mass those of the slip rate are derivatives of the balance of forces.
    """
    run, answer = waves.run, room_for(ROOM_OF_ANSWER)
    one, many = pieces_of(run.pieces)[part.piece], len(run.reverses)
    mode, width = one.mode, 1 + len(run.reverses)
    for i in range(WAVE_POINTS):
        time = part.begin + (part.end - part.begin) * WAVE_PLACES[i]
        look(run, part.piece, (time - waves.starts[part.piece]) / waves.lasts[part.piece], answer)
        force = 0.0 if mode == 0 else 1.0 / run.inertia if run.inertia > 0.0 else 1.0
        slopes[i] = -force * (run.damping + run.normal * answer[BY_RATE])
        for n in range(many):
            sign = sign_of_state(run, n, mode)
            slopes[(1 + n) * WAVE_POINTS + i] = -force * mode * sign * run.normal * answer[BY_STATE + n]
            row = ahead(slopes, (1 + n) * width * WAVE_POINTS)
            row[i] = sign * mode * answer[CHANGE_BY_RATE + n]
            for other in range(many):
                turned = sign * sign_of_state(run, other, mode)
                row[(1 + other) * WAVE_POINTS + i] = turned * answer[CHANGE_BY_STATE + MOST_OF_FORMULA * n + other]


@kernel
def solve_part(waves: WavesOfRun, part: PartInTime, equations: Floats) -> None:
    """Solve for slip rate and states at the points of a part.

    The right-hand sides are slip rate and states at its start, and the load at each point; solutions replace them.
    """
    slopes, lasts = room_for(ROOM_OF_PART_SLOPES), part.end - part.begin
    write_part_slopes(waves, part, slopes)
    run, mode = waves.run, pieces_of(waves.run.pieces)[part.piece].mode
    unknowns, points = 1 + len(run.reverses), WAVE_POINTS
    size = unknowns * points
    width = size + unknowns + points
    for r in range(unknowns):
        algebraic = r == 0 and (mode == 0 or run.inertia == 0.0)
        for i in range(points):
            row = ahead(equations, (r * points + i) * width)
            for c in range(width):
                row[c] = 0.0
            for c in range(unknowns):
                of = ahead(slopes, (r * unknowns + c) * points)
                if algebraic:
                    row[c * points + i] = -of[i]
                else:
                    for j in range(points):
                        row[c * points + j] = -lasts * WAVE_COEFFICIENTS[i, j] * of[j]
            if not algebraic:
                row[r * points + i] += 1.0
                row[size + r] = 1.0
            elif mode == 0:
                row[i] = 1.0
            else:
                row[size + unknowns + i] = 1.0
            if r == 0 and mode != 0 and run.inertia > 0.0:
                for j in range(points):
                    row[size + unknowns + j] = lasts * WAVE_COEFFICIENTS[i, j] / run.inertia
    eliminate(equations, size, width)


@kernel
def is_rough_series(series: Floats, begin: float, length: float) -> bool:
    """Return True if the derivative of a polynomial is not followed by one with fewer terms on a part (1) of its interval."""
    last, size = 0.0, 0.0
    for i in range(WAVE_POINTS):
        value, slope = value_and_slope(series, begin + length * WAVE_PLACES[i])
        last += LAST_TERM[i] * slope * length
        size = max(size, abs(value) + abs(slope * length))
    return abs(last) > RESOLVED_MOTION * size


@kernel
def is_rough_part(waves: WavesOfRun, part: PartInTime) -> bool:
    """Return True if polynomials on a part do not follow the motion itself, whose change in time is a disturbance, too."""
    run, lasts, rough = waves.run, waves.lasts[part.piece], 0
    begin, length = (part.begin - waves.starts[part.piece]) / lasts, (part.end - part.begin) / lasts
    if is_rough_series(pieces_of(run.pieces)[part.piece].rate, begin, length):
        rough += 1
    for n in range(len(run.reverses)):
        if is_rough_series(run.states[part.piece, n], begin, length):
            rough += 1
    return rough > 0


@kernel
def write_loads(waves: WavesOfRun, parts: PartsOfRun, echo: PartHeard, part: PartInTime) -> None:
    """Write disturbances of the load at the points of a part, an echo."""
    weights, begin = room_for(WAVE_POINTS), parts.ends[echo.part, 0]
    lasted = parts.ends[echo.part, 1] - begin
    for i in range(WAVE_POINTS):
        time = part.begin + (part.end - part.begin) * WAVE_PLACES[i]
        write_interpolation((time - echo.delay - begin) / lasted, weights)
        for k in range(WAVE_POINTS):
            share = waves.back * echo.share * weights[k]
            if k == 0:
                set_row(parts.loads[i], share, parts.waves[echo.part * WAVE_POINTS])
            else:
                add_row(parts.loads[i], share, parts.waves[echo.part * WAVE_POINTS + k])


@kernel
def apply_part(waves: WavesOfRun, parts: PartsOfRun, count: int, equations: Floats) -> None:
    """Write the wave that leaves on a part, the last of a number of them, and load, slip rate and states at its end."""
    unknowns, points = 1 + len(waves.run.reverses), WAVE_POINTS
    size = unknowns * points
    width = size + unknowns + points
    for i in range(points):
        row, target = ahead(equations, i * width + size), parts.waves[count * points + i]
        set_row(target, -1.0, parts.loads[i])
        for c in range(unknowns):
            if row[c] != 0.0:
                add_row(target, 2.0 * waves.impedance * row[c], parts.now[RATE_ROW + c])
        for j in range(points):
            if row[unknowns + j] != 0.0:
                add_row(target, 2.0 * waves.impedance * row[unknowns + j], parts.loads[j])
    for r in range(unknowns):
        row, target = ahead(equations, ((r + 1) * points - 1) * width + size), parts.later[RATE_ROW + r]
        set_row(target, row[0], parts.now[RATE_ROW])
        for c in range(1, unknowns):
            add_row(target, row[c], parts.now[RATE_ROW + c])
        for j in range(points):
            add_row(target, row[unknowns + j], parts.loads[j])
    for r in range(unknowns):
        set_row(parts.now[RATE_ROW + r], 1.0, parts.later[RATE_ROW + r])
    set_row(parts.now[LOAD_ROW], 1.0, parts.loads[points - 1])


@kernel
def pass_wave_piece(waves: WavesOfRun, parts: PartsOfRun, count: int, piece: int, until: float) -> int:
    """Carry disturbances over a piece, up to a time (s), in parts; return the number of parts then, or NO_ROOM."""
    equations, now, same = room_for(ROOM_OF_PART), waves.starts[piece], SAME_MOMENT * waves.trip
    allowed = until - now
    for _ in range(8 * MOST_IN_A_PIECE):
        if until - now <= same:
            return count
        if (count + 1) * WAVE_POINTS > len(parts.waves):
            return NO_ROOM
        echo = echo_behind(waves, parts.ends, count, now, waves.trip)
        end = min(until, echo.until, now + allowed)
        end = until if until - end <= same else end
        part = PartInTime(piece, now, end)
        if (end - now) * MOST_IN_A_PIECE > waves.lasts[piece] and is_rough_part(waves, part):
            allowed = 0.5 * (end - now)
            continue
        write_loads(waves, parts, echo, part)
        solve_part(waves, part, equations)
        apply_part(waves, parts, count, equations)
        parts.ends[count, 0], parts.ends[count, 1] = now, end
        now, count, allowed = end, count + 1, 2.0 * (end - now)
    return NO_ROOM


@entry
def carry(waves: WavesOfRun, parts: PartsOfRun, last: int, place: float) -> int:
    """Carry disturbances from the start of a run to its return at a place (1) in a piece; return the number of parts, or NO_ROOM.

    At the end `parts.now` has load, slip rate and states at the moved return.
    """
    count, pace = waves.first, room_for(MOST_OF_FORMULA)
    for piece in range(waves.first, last + 1):
        pass_wave_event(waves, parts, count, piece)
        until = waves.starts[piece] + waves.lasts[piece] * (place if piece == last else 1.0)
        count = pass_wave_piece(waves, parts, count, piece, until)
        if count == NO_ROOM:
            return NO_ROOM
    if waves.at_onset == 1:
        high = room_for(MOST_OF_FORMULA)
        write_moved(waves, parts, count, last + 1, RELEASE)
        write_sides(waves, last + 1, pace, high)
    else:
        write_side(waves, last, place, pace)
        set_row(parts.moved, 1.0 / pace[RATE_ROW], parts.now[RATE_ROW])
    for n in range(FIRST_STATE_ROW + len(waves.run.reverses)):
        add_row(parts.now[n], -pace[n], parts.moved)
    return count


@entry
def read_waves(waves: WavesOfRun, parts: PartsOfRun, count: int, times_and_paces: Floats2, found: Floats2) -> None:
    """Write disturbances of the wave at times (s) before the return that move with it, beside how fast the wave changes (Pa/s)."""
    weights = room_for(WAVE_POINTS)
    for i in range(len(times_and_paces)):
        time = times_and_paces[i, 0]
        echo = echo_behind(waves, parts.ends, count, time, 0.0)
        begin = parts.ends[echo.part, 0]
        write_interpolation((time - echo.delay - begin) / (parts.ends[echo.part, 1] - begin), weights)
        set_row(found[i], -times_and_paces[i, 1], parts.moved)
        for k in range(WAVE_POINTS):
            add_row(found[i], echo.share * weights[k], parts.waves[echo.part * WAVE_POINTS + k])
