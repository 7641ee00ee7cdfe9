"""Branches of many resistances g(s) = Z s + S mu(s): `contact.branches` and the rules of `contact.rules.selection`, compiled.

Where mu is convex or concave g turns once at most, and the fold is found between two floating-point numbers that are neighbours.
Any other law is searched over the grid of slip rates of `contact.branches`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.engine.codegen.compiler import ahead, bits_of, call_value, float_of, floats, kernel
from stickslip.engine.state.layout import Floats, Integers

MOST_BRANCHES = 4
RULES = ("perfect-delay", "minimal", "maximal")
"""Selection rules that the batch knows."""
PERFECT_DELAY, MINIMAL, MAXIMAL = range(3)

POINTS_PER_DECADE = 64
EVEN_POINTS, EVEN_REACH = 2001, 10.0
BELOW, ABOVE = 1e-8, 1e4
ROUNDS, BETWEEN = 3, 17
"""The grid is refined so often where g' nearly touches zero, with so many rates between two neighbours."""
NEVER_RISES, TOO_MANY = 0, -1
NEARBY = 1e-14
"""Rounding of where a law says that the turn is, relative."""
OCTAVE, STEPS = 2**52, 16
"""A factor of two between slip rates, by their bits, and steps of false position behind which the bits are halved again."""


@kernel
def slope_at(address: int, c: Any, impedance: float, normal: float, rate: float, out: Any) -> float:
    """g'(s)."""
    call_value(address, c, 0.0, rate, out)
    return impedance + normal * out[1]


@kernel
def excess_at(address: int, c: Any, impedance: float, normal: float, start: float, rate: float, out: Any) -> float:
    """g(s) minus the static strength."""
    call_value(address, c, 0.0, rate, out)
    return impedance * rate + normal * out[0] + start


@kernel
def turn_between(
    address: int, c: Any, impedance: float, normal: float, low: float, high: float, at_low: float, at_high: float, out: Any
) -> float:
    """The rate between two at which g' changes sign: the last one at which it still rises, or the first one at which it does.

    at_low, at_high: g' there. Halves the bits of the rates down to a factor of two; from there on false position, kept from
    standing still by the weights of Anderson & Björck 1973 (BIT 13, 253).
    """
    rises, side, steps = at_low > 0.0, 0, 0
    before, behind = bits_of(low), bits_of(high)
    while behind - before > 1:
        probe = before + (behind - before) // 2
        near = behind - before <= OCTAVE and steps < STEPS
        if near:
            crossing = (float_of(before) * at_high - float_of(behind) * at_low) / (at_high - at_low)
            probe, steps = min(max(bits_of(crossing), before + 1), behind - 1), steps + 1
        value = slope_at(address, c, impedance, normal, float_of(probe), out)
        if (value > 0.0) == rises:
            at_high *= share_kept(value, at_low) if side > 0 else 1.0
            before, at_low, side = probe, value, 1 if near else 0
        else:
            at_low *= share_kept(value, at_high) if side < 0 else 1.0
            behind, at_high, side = probe, value, -1 if near else 0
    return float_of(before) if rises else float_of(behind)


@kernel
def share_kept(value: float, last: float) -> float:
    """What false position leaves of the value at the end that stays where it is for a second time."""
    share = 1.0 - value / last
    return share if share > 0.0 else 0.5


@kernel
def turns_once(
    address: int, c: Any, impedance: float, normal: float, slowest: float, fastest: float, near: float, ends: Floats, out: Any
) -> int:
    """Ends of the branches of a resistance whose slope only rises, or only falls. Returns how many branches there are.

    near: where the turn may be, if that is known.
    """
    low, high = 0.0, ABOVE * fastest
    at_high = slope_at(address, c, impedance, normal, high, out)
    if not at_high > 0.0:
        return NEVER_RISES
    at_low = slope_at(address, c, impedance, normal, low, out)
    ends[0], ends[1] = 0.0, math.inf
    if at_low > 0.0 or (at_low == 0.0 and slope_at(address, c, impedance, normal, BELOW * slowest, out) > 0.0):
        return 1
    for rate in (near * (1.0 - NEARBY), near * (1.0 + NEARBY), slowest, fastest):
        if low < rate < high:
            slope = slope_at(address, c, impedance, normal, rate, out)
            if slope > 0.0:
                high, at_high = rate, slope
            else:
                low, at_low = rate, slope
    ends[0] = turn_between(address, c, impedance, normal, low, high, at_low, at_high, out)
    return 1


