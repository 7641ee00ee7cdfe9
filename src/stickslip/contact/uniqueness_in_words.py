"""Uniqueness of the slip rate in words: the paragraph that `Uniqueness.summary` is, and lines on its regime, folds and jumps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from stickslip.contact.critical import critical_normal_stress
from stickslip.contact.folds import Fold
from stickslip.contact.rules.loop import Jump
from stickslip.foundation.names import si_unit
from stickslip.foundation.show import NamedLine, brief, exact_range, exactly
from stickslip.problem import Problem, Resistance

MOST_SHOWN = 6
"""`repr` and `summary` show at most this many folds, and jumps."""
MOST_UNDECIDED = 10
"""At most this many intervals of slip rates are listed as undecided, because they may or may not hold a fold."""


INERTIA = (
    "The {body} has inertia: its slip rate is a state that changes continuously, and the motion is unique (regular) whatever the "
    "friction law. The selection rule ({rule}) has no effect."
)
STATE = (
    "{law}: regular. The slip rate follows from load and state, and is unique: at a given state friction does not fall with the "
    "slip rate. The selection rule ({rule}) has no effect."
)
STATE_FALLS = (
    "{law}: regular as long as friction, at a given state, falls with the slip rate by less than waves carry away. The slip rate "
    "then follows from load and state, and is unique. A run that is seen to get beyond that ends as off the law; a contact with "
    "mass goes on. The selection rule ({rule}) has no effect."
)

WITH_DASHPOT = " Here Z is that of the waves and the dashpot of the contact together."


def summary_of(
    problem: Problem, g: Resistance, critical: tuple[str, float] | None, window: tuple[float, float] | None, jumps: tuple[Jump, ...]
) -> str:
    """Return a paragraph that summarises the result for the user."""
    law, idle = _named(problem, g), f"The selection rule ({problem.rule}) has no effect."
    bound = ""
    if critical:
        found = problem.parameters[critical[0]]
        there, here = (brief(value, found.unit, 9) for value in (critical[1], found.value))
        bound = f" The critical value is {critical[0]} = {there}; here {critical[0]} = {here}."
    if not problem.friction.depends_on_rate:
        reason = "friction does not depend on the slip rate and the impedance Z is positive"
        return f"{law}: regular. The slip rate is unique: {reason}. {idle}{bound}"
    if window is None:
        reason = "the resistance Z v + S mu(v) rises with the slip rate everywhere"
        return f"{law}: regular. The slip rate is unique: {reason}. {idle}{bound}"
    unit, rate = problem.load_unit, problem.unit_of("slip_rate")
    flat = "; ".join(
        f"{exact_range((p.rate_from, p.rate_to), rate, 6)} at a load of {brief(g.strength + p.excess, unit, 9)}" for p in g.plateaus
    )
    sizes = [f"a continuum of slip rates, {flat}, where no rule picks one"] if flat else []
    if window[0] < window[1]:
        end = window[1]
        side = "at" if end == 0.0 else f"{brief(abs(end), unit)} {'above' if end > 0.0 else 'below'}"
        sizes.append(f"a window of {brief(end - window[0], unit)} that ends {side} the static strength")
    steps = "; ".join(
        f"{j.direction} from {exact_range((j.rate_before, j.rate_after), rate, 6)} at a load of {brief(j.load, unit, 9)}"
        for j in jumps[:MOST_SHOWN]
    )
    steps += f"; and {len(jumps) - MOST_SHOWN} more" if len(jumps) > MOST_SHOWN else ""
    moves = f"jumps {steps}" if steps else "makes no jump"
    several = f"Several slip rates solve the contact equation in {' and in '.join(sizes)}."
    return f"{law}: {'continuum' if flat else 'irregular'}. {several}{bound} The rule '{problem.rule}' {moves}."


def _named(problem: Problem, g: Resistance) -> str:
    law = problem.friction
    moving = law.depends_on_slip and law.depends_on_rate
    slip = f" at a slip of {g.law_slip:.6g} {problem.unit_of('slip')}" if moving else ""
    return f"{type(law).__name__}{slip}{' under the first normal load' if problem.normal_varies else ''}"


def said_of_pressing(problem: Problem, g: Resistance) -> str:
    """Return a sentence on the regimes under a normal load that varies; empty if it is constant, or friction is not of the rate."""
    history, unit = problem.normal_load, problem.load_unit
    if history is None or not problem.friction.depends_on_rate:
        return ""
    stress = critical_normal_stress(g)
    low, high = brief(history.lowest, unit), brief(history.highest, unit)
    ranges = f" The normal load varies from {low} to {high}: "
    if stress is None or history.highest <= stress:
        return f"{ranges}the contact is regular under all of it."
    if history.lowest >= stress:
        return f"{ranges}the contact is irregular under all of it, and the folds move with it."
    return f"{ranges}the contact is regular up to {brief(stress, unit, 9)} and irregular above, where the folds move with it."


def _units(contact: Any) -> tuple[str, str]:
    """Return the units of loads and slip rates of a `Uniqueness`."""
    loads = "Pa" if contact.problem is None else contact.problem.load_unit
    return loads, si_unit("slip_rate", loads)


def regime_lines(contact: Any) -> Iterator[NamedLine]:
    """Yield the regime, the critical value, and the loads with several slip rates."""
    yield "regime", f"{contact.regime}, {contact.certificate}"
    if contact.critical_parameter is not None and contact.critical_value is not None:
        yield "critical", f"{contact.critical_parameter} = {brief(contact.critical_value, contact.critical_unit)}"
    if contact.window is not None:
        low, high = (brief(excess, _units(contact)[0]) for excess in contact.window)
        yield "window", f"load minus static strength from {low} to {high}"


def fold_lines(contact: Any, most: int | None = None) -> Iterator[NamedLine]:
    """Yield the folds, what is not decided of them, and what depends on the rule: jumps, and the loop that they enclose.

    Of folds and of jumps `most` are shown, by default all. Those of backward slip follow where friction differs there.
    """
    loads, rates = _units(contact)
    for fold in contact.folds[:most]:
        yield "fold", f"slip rate {exactly(fold.rate, rates)}, load {brief(fold.load, loads, 12)}{_proof(fold, rates)}"
    yield from _more("folds", contact.folds[:most], contact.folds)
    for low, high in contact.undecided[:MOST_UNDECIDED]:
        yield "not decided", f"whether there is a fold between {exact_range((low, high), rates, between=' and ')}"
    for jump in contact.jumps[:most]:
        change = jump.traction_after - jump.traction_before
        at = f"slip rate {exact_range((jump.rate_before, jump.rate_after), rates)} at a load of {brief(jump.load, loads, 12)}"
        yield f"jump {jump.direction} *", f"{at}; traction changes by {brief(change, loads)}"
    yield from _more("jumps", contact.jumps[:most], contact.jumps)
    if contact.jumps:
        retraced = ": the path is retraced" if contact.loop_area == 0.0 else " in the plane of load and slip rate"
        yield "loop *", f"the load going up and down encloses {brief(contact.loop_area, f'{loads} {rates}')}{retraced}"
        yield "*", f"depends on the rule '{contact.rule}'; nothing else above does."
    for name, text in () if contact.backward is None else fold_lines(contact.backward, most):
        yield name if name in ("", "*") else f"backward {name}", text


def _more(what: str, shown: tuple[object, ...], found: tuple[object, ...]) -> Iterator[NamedLine]:
    if len(found) > len(shown):
        yield "", f"and {len(found) - len(shown)} more {what}"


def _proof(fold: Fold, unit: str) -> str:
    """Return how closely a fold is proven, as the end of a sentence, with the unit of slip rates."""
    if fold.enclosure is None:
        return "; not proven"
    low, high = fold.enclosure
    return f"; proven to within {exactly(high - low, unit, 1)}" if high > low else "; proven, at a kink of the law"
