"""Table of the branches of a massless contact for the engine.

A law of slip rate alone needs it once. If friction depends on both slip and slip rate, the folds and the levels of the selection
rule move with slip, and the table is needed again and again. The slip rate itself follows from its series; the branches at a slip
are computed only where a choice between them is due. A rule other than perfect delay is checked after every step: a built-in rule
in compiled code (`moving_levels`), a user's own rule by its table, in Python, which costs milliseconds per step.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from stickslip.contact.equation import resistance
from stickslip.contact.folds import bounds_of
from stickslip.contact.rules.selection import selection_table
from stickslip.engine.folds.moving_branches import Search, new_search
from stickslip.engine.folds.moving_levels import (
    COMPILED_RULES,
    EXACT,
    LEVEL_ROUNDING,
    NEXT,
    SHORTEST,
    crossing_in,
    set_maxwell_levels,
)
from stickslip.engine.loop import run_until
from stickslip.engine.series.polynomial import RECIPROCAL
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Branch, Counts, Floats, Integers, Params, Rule, Setup, State, Stop, Store
from stickslip.friction.formula.differences import difference
from stickslip.problem.problem import Problem

AT_A_TIME = 100
"""Number of steps that are checked before the caller gets a chance to report progress."""
CHECKED_AT = (0.5, 1.0)
"""Places in a step, on [0, 1], at which a user's own rule is checked."""
STORM_OF, STORM_IN = 30, 1e-6
"""An event storm: this many crossings within this share of a round trip."""


def is_algebraic(problem: Problem) -> bool:
    """Return True if the slip rate is a root of the contact equation, on one of its branches.

    This holds for a massless contact under a law of slip rate without a state variable.
    """
    return not problem.body.has_inertia and problem.friction.depends_on_rate and not problem.friction.states


def folds_move(problem: Problem) -> bool:
    """Return True if the branches of the contact equation change with slip."""
    return is_algebraic(problem) and problem.friction.depends_on_slip


def table_of_branches(problem: Problem, law_slip: float) -> tuple[Floats, float]:
    """Return the table of branches at a law slip (m, minus the initial one), and the load at which the contact leaves stick.

    That load is in Pa, minus the strength. Where the solution is unique there is one branch, which is never left.
    """
    if not is_algebraic(problem):
        return np.array([[0.0, math.inf, -math.inf, math.inf, -math.inf, math.inf]]), 0.0
    branches, levels = selection_table(problem, problem.law_slip + law_slip)
    table, change = Branch.table(len(branches)), strength_change(problem, law_slip)
    found = Branch.of(table)
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


def branch_of(branches: Branch, rate: float) -> int:
    """Return the branch to which a slip rate (m/s) belongs.

    It is the nearest branch, because rounding may put a rate at a fold outside of every branch.
    """
    return int(np.argmin(np.maximum(np.maximum(branches.rate_from - rate, rate - branches.rate_to), 0.0)))


def has_levels_to_set(problem: Problem) -> bool:
    """Return True if compiled code sets the levels of the rule: those of Maxwell's rule take tenths of a second in Python."""
    return COMPILED_RULES.get(problem.rule) == Rule.MAXWELL


def renewed(problem: Problem, setup: Setup, params: Params, state: State, count: Counts) -> Setup:
    """Return the setup with the branches at the present law slip, and update `params`, `state` and `count` to match.

    Under Maxwell's rule the levels still have to be set (`RuleFollower.set_levels`).
    """
    case = replace(problem, selection="perfect-delay") if has_levels_to_set(problem) else problem
    table, params.stick_to = table_of_branches(case, float(state.law_slip))
    count.branch = branch_of(Branch.of(table), abs(float(state.rate_now)))
    state.table_slip = state.law_slip
    return setup._replace(branches=table)