@kernel
def search_grid(slowest: float, fastest: float) -> Floats:
    """0 and slip rates (m/s) in geometric progression over every scale, evenly up to the fastest, ascending."""
    low, high = math.log10(slowest * BELOW), math.log10(fastest * ABOVE)
    even = np.linspace(0.0, EVEN_REACH * fastest, EVEN_POINTS)
    steep = 10.0 ** np.linspace(low, high, math.ceil((high - low) * POINTS_PER_DECADE))
    return np.unique(np.concatenate((even, steep)))


@kernel
def refined(rates: Floats, slope: Floats) -> Floats:
    """The rates, and more of them where a parabola through three values of g' of one sign would reach zero."""
    extra = [rates[0]]
    for n in range(1, len(rates) - 1):
        left, middle, right = slope[n - 1], slope[n], slope[n + 1]
        bends = 4.0 * abs(middle) < np.sign(middle) * (left - 2.0 * middle + right)
        if bends and left * middle > 0.0 and middle * right > 0.0:
            extra.extend(np.linspace(rates[n - 1], rates[n + 1], BETWEEN))
    return np.unique(np.concatenate((rates, np.array(extra)))) if len(extra) > 1 else rates


@kernel
def slopes_at(address: int, c: Any, impedance: float, normal: float, rates: Floats, out: Any) -> Floats:
    """g' at many rates."""
    slope = np.empty(len(rates))
    for n in range(len(rates)):
        slope[n] = slope_at(address, c, impedance, normal, rates[n], out)
    return slope


@kernel
def turns(address: int, c: Any, impedance: float, normal: float, slowest: float, fastest: float, ends: Floats, out: Any) -> int:
    """Ends of the branches of any resistance. Returns how many branches there are; NEVER_RISES or TOO_MANY."""
    rates = search_grid(slowest, fastest)
    for _ in range(ROUNDS):
        rates = refined(rates, slopes_at(address, c, impedance, normal, rates, out))
    slope = slopes_at(address, c, impedance, normal, rates, out)
    if not slope[-1] > 0.0:
        return NEVER_RISES
    found, rises = 0, slope[0] > 0.0 or (slope[0] == 0.0 and slope[1] > 0.0)
    if rises:
        ends[0], found = 0.0, 1
    for n in range(1, len(rates)):
        if (slope[n] > 0.0) != rises:
            if found + 2 > len(ends):
                return TOO_MANY
            ends[found] = turn_between(address, c, impedance, normal, rates[n - 1], rates[n], slope[n - 1], slope[n], out)
            found, rises = found + 1, not rises
    ends[found] = math.inf
    return (found + 1) // 2


@kernel
def keep_levels(rule: int, branches: int, table: Floats) -> float:
    """Fill in between which loads the rule keeps each branch; returns the load at which stick is left."""
    stick_to = 0.0
    for n in range(branches):
        low, high = table[4 * branches + n], table[5 * branches + n]
        if rule == MINIMAL:
            low = max(low, 0.0)
            for other in range(n):
                low = max(low, table[5 * branches + other])
        elif rule == MAXIMAL:
            stick_to = min(stick_to, low)
            for other in range(n + 1, branches):
                high = min(high, table[4 * branches + other])
        table[2 * branches + n], table[3 * branches + n] = low, high
    return stick_to


@kernel
def branch_tables(
    address: int,
    constants: Floats,
    impedance: Floats,
    normal: Floats,
    start: Floats,
    slowest: Floats,
    fastest: Floats,
    near: Floats,
    one_way: bool,
    rule: int,
    work: Floats,
    table: Floats,
    branches: Integers,
    irregular: Floats,
    stick_to: Floats,
) -> None:
    """Rows of `Setup.branch` of each member, one behind the other; how many branches; whether a load has several solutions.

    work: room for four numbers, the caller's: an array made here would end where its address is taken.
    """
    ends = np.empty(2 * MOST_BRANCHES)
    out, size = floats(work.ctypes.data), constants.shape[1] * constants.shape[2] if len(constants) > 1 else 0
    for n in range(len(table)):
        c, z, s = ahead(floats(constants.ctypes.data), n * size), impedance[n], normal[n]
        if one_way:
            found = turns_once(address, c, z, s, slowest[n], fastest[n], near[n], ends, out)
        else:
            found = turns(address, c, z, s, slowest[n], fastest[n], ends, out)
        branches[n], irregular[n], stick_to[n] = found, 0.0, 0.0
        if found <= 0:
            continue
        for i in range(found):
            low, high = ends[2 * i], ends[2 * i + 1]
            table[n, i], table[n, found + i] = low, high
            table[n, 4 * found + i] = excess_at(address, c, z, s, start[n], low, out)
            table[n, 5 * found + i] = math.inf if math.isinf(high) else excess_at(address, c, z, s, start[n], high, out)
            if low > 0.0 or table[n, 4 * found + i] < 0.0:
                irregular[n] = 1.0
        stick_to[n] = keep_levels(rule, found, table[n])
