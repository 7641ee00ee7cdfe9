"""Loading that varies in time: what it adds to a piece of load, where it cuts it, and how long a contact at rest withstands it.

The inflow F runs straight from break to break, with a tone on top. A piece of load is cut where a segment of it arrives; from there
on the break is an edge between pieces, and so are its echoes. A load at rest grows by F from row to row on a slab and by its
integral on a block: over rows in which nothing but the tone changes both are closed forms, taken at the mean time.
"""

from __future__ import annotations

import math

from stickslip.engine.codegen.compiler import ahead, kernel
from stickslip.engine.contact_step.append_segment import xi_at
from stickslip.engine.series.polynomial import RECIPROCAL, copy, maximum, restrict, total
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import TERMS, Cause
from stickslip.engine.state.workspace import WHOLE, Run

TIE = 1e-13
"""Breaks nearer to the edge of a piece, as a share of a row, lie on it."""


@kernel
def take_part(run: Run) -> None:
    """Of the source of load just brought, and not yet taken, the part up to the next break of the loading, with what it adds."""
    begin = run.state.taken
    if begin > 0.0:
        run.counts.arriving = Cause.NO_CAUSE
    theta = run.state.taken_to_theta if begin > 0.0 else run.state.theta_from
    if enter_segment(run, theta):
        run.counts.arriving = Cause.LOADING
    end, theta_to = 1.0, run.state.theta_to
    change = next_change(run)
    if change < theta_to - TIE * run.par.row_time:
        end, theta_to = min(xi_at(run, change), 1.0), change
    if begin > 0.0 or end < 1.0:
        cut(run, begin, end, theta, theta_to)
    add_loading(run)
    run.state.taken, run.state.taken_to_theta = (end, theta_to) if end < 1.0 else (0.0, 0.0)
    run.counts.source += 1 if end == 1.0 else 0


@kernel
def enter_segment(run: Run, theta: float) -> bool:
    """Go on to the segment that has arrived at an offset of the present row; whether the loading jumps there."""
    jumps, tie = False, TIE * run.par.row_time
    while next_change(run) <= theta + tie:
        run.counts.segment += 1
        run.counts.stuck_rows = -1  # what the last round trip at rest was says nothing of the next one
        jumps = jumps or run.from_jump[run.counts.segment] == 1.0
    return jumps


@kernel
def next_change(run: Run) -> float:
    """Offset, from the start of the present row, at which the next segment arrives; inf in later rows."""
    following = run.counts.segment + 1
    if following >= run.segments or run.from_row[following] > run.counts.row:
        return math.inf
    return run.from_offset[following] if run.from_row[following] == run.counts.row else -math.inf


@kernel
def cut(run: Run, begin: float, end: float, theta: float, theta_to: float) -> None:
    """Keep the part of the source between two places in it."""
    width = end - begin
    restrict(run.load, begin, width, run.spare)
    copy(run.spare, run.load, TERMS)
    run.state.speed = (run.state.speed + 2.0 * run.state.bend * begin) * width
    run.state.bend *= width * width
    run.state.theta_from, run.state.theta_to = theta, theta_to


@kernel
def add_loading(run: Run) -> None:
    """Add to the part what the driver sent since its load was recorded."""
    row = float(run.counts.row)
    if run.counts.is_block == 1:
        pull_block(run)
    elif row > 0.0 or run.state.theta_from >= 0.5 * run.par.row_time:
        leaped = 0.0
        if row > 0.0 and run.par.reflection == -1.0:
            leaped = row - 1.0 - run.whole[WHOLE * run.counts.echo_of + at.S_ROW]
        if leaped > 0.0:
            add_inflow(run, leaped, row - 0.5 * (leaped + 1.0), run.counts.row_segment)
        add_inflow(run, 1.0, row, run.counts.segment)


