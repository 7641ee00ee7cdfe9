"""Branches of the contact equation at any law slip, in compiled code: the turns of g (`turns`) and the load at each of them.

g(v) = Z v + S mu is the resistance at slip rate v. The search ends at the fastest slip rate that a load allows. It serves rules
that must be checked in every step; where a choice between branches is due, they come from `contact.branches`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.contact.contact_equation import friction_of, piece_at
from stickslip.engine.folds.panels import MOST_PANELS, NODES, WEIGHTS, panels_between
from stickslip.engine.folds.turns import Resistance, Turns, find_turns, folds_of, room_for_turns
from stickslip.engine.state.layout import Branch, Floats, Integers
from stickslip.engine.state.workspace import Run, borrow, branches_in

MOST_EVALUATIONS = 20_000
"""Largest number of slip rates and cells at which one search for branches bounds g'."""
MOST_TURNS = 1024
"""Largest number of turns of g (1) for which there is room."""


class Search(NamedTuple):
    """Hold what the branches of a contact are searched with, and the memory for what is found; callers keep it between searches."""

    resistance: Resistance
    start: float  # m: law slip at the start of the run
    turns: Turns
    folds: Floats  # m/s
    edges: Floats  # m/s: panels of an area
    found: Floats  # table of Branch, of which only the ends are set


class Contact(NamedTuple):
    """Hold a contact at one law slip, with the table for its branches."""

    run: Run
    piece: int  # piece of the law that holds there, if its knots are in slip
    law_slip: float  # m, minus its initial value
    search: Search
    found: Branch


def new_search(resistance: Resistance, start: float) -> Search:
    """Return a search for the branches of a resistance; `start` is the law slip (m) at the start of the run."""
    turns, folds, edges = room_for_turns(MOST_TURNS), np.zeros(2 * MOST_TURNS), np.zeros(MOST_PANELS + 1)
    return Search(resistance, start, turns, folds, edges, Branch.table(MOST_TURNS + 1))


@kernel
def contact_of(run: Run, piece: int, law_slip: float, search: Search) -> Contact:
    """Return the contact of a run at a law slip (m, minus its initial value), under a piece of the law."""
    if run.counts.knots_in_rate == 0:
        search.resistance.pieces[0] = piece
    return Contact(run, piece, law_slip, search, branches_in(search.found))


@kernel
def friction_there(contact: Contact, rate: float) -> None:
    """Write S (mu - mu_reference) at a slip rate, its derivatives and mu - mu_reference into run.friction."""
    run = contact.run
    piece = piece_at(run, rate) if run.counts.knots_in_rate == 1 else contact.piece
    friction_of(run, piece, contact.law_slip, rate)


@kernel
def level_at(contact: Contact, rate: float) -> float:
    """Return g (Pa, minus the reference strength) at a slip rate >= 0, where 0 means 0+, and leave g' in run.friction.by_rate."""
    friction_there(contact, rate)
    contact.run.friction.by_rate += contact.run.params.damping
    return contact.run.params.damping * rate + contact.run.friction.stress


@kernel
def strength_at(contact: Contact) -> float:
    """Return the static strength (Pa), minus the reference strength."""
    friction_there(contact, 0.0)
    return contact.run.params.normal * (contact.run.friction.coefficient + contact.run.params.static_excess)


@kernel
def find_branches(contact: Contact, top: float) -> int:
    """Fill the table with the branches that begin below the slip rate `top` (m/s), and return their number."""
    search = contact.search
    seen = find_turns(search.resistance, search.start + contact.law_slip, top, MOST_EVALUATIONS, search.turns)
    folds = folds_of(search.turns, max(seen.intervals, 0), search.folds)
    falls_at_first = seen.at_rest < 0 or (seen.at_rest == 0 and (folds % 2 == 1) == (seen.at_end > 0))
    begin, fold, branches = 0.0, 0, 0
    if falls_at_first:
        begin, fold = (search.folds[0], 1) if folds > 0 else (math.inf, 0)
    for _ in range(folds + 1):
        if begin == math.inf:
            break
        branch = contact.found[branches]
        branch.rate_from, branch.excess_from, branches = begin, level_at(contact, begin), branches + 1
        branch.rate_to = branch.excess_to = begin = math.inf
        if fold < folds:
            branch.rate_to, branch.excess_to = search.folds[fold], level_at(contact, search.folds[fold])
            begin, fold = (search.folds[fold + 1] if fold + 1 < folds else math.inf), fold + 2
    return branches


@kernel
def branches_at(places: Integers, law_slip: float, piece: int, search: Search) -> int:
    """Find all branches at a law slip (m, minus its initial value) and return their number; lend `places` before."""
    return find_branches(contact_of(borrow(places), piece, law_slip, search), math.inf)


@kernel
def branch_near(contact: Contact, rate: float, branches: int) -> int:
    """Return the branch nearest to a slip rate: at a fold, rounding may put the rate outside of the branch to which it belongs."""
    nearest, least = 0, math.inf
    for k in range(branches):
        away = max(contact.found[k].rate_from - rate, rate - contact.found[k].rate_to, 0.0)
        if away < least:
            nearest, least = k, away
    return nearest


@kernel
def rate_at(contact: Contact, load: float, low: float, high: float) -> float:
    """Return the slip rate (m/s) at which g meets a load, between two rates between which g rises, by safeguarded Newton steps."""
    s = 0.5 * (low + high)
    for _ in range(100):
        error = level_at(contact, s) - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            break
        step = s - error / contact.run.friction.by_rate if contact.run.friction.by_rate > 0.0 else 0.5 * (low + high)
        if not low < step < high and step != s:  # where Newton has converged, s itself bounds the interval
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * s or step in (low, high):
            break
        s = step
    return s


@kernel
def area(contact: Contact, load: float, low: float, high: float) -> float:
    """Return the integral of g - load over slip rates (Pa m/s)."""
    search, whole = contact.search, 0.0
    count = panels_between(search.resistance, search.start + contact.law_slip, low, high, search.edges)
    for n in range(count):
        half = 0.5 * (search.edges[n + 1] - search.edges[n])
        for k in range(len(NODES)):
            whole += half * WEIGHTS[k] * (level_at(contact, search.edges[n] + half * (1.0 + NODES[k])) - load)
    return whole
