"""Loading that varies in time: what it adds to a piece of load, where it cuts it, and how long a contact at rest withstands it.

The inflow F runs straight from break to break, with a tone on top. A piece of load is cut where a segment of it arrives; from there
on the break is an edge between pieces, and so are its echoes. A load at rest grows by F from row to row on a slab and by its
integral on a block: over rows in which nothing but the tone changes both are closed forms, taken at the mean time.
"""

from __future__ import annotations

import math

from stickslip.evolution import layout as at
from stickslip.evolution.compiled import ahead, inlined, kernel
from stickslip.evolution.layout import TERMS
from stickslip.evolution.polynomial import RECIPROCAL, copy, maximum, restrict, total
from stickslip.evolution.record import xi_at
from stickslip.evolution.workspace import WHOLE, Run

TIE = 1e-13
"""Breaks nearer to the edge of a piece, as a share of a row, lie on it."""


@kernel
def take_part(run: Run) -> None:
    """Of the source of load just brought, and not yet taken, the part up to the next break of the loading, with what it adds."""
    begin = run.state[at.TAKEN]
    if begin > 0.0:
        run.counts[at.ARRIVING] = at.NO_CAUSE
    theta = run.state[at.TAKEN_TO_THETA] if begin > 0.0 else run.state[at.THETA_FROM]
    if enter_segment(run, theta):
        run.counts[at.ARRIVING] = at.LOADING
    end, theta_to = 1.0, run.state[at.THETA_TO]
    change = next_change(run)
    if change < theta_to - TIE * run.par[at.ROW_TIME]:
        end, theta_to = min(xi_at(run, change), 1.0), change
    if begin > 0.0 or end < 1.0:
        cut(run, begin, end, theta, theta_to)
    add_loading(run)
    run.state[at.TAKEN], run.state[at.TAKEN_TO_THETA] = (end, theta_to) if end < 1.0 else (0.0, 0.0)
    run.counts[at.SOURCE] += 1 if end == 1.0 else 0


@inlined
def enter_segment(run: Run, theta: float) -> bool:
    """Go on to the segment that has arrived at an offset of the present row; whether the loading jumps there."""
    jumps, tie = False, TIE * run.par[at.ROW_TIME]
    while next_change(run) <= theta + tie:
        run.counts[at.SEGMENT] += 1
        run.counts[at.STUCK_ROWS] = -1  # what the last round trip at rest was says nothing of the next one
        jumps = jumps or run.from_jump[run.counts[at.SEGMENT]] == 1.0
    return jumps


@inlined
def next_change(run: Run) -> float:
    """Offset, from the start of the present row, at which the next segment arrives; inf in later rows."""
    following = run.counts[at.SEGMENT] + 1
    if following >= run.segments or run.from_row[following] > run.counts[at.ROW]:
        return math.inf
    return run.from_offset[following] if run.from_row[following] == run.counts[at.ROW] else -math.inf


@inlined
def cut(run: Run, begin: float, end: float, theta: float, theta_to: float) -> None:
    """Keep the part of the source between two places in it."""
    width = end - begin
    restrict(run.load, begin, width, run.spare)
    copy(run.spare, run.load, TERMS)
    run.state[at.SPEED] = (run.state[at.SPEED] + 2.0 * run.state[at.BEND] * begin) * width
    run.state[at.BEND] *= width * width
    run.state[at.THETA_FROM], run.state[at.THETA_TO] = theta, theta_to


@inlined
def add_loading(run: Run) -> None:
    """Add to the part what the driver sent since its load was recorded."""
    row = float(run.counts[at.ROW])
    if run.counts[at.IS_BLOCK] == 1:
        pull_block(run)
    elif row > 0.0 or run.state[at.THETA_FROM] >= 0.5 * run.par[at.ROW_TIME]:
        leaped = 0.0
        if row > 0.0 and run.par[at.REFLECTION] == -1.0:
            leaped = row - 1.0 - run.whole[WHOLE * run.counts[at.ECHO_OF] + at.S_ROW]
        if leaped > 0.0:
            add_inflow(run, leaped, row - 0.5 * (leaped + 1.0), run.counts[at.ROW_SEGMENT])
        add_inflow(run, 1.0, row, run.counts[at.SEGMENT])


