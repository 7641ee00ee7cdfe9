"""Branches of a massless contact, for the engine: once for a law of slip rate, again and again for a law of slip and slip rate.

Where friction depends on both, folds and the levels of the selection rule move with slip. The slip rate is followed by its series;
the branches at a slip are worked out only where a choice is due. A rule other than perfect delay is looked at after every step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.contact.selection import selection_table
from stickslip.evolution import layout as at
from stickslip.evolution.engine import advance
from stickslip.evolution.layout import Floats, Integers, Setup, Store
from stickslip.evolution.polynomial import RECIPROCAL
from stickslip.evolution.workspace import EXIT
from stickslip.friction.difference import difference
from stickslip.problem import Problem

OUT_OF_BUDGET = -1
"""What `advance` returns when it has made as many steps as it was asked for."""
ROUNDING = 1e-11
"""Loads nearer to a level, relative to the strength, have not crossed it."""
PLACES = (0.5, 1.0)
"""Where in a step the rule is looked at."""


def has_inertia(problem: Problem) -> bool:
    """Whether the contact itself has mass, so that its slip rate cannot jump."""
    return not isinstance(problem.body, ElasticSlab) or problem.body.contact_mass > 0.0


def is_algebraic(problem: Problem) -> bool:
    """Whether the slip rate is a root of the contact equation, on one of its branches: a massless contact under a law of rate."""
    return not has_inertia(problem) and problem.friction.depends_on_rate


def folds_move(problem: Problem) -> bool:
    """Whether these branches change with slip."""
    return is_algebraic(problem) and problem.friction.depends_on_slip


def branch_rows(problem: Problem, law_slip: float) -> tuple[Floats, float]:
    """Rows of `Setup.branch` at a law slip (m, minus the initial one), and the load minus strength (Pa) at which stick is left.

    One branch, kept for ever, where the solution is unique.
    """
    if not is_algebraic(problem):
        return np.array([[0.0], [math.inf], [-math.inf], [math.inf], [-math.inf], [math.inf]]), 0.0
    branches, table = selection_table(problem, problem.law_slip + law_slip)
    rates = [[getattr(branch, name) for branch in branches] for name in ("rate_from", "rate_to")]
    ends = [[getattr(branch, name) for branch in branches] for name in ("excess_from", "excess_to")]
    loads = np.array([table.keep_from, table.keep_to, *ends]) + strength_change(problem, law_slip)
    return np.array([*rates, *loads]), table.stick_to


def strength_change(problem: Problem, law_slip: float) -> float:
    """Static strength (Pa) at a law slip (m, minus the initial one), minus that at the start, to rounding of the difference."""
    law, start = problem.friction, problem.law_slip
    home = int(law.piece_at(start))
    if law.knot_variable == "slip" and int(law.piece_at(start + law_slip)) != home:
        return problem.normal * float(law.static_coefficient(start + law_slip) - law.static_coefficient(start))
    return problem.normal * float(difference(law.trees()[home], law.numbers(home), start, law_slip, 0.0)[0])


def branch_of(rows: Floats, rate: float) -> int:
    """The branch to which a slip rate (m/s) belongs: the nearest one, for at a fold it may lie outside by rounding."""
    return int(np.argmin(np.maximum(np.maximum(rows[at.RATE_FROM] - rate, rate - rows[at.RATE_TO]), 0.0)))


def renewed(problem: Problem, setup: Setup, state: Floats, count: Integers) -> Setup:
    """The setup with the branches at the present law slip; state and count take note of it."""
    rows, setup.par[at.STICK_TO] = branch_rows(problem, float(state[at.LAW_SLIP]))
    count[at.BRANCH] = branch_of(rows, abs(float(state[at.RATE_NOW])))
    state[at.TABLE_SLIP] = state[at.LAW_SLIP]
    return setup._replace(branch=rows)


@dataclass(frozen=True)
class Step:
    """The last step in a history, with the rule's levels along it: xi runs over it from 0 to 1."""

    problem: Problem
    store: Store
    row: int

    @property
    def direction(self) -> int:
        """+1 for slip forwards, -1 backwards, 0 at rest."""
        return int(self.store.mode[self.row])

    def law_slip(self, xi: float) -> float:
        """Law slip (m), minus the initial one."""
        rate, powers = self.store.rate[self.row], xi ** np.arange(1, at.TERMS + 1)
        straight = self.store.speed[self.row] * (RECIPROCAL[1 : at.TERMS + 1] * rate * powers).sum()
        bent = 2.0 * self.store.bend[self.row] * xi * (RECIPROCAL[2 : at.TERMS + 2] * rate * powers).sum()
        grown = float(straight + bent)
        return float(self.store.law_slip[self.row]) + (grown if self.problem.friction.counts == "net" else self.direction * grown)

    def room(self, xi: float) -> float:
        """How far (Pa) the load is inside the interval for which the rule keeps the branch; negative outside."""
        rows, _ = branch_rows(self.problem, self.law_slip(xi))
        powers = xi ** np.arange(at.TERMS)
        rate, load = abs(float(self.store.rate[self.row] @ powers)), float(self.store.load[self.row] @ powers)
        seen = load if self.direction > 0 else -load - 2.0 * self.problem.strength
        branch = branch_of(rows, rate)
        return min(seen - float(rows[at.KEEP_FROM, branch]), float(rows[at.KEEP_TO, branch]) - seen)

    def crossing(self) -> float | None:
        """Where the load first leaves that interval; None if it stays in it."""
        before = 0.0
        for place in PLACES:
            if self.room(place) < -ROUNDING * self.problem.strength:
                return bisection(self.room, before, place)
            before = place
        return None


def bisection(room: Callable[[float], float], low: float, high: float) -> float:
    """Where a function positive at low (or 0 to rounding) turns negative, to 1e-14."""
    if room(low) <= 0.0:
        return low
    while high - low > 1e-14:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if room(middle) > 0.0 else (low, middle)
    return high


def advance_by_rule(
    problem: Problem, table: Integers, state: Floats, count: Integers, store: Store, last: tuple[int, float], budget: int
) -> int:
    """As `advance`, for a rule whose levels move: a step over a level is taken back, and made again up to it."""
    for _ in range(budget):
        state_before, count_before = state.copy(), count.copy()
        code = advance(table, *last, 1)
        length = int(count[at.LENGTH])
        stepped = length > count_before[at.LENGTH] and store.mode[length - 1] != 0 and count[at.LEAVING] == 0
        place = Step(problem, store, length - 1).crossing() if stepped else None
        if place is not None:
            start, end = state_before[at.XI], state[at.XI]
            state[:], count[:] = state_before, count_before
            state[EXIT] = start + place * (end - start)
        elif code != OUT_OF_BUDGET:
            return code
    return OUT_OF_BUDGET
