"""Table of the branches of a massless contact for the engine.

A law of slip rate alone needs it once. If friction depends on both slip and slip rate, the folds move with slip, and so they do
with a normal load that varies: the table is needed again and again. The slip rate itself follows from its series; the branches are
computed only where a branch has ended, slip begins, or load or normal load jump. That is where the rule of perfect delay chooses,
and it is the only rule that may be followed there (`Problem`, `contact.uniqueness`).
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.contact import Branches, regime_when_pressed, resistance, selection_table, table_of
from stickslip.engine.state.layout import BranchRow, Counts, Floats, Params, Setup, State
from stickslip.friction.formula import difference
from stickslip.problem import Branch, Problem, SelectionTable


def is_algebraic(problem: Problem) -> bool:
    """Return True if the slip rate is a root of the contact equation, on one of its branches.

    This holds for a massless contact under a law of slip rate without a state variable of its own.
    """
    return not problem.body.has_inertia and problem.friction.depends_on_rate and not problem.friction.states


def _selected(problem: Problem, law_slip: float, pressing: float) -> tuple[Branches, SelectionTable]:
    """Return the branches and the table of the rule at a law slip (m) and a growth of the normal load (1)."""
    normal = problem.normal * (1.0 + pressing)
    is_known = problem.normal_varies and not problem.friction.depends_on_slip
    if is_known and regime_when_pressed(problem) == "regular":  # no proof of folds again at every event
        g = resistance(problem, law_slip, normal)
        only = (Branch(0.0, math.inf, g.start, math.inf),)
        return only, table_of(problem, g, only)
    return selection_table(problem, law_slip, normal)


def table_of_branches(problem: Problem, law_slip: float, pressing: float = 0.0) -> tuple[Floats, float]:
    """Return the table of branches at a law slip (m, minus the initial one), and the load that ends stick.

    `pressing` is the growth of the normal load (1, as a share of it). That load is in Pa, minus the strength. Where the solution is
    unique there is one branch, which is never left.
    """
    if not is_algebraic(problem):
        return np.array([[0.0, math.inf, -math.inf, math.inf, -math.inf, math.inf]]), 0.0
    branches, levels = _selected(problem, problem.law_slip + law_slip, pressing)
    table, change = BranchRow.table(len(branches)), strength_change(problem, law_slip)
    if pressing != 0.0:
        change += pressing * problem.normal * float(problem.friction.static_coefficient(problem.law_slip + law_slip))
    found = BranchRow.of(table)
    found.rate_from, found.rate_to = [one.rate_from for one in branches], [one.rate_to for one in branches]
    found.keep_from, found.keep_to = [one + change for one in levels.keep_from], [one + change for one in levels.keep_to]
    found.excess_from = [one.excess_from + change for one in branches]
    found.excess_to = [one.excess_to + change for one in branches]
    return table, levels.stick_to


def branches_both_ways(problem: Problem) -> tuple[Floats, dict[str, float]]:
    """Return the table of branches at the start, and the numbers of `Params` that belong to it.

    Where friction differs with the direction of slip, the branches of forward slip come first, then those of backward slip.
    """
    table, stick_to = table_of_branches(problem.facing(1), 0.0)
    if not (problem.friction.backward_from and is_algebraic(problem)):
        return table, {"stick_to": stick_to}
    backward = problem.facing(-1)
    other, back_to = table_of_branches(backward, 0.0)
    rows = BranchRow.of(other)
    for name in ("keep_from", "keep_to", "excess_from", "excess_to"):
        setattr(rows, name, getattr(rows, name) + (backward.strength - problem.strength))
    numbers = {"stick_to": stick_to, "backward_branch": float(len(table)), "backward_stick_to": back_to}
    return np.concatenate((table, other)), numbers


def strength_change(problem: Problem, law_slip: float) -> float:
    """Return the static strength (Pa) at a law slip (m, minus the initial one), minus that at the start.

    The result is exact to the rounding of the difference.
    """
    if law_slip == 0.0:
        return 0.0
    law, start = problem.friction, problem.law_slip
    home = int(law.piece_at(start))
    if law.knot_variable == "slip" and int(law.piece_at(start + law_slip)) != home:
        return problem.normal * float(law.static_coefficient(start + law_slip) - law.static_coefficient(start))
    return problem.normal * float(difference(law.trees()[home], law.numbers(home), start, law_slip, 0.0)[0])


def branch_of(branches: BranchRow, rate: float) -> int:
    """Return the branch of a slip rate (m/s).

    It is the nearest branch, because rounding may put a rate at a fold outside of every branch.
    """
    return int(np.argmin(np.maximum(np.maximum(branches.rate_from - rate, rate - branches.rate_to), 0.0)))


def renewed(problem: Problem, setup: Setup, params: Params, state: State, count: Counts) -> Setup:
    """Return the setup with the branches at the present slip and normal load, and make `params`, `state` and `count` match."""
    if count.given:
        state.table_pressing = state.state_now[count.states - count.given]
    table, params.stick_to = table_of_branches(problem, float(state.law_slip), float(state.table_pressing))
    count.branch = branch_of(BranchRow.of(table), abs(float(state.rate_now)))
    state.table_slip = state.law_slip
    return setup._replace(branches=table)
