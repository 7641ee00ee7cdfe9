"""Branches of the contact equation at any law slip, in compiled code: one scan of g' over slip rates, with each fold refined.

g(s) = Z s + S mu is the resistance at slip rate s. The scan ends at the fastest slip rate that a load allows. It serves rules that
must be checked in every step; where a choice between branches is due, they come from `contact.branches`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.contact.contact_equation import friction_of, piece_at
from stickslip.engine.state.layout import Branch, Floats, Integers
from stickslip.engine.state.workspace import Run, borrow, branches_in

FLAT = 1e-11
"""Slope of g, relative to Z (1), up to which g counts as flat and not as rising."""
BETWEEN = 16
"""Number of parts (1) into which a step of the scan is divided if g' may touch zero near it."""
PANELS = 4096
"""Largest number of panels of an area (1) beside its knots: the smallest float becomes the largest by half as many doublings."""
FIRST_PANEL = 1e5
"""End of the first panel of an area, in units of the slowest rate scanned: a thousandth of the law's slowest scale."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Gauss's rule on [-1, 1] for the panels of an area."""


class Contact(NamedTuple):
    """Hold a contact at one law slip, with the slip rates to scan and the table for its branches."""

    run: Run
    piece: int  # piece of the law that holds there, if its knots are in slip
    law_slip: float  # m, minus its initial value
    scan: Floats  # m/s, ascending
    steepness: Floats  # Pa s/m: g' at each slip rate of the scan, minus the slope that counts as flat
    found: Branch  # the branches that the scan finds, with room for as many as it has slip rates; only their ends are set


class Scan(NamedTuple):
    """Hold the memory of a scan, which callers keep between scans."""

    rates: Floats  # m/s, ascending
    steepness: Floats  # (rates,)
    found: Floats  # table of Branch, with a row for each rate


def new_scan(rates: Floats) -> Scan:
    """Return the memory of a scan at these slip rates (m/s, ascending)."""
    return Scan(rates, np.zeros(len(rates)), Branch.table(len(rates)))


@kernel
def contact_of(run: Run, piece: int, law_slip: float, scan: Scan) -> Contact:
    """Return the contact of a run at a law slip (m, minus its initial value), under a piece of the law."""
    return Contact(run, piece, law_slip, scan.rates, scan.steepness, branches_in(scan.found))


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
    contact.run.friction.by_rate += contact.run.params.impedance
    return contact.run.params.impedance * rate + contact.run.friction.stress


@kernel
def strength_at(contact: Contact) -> float:
    """Return the static strength (Pa), minus the reference strength."""
    friction_there(contact, 0.0)
    return contact.run.params.normal * (contact.run.friction.coefficient + contact.run.params.static_excess)


@kernel
def steepness(contact: Contact, rate: float) -> float:
    """Return g' (Pa s/m) at a slip rate, minus the slope that counts as flat: positive on a branch."""
    level_at(contact, rate)
    return contact.run.friction.by_rate - FLAT * contact.run.params.impedance


@kernel
def fold_between(contact: Contact, low: float, high: float) -> float:
    """Return the slip rate (m/s) at which g' changes sign, on the side where g rises, by safeguarded false position."""
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
    """Return True if zero may be near: the middle one of three values of one sign is small against their second difference."""
    if before * here <= 0.0 or here * after <= 0.0:
        return False
    bend = before - 2.0 * here + after
    return 4.0 * abs(here) < (bend if here > 0.0 else -bend)


@kernel
def note_fold(contact: Contact, rate: float, count: int) -> int:
    """Write the begin (count even) or the end (count odd) of a branch into the table, and return the count of ends so far."""
    branch = count // 2
    if branch < len(contact.scan):
        level = level_at(contact, rate)
        if count % 2 == 0:
            contact.found[branch].rate_from, contact.found[branch].excess_from = rate, level
        else:
            contact.found[branch].rate_to, contact.found[branch].excess_to = rate, level
    return count + 1


@kernel
def fold_in(contact: Contact, low: float, high: float, count: int) -> int:
    """Write the folds between two slip rates into the table, from signs of g' at BETWEEN steps; return the count of ends so far."""
    step, before = (high - low) / BETWEEN, low
    for k in range(1, BETWEEN + 1):
        rate = high if k == BETWEEN else low + k * step
        if (steepness(contact, rate) > 0.0) != (count % 2 == 1):
            count = note_fold(contact, fold_between(contact, before, rate), count)
        before = rate
    return count


@kernel
def find_branches(contact: Contact, top: float) -> int:
    """Fill the table with the branches that begin below the slip rate `top` (m/s), and return their number."""
    slope, length = contact.steepness, 0
    while length < len(contact.scan) and (length < 2 or contact.scan[length - 1] <= top):
        slope[length] = steepness(contact, contact.scan[length])
        length += 1
    starts_flat = slope[0] >= -2.0 * FLAT * contact.run.params.impedance and slope[1] > 0.0
    count = note_fold(contact, 0.0, 0) if slope[0] > 0.0 or starts_flat else 0
    refined = 0  # index of the scan up to which g' has been evaluated between rates, too
    for k in range(1, length):
        if (slope[k] > 0.0) != (count % 2 == 1):
            count = note_fold(contact, fold_between(contact, contact.scan[k - 1], contact.scan[k]), count)
        elif k + 1 < length and may_touch(slope[k - 1], slope[k], slope[k + 1]):
            for end in range(max(k, refined + 1), k + 2):
                count = fold_in(contact, contact.scan[end - 1], contact.scan[end], count)
            refined = k + 1
    branches = min((count + 1) // 2, len(contact.scan))
    if count % 2 == 1:
        contact.found[branches - 1].rate_to = contact.found[branches - 1].excess_to = math.inf
    return branches


@kernel
def branches_at(places: Integers, law_slip: float, piece: int, scan: Scan) -> int:
    """Find all branches at a law slip (m, minus its initial value) and return their number; lend `places` before."""
    return find_branches(contact_of(borrow(places), piece, law_slip, scan), math.inf)


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
        if not low < step < high:
            step = 0.5 * (low + high)
        if abs(step - s) <= 1e-16 * s or step in (low, high):
            break
        s = step
    return s


@kernel
def area(contact: Contact, load: float, low: float, high: float) -> float:
    """Return the integral of g - load over slip rates (Pa m/s), by Gauss's rule between knots, on panels that double in width.

    It is NaN if PANELS do not reach from `low` to `high`.
    """
    run, whole, start, first = contact.run, 0.0, low, FIRST_PANEL * contact.scan[1]
    for _ in range(PANELS + run.pieces):
        if not start < high:
            return whole
        end = min(max(first, 2.0 * start), high)
        if run.counts.knots_in_rate == 1:
            for k in range(run.pieces - 1):
                if start < run.law[k].knot < end:
                    end = run.law[k].knot
        half = 0.5 * (end - start)
        for k in range(len(NODES)):
            whole += half * WEIGHTS[k] * (level_at(contact, start + half * (1.0 + NODES[k])) - load)
        start = end
    return math.nan