@kernel
def add_inflow(run: Run, rows: float, mean_row: float, segment: int) -> None:
    """Add to a slab's load the inflow of so many rows, whose mean row is given, at the phases of the part."""
    since = (mean_row - run.from_row[segment]) * run.par.row_time + (run.state.theta_from - run.from_offset[segment])
    slope = rows * run.from_slope[segment]
    run.load[0] += rows * run.from_value[segment] + slope * since
    run.load[1] += slope * run.state.speed
    run.load[2] += slope * run.state.bend
    if run.par.tone != 0.0:
        weight = dirichlet(rows, run.par.tone_frequency * run.par.row_time)
        tone_series(run, weight * run.par.tone, mean_row * run.par.row_time + run.state.theta_from)
        for k in range(TERMS):
            run.load[k] += run.spare[k]


@kernel
def dirichlet(count: float, step: float) -> float:
    """Sum of so many unit phasors, a step (rad) apart, along their mean: sin(count step/2) / sin(step/2)."""
    turns = math.floor(step / (2.0 * math.pi) + 0.5)
    rest = 0.5 * step - turns * math.pi  # in [-pi/2, pi/2]
    value = count if rest == 0.0 else math.sin(count * rest) / math.sin(rest)
    return -value if (turns * (count - 1.0)) % 2.0 == 1.0 else value


@kernel
def tone_series(run: Run, amplitude: float, time: float) -> None:
    """amplitude sin(frequency t + phase) along the part, which begins at a time (s): coefficients in xi, into `spare`.

    From the equations of sine and cosine: s' = frequency theta' c, c' = -frequency theta' s.
    """
    frequency = run.par.tone_frequency
    turn, bend = frequency * run.state.speed, 2.0 * frequency * run.state.bend
    angle = frequency * time + run.par.tone_phase
    sine, cosine = run.spare, run.part
    sine[0], cosine[0] = amplitude * math.sin(angle), amplitude * math.cos(angle)
    for k in range(TERMS - 1):
        before = k - 1 if k > 0 else 0
        bent = bend if k > 0 else 0.0
        sine[k + 1] = RECIPROCAL[k + 1] * (turn * cosine[k] + bent * cosine[before])
        cosine[k + 1] = -RECIPROCAL[k + 1] * (turn * sine[k] + bent * sine[before])


@kernel
def pull_block(run: Run) -> None:
    """A block's load: where it stood, and what its spring is stretched by since."""
    n = run.counts.length - 1
    if n >= 0:
        run.load[0] = total(ahead(run.stored_load, TERMS * n))
        rows = float(run.counts.row - run.whole[WHOLE * n + at.S_ROW] - 1)
        if rows > 0.0:
            run.load[0] += pulled_in_rows(run, rows)
    segment, pace = run.counts.segment, run.state.speed
    since = (run.counts.row - run.from_row[segment]) * run.par.row_time
    since += run.state.theta_from - run.from_offset[segment]
    slope = run.from_slope[segment]
    run.load[1] += pace * (run.from_value[segment] + slope * since)
    run.load[2] += 0.5 * pace * pace * slope
    if run.par.tone != 0.0:
        tone_series(run, run.par.tone, run.counts.row * run.par.row_time + run.state.theta_from)
        for k in range(1, TERMS):
            run.load[k] += pace * RECIPROCAL[k] * run.spare[k - 1]


@kernel
def pulled_in_rows(run: Run, rows: float) -> float:
    """Force (N) that a block's spring gains in so many rows at rest before the present one."""
    segment, lasting = run.counts.row_segment, rows * run.par.row_time
    middle = (run.counts.row - 0.5 * rows) * run.par.row_time
    since = (run.counts.row - 0.5 * rows - run.from_row[segment]) * run.par.row_time - run.from_offset[segment]
    gained = lasting * (run.from_value[segment] + run.from_slope[segment] * since)
    if run.par.tone != 0.0:
        frequency = run.par.tone_frequency
        swing = math.sin(frequency * middle + run.par.tone_phase)
        gained += run.par.tone * 2.0 / frequency * math.sin(0.5 * frequency * lasting) * swing
    return gained


