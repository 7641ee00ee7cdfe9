"""Friction in steady sliding: its states, its traction, and how it responds to a disturbance of the slip rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.contact.disturbance import Response
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import value_and_slopes
from stickslip.problem import Problem

FAR = (0.0, 0.37, 1e3)
"""Steady sliding requires that friction does not change with slip over these distances (m)."""
CANCELLED = 1e-14
"""Rounding of a slope of a state's rate by the slip rate, relative to its terms."""


@dataclass(frozen=True)
class SteadyFriction:
    """The law of a problem after a long way at one slip rate; slip rates are magnitudes, in the direction of the drive."""

    problem: Problem
    drive: float
    """What steady sliding balances, with its sign, which is the direction of slip."""

    @property
    def changes_with_slip(self) -> bool:
        """True if friction, or the rate of a state, keeps changing while the contact slides."""
        law, states = self.problem.friction, self.states(1.0)[1]
        slips = self.slip + math.copysign(1.0, self.drive) * np.array(FAR)
        formulas = [(law.trees()[i], law.numbers(i)) for i in self.pieces]
        formulas += [(tree, law.numbers(self.pieces[0])) for tree in law.state_trees()]
        return any(value_and_slopes(tree, numbers, slips, 1.0, *states)[1][0].any() for tree, numbers in formulas)

    @cached_property
    def pieces(self) -> tuple[int, ...]:
        """The pieces of the law that steady sliding may be on: after a long way, a law of slip is on its last one."""
        law = self.problem.friction
        if law.knot_variable == "rate" or not law.knots:
            return tuple(range(len(law.pieces)))
        return (0,) if self.drive < 0.0 and law.counts == "net" else (len(law.pieces) - 1,)

    @cached_property
    def slip(self) -> float:
        """A slip (m) of the law in the piece of steady sliding."""
        law = self.problem.friction
        if law.knot_variable == "rate" or not law.knots:
            return self.problem.law_slip
        return law.knots[-1] if self.pieces[0] else float(np.nextafter(law.knots[0], -math.inf))

    def states(self, rate: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the states of steady sliding at a slip rate (m/s): as users see them, and as formulas use them."""
        law = self.problem.friction
        found = law.steady_state(rate) if law.states else None
        seen = () if found is None else tuple(np.ravel(found).tolist())
        return seen, law.inner_states(seen)

    def traction(self, rate: float) -> float:
        """Return the traction (Pa, N or N m) of steady sliding at a slip rate (m/s)."""
        mu = self.problem.friction.coefficient(self.slip, rate, one_argument(self.states(rate)[1]))
        return self.problem.normal * float(mu)

    def response(self, rate: float) -> Response:
        """Return how friction responds to a disturbance of steady sliding at a slip rate (m/s).

        With w' = f(v, w) it is Phi = mu_v + mu_w (s - f_w)^-1 f_v.
        """
        law, states = self.problem.friction, self.states(rate)[1]
        piece = int(law.piece_at(self.slip, rate))
        numbers, at, many = law.numbers(piece), (self.slip, rate, *states), len(states)
        slopes = value_and_slopes(law.trees()[piece], numbers, *at)[1]
        if not many:
            return Response(slopes[1:2], np.ones(1))
        evolve = np.array([value_and_slopes(tree, numbers, *at)[1] for tree in law.state_trees()])
        matrix, forced, felt = evolve[:, 2:], evolve[:, 1], slopes[2:]
        # a difference of nearly equal terms is rounding, as for friction that is the same at any rate
        forced = np.where(np.abs(forced) * rate > CANCELLED * np.abs(np.diag(matrix) * states), forced, 0.0)
        below = np.real(np.poly(matrix))[::-1]
        above = np.zeros(many)
        above[-1] = felt @ forced
        if many == 2:  # the adjugate of s - f_w is s + f_w - trace
            above[0] = felt @ (matrix - np.trace(matrix) * np.eye(2)) @ forced
        return Response(np.append(above, 0.0) + slopes[1] * below, below)
