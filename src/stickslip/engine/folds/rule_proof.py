"""Proof that a selection rule keeps its branch along a whole slice of a step, while folds move with slip; in compiled code.

Slip, load and the slip rate of the contact stay in intervals during the slice. Under the rule of the largest slip rate the branch
is kept if g stays above the load at every faster slip rate: on cells on which g rises it does so because it does at the lower end,
on others because its bounds say so. Under the rule of the smallest slip rate g has to stay below the load at every slower one, and
so has the static strength. Under Maxwell's rule both are asked for: there is then no other solution. Cells that show neither are
cut in two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.contact.contact_equation import towards
from stickslip.engine.enclosure.formula import bound_at_slips, bound_friction
from stickslip.engine.enclosure.intervals import add, multiply
from stickslip.engine.folds.moving_branches import Contact
from stickslip.engine.folds.turns import DEPTH, FASTEST, NARROW, cut_between
from stickslip.engine.series.polynomial import evaluate, integral
from stickslip.engine.state.layout import TERMS, Floats, Integers, Rule
from stickslip.engine.state.workspace import Run

MOST_CELLS = 300
"""Largest number of cells on which g is bounded for one slice; a shorter slice is tried where they are not enough."""
DOUBLE = 2.0
"""Ratio of the ends of the first cells beyond the slip rate of the contact (1)."""
ABOVE_ALL = 1.0 + 1e-9
"""Factor (1) by which the search goes beyond the fastest slip rate that the load allows."""


class Slice(NamedTuple):
    """Hold between which numbers the law slip (m), load (Pa, minus the reference strength) and slip rate (m/s) stay."""

    slip_low: float
    slip_high: float
    load_low: float
    load_high: float
    rate_low: float
    rate_high: float


class Attempt(NamedTuple):
    """Hold an attempt at a proof: the contact, the slice, and the number of cells that may still be looked at."""

    contact: Contact
    seen: Slice
    left: Integers


@kernel
def range_of(c: Floats, low: float, high: float) -> tuple[float, float]:
    """Return bounds of a polynomial between two places in [0, 1], from value and slope in the middle and the largest curvature."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    value = evaluate(c, middle)
    slope = bent = 0.0
    for k in range(TERMS - 1, 0, -1):
        slope = slope * middle + k * c[k]
    for k in range(TERMS - 1, 1, -1):
        bent = bent * high + k * (k - 1) * abs(c[k])
    reach = half * (abs(slope) + 0.5 * half * bent) + 1e-15 * abs(value)
    return value - reach, value + reach


@kernel
def law_slip_in(run: Run, n: int, xi: float) -> float:
    """Return the law slip (m), minus its initial value, at the place `xi` in piece n of the history."""
    piece = run.history[n]
    grown = piece.speed * integral(piece.rate, xi, 1) + 2.0 * piece.bend * integral(piece.rate, xi, 2)
    return piece.law_slip + (grown if run.params.counts_net == 1.0 else piece.mode * grown)


@kernel
def slice_of(contact: Contact, n: int, low: float, high: float) -> Slice:
    """Return the intervals of a slice, between two places in piece n of the history."""
    run, step = contact.run, contact.run.history[n]
    one, other = law_slip_in(run, n, low), law_slip_in(run, n, high)
    start, least, most = contact.search.start, min(one, other), max(one, other)
    slack = 1e-15 * (abs(start) + abs(least) + abs(most))
    loads, rates = range_of(step.load, low, high), range_of(step.rate, low, high)
    first, last = towards(run, loads[0], step.mode), towards(run, loads[1], step.mode)
    slow, fast = min(abs(rates[0]), abs(rates[1])), max(abs(rates[0]), abs(rates[1]))
    slow = 0.0 if rates[0] * rates[1] < 0.0 else slow
    return Slice(start + least - slack, start + most + slack, min(first, last), max(first, last), slow, fast)


