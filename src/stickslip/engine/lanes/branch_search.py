"""Find the branches of many resistances g(s) = Z s + S mu(s): `contact.branches` in compiled code.

If mu is convex or concave, g has one fold at most, which is located to two neighbouring floating-point numbers. For any other law,
the ends of branches come from `contact.turns`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from stickslip.engine.state.layout import Floats
from stickslip.engine.state.workspace import branches_in
from stickslip.foundation.arrays import Floats1, Floats2, Floats3, Integers1
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import ahead, bits_of, call_value, float_of, floats, room_for

MOST_BRANCHES = 4
"""Room of tables for branches."""
BELOW, ABOVE = 1e-8, 1e4
"""Between these multiples of the slowest and of the fastest scale of a contact lies the fold of a law that bends one way."""
NEVER_RISES, TOO_MANY = 0, -1
"""Results instead of a number of branches: g still falls at the fastest rate, or there are more branches than fit."""
PROBES = 128
"""Try at most this many slip rates (1) for one turn: more than the 64 bits that are halved and STEPS together."""
OCTAVE, STEPS = 2**52, 16
"""A factor of two between slip rates, as a difference of their bits; number of steps of false position after which the search
returns to halving the bits."""


class MemberResistance(NamedTuple):
    """Hold what the resistance g(s) = Z s + S mu(s) of one member is calculated from."""

    address: int  # of the formula's compiled `value`
    constants: Any  # pointer to the formula's constants
    damping: float  # Z, Pa s/m, or that of a block, N s/m
    normal: float  # S, Pa
    start: float  # g(0+) minus the static strength, Pa
    out: Any  # pointer to room for what `value` returns


class Resistances(NamedTuple):
    """Hold what the resistances of all members are calculated from, and where to look for their folds."""

    address: int  # of the formula's compiled `value`
    constants: Floats3  # (members or 1, 1, size)
    damping: Floats1  # the same
    normal: Floats1  # S, Pa
    start: Floats1  # g(0+) minus the static strength, Pa
    slowest: Floats1  # slowest and fastest scale of the contact, m/s
    fastest: Floats1


class FoundBranches(NamedTuple):
    """Hold what is found for each member."""

    table: Floats3  # (members, largest number of branches, Branch.total)
    branches: Integers1  # number of branches; NEVER_RISES or TOO_MANY
    irregular: Floats1  # 1 if several slip rates solve the contact equation at some load


@kernel
def slope_at(g: MemberResistance, rate: float) -> float:
    """Return g'(s), in Pa s/m, at a slip rate (m/s) and the reference slip."""
    call_value(g.address, g.constants, 0.0, rate, g.out)
    return g.damping + g.normal * g.out[1]


@kernel
def excess_at(g: MemberResistance, rate: float) -> float:
    """Return g(s) minus the static strength (Pa) at a slip rate (m/s)."""
    call_value(g.address, g.constants, 0.0, rate, g.out)
    return g.damping * rate + g.normal * g.out[0] + g.start


@kernel
def turn_between(g: MemberResistance, low: float, high: float, at_low: float, at_high: float) -> float:
    """Return the slip rate between `low` and `high` where g' changes sign: the last or the first one where g still rises.

    at_low and at_high are g' at the two ends. The bits of the rates are halved until these differ by less than a factor of two.
    Then false position takes over, with the weights of Anderson & Björck 1973 (BIT 13, 253) so that neither end gets stuck.
    """
    rises, side, steps = at_low > 0.0, 0, 0
    before, behind = bits_of(low), bits_of(high)
    for _ in range(PROBES):
        if behind - before <= 1:
            break
        probe = before + (behind - before) // 2
        near = behind - before <= OCTAVE and steps < STEPS
        if near:
            crossing = (float_of(before) * at_high - float_of(behind) * at_low) / (at_high - at_low)
            probe, steps = min(max(bits_of(crossing), before + 1), behind - 1), steps + 1
        value = slope_at(g, float_of(probe))
        if (value > 0.0) == rises:
            at_high *= share_kept(value, at_low) if side > 0 else 1.0
            before, at_low, side = probe, value, 1 if near else 0
        else:
            at_low *= share_kept(value, at_high) if side < 0 else 1.0
            behind, at_high, side = probe, value, -1 if near else 0
    return float_of(before) if rises else float_of(behind)


@kernel
def share_kept(value: float, last: float) -> float:
    """Return the weight for the value at an end that false position keeps twice, from the new value and the one it replaces."""
    share = 1.0 - value / last
    return share if share > 0.0 else 0.5


@kernel
def turns_once(g: MemberResistance, slowest: float, fastest: float, ends: Floats) -> int:
    """Write the ends of the branches (m/s) into `ends`, if the slope of g is monotone; return their number or NEVER_RISES.

    slowest and fastest are those of `Resistances`.
    """
    low, high = 0.0, ABOVE * fastest
    at_high = slope_at(g, high)
    if not at_high > 0.0:
        return NEVER_RISES
    at_low = slope_at(g, low)
    ends[0], ends[1] = 0.0, math.inf
    if at_low > 0.0 or (at_low == 0.0 and slope_at(g, BELOW * slowest) > 0.0):
        return 1
    for rate in (slowest, fastest):
        if low < rate < high:
            slope = slope_at(g, rate)
            if slope > 0.0:
                high, at_high = rate, slope
            else:
                low, at_low = rate, slope
    ends[0] = turn_between(g, low, high, at_low, at_high)
    return 1


@entry
def search_branches(of: Resistances, ends: Floats2, work: Floats1, found: FoundBranches) -> None:
    """Find the branches of each member's resistance and what follows from them.

    `ends` holds the ends of the branches (m/s) of each member, whose number is in `found`; without members mu is convex or concave,
    and they are found here. `work` has room for what `value` returns.
    """
    own = room_for(2)
    out, size = floats(work.ctypes.data), of.constants.shape[1] * of.constants.shape[2] if len(of.constants) > 1 else 0
    for n in range(len(found.table)):
        c = ahead(floats(of.constants.ctypes.data), n * size)
        g = MemberResistance(of.address, c, of.damping[n], of.normal[n], of.start[n], out)
        if len(ends) == 0:
            found.branches[n] = turns_once(g, of.slowest[n], of.fastest[n], own)
        count, found.irregular[n] = found.branches[n], 0.0
        if count <= 0:
            continue
        branches, edges = branches_in(found.table[n]), own if len(ends) == 0 else floats(ends[n].ctypes.data)
        for i in range(count):
            branch, low, high = branches[i], edges[2 * i], edges[2 * i + 1]
            branch.rate_from, branch.rate_to = low, high
            branch.excess_from = excess_at(g, low)
            branch.excess_to = math.inf if math.isinf(high) else excess_at(g, high)
            if low > 0.0 or branch.excess_from < 0.0:
                found.irregular[n] = 1.0