@kernel
def add_inflow(run: Run, rows: float, mean_row: float, segment: int) -> None:
    """Add to a slab's load the inflow of so many rows, whose mean row is given, at the phases of the part."""
    since = (mean_row - run.from_row[segment]) * run.par[at.ROW_TIME] + (run.state[at.THETA_FROM] - run.from_offset[segment])
    slope = rows * run.from_slope[segment]
    run.load[0] += rows * run.from_value[segment] + slope * since
    run.load[1] += slope * run.state[at.SPEED]
    run.load[2] += slope * run.state[at.BEND]
    if run.par[at.TONE] != 0.0:
        weight = dirichlet(rows, run.par[at.TONE_FREQUENCY] * run.par[at.ROW_TIME])
        tone_series(run, weight * run.par[at.TONE], mean_row * run.par[at.ROW_TIME] + run.state[at.THETA_FROM])
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
    frequency = run.par[at.TONE_FREQUENCY]
    turn, bend = frequency * run.state[at.SPEED], 2.0 * frequency * run.state[at.BEND]
    angle = frequency * time + run.par[at.TONE_PHASE]
    sine, cosine = run.spare, run.part
    sine[0], cosine[0] = amplitude * math.sin(angle), amplitude * math.cos(angle)
    for k in range(TERMS - 1):
        before = k - 1 if k > 0 else 0
        bent = bend if k > 0 else 0.0
        sine[k + 1] = RECIPROCAL[k + 1] * (turn * cosine[k] + bent * cosine[before])
        cosine[k + 1] = -RECIPROCAL[k + 1] * (turn * sine[k] + bent * sine[before])


@inlined
def pull_block(run: Run) -> None:
    """A block's load: where it stood, and what its spring is stretched by since."""
    n = run.counts[at.LENGTH] - 1
    if n >= 0:
        run.load[0] = total(ahead(run.stored_load, TERMS * n))
        rows = float(run.counts[at.ROW] - run.whole[WHOLE * n + at.S_ROW] - 1)
        if rows > 0.0:
            run.load[0] += pulled_in_rows(run, rows)
    segment, pace = run.counts[at.SEGMENT], run.state[at.SPEED]
    since = (run.counts[at.ROW] - run.from_row[segment]) * run.par[at.ROW_TIME]
    since += run.state[at.THETA_FROM] - run.from_offset[segment]
    slope = run.from_slope[segment]
    run.load[1] += pace * (run.from_value[segment] + slope * since)
    run.load[2] += 0.5 * pace * pace * slope
    if run.par[at.TONE] != 0.0:
        tone_series(run, run.par[at.TONE], run.counts[at.ROW] * run.par[at.ROW_TIME] + run.state[at.THETA_FROM])
        for k in range(1, TERMS):
            run.load[k] += pace * RECIPROCAL[k] * run.spare[k - 1]


@inlined
def pulled_in_rows(run: Run, rows: float) -> float:
    """Force (N) that a block's spring gains in so many rows at rest before the present one."""
    segment, lasting = run.counts[at.ROW_SEGMENT], rows * run.par[at.ROW_TIME]
    middle = (run.counts[at.ROW] - 0.5 * rows) * run.par[at.ROW_TIME]
    since = (run.counts[at.ROW] - 0.5 * rows - run.from_row[segment]) * run.par[at.ROW_TIME] - run.from_offset[segment]
    gained = lasting * (run.from_value[segment] + run.from_slope[segment] * since)
    if run.par[at.TONE] != 0.0:
        frequency = run.par[at.TONE_FREQUENCY]
        swing = math.sin(frequency * middle + run.par[at.TONE_PHASE])
        gained += run.par[at.TONE] * 2.0 / frequency * math.sin(0.5 * frequency * lasting) * swing
    return gained