@kernel
def slope_and_level(contact: Contact, piece: int, low: float, high: float) -> tuple[float, float, float, float]:
    """Bound g' from below and g (Pa, minus the reference strength) from both sides on a cell; g' also from above."""
    g, friction = contact.search.resistance, bound_friction(contact.search.resistance.formulas, piece, low, high)
    slope = multiply(g.normal, g.normal, friction[2], friction[3])
    slope = add(g.damping, g.damping, slope[0], slope[1])
    level = multiply(g.normal, g.normal, friction[0], friction[1])
    viscous = multiply(g.damping, g.damping, low, high)
    level = add(level[0], level[1], viscous[0], viscous[1])
    reference = contact.run.params.reference
    return slope[0], slope[1], level[0] - reference, level[1] - reference


@kernel
def rule_is_kept(contact: Contact, rule: int, n: int, low: float, high: float) -> bool:
    """Return True if it is proven that the rule keeps its branch between two places in piece n of the history."""
    seen, g = slice_of(contact, n, low, high), contact.search.resistance
    if rule != Rule.MAXIMAL and not static_strength_is_below(contact, seen):
        return False
    attempt, begin = Attempt(contact, seen, np.full(1, MOST_CELLS)), 0.0
    for k in range(len(g.pieces)):
        piece, end = g.pieces[k], g.knots[k] if k < len(g.knots) else FASTEST
        bound_at_slips(g.formulas, piece, seen.slip_low, seen.slip_high)
        own = (max(begin, seen.rate_low), min(end, seen.rate_high))
        if own[0] <= own[1] and not slope_and_level(contact, piece, own[0], own[1])[0] > 0.0:
            return False
        if rule != Rule.MAXIMAL and not is_beyond(attempt, piece, -1, begin, min(end, seen.rate_low)):
            return False
        if rule != Rule.MINIMAL and not is_beyond(attempt, piece, 1, max(begin, seen.rate_high), min(end, top_of(contact, seen))):
            return False
        begin = end
    return True


@kernel
def top_of(contact: Contact, seen: Slice) -> float:
    """Return a slip rate (m/s) beyond which g exceeds every load of the slice."""
    params = contact.run.params
    return max((seen.load_high + params.largest_drop) / params.damping, seen.rate_high) * ABOVE_ALL


@kernel
def static_strength_is_below(contact: Contact, seen: Slice) -> bool:
    """Return True if every load of the slice is proven to exceed the static strength."""
    g, params = contact.search.resistance, contact.run.params
    bound_at_slips(g.formulas, g.pieces[0], seen.slip_low, seen.slip_high)
    level = slope_and_level(contact, g.pieces[0], 0.0, 0.0)[3]
    return level + params.normal * params.static_excess < seen.load_low


@kernel
def is_beyond(attempt: Attempt, piece: int, way: int, begin: float, end: float) -> bool:
    """Return True if g is proven to be beyond every load between two slip rates: above them (way 1) or below them (-1)."""
    contact, seen = attempt.contact, attempt.seen
    cells, waiting = contact.search.resistance.cells, 1 if begin < end else 0
    cells[0, 0], cells[0, 1] = begin, end
    for _ in range(MOST_CELLS + DEPTH):
        if waiting == 0:
            return True
        waiting -= 1
        attempt.left[0] -= 1
        low, high = cells[waiting, 0], cells[waiting, 1]
        if attempt.left[0] < 0:
            return False
        slope_low, slope_high, least, most = slope_and_level(contact, piece, low, high)
        if slope_low > 0.0 or (least > seen.load_high if way > 0 else most < seen.load_low):
            continue
        middle = cut_between(low, high)
        _, _, there_low, there_high = slope_and_level(contact, piece, middle, middle)
        reach = max(abs(slope_low), abs(slope_high)) * max(high - middle, middle - low) * (1.0 + 1e-15)
        if there_low - reach > seen.load_high if way > 0 else there_high + reach < seen.load_low:
            continue
        lost = there_high < seen.load_low if way > 0 else there_low > seen.load_high
        if lost or high - low <= NARROW * high or waiting + 2 > DEPTH:
            return False
        cells[waiting, 0], cells[waiting, 1] = middle, high
        cells[waiting + 1, 0], cells[waiting + 1, 1] = low, middle
        waiting += 2
    return False
