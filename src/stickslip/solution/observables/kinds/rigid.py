"""What a finished run of a rigid body on a spring says: its driver is the end of the spring, and nothing travels inside.

Beside the spring there may be a dashpot, which takes c (V - v) of the force of the driver, with the pull rate V and the slip rate
v. The load of the engine has c V in it, and c v is with what damps slip.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from stickslip.engine import Cause, History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, driver_of
from stickslip.problem.bodies import as_on_spring
from stickslip.solution.observables.asked import AtContact, AtDriver, Extent, Field, FollowedFronts, LoadCompared, ObservablesOfKind
from stickslip.solution.observables.energy.balance import heat
from stickslip.solution.observables.field import NO_INSIDE, rounding
from stickslip.solution.observables.given_load import of_ground, pulled, squared_pull, value_at
from stickslip.solution.observables.proof import Places
from stickslip.solution.observables.proof_of_load import compared_in_steps, times_in
from stickslip.solution.observables.quadrature import Integrand, between, up_to


class ObservablesOfRigid(ObservablesOfKind):
    """The answers of rigid bodies; energies are in J."""

    def energies(self, history: History, at: Positions, nodes: int) -> dict[str, Floats]:
        """Return them from the force of the spring; work, heat and damping are integrated with `nodes` nodes on each piece."""
        problem = history.problem
        body = problem.body
        force, rate = spring_force(history, at), history.rate(at)
        first = problem.excess + driver_of(problem).jump_at_start(problem)
        first -= as_on_spring(body).driver_damping * problem.first_pull_rate
        spring = _stretching(history, np.full(len(force), first), force)
        return {
            "work": up_to(history, at, _pulling(history), nodes=nodes) + _at_rest(history, at),
            "stored": spring + 0.5 * body.inertia * rate**2,
            "elastic": spring,
            "kinetic": 0.5 * body.inertia * rate**2,
            "heat": heat(history, at, nodes),
            "damped": _damped(history, at, nodes) + lost_at_stops(history, at),
            "radiated": np.zeros(len(force)),
            "trapped": np.zeros(len(force)),
        }

    def event_energies(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return them from the forces of the spring at the start and at the end of each event."""
        body = history.problem.body
        force, left = spring_force(history, first), spring_force(history, last)
        spring = _stretching(history, left, force)
        return {
            "released": spring + 0.5 * body.inertia * (history.rate(first) ** 2 - history.rate(last) ** 2),
            "work": between(history, first, last, _pulling(history)),
            "damped": between(history, first, last, damped_power(history)) + lost_between(history, first, last),
            "trapped": np.zeros(len(force)),
        }

    def energetics(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return the kinetic energy that the body gains; nothing is radiated or trapped."""
        nothing = np.zeros(len(first.piece))
        moving = 0.5 * history.problem.body.inertia * (history.rate(last) ** 2 - history.rate(first) ** 2)
        return {"kinetic": moving, "radiated": nothing, "trapped_before": nothing}

    def trapped(self, history: History) -> None:
        """Return None: there are no waves."""

    def at_driver(self, history: History, time: Floats, side: Side) -> AtDriver:
        """Return the pull rate at the end of the spring, and the force there: that of spring and dashpot."""
        begun = history.epoch.trip * history.round_trip_time + history.epoch.offset
        slack = rounding(time, history.round_trip_time) * (1.0 if side == "left" else -1.0)
        rate = history.problem.pull_rate_at(np.maximum(begun + time - slack, 0.0))
        return AtDriver(np.asarray(rate, float), history.problem.strength + driver_force(history, history.find(time, side)))

    def field(self, history: History, at_contact: AtContact, place: Floats, time: Floats, side: Side) -> Field:
        """Raise InputError: there is nothing inside."""
        raise InputError(NO_INSIDE)

    def extent(self, problem: Problem) -> Extent:
        """Raise InputError: there is nothing inside."""
        raise InputError(NO_INSIDE)

    def fronts(self, problem: Problem) -> FollowedFronts:
        """Raise InputError: there is nothing inside."""
        raise InputError(NO_INSIDE)

    def load_compared(self, history: History) -> LoadCompared:
        """Compare the loads with the forces of the spring, in steps and beside breaks of the loading."""
        return compared_in_steps(history, _of_spring)


def spring_force(history: History, at: Positions) -> Floats:
    """Return the force of the spring minus the reference strength (N)."""
    force, damping = _held(history, at), as_on_spring(history.problem.body).driver_damping
    return force - damping * _pull_rate(history, at) if damping else force


def driver_force(history: History, at: Positions) -> Floats:
    """Return the force of the driver minus the reference strength (N): that of the spring, and of a dashpot beside it."""
    force, damping = _held(history, at), as_on_spring(history.problem.body).driver_damping
    return force - damping * history.rate(at) if damping else force


def _held(history: History, at: Positions) -> Floats:
    """Return the load minus the reference strength (N) without the inertia of moving ground, and without a force that is given."""
    force = history.excess(at)
    return np.where(at.before, force, force - pushing(history, at)) if is_pushed(history) else force


def _pull_rate(history: History, at: Positions) -> Floats:
    """Return the pull rate (m/s) at positions, at a jump that of their piece."""
    return value_at(history.problem.pull_rate, *history.times_inside(at))


def is_pushed(history: History) -> bool:
    """Return True if a force acts on the body beside spring, dashpot, and friction: one that is given, or that of inertia."""
    return history.problem.ground is not None or history.problem.force is not None


def pushing(history: History, at: Positions) -> Floats:
    """Return the force on the body that is given, less its mass times the acceleration of the ground, N."""
    problem, times = history.problem, history.times_inside(at)
    _, acceleration = of_ground(problem, *times)
    return np.asarray(value_at(problem.force_in_time or 0.0, *times) - problem.body.inertia * acceleration)


def _pulling(history: History) -> Integrand:
    """Return the power (W) of the driver, of a force, and of that of inertia where the ground moves, as a function of positions."""
    problem = history.problem

    def power(at: Positions) -> Floats:
        trip, offset = history.placed(at)
        pulling = problem.pull_rate_at(trip * history.round_trip_time + offset) * (problem.strength + driver_force(history, at))
        if problem.body.is_free:  # no spring stores the work of the load of the start, which moves with the body
            pulling += (problem.strength + spring_force(history, at)) * (history.rate(at) - _pull_rate(history, at))
        return np.asarray(pulling + pushing(history, at) * history.rate(at) if is_pushed(history) else pulling)

    return power


def _at_rest(history: History, at: Positions) -> Floats:
    """Return the work of the driver up to each position in rests that were not recorded, J.

    The spring has stored it, but for what a dashpot has taken.
    """
    return _in_rests(history, at, partial(_stored, history)) + _damped_at_rest(history, at)


def _in_rests(history: History, at: Positions, gained: Callable[[Positions, Positions], Floats]) -> Floats:
    """Return the sum of gains from position to position, up to each position in rests that were not recorded."""
    before = np.flatnonzero(np.diff(history.store.trip) > 1)  # the last pieces before leaps
    whole = np.append(0.0, np.cumsum(gained(Positions.inside(before, 1.0), Positions.inside(before + 1, 0.0))))
    part = np.where(at.at_rest, gained(Positions.inside(at.last, 1.0), at), 0.0)
    return np.asarray(whole[np.searchsorted(before, at.last)] + part)


def _stored(history: History, begin: Positions, end: Positions) -> Floats:
    """Return the energy (J) that the spring gains between pairs of positions."""
    return _stretching(history, spring_force(history, begin), spring_force(history, end))


def _stretching(history: History, force: Floats, later: Floats) -> Floats:
    """Return the energy (J) that the spring gains from one force to another (both minus the reference)."""
    body = history.problem.body
    if body.is_free:
        return np.zeros(len(later))
    return np.asarray((later - force) * (force + later + 2.0 * history.problem.strength) / (2.0 * body.stiffness))


def damped_power(history: History) -> Integrand:
    """Return the power that the damping dissipates as a function of positions, W."""
    damping, dashpot = history.problem.body.damping, as_on_spring(history.problem.body).driver_damping
    if not dashpot:
        return lambda at: damping * history.rate(at) ** 2
    return lambda at: damping * history.rate(at) ** 2 + dashpot * (_pull_rate(history, at) - history.rate(at)) ** 2


def _damped(history: History, at: Positions, nodes: int) -> Floats:
    """Return what the damping has dissipated up to each position, J: that against the ground, and a dashpot beside the spring."""
    body = as_on_spring(history.problem.body)
    if not body.total_damping:
        return np.zeros(len(at.piece))
    pieces = None if body.driver_damping else np.flatnonzero(history.store.mode)
    return up_to(history, at, damped_power(history), pieces, nodes=nodes) + _damped_at_rest(history, at)


def _damped_at_rest(history: History, at: Positions) -> Floats:
    """Return what a dashpot beside the spring has dissipated up to each position in rests that were not recorded, J."""
    problem, damping = history.problem, as_on_spring(history.problem.body).driver_damping
    if not damping:
        return np.zeros(len(at.piece))

    def gained(begin: Positions, end: Positions) -> Floats:
        low, high = (history.times_inside(one)[0] for one in (begin, end))
        return np.asarray(damping * (squared_pull(problem, high) - squared_pull(problem, low)))

    return _in_rests(history, at, gained)


def lost_at_stops(history: History, at: Positions) -> Floats:
    """Return the energy (J) that a body has lost at hard stops up to each position."""
    met = np.flatnonzero(history.store.cause == Cause.STOP)
    rates = history.rate(history.just_before(met)) ** 2 - history.rate(Positions.inside(met, 0.0)) ** 2
    lost = np.append(0.0, np.cumsum(0.5 * history.problem.body.inertia * rates))
    return np.asarray(lost[np.searchsorted(met, at.last, side="right")])


def lost_between(history: History, first: Positions, last: Positions) -> Floats:
    """Return the same between pairs of positions."""
    return lost_at_stops(history, last) - lost_at_stops(history, first)


def _of_spring(history: History, piece: Places, xi: Floats) -> Floats:
    """Return the load minus the reference strength (N): that of spring and dashpot, a force, and inertia on moving ground."""
    problem = history.problem
    _, _, time, inside = times_in(history, piece, xi)
    slip = history.slipped(Positions.inside(piece, xi))
    _, acceleration = of_ground(problem, time, inside)
    moved = pulled(problem, time) - slip
    if problem.body.has_play:
        numbers = driver_of(problem).numbers(problem)
        lag, half = numbers["first_lag"] + moved, numbers["play"]
        first = as_on_spring(problem.body).driver_damping * problem.first_pull_rate - problem.strength
        spring = first + problem.body.stiffness * (lag - np.clip(lag, -half, half))
    else:
        first = problem.excess + driver_of(problem).jump_at_start(problem)
        spring = first + problem.body.stiffness * moved
    gained = value_at(problem.pull_rate, time, inside) - problem.first_pull_rate
    pushing = value_at(problem.force_in_time or 0.0, time, inside) - problem.body.inertia * acceleration
    return np.asarray(spring + as_on_spring(problem.body).driver_damping * gained + pushing)


ANSWERS = ObservablesOfRigid()
