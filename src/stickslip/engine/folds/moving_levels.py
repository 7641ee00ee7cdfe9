"""Levels of the built-in selection rules where folds move with slip, in compiled code: along a step, and for a choice.

A level is a load at which a rule leaves a branch or rest. At a place in a step the branches are found by `moving_branches`; the
distance of the load from the levels of its branch is the *room* that the rule leaves to it. The step crosses a level where the room
falls below zero. Between two places `rule_proof` shows that it does not; a slice of the step without this proof is halved, down to
SHORTEST_SLICE, and what is still open then is noted.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.contact.contact_equation import towards
from stickslip.engine.folds.moving_branches import (
    Contact,
    Search,
    area,
    branch_near,
    contact_of,
    find_branches,
    rate_at,
    strength_at,
)
from stickslip.engine.folds.rule_proof import law_slip_in, rule_is_kept
from stickslip.engine.series.polynomial import NONE, evaluate
from stickslip.engine.state.layout import Integers, Rule
from stickslip.engine.state.workspace import Run, borrow

COMPILED_RULES = {"minimal": Rule.MINIMAL, "maximal": Rule.MAXIMAL, "maxwell": Rule.MAXWELL}
"""Rules whose levels are calculated here. Perfect delay needs none; others are followed by their tables (`branch_table.Step`)."""

LEVEL_ROUNDING = 1e-11
"""Distance of a load from a level, relative to the reference strength (1), up to which it has not crossed the level."""
EXACT, SHORTEST = 1e-14, 1e-15
"""Tolerances of a crossing (1): distance of the load from the level, relative to the reference strength, and width of the bracket
in the step. Equal areas use the first, relative to the normal stress."""
SHORTEST_SLICE = 2.0**-20
"""Length of a slice, as a share of a step (1), that is not halved any more."""
SHORTEST_IN_WINDOW = 0.125
"""The same under Maxwell's rule, for which there is no proof while several solutions exist: the ends of slices decide."""
MOST_SLICES = 1000
"""Largest number of slices of a step that are looked at one by one; after that only the end of the step is."""
NOTED = 1e-3
"""Share of a step (1) without a proof from which on this is noted."""
NEXT = 1e-4
"""Share of a slice (1) after which a load that starts at a level is checked again: if it is outside there, it leaves at once."""


class View(NamedTuple):
    """Hold a step of slip to which a rule is applied, and what its branches are searched with."""

    run: Run
    step: int  # its piece of the history
    rule: int  # a code of `Rule`, not PERFECT_DELAY
    search: Search


@kernel
def fastest(run: Run, load: float) -> float:
    """Return a slip rate (m/s) that no solution of the contact equation at this load exceeds."""
    return (load + run.params.largest_drop) / run.params.damping * (1.0 + 1e-12)


@kernel
def rate_on(contact: Contact, load: float, branch: int) -> float:
    """Return the slip rate (m/s) on a branch of the table, at a load between the levels of its ends."""
    low, high = contact.found[branch].rate_from, contact.found[branch].rate_to
    return rate_at(contact, load, low, max(low, min(high, fastest(contact.run, load))))


@kernel
def better_by(contact: Contact, load: float, slow: float, fast: float) -> float:
    """Return the height (Pa) of the load above the level of equal areas of two slip rates that solve for it; exact at the level."""
    return -area(contact, load, slow, fast) / (fast - slow)


@kernel
def maxwell_room(contact: Contact, rate: float, load: float, branches: int) -> float:
    """Return the distance (Pa) of the load from the level at which Maxwell's rule prefers another solution; negative beyond it."""
    room, own = math.inf, branch_near(contact, rate, branches)
    if load <= strength_at(contact):
        room = better_by(contact, load, 0.0, rate) if rate > 0.0 else room
    for k in range(branches):
        if k == own or not contact.found[k].excess_from < load < contact.found[k].excess_to:
            continue
        other = rate_on(contact, load, k)
        if other < rate:
            room = min(room, better_by(contact, load, other, rate))
        elif other > rate:
            room = min(room, -better_by(contact, load, rate, other))
    return room


@kernel
def room_in(view: View, xi: float) -> float:
    """Return the distance (Pa) of the load from the ends of the interval in which the rule keeps the branch; negative outside."""
    run, n = view.run, view.step
    step, law_slip = run.history[n], law_slip_in(run, n, xi)
    contact = contact_of(run, step.law_piece, law_slip, view.search)
    rate = abs(evaluate(step.rate, xi))
    load = towards(run, evaluate(step.load, xi), step.mode)
    branches = find_branches(contact, max(rate, fastest(run, load)) * (1.0 + 1e-9))
    if branches == 0:
        return math.inf  # more turns than there is room for
    own = branch_near(contact, rate, branches)
    low, high = contact.found[own].excess_from, contact.found[own].excess_to
    if view.rule == Rule.MINIMAL:
        low = max(low, strength_at(contact))
        for k in range(own):
            low = max(low, contact.found[k].excess_to)
    elif view.rule == Rule.MAXIMAL:
        for k in range(own + 1, branches):
            high = min(high, contact.found[k].excess_from)
    room = min(load - low, high - load)
    return min(room, maxwell_room(contact, rate, load, branches)) if view.rule == Rule.MAXWELL else room


