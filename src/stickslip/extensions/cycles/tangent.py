"""How small disturbances of a run grow: the linear equation along a history of a rigid body, with jumps at its events.

The state is load L, slip rate v, and the states w of the law. Under a steady pull V, with d = 1 in forward and -1 in backward slip,

    dL/dt = K (V - v)      m dv/dt = L - c v - d S mu(|v|, w)      dw/dt = f(|v|, w)

and at rest v = 0. A disturbance obeys the derivative of this, which Radau's method solves on each piece of the history: a fast
motion that has long faded takes no short steps. At an event with the condition n y = const a disturbance is multiplied by
I + (f+ - f-) n / (n f-), where f- and f+ are dy/dt before and after it.

Source: di Bernardo et al. 2008, Piecewise-smooth Dynamical Systems, section 2.5, for the factor at events.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import value_and_slopes
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring

STAGES = 8
"""Points of Radau's method on each part of a piece, whose order is twice that less one."""
TOLERANCE, MOST_PARTS = 1e-11, 64
"""Pieces are divided until the result changes by less than this share (1) of the largest so far, into no more parts than this."""
LOAD_ROW, RATE_ROW, FIRST_STATE_ROW = range(3)
"""Places of load, slip rate and the first state in a disturbance."""


def _radau() -> tuple[Floats, Floats]:
    """Return places and coefficients of Radau's method on (0, 1]; the last row of the coefficients are its weights."""
    series = np.polynomial.legendre.Legendre.basis(STAGES - 1) - np.polynomial.legendre.Legendre.basis(STAGES)
    places = 0.5 * (np.sort(series.roots().real) + 1.0)
    places[-1] = 1.0
    powers = np.arange(1, STAGES + 1)
    return places, (places[:, None] ** powers / powers) @ np.linalg.inv(places[:, None] ** (powers - 1))


RADAU_PLACES, COEFFICIENTS = _radau()


@dataclass(frozen=True)
class RigidMotion:
    """The equation of motion of a rigid body under a steady pull, and its derivatives."""

    problem: Problem

    @cached_property
    def size(self) -> int:
        """The number of load, slip rate and states."""
        return FIRST_STATE_ROW + len(self.problem.friction.states)

    def _law(self, direction: int) -> Any:
        law = self.problem.friction
        return law.ways[1] if direction < 0 and law.backward_from else law

    def _signs(self, direction: int) -> Floats:
        """Return -1 for each state that the formulas see with another sign in this direction."""
        signs = np.ones(len(self.problem.friction.states))
        if direction < 0:
            signs[list(self.problem.friction.reverses)] = -1.0
        return signs

    def state_pace(self, values: Floats, direction: int) -> list[float]:
        """Return dw/dt of each state at one point."""
        law, signs = self._law(direction), self._signs(direction)
        seen, rate = signs * values[FIRST_STATE_ROW:], abs(float(values[RATE_ROW]))
        trees = law.state_trees()
        return [
            sign * float(value_and_slopes(tree, law.numbers(), 0.0, rate, *seen)[0])
            for sign, tree in zip(signs, trees, strict=True)
        ]

    def slopes(self, values: Floats, direction: int) -> Floats:
        """Return the derivatives of dy/dt by y at points with one direction; a row of `values` has L, v or a state of all."""
        problem, law, signs = self.problem, self._law(direction), self._signs(direction)
        body, count = as_on_spring(problem.body), len(values)
        rate, seen = np.abs(values[RATE_ROW]), [sign * state for sign, state in zip(signs, values[FIRST_STATE_ROW:], strict=True)]
        found = np.zeros((values.shape[1], count, count))
        if direction:
            mu = law.slopes(0.0, rate, one_argument(seen))
            found[:, LOAD_ROW, RATE_ROW] = -body.stiffness
            found[:, RATE_ROW, LOAD_ROW] = 1.0 / body.inertia
            found[:, RATE_ROW, RATE_ROW] = -(body.total_damping + problem.normal * mu[1]) / body.inertia
            for n, sign in enumerate(signs):
                found[:, RATE_ROW, FIRST_STATE_ROW + n] = -direction * sign * problem.normal * mu[2 + n] / body.inertia
        for n, tree in enumerate(law.state_trees()):
            by = value_and_slopes(tree, law.numbers(), np.zeros(len(rate)), rate, *seen)[1]
            if direction:
                found[:, FIRST_STATE_ROW + n, RATE_ROW] = signs[n] * direction * by[1]
            for other, sign in enumerate(signs):
                found[:, FIRST_STATE_ROW + n, FIRST_STATE_ROW + other] = signs[n] * sign * by[2 + other]
        return found

    def begins_slip(self, values: Floats, direction: int) -> Floats:
        """Return the derivative by y of the load beyond the strength, with the sign of the load, where rest ends."""
        problem, signs, law = self.problem, self._signs(direction), self._law(direction)
        found = np.zeros(len(values))
        found[LOAD_ROW] = 1.0
        if len(signs):
            slopes = law.slopes(0.0, 0.0, one_argument(tuple(signs * values[FIRST_STATE_ROW:])))
            found[FIRST_STATE_ROW:] = -direction * signs * problem.normal * slopes[2:]
        return found


def values_at(history: History, at: Positions) -> Floats:
    """Return load, slip rate and states at positions, each in a row."""
    return np.array([history.excess(at) + history.problem.strength, history.rate(at), *history.states(at)])


