"""Selection rules as data: the branch that the slip rate takes if several solve the contact equation.

A rule receives the branches of one resistance and returns a table of the loads at which each of them is kept; the engine only
reads this table. Source: Campillo et al. 1996, section 3 (perfect delay: paths ODABE and EBCDO of Fig. 4; Maxwell: equal areas).
"""

from __future__ import annotations

import math
from functools import lru_cache

from stickslip.contact.branches import Branch, branches_of
from stickslip.contact.equation import Resistance, resistance
from stickslip.contact.rules.maxwell import best_branches
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.problem.selection_rule import SelectionRule, SelectionTable, registered

Branches = tuple[Branch, ...]


def perfect_delay(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Keep the branch as long as it exists, then take the nearest one in the direction of the change of load."""
    return SelectionTable(0.0, tuple(b.excess_from for b in stable), tuple(b.excess_to for b in stable))


def minimal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the smallest stable slip rate: a branch is left as soon as stick or a slower branch exists."""
    slower = [max([0.0, *(b.excess_to for b in stable[:i])]) for i in range(len(stable))]
    keep_from = tuple(max(b.excess_from, below) for b, below in zip(stable, slower, strict=True))
    return SelectionTable(0.0, keep_from, tuple(b.excess_to for b in stable))


def maximal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the largest stable slip rate: stick or a branch is left as soon as a faster branch exists."""
    faster = [min([math.inf, *(b.excess_from for b in stable[i + 1 :])]) for i in range(len(stable))]
    keep_to = tuple(min(b.excess_to, above) for b, above in zip(stable, faster, strict=True))
    return SelectionTable(min([0.0, *(b.excess_from for b in stable)]), tuple(b.excess_from for b in stable), keep_to)


@lru_cache(maxsize=16)  # it takes some hundredths of a second, and a run and its tables ask for it in turn
def maxwell(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Take the stable slip rate with the smallest integral of (g - load) ds: branches change at loads of equal areas."""
    kept = best_branches(g, stable)
    never = (math.inf, -math.inf)
    intervals = [kept.get(i, never) for i in range(len(stable))]
    return SelectionTable(kept[-1][1], tuple(low for low, _ in intervals), tuple(high for _, high in intervals))


RULES: dict[str, SelectionRule] = {rule.__name__.replace("_", "-"): rule for rule in (perfect_delay, maxwell, minimal, maximal)}
"""The built-in rules, keyed by their names in problems and scenarios (`stickslip.selection.SELECTION_RULES`)."""


def rule_of(problem: Problem) -> SelectionRule:
    """Return the selection rule of a problem. Raises InputError for a name that is not registered in this process."""
    if not isinstance(problem.selection, str):
        return problem.selection
    known = RULES | registered
    if problem.selection not in known:
        raise InputError(f"selection rule '{problem.selection}' is unknown here: stickslip.selection.register it first")
    return known[problem.selection]


def selection_table(problem: Problem, law_slip: float | None = None) -> tuple[Branches, SelectionTable]:
    """Return the branches of the problem's contact at a law slip (m; default: the initial one), and the table of its rule.

    Raises InputError for a block, which has no contact equation, and for a rule whose table cannot be followed.
    """
    g = resistance(problem, law_slip)
    stable = branches_of(g)
    return stable, table_of(problem, g, stable)


def table_of(problem: Problem, g: Resistance, stable: Branches) -> SelectionTable:
    """Return the table of the problem's rule. Raises InputError if it cannot be followed: see `flaw`."""
    table = rule_of(problem)(g, stable)
    wrong = flaw(table, stable)
    if wrong:
        raise InputError(f"selection rule '{problem.rule}': {wrong}")
    return table


def flaw(table: SelectionTable, stable: Branches) -> str:
    """Return a description of what is wrong with a table, "" if nothing is.

    Stick cannot be kept beyond the static strength, nor a branch at loads at which it does not exist. At each load at which a
    branch is left, the branch taken next must be kept; otherwise the contact would have no branch to take, or would switch back
    and forth.
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
    return next((_dead_end(i, up) for i in (-1, *kept) for up in (True, False) if not _leads_on(table, i, up)), "")


def _dead_end(branch: int, up: bool) -> str:
    place = "stick" if branch < 0 else f"branch {branch}"
    return f"when the load {'rises' if up else 'falls'} beyond what {place} is kept for, no branch is kept there"


def _leads_on(table: SelectionTable, branch: int, up: bool) -> bool:
    """Return True if at all loads above (or below) those at which a branch is kept, the branch that is taken next is kept."""
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
