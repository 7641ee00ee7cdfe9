"""The sentence above the panels: regime, what happened, what jumped, and what rests on the selection rule."""

from __future__ import annotations

import math

import numpy as np

from stickslip.contact.uniqueness import Uniqueness
from stickslip.explorer.model.events import Found
from stickslip.explorer.model.words import several, short
from stickslip.observables.rule_influence import RuleInfluence
from stickslip.problem.problem import Problem


def sentence(found: Found, contact: Uniqueness, influence: RuleInfluence) -> str:
    """Return the sentence on a run; its parts end with full stops."""
    parts = (_regime(found.solution.problem, contact, influence), _motion(found), _jumped(found), _rule(influence))
    return " ".join(f"{part[0].upper()}{part[1:]}." for part in parts if part)


def _regime(problem: Problem, contact: Uniqueness, influence: RuleInfluence) -> str:
    if problem.body.has_inertia:
        return "regular: the contact has a mass, so its slip rate cannot jump"
    if problem.friction.state is not None:
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
    times = f"{ratio:.4g} times" if abs(ratio - 1.0) > 5e-4 else f"{abs(ratio - 1.0):.2g} {'above' if ratio > 1.0 else 'below'}"
    if ratio == 1.0:
        times = "exactly at"
    return f"; {one.name} = {short(one.value, one.unit)} is {times} the critical value {short(critical, one.unit)}"


def _motion(found: Found) -> str:
    """Return what moved: slip, pulses and arrest of the largest event."""
    event, span = found.largest, found.solution.history.span
    if event is None:
        moved = found.total_slip
        if moved == 0.0:
            return "nothing slips"
        return f"it slips {short(moved, 'm')} in {short(span[1] - span[0], 's')}, without a slip event"
    number = len(found.events)
    first = f"{several(number, 'slip event')}" + (", the largest of" if number > 1 else " of")
    text = f"{first} {short(event.slip, 'm')} in {several(int(event.pulses), 'pulse')}, up to {short(event.peak_rate, 'm/s')}"
    if np.isnan(event.end):
        return f"{text}, still slipping at the end of the run"
    lasts = short(event.duration, "s")
    return f"{text}, arrest {'at ' + short(event.end, 's') if number == 1 else 'after ' + lasts}"


def _jumped(found: Found) -> str:
    """Return what the largest jumps of the slip rate are."""
    shocks = found.shocks
    if shocks.empty:
        return "the slip rate never jumps"
    largest = shocks.iloc[int(np.argmax(np.abs(shocks.rate_after - shocks.rate_before)))]
    step = f"{short(largest.rate_before, 'm/s')} to {short(largest.rate_after, 'm/s')}"
    which = "" if len(shocks) == 1 else ", at most"
    return f"the slip rate jumps {several(len(shocks), 'time')}{which} from {step} at {short(largest.time, 's')} ({largest.cause})"


def _rule(influence: RuleInfluence) -> str:
    """Return what rests on the selection rule."""
    if influence.regime == "regular":
        return ""
    if influence.folds_move:
        return f"the folds move as it slips, and the run rests on the rule {influence.rule}"
    decided, shocks = int(influence.shocks.sum()), len(influence.shocks)
    if influence.since is None and not decided:
        return f"nothing rests on the rule {influence.rule}: the load was never between the folds"
    since = "" if influence.since is None else f", the first choice at {short(influence.since, 's')}"
    return f"the rule {influence.rule} decided {decided} of {several(shocks, 'jump')}{since}"
