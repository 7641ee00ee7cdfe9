"""Table of the branches of a massless contact for the engine.

A law of slip rate alone needs it once. If friction depends on both slip and slip rate, the folds move with slip, and the table is
needed again and again. The slip rate itself follows from its series; the branches at a slip are computed only where a branch has
ended. That is where the rule of perfect delay chooses, and it is the only rule that such a law may have (`Problem`).
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.contact.rules.selection import selection_table
from stickslip.engine.state.layout import BranchRow, Counts, Floats, Params, Setup, State
from stickslip.friction.formula.differences import difference
from stickslip.problem.problem import Problem


def is_algebraic(problem: Problem) -> bool:
    """Return True if the slip rate is a root of the contact equation, on one of its branches.

    This holds for a massless contact under a law of slip rate without a state variable.
    """
    return not problem.body.has_inertia and problem.friction.depends_on_rate and not problem.contact_law.states


def table_of_branches(problem: Problem, law_slip: float) -> tuple[Floats, float]:
    """Return the table of branches at a law slip (m, minus the initial one), and the load that ends stick.

    That load is in Pa, minus the strength. Where the solution is unique there is one branch, which is never left.
    """
    if not is_algebraic(problem):
        return np.array([[0.0, math.inf, -math.inf, math.inf, -math.inf, math.inf]]), 0.0
    branches, levels = selection_table(problem, problem.law_slip + law_slip)
    table, change = BranchRow.table(len(branches)), strength_change(problem, law_slip)
    found = BranchRow.of(table)
    found.rate_from, found.rate_to = [one.rate_from for one in branches], [one.rate_to for one in branches]
    found.keep_from, found.keep_to = np.array(levels.keep_from) + change, np.array(levels.keep_to) + change
    found.excess_from = np.array([one.excess_from for one in branches]) + change
    found.excess_to = np.array([one.excess_to for one in branches]) + change
    return table, levels.stick_to


def strength_change(problem: Problem, law_slip: float) -> float:
    """Return the static strength (Pa) at a law slip (m, minus the initial one), minus that at the start.

    The result is exact to the rounding of the difference.
    """
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
    """Return the setup with the branches at the present law slip, and update `params`, `state` and `count` to match."""
    table, params.stick_to = table_of_branches(problem, float(state.law_slip))
    count.branch = branch_of(BranchRow.of(table), abs(float(state.rate_now)))
    state.table_slip = state.law_slip
    return setup._replace(branches=table)
