"""Selection rules as data: the branch that the slip rate takes if several solve the contact equation.

A rule receives the branches of one resistance and returns a table with the interval of loads that keeps each of them; the engine
only reads this table.
Source: Campillo et al. 1996, section 3 (perfect delay: paths ODABE and EBCDO of Fig. 4; Maxwell: equal areas).

Maxwell's rule takes at each load the stable slip rate with the smallest phi(s) = integral from 0 to s of (g - load) ds. Source:
Campillo et al. 1996, section 3. Stick has phi = 0. The faster a branch, the faster its phi falls as the load grows. Therefore each
branch has the smallest phi on a single interval of loads. Two neighbours change places at the load that makes the areas between g
and the load line equal. Loads are excesses over the static strength, in Pa.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import combinations, pairwise, product

import numpy as np

from stickslip.contact.areas import area
from stickslip.contact.branches import branches_of, rate_on, resistance
from stickslip.contact.folds import MOST_FOLDS, certificate
from stickslip.contact.roots import bracketed_newton
from stickslip.contact.slopes import FASTEST_BOUNDED
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Branch, Problem, Resistance, SelectionRule, SelectionTable, registered

MOST_COMPARED = 150
"""Largest number of branches that Maxwell's rule compares: a minute's work."""

_STICK = Branch(0.0, 0.0, -math.inf, 0.0)


def best_branches(g: Resistance, stable: tuple[Branch, ...]) -> dict[int, tuple[float, float]]:
    """Return the interval of excess (Pa) where each branch has the smallest phi, keyed by its index (-1: stick).

    Branches that never have the smallest phi are left out.
    """
    candidates = {-1: _STICK, **dict(enumerate(stable))}
    levels = {end for b in candidates.values() for end in (b.excess_from, b.excess_to) if math.isfinite(end)}
    levels |= {level for a, b in combinations(candidates.values(), 2) if (level := equal_area_level(g, a, b)) is not None}
    cuts = [-math.inf, *sorted(levels), math.inf]
    best: dict[int, tuple[float, float]] = {}
    for low, high in pairwise(cuts):
        excess = _between(low, high)
        alive = {i: b for i, b in candidates.items() if b.excess_from <= excess <= b.excess_to}
        phi = {i: area(g, 0.0, _rate(g, b, excess), excess) for i, b in alive.items()}
        winner = min(phi, key=phi.__getitem__)
        best[winner] = (best.get(winner, (low, high))[0], high)
    return best


def _between(low: float, high: float) -> float:
    """Return an excess inside an interval that may be infinite on one side."""
    if math.isinf(low):
        return high - 1.0 - abs(high)
    return low + 1.0 + abs(low) if math.isinf(high) else low + 0.5 * (high - low)


def equal_area_level(g: Resistance, slower: Branch, faster: Branch) -> float | None:
    """Return the excess (Pa) that gives two branches the same phi, to rounding; None if there is no such excess."""
    low, high = max(slower.excess_from, faster.excess_from), min(slower.excess_to, faster.excess_to)
    if not low < high or _gap(g, slower, faster, low)[0] <= 0.0 or _gap(g, slower, faster, high)[0] >= 0.0:
        return None
    return bracketed_newton(lambda excess: _gap(g, slower, faster, excess), low, high, high, rising=False)


def _gap(g: Resistance, slower: Branch, faster: Branch, excess: float) -> tuple[float, float]:
    """Return phi of the faster branch minus phi of the slower one, and its derivative with respect to the excess."""
    start, end = _rate(g, slower, excess), _rate(g, faster, excess)
    return area(g, start, end, excess), start - end


def _rate(g: Resistance, branch: Branch, excess: float) -> float:
    return 0.0 if branch is _STICK else rate_on(g, branch, excess)


Branches = tuple[Branch, ...]


def levels(rule: str, start: Floats, end: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the largest load of stick, and the smallest and largest load of each branch under a rule, for any number of contacts.

    A branch exists at loads from `start` to `end`; branches are along the last axis, slowest first. If a contact has fewer branches
    than others, the rest start at inf and end at -inf.
    """
    stick_to, last = np.zeros(start.shape[:-1]), start.shape[-1]
    if rule == "minimal":
        slower = np.maximum.accumulate(np.insert(end, 0, 0.0, axis=-1), axis=-1)[..., :last]
        return stick_to, np.maximum(start, slower), end
    if rule == "maximal":
        faster = np.minimum.accumulate(np.insert(start, last, np.inf, axis=-1)[..., ::-1], axis=-1)[..., last - 1 :: -1]
        return start.min(axis=-1, initial=0.0), start, np.minimum(end, faster)
    return stick_to, start, end


