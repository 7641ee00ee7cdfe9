"""How small disturbances of a run grow: the linear equation along a history of a rigid body, with jumps at its events.

The state is load L, slip rate v, and the states w of the law. Under a steady pull V, with d = 1 in forward and -1 in backward slip,

    dL/dt = K (V - v)      m dv/dt = L - c v - d S mu(|v|, w)      dw/dt = f(|v|, w)

and at rest v = 0. In a position loop, at hard stops and in a play the lag e behind the reference matters, too (`lag`), and dL/dt
has ki e more in a loop and no K in a play. A disturbance obeys the derivative of this, which Radau's method solves on each piece
of the history: a fast motion that has long faded takes no short steps. At an event with the condition n y = const a disturbance is
multiplied by I + (f+ - f-) n / (n f-), where f- and f+ are dy/dt before and after it (`events`). All of it is machine code.

Source: di Bernardo et al. 2008, Piecewise-smooth Dynamical Systems, section 2.5, for the factor at events.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from stickslip.engine import CompiledFormula, History, Positions, compile_formula
from stickslip.extensions.cycles.compiled.along_run import FIRST_STATE_ROW, LOAD_ROW, RATE_ROW, RunNumbers, pace_in_piece
from stickslip.extensions.cycles.compiled.disturbances import grow
from stickslip.extensions.cycles.compiled.places import write_values
from stickslip.extensions.cycles.lag import has_lag, is_wound, lags_at, lags_of
from stickslip.foundation.arrays import Floats, Floats1, Integers1
from stickslip.foundation.kernels.uncompiled import lend_memory
from stickslip.friction import FrictionLaw
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring

__all__ = ["FIRST_STATE_ROW", "LOAD_ROW", "RATE_ROW", "RigidMotion", "Tangent", "pace_at", "values_at"]


class LawNumbers(NamedTuple):
    """A law for compiled code: addresses of its formulas and of their constants, and what else compiled code asks of it."""

    calls: Integers1
    constants: Integers1
    reverses: Floats1
    sticks: int
    has_knots: int
    owners: tuple[tuple[CompiledFormula, Floats], ...]
    """What must live as long as the addresses."""


@lru_cache(32)
def numbers_of_law(law: FrictionLaw) -> LawNumbers:
    """Return a law for compiled code; its formulas are those that a run has compiled."""
    owners = []
    for piece, tree in enumerate(law.trees()):
        formula = compile_formula(tree, law.parameters(), law.state_trees())
        constants = np.zeros(formula.size)
        formula.fill(np.array(law.piece_values(piece)), 0.0, constants)
        lend_memory(constants)
        owners.append((formula, constants))
    asked, reverses = "state_value" if law.states else "value", np.zeros(len(law.states))
    reverses[list(law.reverses)] = 1.0
    return LawNumbers(
        np.array([formula.address(asked) for formula, _ in owners]),
        np.array([constants.ctypes.data for _, constants in owners]),
        reverses,
        int(law.sticks),
        int(len(law.pieces) > 1 and law.knot_variable == "rate"),
        tuple(owners),
    )


@dataclass(frozen=True)
class RigidMotion:
    """The equation of motion of a rigid body under a steady pull."""

    problem: Problem

    @property
    def size(self) -> int:
        """The number of load, slip rate, states, and lag if it matters."""
        return FIRST_STATE_ROW + len(self.problem.friction.states) + has_lag(self.problem)

    def along(self, history: History) -> RunNumbers:
        """Return the equation and a run that obeys it, for compiled code."""
        problem, body, law = self.problem, as_on_spring(self.problem.body), numbers_of_law(self.problem.friction)
        spring = body.stiffness, body.total_damping, body.inertia, problem.normal, problem.first_pull_rate
        return RunNumbers(
            *history.store,
            *spring,
            law.calls,
            law.constants,
            law.reverses,
            law.sticks,
            law.has_knots,
            lags_of(history),
            body.integral_gain,
            0.5 * body.backlash,
            body.stop_ahead,
            -body.stop_behind,
            body.restitution,
        )


def values_at(history: History, at: Positions) -> Floats:
    """Return load, slip rate and states at positions inside recorded pieces, each in a row, and the lag if a loop integrates it."""
    problem = history.problem
    found = np.empty((FIRST_STATE_ROW + len(problem.friction.states), len(at.piece)))
    write_values(*history.store, np.ascontiguousarray(at.piece), np.ascontiguousarray(at.xi), found)
    found[LOAD_ROW] += problem.strength
    return np.vstack([found, lags_at(history, at)]) if is_wound(problem) else found


def pace_at(history: History, piece: int, place: float) -> Floats:
    """Return dy/dt at a place (1) in a piece."""
    motion = RigidMotion(history.problem)
    pace = np.empty(motion.size)
    pace_in_piece(motion.along(history), piece, place, pace)
    return pace


@dataclass(frozen=True)
class Tangent:
    """Disturbances along the history of a run, from its start to a place in it."""

    history: History
    last: int
    """The last piece."""
    place: float
    """The place (1) in it."""

    @cached_property
    def motion(self) -> RigidMotion:
        """The equation of motion."""
        return RigidMotion(self.history.problem)

    def grown(self, *, exactly: bool = True) -> Floats:
        """Return by what matrix a disturbance at the start is multiplied until the end, to `TOLERANCE` if `exactly`."""
        found = np.empty((self.motion.size, self.motion.size))
        grow(self.motion.along(self.history), self.last, self.place, exactly, found)
        return found
