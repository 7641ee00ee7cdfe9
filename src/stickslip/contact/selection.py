"""Selection rules as data: which branch the slip rate takes where several solve the contact equation.

Source: Campillo et al. 1996, section 3 (perfect delay: paths ODABE and EBCDO of Fig. 4; Maxwell: equal areas). A rule looks at
the branches of one resistance and says at which loads each of them is kept; the engine only reads the table.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from stickslip.contact.branches import Branch, branches_of
from stickslip.contact.maxwell import best_branches
from stickslip.contact.resistance import Resistance, resistance
from stickslip.problem import Problem

Branches = tuple[Branch, ...]


@dataclass(frozen=True)
class SelectionTable:
    """Excess of the load over the static strength (Pa) at which stick is left, and between which each branch is kept.

    Read it so: stuck, stay while excess <= stick_to, else take the first branch i with excess <= keep_to[i]. On branch i stay
    while keep_from[i] <= excess <= keep_to[i]; above, take the first j > i with excess <= keep_to[j]; below, the last j < i with
    keep_from[j] <= excess, else stick. A branch that is never taken has keep_from > keep_to. Backwards everything is mirrored.
    """

    stick_to: float
    keep_from: tuple[float, ...]
    keep_to: tuple[float, ...]

    def climb(self, branch: int, excess: float) -> int:
        """The branch taken when the load has risen past what `branch` (-1: stick) keeps."""
        return next(j for j in range(branch + 1, len(self.keep_to)) if excess <= self.keep_to[j])

    def descend(self, branch: int, excess: float) -> int:
        """The branch taken when the load has fallen below what `branch` keeps; -1 is stick."""
        return next((j for j in range(branch - 1, -1, -1) if self.keep_from[j] <= excess), -1)


class SelectionRule(Protocol):
    """A rule: from a resistance and its branches, slowest first, to a table."""

    def __call__(self, g: Resistance, stable: Branches, /) -> SelectionTable: ...


def perfect_delay(g: Resistance, stable: Branches, /) -> SelectionTable:
    """Keep the branch as long as it exists, then take the nearest one in the direction in which the load has left it."""
    return SelectionTable(0.0, tuple(b.excess_from for b in stable), tuple(b.excess_to for b in stable))


def minimal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """The smallest stable slip rate: a branch is left as soon as stick or a slower branch exists."""
    slower = [max([0.0, *(b.excess_to for b in stable[:i])]) for i in range(len(stable))]
    keep_from = tuple(max(b.excess_from, below) for b, below in zip(stable, slower, strict=True))
    return SelectionTable(0.0, keep_from, tuple(b.excess_to for b in stable))


def maximal(g: Resistance, stable: Branches, /) -> SelectionTable:
    """The largest stable slip rate: stick or a branch is left as soon as a faster branch exists."""
    faster = [min([math.inf, *(b.excess_from for b in stable[i + 1 :])]) for i in range(len(stable))]
    keep_to = tuple(min(b.excess_to, above) for b, above in zip(stable, faster, strict=True))
    return SelectionTable(min([0.0, *(b.excess_from for b in stable)]), tuple(b.excess_from for b in stable), keep_to)


def maxwell(g: Resistance, stable: Branches, /) -> SelectionTable:
    """The stable slip rate with the smallest integral of (g - load) ds: branches change hands at equal areas."""
    kept = best_branches(g, stable)
    never = (math.inf, -math.inf)
    intervals = [kept.get(i, never) for i in range(len(stable))]
    return SelectionTable(kept[-1][1], tuple(low for low, _ in intervals), tuple(high for _, high in intervals))


RULES: dict[str, SelectionRule] = {rule.__name__.replace("_", "-"): rule for rule in (perfect_delay, maxwell, minimal, maximal)}
"""Every rule by its name in problems and scenarios (`stickslip.problem.SELECTION_RULES`)."""


def selection_table(problem: Problem, law_slip: float | None = None) -> tuple[Branches, SelectionTable]:
    """Branches of the problem's contact at a law slip (m; default: the start) and the table of its selection rule.

    Raises InputError for a block, which has no contact equation of its own.
    """
    g = resistance(problem, law_slip)
    stable = branches_of(g)
    return stable, RULES[problem.selection](g, stable)