# ---- rest -------------------------------------------------------------------------------------------------------------------


@kernel
def rows_withstood(run: Run, limit: float) -> int:
    """Whole rows, up to the one in which the loading breaks, that a contact at rest stays so for certain; FOREVER if for ever."""
    segment = run.counts[at.SEGMENT]
    following = segment + 1
    room = run.from_row[following] - run.counts[at.ROW] - 1.0 if following < run.segments else float(at.NEVER)
    is_dead = run.from_slope[segment] == 0.0 and run.par[at.TONE] == 0.0
    if run.counts[at.IS_BLOCK] == 0 and run.par[at.REFLECTION] != -1.0:
        return int(max(room, 0.0)) if is_dead and has_faded(run) else 0
    if is_dead and run.from_value[segment] == 0.0:
        return int(max(room, 0.0))
    top, bottom = limit - tops(run, 1.0), limit + 2.0 * run.par[at.REFERENCE] - tops(run, -1.0)
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


@inlined
def has_faded(run: Run) -> bool:
    """Whether the round trips of a slab at rest are the same from here on: what they differ by fades from the first one on."""
    return run.counts[at.STUCK_ROWS] > 0 and abs(run.par[at.REFLECTION]) ** (run.counts[at.STUCK_ROWS] - 1) < FORGOTTEN


@inlined
def tops(run: Run, sign: float) -> float:
    """Largest load of the row just past, in a direction."""
    top = -math.inf
    for n in range(run.counts[at.ROW_FROM], run.counts[at.LENGTH]):
        top = max(top, maximum(ahead(run.stored_load, TERMS * n), sign))
    return top


@inlined
def withstands(run: Run, rows: float, top: float, bottom: float) -> bool:
    """Whether the load can certainly not grow by more than `top`, nor fall by more than `bottom`, in the next so many rows."""
    return growth_bound(run, rows, 1.0) < top and growth_bound(run, rows, -1.0) < bottom


@kernel
def growth_bound(run: Run, rows: float, sign: float) -> float:
    """A bound on the growth of a load at rest, in a direction, over the next 0 to so many rows."""
    segment, period, frequency = run.counts[at.SEGMENT], run.par[at.ROW_TIME], run.par[at.TONE_FREQUENCY]
    begin = run.counts[at.ROW] * period
    end = begin + (rows + 2.0) * period
    since = (run.counts[at.ROW] - run.from_row[segment]) * period - run.from_offset[segment]
    value, slope = sign * run.from_value[segment], sign * run.from_slope[segment]
    largest = max(value + slope * since, value + slope * (since + (rows + 2.0) * period), 0.0)
    is_block = run.counts[at.IS_BLOCK] == 1
    lasting = rows * period if is_block else rows
    bound = lasting * largest
    if run.par[at.TONE] != 0.0:
        amplitude, phase = sign * run.par[at.TONE], run.par[at.TONE_PHASE]
        steepest = largest_sine(frequency * begin + phase, frequency * end + phase, amplitude)
        half = abs(math.sin(0.5 * frequency * period))
        swing = 2.0 / frequency if is_block else 1.0 / half if half > 0.0 else math.inf
        bound += min(lasting * max(steepest, 0.0), abs(amplitude) * swing)
    return bound


@inlined
def largest_sine(begin: float, end: float, amplitude: float) -> float:
    """Largest amplitude sin(x) for x between two angles."""
    if amplitude < 0.0:
        return largest_sine_up(begin + math.pi, end + math.pi) * -amplitude
    return largest_sine_up(begin, end) * amplitude


@inlined
def largest_sine_up(begin: float, end: float) -> float:
    """Largest sin(x) for x between two angles."""
    peak = (math.floor((begin - 0.5 * math.pi) / (2.0 * math.pi)) + 1.0) * 2.0 * math.pi + 0.5 * math.pi
    return 1.0 if peak <= end else max(math.sin(begin), math.sin(end))
