"""The sentence above the panels: regime, what happened, what jumped, and what rests on the selection rule."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.contact.uniqueness import Uniqueness
from stickslip.explorer.model.findings import Found
from stickslip.explorer.model.words import several, short
from stickslip.observables.rule_influence import RuleInfluence
from stickslip.problem.problem import Problem

NEAR = 5e-4
"""Distance of a ratio from 1 below which the distance is given instead of the ratio."""
FEW = 2
"""Largest number of jumps that are all named."""
RULES = {
    "perfect-delay": "the rule of perfect delay",
    "maxwell": "Maxwell's rule",
    "minimal": "the minimal rule",
    "maximal": "the maximal rule",
}
"""How the built-in selection rules are called."""
CAUSES = {
    "start": "at the start",
    "fold": "at a fold",
    "echo": "by an echo",
    "loading": "by the loading",
    "healing": "by healing",
}
"""How a jump came about, by the cause that the table of shocks gives."""


def sentence(found: Found, contact: Uniqueness, influence: RuleInfluence) -> str:
    """Return the sentence on a run; its parts end with full stops."""
    parts = (_regime(found.solution.problem, contact, influence), _motion(found), _jumped(found), _rule(influence))
    return " ".join(f"{part[0].upper()}{part[1:]}." for part in parts if part)


def _regime(problem: Problem, contact: Uniqueness, influence: RuleInfluence) -> str:
    if problem.body.has_inertia:
        return f"regular: {'the contact' if problem.body.has_waves else 'the block'} has a mass, so its slip rate cannot jump"
    if problem.friction.states:
        return "regular: friction has a state, and one slip rate at every load"
    meanings = {
        "regular": "one slip rate at every load",
        "irregular": "several slip rates at some loads",
        "continuum": "all slip rates of an interval at one load",
    }
    return f"{influence.regime}: {meanings[influence.regime]}{_against_critical(problem, contact)}"


def _against_critical(problem: Problem, contact: Uniqueness) -> str:
    """Return how the parameter that has a critical value compares with it, as the end of a sentence."""
    name, critical = contact.critical_parameter, contact.critical_value
    if name is None or critical is None:
        return ""
    one = problem.parameters[name]
    ratio = one.value / critical if critical else math.inf
    own, limit = short(one.value, one.unit), f"its critical value of {short(critical, one.unit)}"
    word = one.name.rpartition(".")[2].replace("_", " ")
    if ratio == 1.0:
        return f"; {word} = {own} is {limit}"
    if abs(ratio - 1.0) > NEAR:
        return f"; {word} = {own} is {ratio:.4g} times {limit}"
    return f"; {word} is {'above' if ratio > 1.0 else 'below'} {limit} by {abs(ratio - 1.0):.2g} of it"


def _motion(found: Found) -> str:
    """Return what moved: slip, pulses and arrest of the largest event."""
    event, span = found.largest, found.solution.history.span
    if event is None:
        moved = found.total_slip
        lasts = short(span[1] - span[0], "s")
        return f"it slips {short(moved, 'm')} in {lasts}, too slowly for a slip event" if moved else f"nothing slips in {lasts}"
    number = len(found.events)
    head = f"{several(number, 'slip event')}{', the largest' if number > 1 else ''} of"
    text = f"{head} {short(event.slip, 'm')} in {several(int(event.pulses), 'pulse')}, at up to {short(event.peak_rate, 'm/s')}"
    if np.isnan(event.end):
        return f"{text}, which goes on at the end of the run"
    return f"{text}, {'arrested at ' + short(event.end, 's') if number == 1 else 'lasting ' + short(event.duration, 's')}"


def _jumped(found: Found) -> str:
    """Return how the slip rate jumps: every jump of a few, the largest of many."""
    shocks = found.shocks
    if found.solution.problem.body.has_inertia:  # which has been said
        return ""
    if shocks.empty:
        return "the slip rate never jumps"
    if len(shocks) <= FEW:
        return f"the slip rate jumps {' and '.join(_jump(shock) for shock in shocks.itertuples())}"
    largest = int(np.argmax(np.abs(shocks.rate_after - shocks.rate_before)))
    return f"the slip rate jumps {len(shocks)} times, most {_jump(list(shocks.itertuples())[largest])}"


def _jump(shock: Any) -> str:
    before, after = (short(rate, "m/s") if rate else "rest" for rate in (shock.rate_before, shock.rate_after))
    when = "" if shock.cause == "start" else f" at {short(shock.time, 's')}"
    return f"from {before} to {after} {CAUSES[shock.cause]}{when}"


def _rule(influence: RuleInfluence) -> str:
    """Return what rests on the selection rule."""
    rule = RULES.get(influence.rule, f"the rule {influence.rule}")
    if influence.regime == "regular":
        return ""
    if influence.folds_move:
        return f"the folds move as it slips, and the run rests on {rule}"
    decided, shocks = int(influence.shocks.sum()), len(influence.shocks)
    if influence.since is None and not decided:
        return f"nothing rests on {rule}: the load was never between the folds"
    since = "" if influence.since is None else f"; it had its first choice at {short(influence.since, 's')}"
    return f"{rule} decided {decided or 'none'} of {several(shocks, 'jump')}{since}"
