"""Find the slip rate, load and state at the start of a contact that has a mass and never sticks.

Such a contact cannot start from rest. What the problem leaves out follows from the balance of forces at the start,
load = damping v + S mu(u, v, state), or from steady sliding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import brief
from stickslip.friction.contract import STATE_NAMES, one_argument

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem

FASTEST, SLOWEST = 1e3, 1e-300
"""Slip rates (m/s) between which load and friction must balance; a contact that would be slower starts at rate 0."""
STEADY = "steady"
"""Initial state that stands for the one of steady sliding at the pull rate."""
INITIAL_STATES = tuple(f"initial_{name}" for name in STATE_NAMES)
"""Names of the initial states in a `Problem`."""
AT_ONCE, ROUNDS = 304, 8
"""Number of slip rates that are tried together, first one in each decade, and how often they close in on the balance."""


class Start(NamedTuple):
    """A contact at the start, with signs: slip rate (m/s), load (Pa or N), and states in the form that the formulas use."""

    rate: float
    load: float
    states: tuple[float, ...]  # those that reverse: in the forward direction


def check_rate(problem: Problem) -> None:
    """Raise InputError if a problem has an initial rate that it cannot have."""
    if problem.initial_rate is None or problem.has_initial_rate:
        return
    if problem.friction.sticks:
        name = type(problem.friction).__name__
        raise InputError(f"Problem: initial_rate: under {name} the contact starts from rest: leave out initial_rate")
    why = "a contact without mass has no slip rate of its own, load and friction determine it"
    raise InputError(f"Problem: initial_rate: {why}: leave it out, or give the contact a mass")


def written_out(problem: Problem) -> Problem:
    """Return a problem with its initial load and state as numbers, where they followed from steady sliding."""
    if not problem.has_initial_rate or problem.initial_load is not None or problem.initial_excess is not None:
        return problem
    law = problem.friction
    if not law.states:
        return replace(problem, initial_load=problem.load)
    seen = np.ravel(law.outer_state(np.array(one_argument(problem.states))))
    states: dict[str, Any] = dict(zip(INITIAL_STATES, seen.tolist(), strict=False))
    return replace(problem, initial_load=problem.load, **states)


def start_of(problem: Problem) -> Start:
    """Return the start of a problem that `has_initial_rate`. Raises InputError if it lacks something, or if nothing balances."""
    rate = problem.initial_rate
    if problem.initial_load is None and problem.initial_excess is None:
        return _steady(problem, problem.first_pull_rate if rate is None else rate)
    load = problem.strength + problem.initial_excess if problem.initial_load is None else problem.initial_load  # type: ignore[operator]
    states = problem.friction.inner_states(problem.given_states)
    if rate is None and problem.friction.reverses:
        rate = 0.0
    if rate is None:
        rate = math.copysign(_balance(_resistance(problem, states), abs(load), problem), load)
    return Start(rate, load, states)


def _steady(problem: Problem, rate: float) -> Start:
    """Return steady sliding at a slip rate (m/s) of either sign."""
    law, states = problem.friction, tuple[float, ...]()
    if rate == 0.0:
        none = "the pull rate is 0 at first" if problem.initial_rate is None else "initial_rate is 0"
        raise InputError(
            f"Problem: needs initial_load, and initial_state if the law has a state: {none}, so nothing slides steadily"
        )
    if law.states:
        sliding = law.steady_state(abs(rate))
        if sliding is None:
            name = type(law).__name__
            raise InputError(
                f"Problem: needs initial_load and initial_state: {name} does not say in which state it slides steadily"
            )
        states = law.inner_states(np.ravel(sliding).tolist())
    load = math.copysign(_resistance(problem, states)(abs(rate)).item(), rate)
    return Start(rate, load, tuple(math.copysign(1.0, rate) * one if i in law.reverses else one for i, one in enumerate(states)))


def _resistance(problem: Problem, states: tuple[float, ...]) -> Callable[[Any], Floats]:
    """Return the load (Pa or N) that slip rates v >= 0 (m/s) take: damping v + S mu."""
    law, slip, damping, normal = problem.friction, problem.law_slip, problem.body.damping, problem.normal
    return lambda rate: np.asarray(damping * rate + normal * law.coefficient(slip, rate, one_argument(states)))


def _balance(resistance: Callable[[Any], Floats], load: float, problem: Problem) -> float:
    """Return the slowest slip rate (m/s, >= 0) at which the resistance is a load (>= 0), to rounding."""
    rates = np.geomspace(SLOWEST, FASTEST, AT_ONCE)
    beyond = resistance(rates) > load
    if beyond[0]:
        return 0.0
    if not beyond.any():
        why = f"is more than the contact resists at any slip rate up to {FASTEST:g} m/s"
        raise InputError(f"Problem: a load of {brief(load, problem.load_unit)} {why}: give initial_rate (0 is rest)")
    for _ in range(ROUNDS):
        high = max(int(np.argmax(beyond)), 1)
        rates = np.geomspace(float(rates[high - 1]), float(rates[high]), AT_ONCE)
        beyond = resistance(rates) > load
        beyond[-1] = True  # it was so a round ago, up to rounding
    return float(rates[0])
