"""Branches of the contact equation at any law slip, in compiled code: one scan of g' over slip rates, each fold polished.

The scan looks as far as the fastest slip rate that a load allows. It is for rules that must be looked at in every step; where a
choice is due, the branches come from `contact.branches`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.contact_step.contact_equation import friction_of, piece_at
from stickslip.engine.state.layout import Floats, Integers
from stickslip.engine.state.workspace import Run, borrow

FLAT = 1e-11
"""Slope of g, relative to Z, up to which a branch does not rise."""
BETWEEN = 16
"""Parts into which two steps of the scan are divided where g' may touch zero between them."""
FIRST_PANEL = 1e5
"""The first panel of an area ends at this many times the slowest rate of the scan: a thousandth of the law's slowest scale."""
RATE_FROM, RATE_TO, LEVEL_FROM, LEVEL_TO, STEEPNESS = range(5)
"""Rows of the table that a scan fills: ends of the branches, g there (Pa, minus the reference), and g' along the scan."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


class Contact(NamedTuple):
    """A contact at one law slip: the run, its piece of a law with knots in slip, the slip, rates to scan, room for branches."""

    run: Run
    piece: int
    law_slip: float  # m, minus the initial one
    scan: Floats
    table: Floats


def new_branches(scan: Floats) -> Floats:
    """An empty table with room for as many branches as there are rates in a scan."""
    return np.zeros((5, len(scan)))


@kernel
def friction_there(contact: Contact, rate: float) -> None:
    """Leave S (mu - mu_reference) at a slip rate, its derivatives and mu - mu_reference in run.value, as `friction_of` does."""
    run = contact.run
    piece = piece_at(run, rate) if run.counts.knots_in_rate == 1 else contact.piece
    friction_of(run, piece, contact.law_slip, rate, run.value)


@kernel
def level_at(contact: Contact, rate: float) -> float:
    """g (Pa, minus the reference) at a slip rate >= 0, 0 for 0+; its slope is left in run.value[1]."""
    friction_there(contact, rate)
    contact.run.value[1] += contact.run.par.impedance
    return contact.run.par.impedance * rate + contact.run.value[0]


@kernel
def strength_at(contact: Contact) -> float:
    """Static strength (Pa), minus the reference."""
    friction_there(contact, 0.0)
    return contact.run.par.normal * (contact.run.value[3] + contact.run.par.static_excess)


@kernel
def steepness(contact: Contact, rate: float) -> float:
    """g', less what counts as flat: positive on a branch."""
    level_at(contact, rate)
    return contact.run.value[1] - FLAT * contact.run.par.impedance


@kernel
def fold_between(contact: Contact, low: float, high: float) -> float:
    """The slip rate at which g' changes sign, on the side of it where g rises: false position, kept from standing still."""
    first, last = steepness(contact, low), steepness(contact, high)
    rises, side = first > 0.0, 0
    for k in range(200):
        if high - low <= 4e-16 * high:
            break
        x = (low * last - high * first) / (last - first) if k % 3 < 2 else 0.5 * (low + high)
        if not low < x < high:
            x = 0.5 * (low + high)
        value = steepness(contact, x)
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
def note_fold(contact: Contact, rate: float, count: int) -> int:
    """Write where a branch begins (count even) or ends (odd) into the table. Returns the count of ends so far."""
    branch = count // 2
    if branch < contact.table.shape[1]:
        level = level_at(contact, rate)
        if count % 2 == 0:
            contact.table[RATE_FROM, branch], contact.table[LEVEL_FROM, branch] = rate, level
        else:
            contact.table[RATE_TO, branch], contact.table[LEVEL_TO, branch] = rate, level
    return count + 1


@kernel
def fold_in(contact: Contact, low: float, high: float, count: int) -> int:
    """Note the folds where g' changes sign between slip rates that are looked at one after the other."""
    step, before = (high - low) / BETWEEN, low
    for k in range(1, BETWEEN + 1):
        rate = high if k == BETWEEN else low + k * step
        if (steepness(contact, rate) > 0.0) != (count % 2 == 1):
            count = note_fold(contact, fold_between(contact, before, rate), count)
        before = rate
    return count


@kernel
def find_branches(contact: Contact, top: float) -> int:
    """Fill the table with the branches that begin below a slip rate. Returns how many there are."""
    slope, length = contact.table[STEEPNESS], 0
    while length < len(contact.scan) and (length < 2 or contact.scan[length - 1] <= top):
        slope[length] = steepness(contact, contact.scan[length])
        length += 1
    starts_flat = slope[0] >= -2.0 * FLAT * contact.run.par.impedance and slope[1] > 0.0
    count = note_fold(contact, 0.0, 0) if slope[0] > 0.0 or starts_flat else 0
    refined = 0  # up to this rate of the scan g' has been looked at between rates, too
    for k in range(1, length):
        if (slope[k] > 0.0) != (count % 2 == 1):
            count = note_fold(contact, fold_between(contact, contact.scan[k - 1], contact.scan[k]), count)
        elif k + 1 < length and may_touch(slope[k - 1], slope[k], slope[k + 1]):
            for end in range(max(k, refined + 1), k + 2):
                count = fold_in(contact, contact.scan[end - 1], contact.scan[end], count)
            refined = k + 1
    branches = min((count + 1) // 2, contact.table.shape[1])
    if count % 2 == 1:
        contact.table[RATE_TO, branches - 1] = contact.table[LEVEL_TO, branches - 1] = math.inf
    return branches


@kernel
def branches_at(places: Integers, law_slip: float, piece: int, scan: Floats, table: Floats) -> int:
    """Fill the table with all branches at a law slip (m, minus the initial one). `places` comes from `workspace.lend`."""
    return find_branches(Contact(borrow(places), piece, law_slip, scan, table), math.inf)


@kernel
def branch_near(contact: Contact, rate: float, branches: int) -> int:
    """The branch to which a slip rate belongs: the nearest one, for at a fold it may lie outside by rounding."""
    nearest, least = 0, math.inf
    for k in range(branches):
        away = max(contact.table[RATE_FROM, k] - rate, rate - contact.table[RATE_TO, k], 0.0)
        if away < least:
            nearest, least = k, away
    return nearest


@kernel
def rate_at(contact: Contact, load: float, low: float, high: float) -> float:
    """The slip rate between two others, between which g rises, at which it meets a load: Newton's method, kept inside."""
    s = 0.5 * (low + high)
    for _ in range(100):
        error = level_at(contact, s) - load
        if error > 0.0:
            high = s
        elif error < 0.0:
            low = s
        else:
            break
        step = s - error / contact.run.value[1] if contact.run.value[1] > 0.0 else 0.5 * (low + high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * s or step in (low, high):
            break
        s = step
    return s


@kernel
def area(contact: Contact, load: float, low: float, high: float) -> float:
    """Integral of g - load over slip rates, in Pa m/s: Gauss's rule between knots, on panels that double in width."""
    run, whole, start, first = contact.run, 0.0, low, FIRST_PANEL * contact.scan[1]
    while start < high:
        end = min(max(first, 2.0 * start), high)
        if run.counts.knots_in_rate == 1:
            for k in range(run.pieces - 1):
                if start < run.knot[k] < end:
                    end = run.knot[k]
        half = 0.5 * (end - start)
        for k in range(len(NODES)):
            whole += half * WEIGHTS[k] * (level_at(contact, start + half * (1.0 + NODES[k])) - load)
        start = end
    return whole