@kernel
def place_of_crossing(view: View, low: float, high: float) -> float:
    """Return the place at which the room, not negative at `low` and negative at `high`, falls through zero.

    The method is false position with the Illinois modification, which keeps an end from standing still.
    Source: Dowell & Jarratt 1971, BIT 11, 168.
    """
    slack = EXACT * view.run.params.reference
    above, below = max(room_in(view, low), slack), room_in(view, high)
    side, x = 0, high
    for _ in range(100):
        x = (low * below - high * above) / (below - above)
        value = room_in(view, x)
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
def crossing_in(places: Integers, step: int, rule: int, search: Search) -> float:
    """Return the place in a step, on [0, 1], at which the load first leaves the interval in which the rule keeps the branch.

    NONE means that it stays inside. `places` comes from `workspace.lend`, `step` is a piece of the history.
    """
    view = View(borrow(places), step, rule, search)
    contact = contact_of(view.run, view.run.history[step].law_piece, 0.0, search)
    slack, shortest = LEVEL_ROUNDING * view.run.params.reference, SHORTEST_IN_WINDOW if rule == Rule.MAXWELL else SHORTEST_SLICE
    low, length, open_ = 0.0, 1.0, 0.0
    for k in range(MOST_SLICES):
        if low >= 1.0:
            break
        high = low + length if k < MOST_SLICES - 1 else 1.0
        if not rule_is_kept(contact, rule, step, low, high):
            if length > shortest and k < MOST_SLICES - 1:
                length *= 0.5
                continue
            if room_in(view, high) < -slack:
                if room_in(view, low) <= slack and room_in(view, low + NEXT * (high - low)) <= 0.0:
                    return low
                return place_of_crossing(view, low, high)
            open_ += high - low
        low = high
        doubled = 2.0 * length
        if doubled <= 1.0 and low / doubled == math.floor(low / doubled):
            length = doubled
    view.run.counts.undecided += 1 if open_ > NOTED else 0
    return NONE


@kernel
def gap(contact: Contact, slow: int, fast: int, load: float) -> tuple[float, float]:
    """Return the integral (Pa m/s) of g - load from a slow to a fast branch (-1: stick) and its derivative by the load (m/s)."""
    start = rate_on(contact, load, slow) if slow >= 0 else 0.0
    end = rate_on(contact, load, fast)
    return area(contact, load, start, end), start - end


@kernel
def equal_areas(contact: Contact, slow: int, fast: int, low: float, high: float) -> float:
    """Return the load between two others at which two branches (-1: stick) have equal areas, by safeguarded Newton steps."""
    load = 0.5 * (low + high)
    for _ in range(100):
        value, slope = gap(contact, slow, fast, load)
        if value > 0.0:
            low = load
        elif value < 0.0:
            high = load
        else:
            break
        step = load - value / slope
        if not low < step < high and step != load:
            step = 0.5 * (low + high)
        if abs(step - load) <= EXACT * contact.run.params.normal or step in (low, high):
            load = step
            break
        load = step
    return load


@kernel
def hand_over(contact: Contact, slow: int, fast: int, stick_to: float) -> float:
    """Limit the intervals in which two branches (-1: stick) are kept to where Maxwell's rule prefers each to the other.

    Loads are in Pa, minus the reference strength. Return the load up to which stick is kept: `stick_to` or a lower one.
    """
    run, found = contact.run, contact.found
    low = found[fast].excess_from if slow < 0 else max(found[slow].excess_from, found[fast].excess_from)
    ends = strength_at(contact) if slow < 0 else found[slow].excess_to
    high = min(ends, found[fast].excess_to)
    if not low < high:
        return stick_to
    if gap(contact, slow, fast, low)[0] <= 0.0:
        level = low
    elif gap(contact, slow, fast, high)[0] >= 0.0:
        run.branch_table[fast].keep_from = max(run.branch_table[fast].keep_from, high)
        return stick_to
    else:
        level = equal_areas(contact, slow, fast, low, high)
        run.branch_table[fast].keep_from = max(run.branch_table[fast].keep_from, level)
    if slow < 0:
        return min(stick_to, level)
    run.branch_table[slow].keep_to = min(run.branch_table[slow].keep_to, level)
    return stick_to


@kernel
def set_maxwell_levels(places: Integers, search: Search) -> None:
    """Write the levels of Maxwell's rule at the present slip into the setup, in which branches are still kept up to their ends.

    `places` is the memory that `workspace.lend` has filled; a branch that is never preferred gets an empty interval.
    """
    run = borrow(places)
    contact = contact_of(run, run.counts.piece, run.state.law_slip, search)
    for k in range(run.branches):
        known, found = run.branch_table[k], contact.found[k]
        found.rate_from, found.rate_to = known.rate_from, known.rate_to
        found.excess_from, found.excess_to = known.excess_from, known.excess_to
    strength = strength_at(contact)
    stick_to = strength
    for fast in range(run.branches):
        for slow in range(-1, fast):
            stick_to = hand_over(contact, slow, fast, stick_to)
    for k in range(run.branches):
        if run.branch_table[k].keep_from >= run.branch_table[k].keep_to:
            run.branch_table[k].keep_from, run.branch_table[k].keep_to = math.inf, -math.inf
    run.params.stick_to = stick_to - strength