# ---- rest -------------------------------------------------------------------------------------------------------------------


@kernel
def rows_withstood(run: Run, limit: float) -> int:
    """Whole rows, up to the one in which the loading breaks, that a contact at rest stays so for certain; FOREVER if for ever."""
    segment = run.counts.segment
    following = segment + 1
    room = run.from_row[following] - run.counts.row - 1.0 if following < run.segments else float(at.NEVER)
    is_dead = run.from_slope[segment] == 0.0 and run.par.tone == 0.0
    if run.counts.is_block == 0 and run.par.reflection != -1.0:
        return int(max(room, 0.0)) if is_dead and has_faded(run) else 0
    if is_dead and run.from_value[segment] == 0.0:
        return int(max(room, 0.0))
    top, bottom = limit - tops(run, 1.0), limit + 2.0 * run.par.reference - tops(run, -1.0)
    low, high = 0.0, max(room, 0.0)
    if withstands(run, high, top, bottom):
        return int(high)
    while high - low > 1.0 and high - low > 1e-3 * low:
        middle = math.floor(0.5 * (low + high))
        if withstands(run, middle, top, bottom):
            low = middle
        else:
            high = middle
    return int(low)


FORGOTTEN = 1e-17


@kernel
def has_faded(run: Run) -> bool:
    """Whether the round trips of a slab at rest are the same from here on: what they differ by fades from the first one on."""
    return run.counts.stuck_rows > 0 and abs(run.par.reflection) ** (run.counts.stuck_rows - 1) < FORGOTTEN


@kernel
def tops(run: Run, sign: float) -> float:
    """Largest load of the row just past, in a direction."""
    top = -math.inf
    for n in range(run.counts.row_from, run.counts.length):
        top = max(top, maximum(ahead(run.stored_load, TERMS * n), sign))
    return top


@kernel
def withstands(run: Run, rows: float, top: float, bottom: float) -> bool:
    """Whether the load can certainly not grow by more than `top`, nor fall by more than `bottom`, in the next so many rows."""
    return growth_bound(run, rows, 1.0) < top and growth_bound(run, rows, -1.0) < bottom


@kernel
def growth_bound(run: Run, rows: float, sign: float) -> float:
    """A bound on the growth of a load at rest, in a direction, over the next 0 to so many rows."""
    segment, period, frequency = run.counts.segment, run.par.row_time, run.par.tone_frequency
    begin = run.counts.row * period
    end = begin + (rows + 2.0) * period
    since = (run.counts.row - run.from_row[segment]) * period - run.from_offset[segment]
    value, slope = sign * run.from_value[segment], sign * run.from_slope[segment]
    largest = max(value + slope * since, value + slope * (since + (rows + 2.0) * period), 0.0)
    is_block = run.counts.is_block == 1
    lasting = rows * period if is_block else rows
    bound = lasting * largest
    if run.par.tone != 0.0:
        amplitude, phase = sign * run.par.tone, run.par.tone_phase
        steepest = largest_sine(frequency * begin + phase, frequency * end + phase, amplitude)
        half = abs(math.sin(0.5 * frequency * period))
        swing = 2.0 / frequency if is_block else 1.0 / half if half > 0.0 else math.inf
        bound += min(lasting * max(steepest, 0.0), abs(amplitude) * swing)
    return bound


@kernel
def largest_sine(begin: float, end: float, amplitude: float) -> float:
    """Largest amplitude sin(x) for x between two angles."""
    if amplitude < 0.0:
        return largest_sine_up(begin + math.pi, end + math.pi) * -amplitude
    return largest_sine_up(begin, end) * amplitude


@kernel
def largest_sine_up(begin: float, end: float) -> float:
    """Largest sin(x) for x between two angles."""
    peak = (math.floor((begin - 0.5 * math.pi) / (2.0 * math.pi)) + 1.0) * 2.0 * math.pi + 0.5 * math.pi
    return 1.0 if peak <= end else max(math.sin(begin), math.sin(end))
