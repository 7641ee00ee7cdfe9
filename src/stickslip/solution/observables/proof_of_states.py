"""Prove bounds on the residuals of the equations that the states of a law obey, from a history and the formulas alone.

The contact equation knows the states, and not how they came about: a run whose states evolve wrongly obeys it. With the place xi on
[0, 1] in a step and its time t(xi), the residual of dw/dt = F(u, v, w) is

    G(xi) = dw/dxi - dt/dxi F(u, v, w) ,

in the unit of the state: no more than max |G| is what the step adds to the state without its equation. It is bounded like the
residual of the contact equation (`proof`). Where two steps join, a state goes on, but for the jump that a jump of the normal load
gives it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip.engine import History
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula import VARIABLES, Disc, Expression, largest, on_discs
from stickslip.solution.observables.given_on_discs import NormalLoads
from stickslip.solution.observables.proof import (
    AT_ONCE,
    DEGREE,
    OF_DURATION,
    POINTS_OF_STEP,
    RADII,
    SUM,
    MotionOnDiscs,
    Places,
    around_middle,
    at_points,
    chosen_steps,
    from_points,
)


class StatesProven(NamedTuple):
    """How far states miss their equations, relative to their size in a step and the scale below which errors are absolute."""

    missed: float = 0.0
    """Largest bound (1) on what one step adds to a state without its equation, or on what is missed where two steps join."""
    steps: int = 0
    """Number of steps that have such a bound."""
    unproven: int = 0
    """Number of steps whose residual is known at places only, as F is not analytic around them."""


def states_proven(history: History) -> StatesProven:
    """Return the proven bounds on the states of a history; nothing is missed by a law without a state of its own."""
    if not history.problem.friction.states:
        return StatesProven()
    n = _with_states(history)
    bound, known = np.zeros(len(n)), np.ones(len(n), bool)
    for some in np.array_split(np.arange(len(n)), len(n) // AT_ONCE + 1):
        for i in range(len(history.problem.friction.states)):
            seen, hidden, found = bounds_of_state(history, n[some], i)
            size = sizes(history, n[some], i)
            proven = np.isfinite(hidden) & (hidden <= np.maximum(seen, size))
            known[some] &= proven
            bound[some] = np.maximum(bound[some], np.where(proven, found, seen) / np.where(size > 0.0, size, 1.0))
    joints = 0.0 if history.forgotten else missed_at_joints(history)
    return StatesProven(float(max(np.max(bound, initial=0.0), joints)), int(np.count_nonzero(known)), int(np.count_nonzero(~known)))


def _with_states(history: History) -> Places:
    """Return the pieces of a history whose states are looked at: all but leaps, or a share of them in a long run."""
    n = np.flatnonzero(~np.isin(history.store.trip, history.creep[:, 0]))
    return chosen_steps(history.store, n[n >= history.given])


def sizes(history: History, n: Places, i: int) -> Floats:
    """Return how large state i is in each of some pieces, and the size below which its error counts as absolute, together."""
    values = history.store.state[n, i] @ POINTS_OF_STEP ** np.arange(history.store.state.shape[2])[:, None]
    return np.asarray(np.abs(values).max(axis=1, initial=0.0) + history.problem.friction.states[i].scale)


def bounds_of_state(history: History, n: Places, i: int) -> tuple[Floats, Floats, Floats]:
    """Return, for state i in some steps, the largest |G| at the points of each, the error between them, and a bound on both."""
    found = np.full((3, len(n)), np.inf)
    piece = history.store.law_piece[n]
    for law_piece in np.unique(piece).tolist():
        own = np.flatnonzero(piece == law_piece)
        evolution, motion = _Evolution.of(history, n[own], i), MotionOnDiscs.of(history, n[own])
        there, around = motion.on(at_points), motion.on(around_middle)
        if history.problem.normal_load is not None:
            normal = NormalLoads.of(history, n[own])
            there, around = there.pressed(normal.at(POINTS_OF_STEP)), around.pressed(normal.around_middle(RADII))
        with np.errstate(over="ignore", invalid="ignore"):  # where nothing is known, radii are infinite or no numbers
            values, discs = evolution.residual(there, law_piece, at_points), evolution.residual(around, law_piece, around_middle)
            found[:, own] = from_points(values, largest(discs))
    return found[0], found[1], found[2]


class _Evolution(NamedTuple):
    """One state in some steps: its derivative and the pace of time as polynomials in xi, a row for each step."""

    history: History
    state: int
    change: Floats  # unit of the state
    pace: Floats  # s

    @classmethod
    def of(cls, history: History, n: Places, i: int) -> _Evolution:
        store = history.store
        way = np.where(store.mode[n] < 0, -1.0, 1.0) if i in history.problem.friction.reverses else np.ones(len(n))
        terms = store.state.shape[2]
        change, pace = np.zeros((len(n), DEGREE)), np.zeros((len(n), DEGREE))
        change[:, : terms - 1] = way[:, None] * store.state[n, i, 1:] * np.arange(1, terms)
        pace[:, 0], pace[:, 1] = store.speed[n], 2.0 * store.bend[n]
        return cls(history, i, change, pace)

    def residual(self, motion: MotionOnDiscs, law_piece: int, places: Callable[[Floats], Disc]) -> Disc:
        """Return G where the motion is in discs; `places` makes discs of the values of polynomials."""
        law = self.history.problem.contact_law
        variables: dict[Expression, Disc] = dict(zip(VARIABLES, (motion.slip, motion.rate, *motion.states), strict=False))
        rate = on_discs(law.state_trees()[self.state], law.numbers(law_piece), variables)
        change, pace = places(self.change), places(self.pace)
        centre = change.centre - pace.centre * rate.centre
        radius = change.radius + np.abs(pace.centre) * rate.radius + pace.radius * rate.most
        unsure = (OF_DURATION * self.history.round_trip_time + SUM * pace.most) * rate.most
        return Disc(centre, radius + unsure + SUM * change.most, 0.0)


def missed_at_joints(history: History) -> float:
    """Return the largest change of a state (1), relative to its size, where a step ends and the next one begins.

    A jump of the normal load from S to S' changes the first state by -coupling ln(S'/S) (Linker & Dieterich 1992).
    """
    problem, store = history.problem, history.store
    trips = store.trip
    leaps = np.isin(trips, history.creep[:, 0])
    n = np.flatnonzero(~(leaps[:-1] | leaps[1:]))
    n = n[n >= history.given]
    worst = 0.0
    for i, start in enumerate(problem.contact_states[: len(problem.friction.states)]):
        series = store.state[:, i]
        size = sizes(history, np.arange(len(trips)), i)
        jump = series[n + 1, 0] - series[n].sum(axis=1)
        if i == 0:
            jump += _coupled(history, n)
        both = np.maximum(size[n], size[n + 1])
        worst = max(worst, float(np.max(np.abs(jump) / np.where(both > 0.0, both, 1.0), initial=0.0)))
        if len(trips) and trips[0] == 0 and store.phase_from[0] == 0.0 and size[0] > 0.0 and not history.given:
            worst = max(worst, abs(float(series[0, 0]) - start) / float(size[0]))
    return worst


def _coupled(history: History, n: Places) -> Floats:
    """Return by how much the first state falls where the normal load jumps behind pieces n."""
    coupling = history.problem.friction.normal_coupling
    if history.problem.normal_load is None or coupling == 0.0:
        return np.zeros(len(n))
    loads = [NormalLoads.of(history, one).at(np.array([place]))[0].centre[:, 0] for one, place in ((n, 1.0), (n + 1, 0.0))]
    return np.asarray(coupling * np.log((1.0 + loads[1]) / (1.0 + loads[0])))
