"""Define selection rules and keep a register of their names.

A rule decides which slip rate a contact takes if several solve its equation. It is a function of the resistance g and of the stable
branches of g, slowest first, and returns a table of the loads between which each branch is kept:

    def lazy(g, stable):
        return ss.selection.SelectionTable(stick_to=0.0, keep_from=..., keep_to=...)

    ss.Problem(..., selection=lazy)            the function itself, or
    ss.selection.register("lazy", lazy)        a name for it, which scenarios may then use
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Protocol

from stickslip.foundation.arguments import CheckedArguments, for_users
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.resistance import Branch, Resistance

PERFECT_DELAY = "perfect-delay"
"""Name of the rule that keeps a branch as long as it exists: the only one where folds move with slip."""
SELECTION_RULES = (PERFECT_DELAY, "maxwell", "minimal", "maximal")
"""Names of the built-in rules (`stickslip.contact.rules.selection`)."""

_NAME_OF_RULE = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,59}")
"""Allowed names of rules: scenario files and saved runs contain them."""


@dataclass(frozen=True)
class SelectionTable(CheckedArguments):
    """The loads at which a contact leaves stick, and between which it stays on each branch: excesses over the static strength (Pa).

    A stuck contact stays stuck while excess <= stick_to; otherwise it takes the first branch i, slowest first, that is ever taken
    with excess <= keep_to[i]. A branch that is never taken has keep_from > keep_to.

    A contact on branch i stays there while keep_from[i] <= excess <= keep_to[i]. Above that range it takes the first branch j > i
    that is ever taken with excess <= keep_to[j]. Below that range it takes the last branch j < i that is ever taken with
    keep_from[j] <= excess, and sticks if there is none.

    For backward slip all signs are reversed.
    """

    stick_to: float
    keep_from: tuple[float, ...]
    keep_to: tuple[float, ...]

    def is_taken(self, branch: int) -> bool:
        """Return True if the rule takes the branch at some load."""
        return self.keep_from[branch] <= self.keep_to[branch]

    def climb(self, branch: int, excess: float) -> int:
        """Return the branch taken when the load has risen above the range that keeps `branch`; -1 denotes stick.

        `excess` is the load minus the static strength (Pa).
        """
        return next(j for j in range(branch + 1, len(self.keep_to)) if self.is_taken(j) and excess <= self.keep_to[j])

    def descend(self, branch: int, excess: float) -> int:
        """Return the branch taken when the load has fallen below the range that keeps `branch`; -1 denotes stick.

        `excess` is the load minus the static strength (Pa).
        """
        return next((j for j in range(branch - 1, -1, -1) if self.keep_from[j] <= min(excess, self.keep_to[j])), -1)


class SelectionRule(Protocol):
    """A function that returns a selection table for a resistance and its stable branches, slowest first.

    It must depend on nothing else, and must be hashable.
    """

    def __call__(self, g: Resistance, stable: tuple[Branch, ...], /) -> SelectionTable:
        """Return the table of the resistance and its stable branches."""

    def __hash__(self) -> int: ...


registered: dict[str, SelectionRule] = {}
"""Rules that users have registered, by name."""


@for_users
def register(name: str, rule: SelectionRule) -> None:
    """Register a selection rule under a name, for problems, scenarios and saved runs.

    The name is a letter, then up to 59 letters, digits, - or _; one that is already registered gets the new rule. The rule is a
    function (g, stable) that returns a `SelectionTable`. Raises InputError if the name is not allowed or belongs to a built-in
    rule, or the rule cannot be called.
    """
    if not isinstance(name, str) or not _NAME_OF_RULE.fullmatch(name):
        raise InputError(f"selection.register: a name is made of up to 60 letters, digits, - and _, got {ascii(name)[:60]}")
    if name in SELECTION_RULES:
        raise InputError(f"selection.register: '{name}' is the name of a built-in rule; choose another name")
    if not callable(rule):
        raise InputError(f"selection.register: the rule '{name}' must be a function (g, stable) -> SelectionTable")
    registered[name] = rule


def names() -> tuple[str, ...]:
    """Return the names of all rules, first the built-in ones and then the registered ones."""
    return (*SELECTION_RULES, *registered)


def unknown(name: str) -> str:
    """Return the end of an error message about a name that no rule has."""
    hint = nearest(name, names())
    return f"is unknown; {hint}" if hint.startswith("did") else f"is unknown; {hint} or a registered one"


def name_of(rule: str | SelectionRule) -> str:
    """Return the name of a rule: its registered name, else the name of the function."""
    if isinstance(rule, str):
        return rule
    known = next((name for name, one in registered.items() if one is rule), None)
    return known or str(getattr(rule, "__name__", type(rule).__name__))


def checked(rule: Any) -> str | SelectionRule:
    """Return a rule as a problem stores it: its name if it is built in or registered, else the function.

    Raise InputError for an unknown name, for an object that is not a hashable function, and for a function whose own name cannot
    identify it in a saved run.
    """
    if isinstance(rule, str):
        if rule not in names():
            raise InputError(f"Problem: selection rule {ascii(rule)[:60]} {unknown(rule)}")
        return rule
    if not callable(rule) or rule.__hash__ is None:
        raise InputError(f"Problem: selection must be a name or a function (g, stable), got {type(rule).__name__}")
    name = name_of(rule)
    if name in registered and registered[name] is rule:
        return name
    if not _NAME_OF_RULE.fullmatch(name) or name in names():
        reason = "is that of another rule" if name in names() else "is not made of letters, digits, - and _"
        raise InputError(f"Problem: selection: the function's name, '{name}', {reason}, and a saved run is known by it; rename it")
    kept: SelectionRule = rule
    return kept
