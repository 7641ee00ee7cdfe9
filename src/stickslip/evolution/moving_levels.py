"""Levels of the built-in selection rules along a step of slip under a law of slip and slip rate, in compiled code.

Folds and levels move with slip. At a place in a step the branches are found by one scan of g' over slip rates, up to the fastest
that the load allows, and each fold is polished. Between them and the load stands the room that the rule leaves to the branch.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.evolution import layout as at
from stickslip.evolution.branch import friction_of, towards
from stickslip.evolution.compiled import ahead, kernel
from stickslip.evolution.layout import TERMS, Floats, Integers
from stickslip.evolution.polynomial import NONE, evaluate, integral
from stickslip.evolution.workspace import REAL, WHOLE, Run, borrow

MINIMAL, MAXIMAL, MAXWELL = range(3)
COMPILED_RULES = {"minimal": MINIMAL, "maximal": MAXIMAL, "maxwell": MAXWELL}
"""Rules whose levels are worked out here; any other but perfect delay is followed by its table (`moving_branches.Step`)."""

ROUNDING = 1e-11
"""Loads nearer to a level, relative to the strength, have not crossed it."""
EXACT, SHORTEST = 1e-14, 1e-15
"""A crossing is found when the load is so near to the level, relative to the strength, or its place in the step so well known."""
FIRST_PLACE, LAST_PLACE = 0.5, 1.0
"""Where in a step the rule is looked at."""
NEXT = 1e-4
"""Share of a step: outside the level there too, a load that starts at the level leaves it at once."""
FLAT = 1e-11
"""Slope of g, relative to Z, up to which a branch does not rise."""
BETWEEN = 16
"""Parts into which two steps of the scan are divided where g' may touch zero between them."""
FIRST_PANEL = 1e5
"""The first panel of an area ends at this many times the slowest rate of the scan: a thousandth of the law's slowest scale."""
RATE_FROM, RATE_TO, LEVEL_FROM, LEVEL_TO, STEEPNESS = range(5)
"""Rows of the table that a scan fills: ends of the branches, g there (Pa, minus the reference), and g' along the scan."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def new_branches(scan: Floats) -> Floats:
    """An empty table with room for as many branches as there are rates in a scan."""
    return np.zeros((5, len(scan)))


@kernel
def piece_of(run: Run, n: int, rate: float) -> int:
    """The piece of the law at a slip rate in a step of the history."""
    if run.counts[at.KNOTS_IN_RATE] == 0:
        return run.whole[WHOLE * n + at.S_PIECE]
    piece = 0
    while piece < run.pieces - 1 and rate >= run.knot[piece]:
        piece += 1
    return piece


@kernel
def level_at(run: Run, n: int, law_slip: float, rate: float) -> float:
    """g (Pa, minus the reference) at a slip rate >= 0, 0 for 0+; its slope is left in run.value[1]."""
    friction_of(run, piece_of(run, n, rate), law_slip, rate, run.value)
    run.value[1] += run.par[at.IMPEDANCE]
    return run.par[at.IMPEDANCE] * rate + run.value[0]


@kernel
def strength_at(run: Run, n: int, law_slip: float) -> float:
    """Static strength (Pa), minus the reference."""
    friction_of(run, piece_of(run, n, 0.0), law_slip, 0.0, run.value)
    return run.par[at.NORMAL] * (run.value[3] + run.par[at.STATIC_EXCESS])


@kernel
def steepness(run: Run, n: int, law_slip: float, rate: float) -> float:
    """g', less what counts as flat: positive on a branch."""
    level_at(run, n, law_slip, rate)
    return run.value[1] - FLAT * run.par[at.IMPEDANCE]


@kernel
def fold_between(run: Run, n: int, law_slip: float, low: float, high: float) -> float:
    """The slip rate at which g' changes sign, on the side of it where g rises: false position, kept from standing still."""
    first, last = steepness(run, n, law_slip, low), steepness(run, n, law_slip, high)
    rises, side = first > 0.0, 0
    for k in range(200):
        if high - low <= 4e-16 * high:
            break
        x = (low * last - high * first) / (last - first) if k % 3 < 2 else 0.5 * (low + high)
        if not low < x < high:
            x = 0.5 * (low + high)
        value = steepness(run, n, law_slip, x)
        if (value > 0.0) == rises:
            low, first = x, value
            last *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            high, last = x, value
            first *= 0.5 if side < 0 else 1.0
            side = -1
    return low if rises else high


@kernel
def may_touch(before: float, here: float, after: float) -> bool:
    """Whether a parabola through three values of one sign reaches zero between them."""
    if before * here <= 0.0 or here * after <= 0.0:
        return False
    bend = before - 2.0 * here + after
    return 4.0 * abs(here) < (bend if here > 0.0 else -bend)


