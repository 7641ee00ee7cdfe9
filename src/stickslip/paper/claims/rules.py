"""Claims 7, 8, 9, 11, 12 and 17, on uniqueness and on selection rules."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip import YEAR
from stickslip.bodies import as_slab
from stickslip.contact.roots import sign_change
from stickslip.contact.uniqueness import Uniqueness, uniqueness
from stickslip.friction import HyperbolicRate
from stickslip.paper.cases import Runs, problem
from stickslip.paper.claims.verdict import Verdict, judge, verdict
from stickslip.problem.problem import Problem
from stickslip.problem.selection_rule import SELECTION_RULES
from stickslip.solution.solution import Solution

SO_FAR = "Known so far: four rules on the paper's cases; rules that follow from a physical regularisation are not in this report."
"""Limits of claims 11 and 12, added to their explanations."""


def critical_value(_: Runs) -> Verdict:
    """Measure claim 7: the critical alpha of the contact analysis against the formula, and the regime on both sides of it."""
    slab = problem("fig6-slab")
    law, body = slab.friction, as_slab(slab.body)
    assert isinstance(law, HyperbolicRate)
    found = uniqueness(slab).critical_value or math.nan
    formula = math.sqrt(body.density * body.shear_modulus) / (body.normal_stress * (law.static - law.dynamic))
    below, above = (uniqueness(replace(slab, friction=replace(law, alpha=found * factor))) for factor in (1 - 1e-6, 1 + 1e-6))
    agree = abs(found / 0.196 - 1.0) < 1e-9 and abs(found / formula - 1.0) < 1e-9
    why = (
        "The contact equation has one solution as long as g(v) = Zv + Sμ(v) rises everywhere. Under law (15) it falls fastest "
        "at v = 0, by S (μS − μD) α, so that everything turns on that against Z. α carries s/m: no unit is printed."
    )
    numbers = [
        ("critical α, from the folds", found, "s/m"),
        ("√(ρG)/(S(μS − μD))", formula, "s/m"),
        ("folds at αc (1 − 10⁻⁶)", len(below.folds), ""),
        ("folds at αc (1 + 10⁻⁶)", len(above.folds), ""),
    ]
    return verdict(7, judge(agree and below.regime == "regular" and above.regime == "irregular"), "α in s/m", why, *numbers)


def three_solutions(_: Runs) -> Verdict:
    """Measure claim 8: the number of admissible slip rates on a grid of loads that contains both folds."""
    contact = uniqueness(problem("fig6-slab"))
    lower, upper = fold_loads(contact)
    loads = {
        "below the lower fold": np.linspace(0.0, lower, 201)[:-1],
        "at the lower fold": np.array([lower]),
        "between the folds": np.linspace(lower, upper, 401)[1:-1],
        "at the upper fold": np.array([upper]),
        "above the upper fold": np.linspace(upper, 2.0 * upper, 201)[1:],
    }
    counts = {place: {len(contact.admissible(float(load))) for load in values} for place, values in loads.items()}
    expected = dict(zip(loads, (1, 2, 3, 2, 1), strict=True))
    why = (
        "Stick, slip where g falls, slip where g rises. The upper fold is the static strength, where stick ends and the "
        "falling part begins. Only the middle solution is unstable. For slip backwards everything is mirrored."
    )
    numbers = [
        ("lower fold, load", lower, "Pa"),
        ("lower fold, slip rate", contact.folds[0].rate, "m/s"),
        ("upper fold, load", upper, "Pa"),
    ]
    numbers += [(f"solutions {place}", max(found), "") for place, found in counts.items()]
    return verdict(8, judge(all(counts[p] == {expected[p]} for p in loads)), "α = 1 s/m", why, *numbers)


def fold_loads(contact: Uniqueness) -> tuple[float, float]:
    """Return the loads (Pa) of the lower fold and of the end of stick, which is the upper fold."""
    assert contact.resistance is not None
    return min(fold.load for fold in contact.folds), contact.resistance.strength


def one_solution(_: Runs) -> Verdict:
    """Measure claim 9: the number of solutions on a grid of loads, under a regular rate law and under the slip law."""
    slab, slip = problem("fig6-slab"), problem("fig5-slab-printed")
    law = slab.friction
    assert isinstance(law, HyperbolicRate)
    half = 0.5 * (uniqueness(slab).critical_value or math.nan)
    numbers, good = [], True
    for name, case in ((f"α = {half:g} s/m", replace(slab, friction=replace(law, alpha=half))), ("slip law", slip)):
        contact = uniqueness(case)
        counts = [len(contact.admissible(load)) for load in (case.strength * np.linspace(-2.0, 2.0, 801)).tolist()]
        most, least = max(counts), min(counts)
        good &= contact.regime == "regular" and most == least == 1 and not contact.folds
        numbers += [
            (f"most solutions of any load, {name}", most, ""),
            (f"fewest, {name}", least, ""),
            (f"folds, {name}", len(contact.folds), ""),
        ]
    why = "g rises from stick on, so every load meets it once: at rest, or at one slip rate, forwards or backwards."
    return verdict(9, judge(good), "α = αc/2, and the slip law", why, *numbers)


def shocks_for_every_rule(runs: Runs) -> Verdict:
    """Measure claim 11: the shocks of the slab with alpha = 1 s/m through its second event, under every rule."""
    tables = {rule: runs.case(f"second-event-{rule}").shocks for rule in SELECTION_RULES}
    numbers = []
    for rule, shocks in tables.items():
        size = (shocks.rate_after - shocks.rate_before).abs()
        numbers += [(f"shocks in 480 years, {rule}", len(shocks), ""), (f"largest jump, {rule}", size.max(), "m/s")]
    why = (
        "Any rule must leave the sticking branch for the slipping one at some load between the folds, and no load joins them "
        f"continuously: the rules differ in where they jump, not in whether they do. {SO_FAR}"
    )
    return verdict(11, judge(all(len(shocks) > 0 for shocks in tables.values())), "the four rules known so far", why, *numbers)


def not_an_energy_criterion(runs: Runs) -> Verdict:
    """Measure claim 12: the time of the second event, and the load at which stick ends, under each rule."""
    waits, levels, firsts = {}, {}, {}
    for rule in SELECTION_RULES:
        solution = runs.case(f"second-event-{rule}")
        waits[rule], levels[rule] = waiting_time(solution) / YEAR, stick_ends(solution.problem)
        firsts[rule] = float(solution.events.slip.iloc[0])
    differs = abs(waits["maxwell"] / waits["perfect-delay"] - 1.0) > 1e-3
    same_first = max(firsts.values()) - min(firsts.values()) < 1e-6 * max(firsts.values())
    size = "" if same_first else " but for its size"
    why = (
        "Maxwell's rule (the least integral of g − β: equal areas) lets slip begin below the static strength. The first event "
        f"is the same under every rule{size}, because it starts at the static strength; the second tells them apart. Perfect "
        f"delay keeps stick up to the static strength, long after Maxwell's rule has left it. {SO_FAR}"
    )
    numbers = [
        *((f"from arrest to the second event, {rule}", wait, "year") for rule, wait in waits.items()),
        *((f"load at which stick ends, {rule}", level, "Pa") for rule, level in levels.items()),
        *((f"slip of the first event, {rule}", slip, "m") for rule, slip in firsts.items()),
    ]
    return verdict(12, judge(differs), "second event of the slab, α = 1 s/m", why, *numbers)


def waiting_time(solution: Solution) -> float:
    """Return the time (s) from the end of the first event to the start of the second."""
    events = solution.events
    return float(events.start.iloc[1] - events.end.iloc[0])


def stick_ends(case: Problem) -> float:
    """Return the load (Pa) at which the rule leaves stick as the load slowly rises."""
    return next(jump.load for jump in uniqueness(case).jumps if jump.direction == "up" and jump.rate_before == 0.0)


def rate_at_load(solution: Solution, load: float, start: float, end: float) -> float:
    """Return the slip rate (m/s) when the load of a run passes `load` (Pa).

    At the times `start` and `end` (s) the load must lie on different sides of that value.
    """
    passing = sign_change(lambda t: float(solution.load(start + t * (end - start))) - load, 0.0, 1.0)
    return float(solution.slip_rate(start + passing * (end - start)))


def hysteresis(runs: Runs) -> Verdict:
    """Measure claim 17: the jumps of a run whose load rises and falls, and its slip rates at the same load on both ways."""
    solution = runs.case("fig4-loop")
    time, load = solution.curve("load")
    _, rate = solution.curve("slip_rate")
    turn = int(np.argmax(load))
    lower, upper = fold_loads(uniqueness(solution.problem))
    middle = 0.5 * (lower + upper)
    up, down = (rate_at_load(solution, middle, float(time[n]), float(time[turn])) for n in (0, -1))
    shocks = solution.shocks
    area = float(abs(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(rate))))
    why = (
        "One run under a dead load walks the loop: up along stick to the static strength (O D A), over to slip (B, E), down "
        "along slip to the lower fold (C) and back to stick (D, O). At one and the same load the contact sticks on the way up "
        "and slips on the way down."
    )
    numbers = [
        *((f"jump {i}, time", t, "s") for i, t in enumerate(shocks.time, start=1)),
        *((f"jump {i}, load", float(solution.load(t)), "Pa") for i, t in enumerate(shocks.time, start=1)),
        (f"slip rate at {middle / 1e6:.3f} MPa, load rising", up, "m/s"),
        (f"slip rate at {middle / 1e6:.3f} MPa, load falling", down, "m/s"),
        ("area of the loop", area, "W/m²"),
    ]
    outcome = judge(down != up and area > 0.0 and time[turn] > 0.0)
    return verdict(17, outcome, "α = 1 s/m, under the rule of perfect delay", why, *numbers)