@dataclass(frozen=True)
class Step:
    """The last step in a history, with the levels of the selection rule along it; xi runs over the step from 0 to 1."""

    problem: Problem
    store: Store
    piece: int

    @property
    def direction(self) -> int:
        """+1 for forward slip, -1 for backward slip, 0 at rest."""
        return int(self.store.mode[self.piece])

    def law_slip(self, xi: float) -> float:
        """Return the law slip (m), minus the initial one."""
        rate, powers = self.store.rate[self.piece], xi ** np.arange(1, at.TERMS + 1)
        straight = self.store.speed[self.piece] * (RECIPROCAL[1 : at.TERMS + 1] * rate * powers).sum()
        bent = 2.0 * self.store.bend[self.piece] * xi * (RECIPROCAL[2 : at.TERMS + 2] * rate * powers).sum()
        grown = float(straight + bent)
        return float(self.store.law_slip[self.piece]) + (grown if self.problem.friction.counts == "net" else self.direction * grown)

    def room(self, xi: float) -> float:
        """Return how far (Pa) the load is inside the interval in which the rule keeps the branch; negative outside."""
        branches = Branch.of(table_of_branches(self.problem, self.law_slip(xi))[0])
        powers = xi ** np.arange(at.TERMS)
        rate, load = abs(float(self.store.rate[self.piece] @ powers)), float(self.store.load[self.piece] @ powers)
        seen = load if self.direction > 0 else -load - 2.0 * self.problem.strength
        branch = branch_of(branches, rate)
        return min(seen - float(branches.keep_from[branch]), float(branches.keep_to[branch]) - seen)

    def crossing(self) -> float | None:
        """Return the place at which the load first leaves that interval, or None if it stays in it."""
        before, slack = 0.0, LEVEL_ROUNDING * self.problem.strength
        for place in CHECKED_AT:
            if self.room(place) < -slack:
                starts_outside = self.room(before) <= slack and self.room(before + NEXT * (place - before)) <= 0.0
                return before if starts_outside else root_between(self.room, before, place, EXACT * self.problem.strength)
            before = place
        return None


def root_between(room: Callable[[float], float], low: float, high: float, slack: float) -> float:
    """Return the place at which a function that is not negative at `low` and negative at `high` falls through zero.

    The method is false position with the Illinois modification, which keeps an end from standing still.
    Source: Dowell & Jarratt 1971, BIT 11, 168.
    """
    above, below, side, x = max(room(low), slack), room(high), 0, high
    for _ in range(100):
        x = (low * below - high * above) / (below - above)
        value = room(x)
        if abs(value) <= slack or high - low < SHORTEST:
            break
        if value > 0.0:
            low, above = x, value
            below *= 0.5 if side > 0 else 1.0
        else:
            high, below = x, value
            above *= 0.5 if side < 0 else 1.0
        side = 1 if value > 0.0 else -1
    return x


@dataclass
class RuleFollower:
    """Run the engine under a selection rule whose levels may move with slip.

    If they move, the run goes step by step: a step across a level is taken back and made again up to the level.
    """

    problem: Problem
    round_trip_time: float
    state: State
    count: Counts
    times: deque[float] = field(default_factory=lambda: deque(maxlen=STORM_OF))

    def advance(self, table: Integers, store: Store, last: tuple[int, float], budget: int) -> int:
        """Advance the run as `loop.run_until` does, under the selection rule.

        Returns Stop.STORM if the contact goes to and fro across a level that slip moves against the load.
        """
        if not folds_move(self.problem) or self.problem.rule == "perfect-delay":
            return run_until(table, *last, budget)
        for _ in range(min(budget, AT_A_TIME)):
            state, count = self.state.copy(), self.count.copy()
            code = run_until(table, *last, 1)
            place = self._crossing(table, store, int(count.length))
            if place is not None:
                state.exit = state.xi + place * (self.state.xi - state.xi)
                self.state.numbers[:], self.count.numbers[:] = state.numbers, count.numbers
                if self._storms():
                    return Stop.STORM
            elif code != Stop.NONE:
                return code
        return Stop.NONE

    def set_levels(self, table: Integers) -> None:
        """Set the levels that `renewed` has left out, in the setup that the engine uses."""
        if has_levels_to_set(self.problem):
            set_maxwell_levels(table, self._search)

    def _crossing(self, table: Integers, store: Store, length: int) -> float | None:
        """Return the place at which a slip step that has just been made crosses a level of the rule, or None."""
        stepped = self.count.length > length and store.mode[length] != 0 and self.count.branch_ended == 0
        if not stepped:
            return None
        if self.problem.rule not in COMPILED_RULES:
            return Step(self.problem, store, length).crossing()
        place = crossing_in(table, length, COMPILED_RULES[self.problem.rule], self._search)
        return place if place <= 1.0 else None

    @cached_property
    def _search(self) -> Search:
        """What compiled code searches branches with."""
        return new_search(bounds_of(resistance(self.problem)), self.problem.law_slip)

    def _storms(self) -> bool:
        """Record the time of a crossing, and return True if many have come with hardly any time between them."""
        whole, theta = float(self.count.trip), float(self.state.phase_from)
        xi = float(self.state.exit)
        self.times.append(whole * self.round_trip_time + theta + xi * (self.state.speed + xi * self.state.bend))
        return len(self.times) == STORM_OF and self.times[-1] - self.times[0] <= STORM_IN * self.round_trip_time
