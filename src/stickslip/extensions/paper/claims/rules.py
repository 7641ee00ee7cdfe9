"""Claims 7, 8, 9, 11, 12 and 17, on uniqueness and on selection rules."""

from __future__ import annotations

import math

import numpy as np

from stickslip.contact import Uniqueness, sign_change, uniqueness_of
from stickslip.extensions.paper.cases import Runs, problem, typed
from stickslip.extensions.paper.claims.verdict import ClaimVerdict, Number, claim, each, judge, verdict
from stickslip.foundation.constants import YEAR
from stickslip.friction import HyperbolicRate
from stickslip.problem import SELECTION_RULES, Problem
from stickslip.problem.bodies import as_slab
from stickslip.solution import Solution

SO_FAR = "Known so far: four rules on the paper's cases; rules that follow from a physical regularisation are not in this report."
"""Limits of claims 11 and 12, added to their explanations."""


@claim(7, "The critical value is αc = √(ρG)/(S(μS − μD)) = 0.196 s/m.")
def critical_value(_: Runs) -> ClaimVerdict:
    """Measure the critical alpha of the contact analysis against the formula, and the regime on both sides of it."""
    slab = problem("fig6-slab")
    law, body = typed(slab.friction, HyperbolicRate), as_slab(slab.body)
    found = uniqueness_of(slab).critical_value or math.nan
    formula = math.sqrt(body.density * body.shear_modulus) / (body.normal_stress * (law.static - law.dynamic))
    below, above = (uniqueness_of(slab.parameters["alpha"].put(found * factor)) for factor in (1 - 1e-6, 1 + 1e-6))
    agree = abs(found / 0.196 - 1.0) < 1e-9 and abs(found / formula - 1.0) < 1e-9
    why = (
        "The contact equation has one solution as long as g(v) = Zv + Sμ(v) rises everywhere. Under law (15) it falls fastest "
        "at v = 0, by S (μS − μD) α, so that everything turns on that against Z. α carries s/m: no unit is printed."
    )
    return verdict(
        judge(agree and below.regime == "regular" and above.regime == "irregular"),
        "α in s/m",
        why,
        ("critical α, from the folds", found, "s/m"),
        ("√(ρG)/(S(μS − μD))", formula, "s/m"),
        ("folds at αc (1 − 10⁻⁶)", len(below.folds), ""),
        ("folds at αc (1 + 10⁻⁶)", len(above.folds), ""),
    )


@claim(8, "An irregular contact has three solutions between the folds, two at them, one elsewhere.")
def three_solutions(_: Runs) -> ClaimVerdict:
    """Measure the number of admissible slip rates on a grid of loads that contains both folds."""
    contact = uniqueness_of(problem("fig6-slab"))
    lower, upper = fold_loads(contact)
    expected = {
        "below the lower fold": (1, np.linspace(0.0, lower, 201)[:-1]),
        "at the lower fold": (2, np.array([lower])),
        "between the folds": (3, np.linspace(lower, upper, 401)[1:-1]),
        "at the upper fold": (2, np.array([upper])),
        "above the upper fold": (1, np.linspace(upper, 2.0 * upper, 201)[1:]),
    }
    counts = {place: {len(contact.admissible(load)) for load in loads.tolist()} for place, (_, loads) in expected.items()}
    why = (
        "Stick, slip where g falls, slip where g rises. The upper fold is the static strength, where stick ends and the "
        "falling part begins. Only the middle solution is unstable. For slip backwards everything is mirrored."
    )
    return verdict(
        judge(all(counts[place] == {count} for place, (count, _) in expected.items())),
        "α = 1 s/m",
        why,
        ("lower fold, load", lower, "Pa"),
        ("lower fold, slip rate", contact.folds[0].rate, "m/s"),
        ("upper fold, load", upper, "Pa"),
        *((f"solutions {place}", max(found), "") for place, found in counts.items()),
    )


def fold_loads(contact: Uniqueness) -> tuple[float, float]:
    """Return the loads (Pa) of the lower fold and of the end of stick, which is the upper fold."""
    assert contact.resistance is not None
    return min(fold.load for fold in contact.folds), contact.resistance.strength


@claim(9, "A regular contact has one solution for every load, and no fold.")
def one_solution(_: Runs) -> ClaimVerdict:
    """Measure the number of solutions on a grid of loads, under a regular rate law and under the slip law."""
    slab = problem("fig6-slab")
    half = 0.5 * (uniqueness_of(slab).critical_value or math.nan)
    cases = {f"α = {half:g} s/m": slab.parameters["alpha"].put(half), "slip law": problem("fig5-slab-printed")}
    numbers: list[Number] = []
    good = True
    for name, case in cases.items():
        contact = uniqueness_of(case)
        counts = [len(contact.admissible(load)) for load in (case.strength * np.linspace(-2.0, 2.0, 801)).tolist()]
        good &= contact.regime == "regular" and set(counts) == {1} and not contact.folds
        numbers.append((f"most solutions of any load, {name}", max(counts), ""))
        numbers.append((f"fewest, {name}", min(counts), ""))
        numbers.append((f"folds, {name}", len(contact.folds), ""))
    why = "g rises from stick on, so every load meets it once: at rest, or at one slip rate, forwards or backwards."
    return verdict(judge(good), "α = αc/2, and the slip law", why, *numbers)


