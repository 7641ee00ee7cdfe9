"""What a selection rule is, and the names under which rules are known.

A rule decides which slip rate a contact takes where several solve its equation. It is a function of the resistance g and of its
stable branches, slowest first, that returns a table of the loads at which each of them is kept:

    def lazy(g, stable):
        return ss.selection.SelectionTable(stick_to=0.0, keep_from=..., keep_to=...)

    ss.Problem(..., selection=lazy)            the function itself, or
    ss.selection.register("lazy", lazy)        a name for it, which scenarios may then use
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from stickslip.foundation.errors import InputError, nearest

if TYPE_CHECKING:
    from stickslip.contact.branches import Branch
    from stickslip.contact.equation import Resistance

SELECTION_RULES = ("perfect-delay", "maxwell", "minimal", "maximal")
"""Rules that are always known (`stickslip.contact.rules.selection`)."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,59}")


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

    def is_taken(self, branch: int) -> bool:
        """Whether the rule takes the branch at any load."""
        return self.keep_from[branch] <= self.keep_to[branch]

    def climb(self, branch: int, excess: float) -> int:
        """The branch taken when the load has risen past what `branch` (-1: stick) keeps."""
        return next(j for j in range(branch + 1, len(self.keep_to)) if self.is_taken(j) and excess <= self.keep_to[j])

    def descend(self, branch: int, excess: float) -> int:
        """The branch taken when the load has fallen below what `branch` keeps; -1 is stick."""
        return next((j for j in range(branch - 1, -1, -1) if self.keep_from[j] <= min(excess, self.keep_to[j])), -1)


class SelectionRule(Protocol):
    """A rule: from a resistance and its branches, slowest first, to a table. It must not depend on anything else."""

    def __call__(self, g: Resistance, stable: tuple[Branch, ...], /) -> SelectionTable: ...

    def __hash__(self) -> int: ...


registered: dict[str, SelectionRule] = {}
"""Rules that users have registered, by name."""


def register(name: str, rule: SelectionRule) -> None:
    """Make a rule known by a name, for problems, scenarios and saved runs. A name may be registered anew.

    Raises InputError for a name that is not made of letters, digits, - and _, for one of the built-in rules, and for a rule
    that cannot be called.
    """
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise InputError(f"selection.register: a name is made of up to 60 letters, digits, - and _, got {ascii(name)[:60]}")
    if name in SELECTION_RULES:
        raise InputError(f"selection.register: '{name}' is a rule of its own, give yours another name")
    if not callable(rule):
        raise InputError(f"selection.register: the rule '{name}' must be a function (g, stable) -> SelectionTable")
    registered[name] = rule


def names() -> tuple[str, ...]:
    """Every rule that can be named: the built-in ones, then the registered ones."""
    return (*SELECTION_RULES, *registered)


def unknown(name: str) -> str:
    """The end of a sentence about a name that is no rule."""
    hint = nearest(name, names())
    return f"is unknown; {hint}" if hint.startswith("did") else f"is unknown; {hint} or a registered one"


def name_of(rule: str | SelectionRule) -> str:
    """The name of a rule: the registered one, else that of the function."""
    if isinstance(rule, str):
        return rule
    known = next((name for name, one in registered.items() if one is rule), None)
    return known or str(getattr(rule, "__name__", type(rule).__name__))


def checked(rule: Any) -> str | SelectionRule:
    """A rule as a problem keeps it: by its name where it has a registered one, else the function. Raises InputError."""
    if isinstance(rule, str):
        if rule not in names():
            raise InputError(f"Problem: selection rule {ascii(rule)[:60]} {unknown(rule)}")
        return rule
    if not callable(rule) or rule.__hash__ is None:
        raise InputError(f"Problem: selection must be a name or a function (g, stable), got {type(rule).__name__}")
    name = name_of(rule)
    if name in registered and registered[name] is rule:
        return name
    if not _NAME.fullmatch(name) or name in names():
        reason = "is that of another rule" if name in names() else "is not made of letters, digits, - and _"
        raise InputError(f"Problem: selection: the function's name, '{name}', {reason}, and a saved run is known by it; rename it")
    kept: SelectionRule = rule
    return kept