@kernel
def note_fold(run: Run, n: int, law_slip: float, rate: float, count: int, table: Floats) -> int:
    """Write where a branch begins (count even) or ends (odd) into the table. Returns the count of ends so far."""
    branch = count // 2
    if branch < table.shape[1]:
        level = level_at(run, n, law_slip, rate)
        if count % 2 == 0:
            table[RATE_FROM, branch], table[LEVEL_FROM, branch] = rate, level
        else:
            table[RATE_TO, branch], table[LEVEL_TO, branch] = rate, level
    return count + 1


@kernel
def fold_in(run: Run, n: int, law_slip: float, low: float, high: float, count: int, table: Floats) -> int:
    """Note the folds where g' changes sign between slip rates that are looked at one after the other."""
    step, before = (high - low) / BETWEEN, low
    for k in range(1, BETWEEN + 1):
        rate = high if k == BETWEEN else low + k * step
        if (steepness(run, n, law_slip, rate) > 0.0) != (count % 2 == 1):
            count = note_fold(run, n, law_slip, fold_between(run, n, law_slip, before, rate), count, table)
        before = rate
    return count


@kernel
def find_branches(run: Run, n: int, law_slip: float, top: float, scan: Floats, table: Floats) -> int:
    """Fill the table with the branches that begin below a slip rate. Returns how many there are."""
    slope, length = table[STEEPNESS], 0
    while length < len(scan) and (length < 2 or scan[length - 1] <= top):
        slope[length] = steepness(run, n, law_slip, scan[length])
        length += 1
    starts_flat = slope[0] >= -2.0 * FLAT * run.par[at.IMPEDANCE] and slope[1] > 0.0
    count = note_fold(run, n, law_slip, 0.0, 0, table) if slope[0] > 0.0 or starts_flat else 0
    for k in range(1, length):
        if (slope[k] > 0.0) != (count % 2 == 1):
            count = note_fold(run, n, law_slip, fold_between(run, n, law_slip, scan[k - 1], scan[k]), count, table)
        elif k + 1 < length and may_touch(slope[k - 1], slope[k], slope[k + 1]):
            count = fold_in(run, n, law_slip, scan[k - 1], scan[k], count, table)
            count = fold_in(run, n, law_slip, scan[k], scan[k + 1], count, table)
    branches = min((count + 1) // 2, table.shape[1])
    if count % 2 == 1:
        table[RATE_TO, branches - 1] = table[LEVEL_TO, branches - 1] = math.inf
    return branches


@kernel
def branch_near(rate: float, branches: int, table: Floats) -> int:
    """The branch to which a slip rate belongs: the nearest one, for at a fold it may lie outside by rounding."""
    nearest, least = 0, math.inf
    for k in range(branches):
        away = max(table[RATE_FROM, k] - rate, rate - table[RATE_TO, k], 0.0)
        if away < least:
            nearest, least = k, away
    return nearest


@kernel
def rate_at(run: Run, n: int, law_slip: float, load: float, low: float, high: float) -> float:
    """The slip rate between two others, between which g rises, at which it meets a load: Newton's method, kept inside."""
    s = 0.5 * (low + high)
    for _ in range(100):
        error = level_at(run, n, law_slip, s) - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            break
        step = s - error / run.value[1] if run.value[1] > 0.0 else 0.5 * (low + high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * s or step in (low, high):
            break
        s = step
    return s


@kernel
def area(run: Run, n: int, law_slip: float, load: float, low: float, high: float, first: float) -> float:
    """Integral of g - load over slip rates, in Pa m/s: Gauss's rule between knots, on panels that double in width from `first` on."""
    whole, start = 0.0, low
    while start < high:
        end = min(max(first, 2.0 * start), high)
        if run.counts[at.KNOTS_IN_RATE] == 1:
            for k in range(run.pieces - 1):
                if start < run.knot[k] < end:
                    end = run.knot[k]
        half = 0.5 * (end - start)
        for k in range(len(NODES)):
            whole += half * WEIGHTS[k] * (level_at(run, n, law_slip, start + half * (1.0 + NODES[k])) - load)
        start = end
    return whole


@kernel
def better_by(run: Run, n: int, law_slip: float, load: float, slow: float, fast: float, first: float) -> float:
    """How far (Pa) the load is above the level at which two rates that meet it have equal areas; exact at the level."""
    return -area(run, n, law_slip, load, slow, fast, first) / (fast - slow)


@kernel
def maxwell_room(run: Run, n: int, law_slip: float, rate: float, load: float, branches: int, table: Floats, first: float) -> float:
    """How far (Pa) the load is from the level at which another rate that solves the contact equation is the better one."""
    room, own = math.inf, branch_near(rate, branches, table)
    if load <= strength_at(run, n, law_slip):
        room = better_by(run, n, law_slip, load, 0.0, rate, first) if rate > 0.0 else room
    for k in range(branches):
        if k == own or not table[LEVEL_FROM, k] < load < table[LEVEL_TO, k]:
            continue
        fastest = (load + run.par[at.LARGEST_DROP]) / run.par[at.IMPEDANCE] * (1.0 + 1e-12)
        other = rate_at(run, n, law_slip, load, table[RATE_FROM, k], max(min(table[RATE_TO, k], fastest), table[RATE_FROM, k]))
        if other < rate:
            room = min(room, better_by(run, n, law_slip, load, other, rate, first))
        elif other > rate:
            room = min(room, -better_by(run, n, law_slip, load, rate, other, first))
    return room


@kernel
def law_slip_in(run: Run, n: int, xi: float) -> float:
    """Law slip (m), minus the initial one, at a place in a step of the history."""
    real, rate = ahead(run.real, REAL * n), ahead(run.stored_rate, TERMS * n)
    grown = real[at.S_SPEED] * integral(rate, xi, 1) + 2.0 * real[at.S_BEND] * integral(rate, xi, 2)
    mode = run.whole[WHOLE * n + at.S_MODE]
    return real[at.S_LAW_SLIP] + (grown if run.par[at.COUNTS_NET] == 1.0 else mode * grown)


@kernel
def room_in(run: Run, n: int, xi: float, rule: int, scan: Floats, table: Floats) -> float:
    """How far (Pa) the load is inside the interval for which the rule keeps the branch; negative outside."""
    law_slip, mode = law_slip_in(run, n, xi), run.whole[WHOLE * n + at.S_MODE]
    rate = abs(evaluate(ahead(run.stored_rate, TERMS * n), xi))
    load = towards(run, evaluate(ahead(run.stored_load, TERMS * n), xi), mode)
    top = max(rate, (load + run.par[at.LARGEST_DROP]) / run.par[at.IMPEDANCE]) * (1.0 + 1e-9)
    branches = find_branches(run, n, law_slip, top, scan, table)
    own = branch_near(rate, branches, table)
    low, high = table[LEVEL_FROM, own], table[LEVEL_TO, own]
    if rule == MINIMAL:
        low = max(low, strength_at(run, n, law_slip))
        for k in range(own):
            low = max(low, table[LEVEL_TO, k])
    elif rule == MAXIMAL:
        for k in range(own + 1, branches):
            high = min(high, table[LEVEL_FROM, k])
    room = min(load - low, high - load)
    return (
        min(room, maxwell_room(run, n, law_slip, rate, load, branches, table, FIRST_PANEL * scan[1])) if rule == MAXWELL else room
    )


@kernel
def place_of_crossing(run: Run, n: int, low: float, high: float, rule: int, scan: Floats, table: Floats) -> float:
    """Where the room, not negative at low and negative at high, falls through zero: false position, kept from standing still.

    Source: the Illinois method, Dowell & Jarratt 1971, BIT 11, 168.
    """
    slack = EXACT * run.par[at.REFERENCE]
    above, below = max(room_in(run, n, low, rule, scan, table), slack), room_in(run, n, high, rule, scan, table)
    side, x = 0, high
    for _ in range(100):
        x = (low * below - high * above) / (below - above)
        value = room_in(run, n, x, rule, scan, table)
        if abs(value) <= slack or high - low < SHORTEST:
            break
        if value > 0.0:
            low, above = x, value
            below *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            high, below = x, value
            above *= 0.5 if side < 0 else 1.0
            side = -1
    return x


@kernel
def crossing_in(places: Integers, n: int, rule: int, scan: Floats, table: Floats) -> float:
    """Where on [0, 1] of a step of slip the load first leaves what the rule keeps the branch for; NONE if it stays in it.

    `places` comes from `workspace.lend`.
    """
    run = borrow(places)
    before, slack = 0.0, ROUNDING * run.par[at.REFERENCE]
    for place in (FIRST_PLACE, LAST_PLACE):
        if room_in(run, n, place, rule, scan, table) < -slack:
            if room_in(run, n, before, rule, scan, table) <= slack:
                if room_in(run, n, before + NEXT * (place - before), rule, scan, table) <= 0.0:
                    return before
            return place_of_crossing(run, n, before, place, rule, scan, table)
        before = place
    return NONE
