"""The jumps of a selection rule as the load slowly rises and falls, and the loop that it follows.

Source: Campillo et al. 1996, Fig. 4: the paths ODABE and EBCDO of perfect delay.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from itertools import pairwise
from typing import ClassVar, Literal

from stickslip.contact.areas import area
from stickslip.contact.branches import rate_on, resistance
from stickslip.contact.rules.selection import selection_table
from stickslip.foundation.show import brief_repr
from stickslip.problem import Branch, Problem, Resistance, SelectionTable


@dataclass(frozen=True)
class Jump:
    """A jump of the slip rate at a load (Pa): slip rates (m/s) and tractions (Pa) before and after it."""

    rate_before: float
    rate_after: float
    load: float
    direction: Literal["up", "down"]
    traction_before: float
    traction_after: float
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {
        **dict.fromkeys(("rate_before", "rate_after"), "slip_rate"),
        **dict.fromkeys(("load", "traction_before", "traction_after"), "load"),
    }
    __repr__ = brief_repr


@dataclass(frozen=True)
class Loop:
    """The path of the slip rate under a load that slowly rises from far below the folds to far above them, and back.

    `branches` lists the branches followed, in order (-1 is stick, the others count from the slowest), and `jumps` the jumps between
    them. `area` (Pa m/s) is the area enclosed in the plane of load and slip rate: the integral of (v on the way down - v on the
    way up) over the load. For a load that rises and falls at the constant rate b (Pa/s), area / b is the slip (m) by which the
    way down exceeds the way up. The area has the unit of a power per area but is none: heat depends on how long the load takes.
    """

    branches: tuple[int, ...]
    jumps: tuple[Jump, ...]
    area: float
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"area": "load slip_rate"}
    __repr__ = brief_repr


def jumps_of(g: Resistance, stable: tuple[Branch, ...], table: SelectionTable, slowest: int) -> tuple[Jump, ...]:
    """Return every jump that the rule can make from stick and from each of the slowest branches that it keeps.

    A change of branch with a continuous slip rate does not count as a jump.
    """
    found: list[Jump] = []
    for i in range(-1, slowest):
        low, high = (-math.inf, table.stick_to) if i < 0 else (table.keep_from[i], table.keep_to[i])
        if low > high:
            continue
        if high < math.inf:
            found.append(_jump(g, stable, (i, table.climb(i, math.nextafter(high, math.inf))), high))
        if low > -math.inf:
            found.append(_jump(g, stable, (i, table.descend(i, math.nextafter(low, -math.inf))), low))
    return tuple(jump for jump in found if jump.rate_before != jump.rate_after)


def _jump(g: Resistance, stable: tuple[Branch, ...], way: tuple[int, int], excess: float) -> Jump:
    """Return the jump from one branch to another (-1: stick) at an excess (Pa)."""
    before, after = (0.0 if i < 0 else rate_on(g, stable[i], excess) for i in way)
    load = g.strength + excess
    before, after = (resolved(rate, load, g.damping) for rate in (before, after))
    sides = (load - g.damping * before, load - g.damping * after)
    return Jump(before, after, load, "up" if way[1] > way[0] else "down", *sides, g.load_unit)


def resolved(rate: float, load: float, damping: float) -> float:
    """Return a slip rate (m/s), or 0, rest, if Z v is lost in the rounding of the load (Pa; block: N)."""
    return 0.0 if load - damping * rate == load else rate


def loop_of(g: Resistance, stable: tuple[Branch, ...], table: SelectionTable) -> Loop:
    """Return the loop that the rule follows.

    Between jumps the way up and the way down follow the same g, so that only jumps enclose area. A jump from rate a to rate b adds
    the integral of (load - g) dv from a to b, which is negative if the rule jumps against the sign of load - g.
    """
    walked, levels = [-1], []
    while walked[-1] < len(stable) - 1:
        levels.append(table.stick_to if walked[-1] < 0 else table.keep_to[walked[-1]])
        walked.append(table.climb(walked[-1], math.nextafter(levels[-1], math.inf)))
    while walked[-1] >= 0:
        levels.append(table.keep_from[walked[-1]])
        walked.append(table.descend(walked[-1], math.nextafter(levels[-1], -math.inf)))
    jumps = [_jump(g, stable, way, level) for way, level in zip(pairwise(walked), levels, strict=True)]
    enclosed = math.fsum(_against(g, jump, level) for jump, level in zip(jumps, levels, strict=True))  # areas cancel exactly
    return Loop(tuple(walked), tuple(jump for jump in jumps if jump.rate_before != jump.rate_after), enclosed, g.load_unit)


def _against(g: Resistance, jump: Jump, excess: float) -> float:
    """Return the integral of (load - g) dv along a jump (Pa m/s)."""
    low, high = sorted((jump.rate_before, jump.rate_after))
    return -area(g, low, high, excess) if jump.direction == "up" else area(g, low, high, excess)


def first_rate(problem: Problem) -> float:
    """Return the slip rate (m/s) to which a massless contact jumps forwards at t = 0+.

    The result is 0 for a contact that is stuck, has inertia, or whose law has a state.
    """
    if problem.body.has_inertia or problem.friction.states:
        return 0.0
    stable, table = selection_table(problem)
    grows = problem.excess == 0.0 and problem.first_pull_rate > 0.0
    excess = sys.float_info.min if grows else problem.excess
    if excess <= table.stick_to:
        return 0.0
    rate = rate_on(resistance(problem), stable[table.climb(-1, excess)], excess)
    return rate if rate > sys.float_info.min else 0.0