def pace_at(history: History, piece: int, place: float) -> Floats:
    """Return dy/dt at a place (1) in a piece.

    That of the slip rate is the derivative of its polynomial: a difference of load and friction loses digits in slow slip.
    """
    store, direction = history.store, int(history.store.mode[piece])
    values = values_at(history, Positions.inside(piece, place))[:, 0]
    by_place = float(np.polynomial.polynomial.polyval(place, np.polynomial.polynomial.polyder(store.rate[piece])))
    grows = by_place / float(store.speed[piece] + 2.0 * store.bend[piece] * place) if direction else 0.0
    loads = history.problem.body.stiffness * (history.problem.first_pull_rate - values[RATE_ROW])
    return np.array([loads, grows, *RigidMotion(history.problem).state_pace(values, direction)])


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
        """Return by what matrix a disturbance at the start is multiplied until the end, to TOLERANCE if `exactly`."""
        pieces, parts = np.arange(self.last + 1), np.ones(self.last + 1, int)
        events, coarse = self._events(), self._on_pieces(pieces, 1)
        if not exactly:
            return np.asarray(_multiplied(coarse, events)[-1])
        fine = self._on_pieces(pieces, 2)
        while True:
            found = _multiplied(fine, events)
            change = np.abs((fine - coarse) @ events @ found[:-1])
            rough = np.any(change > TOLERANCE * np.maximum.accumulate(np.abs(found[1:]), axis=0), axis=(1, 2))
            rough = np.flatnonzero(rough & (2 * parts < MOST_PARTS))
            if not len(rough):
                return np.asarray(found[-1])
            parts[rough] *= 2
            for many in np.unique(parts[rough]).tolist():
                here = rough[parts[rough] == many]
                coarse[here], fine[here] = fine[here], self._on_pieces(here, 2 * many)

    def _events(self) -> Floats:
        """Return the factor of disturbances before each piece."""
        mode = self.history.store.mode[: self.last + 1]
        found = np.tile(np.eye(self.motion.size), (len(mode), 1, 1))
        for piece in (1 + np.flatnonzero((np.diff(mode) != 0) | self.has_knots)).tolist():
            found[piece] = self._at_event(piece)
        return found

    @property
    def has_knots(self) -> bool:
        """True if the formula of the law may change between two pieces."""
        law = self.history.problem.friction
        return len(law.pieces) > 1 and law.knot_variable == "rate"

    def _on_pieces(self, pieces: Any, parts: int) -> Floats:
        """Return the matrices of pieces, each from the parts into which it is divided."""
        store, size, count = self.history.store, self.motion.size, len(pieces)
        length = np.repeat(np.where(pieces == self.last, self.place, 1.0) / parts, parts)
        piece = np.repeat(pieces, parts)
        begin = length * np.tile(np.arange(parts), count)
        xi = begin[:, None] + length[:, None] * RADAU_PLACES
        at = Positions.inside(np.repeat(piece, STAGES), xi.ravel())
        slopes, values, mode = np.empty((xi.size, size, size)), values_at(self.history, at), store.mode[at.piece]
        for direction in np.unique(mode).tolist():
            here = mode == direction
            slopes[here] = self.motion.slopes(values[:, here], direction)
        lasts = (store.speed[at.piece] + 2.0 * store.bend[at.piece] * at.xi) * np.repeat(length, STAGES)
        slopes = (lasts[:, None, None] * slopes).reshape(len(piece), STAGES, size, size)
        crossed = np.einsum("niab,ij->niajb", slopes, COEFFICIENTS).reshape(len(piece), STAGES * size, STAGES * size)
        stages = np.linalg.solve(np.eye(STAGES * size) - crossed, slopes.reshape(len(piece), STAGES * size, size))
        each = np.eye(size) + np.einsum("i,niab->nab", COEFFICIENTS[-1], stages.reshape(len(piece), STAGES, size, size))
        each = each.reshape(count, parts, size, size)
        found = each[:, 0]
        for part in range(1, parts):
            found = each[:, part] @ found
        return np.asarray(found)

    def _at_event(self, piece: int) -> Floats:
        """Return the factor of disturbances between a piece and the one before it."""
        history, size = self.history, self.motion.size
        before, after = (int(history.store.mode[n]) for n in (piece - 1, piece))
        if before == after and self._piece_of_law(piece - 1) == self._piece_of_law(piece):
            return np.eye(size)
        if before == -after and not history.problem.friction.sticks:  # friction passes smoothly through rest
            return np.eye(size)
        low, high = pace_at(history, piece - 1, 1.0), pace_at(history, piece, 0.0)
        left = values_at(history, Positions.inside(piece - 1, 1.0))[:, 0]
        normal = self.motion.begins_slip(left, after) if before == 0 else np.eye(size)[RATE_ROW]
        found: Floats = np.eye(size) + np.outer(high - low, normal) / (normal @ low)
        return found

    def _piece_of_law(self, piece: int) -> int:
        rate = abs(float(self.history.rate(Positions.inside(piece, 0.5))[0]))
        return int(self.history.problem.friction.piece_at(0.0, rate))


def _multiplied(each: Floats, events: Floats) -> Floats:
    """Return the products of the matrices of the first pieces, of none to all, with the factors before each piece."""
    found = np.empty((len(each) + 1, *each.shape[1:]))
    found[0] = np.eye(each.shape[1])
    for n, one in enumerate(each @ events):
        found[n + 1] = one @ found[n]
    return found