@claim(11, "Whatever rule selects the solution, shocks occur.")
def shocks_for_every_rule(runs: Runs) -> ClaimVerdict:
    """Measure the shocks of the slab with alpha = 1 s/m through its second event, under every rule."""
    tables = {rule: runs.case(f"second-event-{rule}").shocks for rule in SELECTION_RULES}
    numbers: list[Number] = []
    for rule, shocks in tables.items():
        largest = (shocks.rate_after - shocks.rate_before).abs().max()
        numbers += [(f"shocks in 480 years, {rule}", len(shocks), ""), (f"largest jump, {rule}", largest, "m/s")]
    why = (
        "Any rule must leave the sticking branch for the slipping one at some load between the folds, and no load joins them "
        f"continuously: the rules differ in where they jump, not in whether they do. {SO_FAR}"
    )
    return verdict(judge(all(len(shocks) > 0 for shocks in tables.values())), "the four rules known so far", why, *numbers)


@claim(12, "The rule of perfect delay is no simple energy criterion: Maxwell's rule gives another answer.")
def not_an_energy_criterion(runs: Runs) -> ClaimVerdict:
    """Measure the time of the second event, and the load that ends stick, under each rule."""
    solutions = {rule: runs.case(f"second-event-{rule}") for rule in SELECTION_RULES}
    waits = {rule: waiting_time(s) / YEAR for rule, s in solutions.items()}
    firsts = {rule: float(s.events.slip.iloc[0]) for rule, s in solutions.items()}
    differs = abs(waits["maxwell"] / waits["perfect-delay"] - 1.0) > 1e-3
    same_first = max(firsts.values()) - min(firsts.values()) < 1e-6 * max(firsts.values())
    size = "" if same_first else " but for its size"
    why = (
        "Maxwell's rule (the least integral of g − β: equal areas) lets slip begin below the static strength. The first event "
        f"is the same under every rule{size}, because it starts at the static strength; the second tells them apart. Perfect "
        f"delay keeps stick up to the static strength, long after Maxwell's rule has left it. {SO_FAR}"
    )
    return verdict(
        judge(differs),
        "second event of the slab, α = 1 s/m",
        why,
        *each("from arrest to the second event", waits, "year"),
        *each("load at which stick ends", {rule: stick_ends(s.problem) for rule, s in solutions.items()}, "Pa"),
        *each("slip of the first event", firsts, "m"),
    )


def waiting_time(solution: Solution) -> float:
    """Return the time (s) from the end of the first event to the start of the second."""
    events = solution.events
    return float(events.start.iloc[1] - events.end.iloc[0])


def stick_ends(case: Problem) -> float:
    """Return the load (Pa) that makes the rule leave stick as it slowly rises."""
    return next(jump.load for jump in uniqueness_of(case).jumps if jump.direction == "up" and jump.rate_before == 0.0)


@claim(17, "Accelerating and decelerating paths differ (hysteresis).")
def hysteresis(runs: Runs) -> ClaimVerdict:
    """Measure the jumps of a run whose load rises and falls, and its slip rates at the same load on both ways."""
    solution = runs.case("fig4-loop")
    time, (load, rate) = solution.curves_together(("load", "slip_rate"))
    turn = int(np.argmax(load))
    middle = 0.5 * sum(fold_loads(uniqueness_of(solution.problem)))
    up, down = (rate_at_load(solution, middle, float(time[n]), float(time[turn])) for n in (0, -1))
    shocks = dict(enumerate(solution.shocks.time, start=1))
    area = float(abs(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(rate))))
    why = (
        "One run under a dead load walks the loop: up along stick to the static strength (O D A), over to slip (B, E), down "
        "along slip to the lower fold (C) and back to stick (D, O). At one and the same load the contact sticks on the way up "
        "and slips on the way down."
    )
    return verdict(
        judge(down != up and area > 0.0 and time[turn] > 0.0),
        "α = 1 s/m, under the rule of perfect delay",
        why,
        *((f"jump {i}, time", t, "s") for i, t in shocks.items()),
        *((f"jump {i}, load", solution.load(t), "Pa") for i, t in shocks.items()),
        (f"slip rate at {middle / 1e6:.3f} MPa, load rising", up, "m/s"),
        (f"slip rate at {middle / 1e6:.3f} MPa, load falling", down, "m/s"),
        ("area of the loop", area, "W/m²"),
    )


def rate_at_load(solution: Solution, load: float, start: float, end: float) -> float:
    """Return the slip rate (m/s) when the load of a run passes `load` (Pa).

    At the times `start` and `end` (s) the load must lie on different sides of that value.
    """
    passing = sign_change(lambda t: float(solution.load(start + t * (end - start))) - load, 0.0, 1.0)
    return float(solution.slip_rate(start + passing * (end - start)))