def _table(rule: str, stable: Branches) -> SelectionTable:
    start, end = np.array([b.excess_from for b in stable], float), np.array([b.excess_to for b in stable], float)
    stick_to, keep_from, keep_to = levels(rule, start, end)
    return SelectionTable(float(stick_to), tuple(keep_from.tolist()), tuple(keep_to.tolist()))


def perfect_delay(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Keep the branch as long as it exists, then take the nearest one in the direction of the change of load."""
    return SelectionTable(0.0, tuple(one.excess_from for one in stable), tuple(one.excess_to for one in stable))


def minimal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the smallest stable slip rate: a branch is left as soon as stick or a slower branch exists."""
    return _table("minimal", stable)


def maximal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the largest stable slip rate: stick or a branch is left as soon as a faster branch exists."""
    return _table("maximal", stable)


@lru_cache(maxsize=16)  # it takes some hundredths of a second, and a run and its tables ask for it in turn
def maxwell(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the stable slip rate with the smallest integral of (g - load) ds: branches change at loads of equal areas."""
    if len(stable) > MOST_COMPARED:
        raise InputError(
            f"selection rule 'maxwell': it compares all branches with each other, at most {MOST_COMPARED}, and there "
            f"are {len(stable)}: take 'perfect-delay', 'minimal' or 'maximal'"
        )
    kept = best_branches(g, stable)
    never = (math.inf, -math.inf)
    intervals = [kept.get(i, never) for i in range(len(stable))]
    return SelectionTable(kept[-1][1], tuple(low for low, _ in intervals), tuple(high for _, high in intervals))


RULES: dict[str, SelectionRule] = {rule.__name__.replace("_", "-"): rule for rule in (perfect_delay, maxwell, minimal, maximal)}
"""The built-in rules, keyed by their names in problems and scenarios (`stickslip.selection.SELECTION_RULES`)."""
OF_LEVELS = ("perfect-delay", "minimal", "maximal")
"""Names of the rules that need nothing but `levels`: a batch supports them."""


def rule_of(problem: Problem) -> SelectionRule:
    """Return the selection rule of a problem. Raises InputError for a name that is not registered in this process."""
    if not isinstance(problem.selection, str):
        return problem.selection
    rule = registered.get(problem.selection, RULES.get(problem.selection))
    if rule is None:
        raise InputError(f"selection rule '{problem.selection}' is unknown here: stickslip.selection.register it first")
    return rule


def selection_table(
    problem: Problem, law_slip: float | None = None, normal: float | None = None
) -> tuple[Branches, SelectionTable]:
    """Return the branches of the problem's contact at a law slip (m) and a normal load (Pa), and the table of its rule.

    By default these are the initial ones. Raises InputError for a block, which has no contact equation, for a rule whose table
    cannot be followed, and if the load may reach values where not all branches are known.
    """
    g = resistance(problem, law_slip, normal)
    stable = branches_of(g)
    if g.law.depends_on_rate and certificate(g).reach < FASTEST_BOUNDED and not load_bound(problem, g) <= g.largest_load:
        raise InputError(
            f"{type(g.law).__name__}: g = Z v + S mu(v) turns more than {MOST_FOLDS} times, and its branches are known up to a "
            f"load of {g.largest_load:.3g} {g.load_unit} only, which the load of this problem may exceed"
        )
    return stable, table_of(problem, g, stable)


def load_bound(problem: Problem, g: Resistance) -> float:
    """Return a bound (Pa) of the load's magnitude at any time of a run, infinite if none is known.

    With r <= 1 the share of a wave that the driver sends back, the load of one round trip follows from that before by
    load' = r (2 Z v - load) + c, with a constant c: see paper eq. (13). Let V be the slip rate without friction, Z V = c / (1 - r).
    Then load' - Z V = r (Z (v - V) - friction), where Z (v - V) + friction = load - Z V, and v has the sign of friction: the
    distance |load - Z V| does not grow, or is at most |Z V| plus the largest friction, if v lies between 0 and V. A dashpot at the
    contact adds to friction.
    """
    body, far = problem.body, problem.load if problem.far_stress is None else problem.far_stress
    rigid = problem.is_driven_rigidly
    if problem.varies or (problem.far_stress_rate != 0.0 and not rigid) or body.reflection >= 1.0:
        return math.inf
    freely = problem.first_pull_rate + (0.0 if rigid else float(far) / body.driver_impedance)  # type: ignore[arg-type] # constant here
    apart = abs(problem.load) + 3.0 * body.impedance * max(abs(problem.first_pull_rate), abs(freely))
    return body.impedance * abs(freely) + max(apart, (body.impedance + body.dashpot) * abs(freely) + g.largest_friction)


def table_of(problem: Problem, g: Resistance, stable: Branches) -> SelectionTable:
    """Return the table of the problem's rule. Raises InputError if it cannot be followed: see `flaw`."""
    table = rule_of(problem)(g, stable)
    wrong = flaw(table, stable)
    if wrong:
        raise InputError(f"selection rule '{problem.rule}': {wrong}")
    return table


def flaw(table: SelectionTable, stable: Branches) -> str:
    """Return a description of the fault of a table, "" if it has none.

    Stick cannot be kept beyond the static strength, nor a branch at loads where it does not exist. When the load leaves the
    interval of a branch, the branch taken next must be kept; otherwise the contact would have no branch to take, or would switch
    back and forth.
    """
    if not isinstance(table, SelectionTable):
        return f"it must return a SelectionTable, got {type(table).__name__}"
    if not len(table.keep_from) == len(table.keep_to) == len(stable):
        return f"{len(stable)} branches, but keep_from has {len(table.keep_from)} numbers and keep_to has {len(table.keep_to)}"
    if any(math.isnan(level) for level in (table.stick_to, *table.keep_from, *table.keep_to)):
        return "a level is not a number"
    if table.stick_to > 0.0:
        return f"stick_to must be at most 0, the static strength, got {table.stick_to:g} Pa"
    kept = [i for i in range(len(stable)) if table.keep_from[i] <= table.keep_to[i]]
    for i in kept:
        if table.keep_from[i] < stable[i].excess_from or table.keep_to[i] > stable[i].excess_to:
            exists = f"exists from {stable[i].excess_from:g} to {stable[i].excess_to:g} Pa"
            return f"branch {i} {exists}, but is kept from {table.keep_from[i]:g} to {table.keep_to[i]:g} Pa"
    for i, up in product((-1, *kept), (True, False)):
        if not _leads_on(table, i, up):
            place = "stick" if i < 0 else f"branch {i}"
            return f"when the load {'rises' if up else 'falls'} beyond what {place} is kept for, no branch is kept there"
    return ""


def _leads_on(table: SelectionTable, branch: int, up: bool) -> bool:
    """Return True if, at all loads above (or below) the interval of a branch, the branch that is taken next is kept."""
    if up:
        level = table.stick_to if branch < 0 else table.keep_to[branch]
        for low, high in zip(table.keep_from[branch + 1 :], table.keep_to[branch + 1 :], strict=True):
            if level < high and low <= high:  # low > high marks a branch that is never taken
                if low > level:
                    return False
                level = high
        return level == math.inf
    level = -math.inf if branch < 0 else table.keep_from[branch]
    for low, high in reversed(list(zip(table.keep_from[: max(branch, 0)], table.keep_to[: max(branch, 0)], strict=True))):
        if low < level and low <= high:
            if high < level:
                return False
            level = low
    return level == -math.inf or table.stick_to >= level
