"""Find the slip rate, load and state at the start of a contact that starts in motion.

A contact that has a mass and never sticks cannot start from rest; any other may start at a rate. What the problem leaves out
follows from the balance of forces at the start, load = damping v + S mu(u, v, state), or from steady sliding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.friction.contract import one_argument
from stickslip.problem.fields import STEADY, ProblemFields
from stickslip.problem.loading import LoadingHistory

FASTEST, SLOWEST = 1e3, 1e-300
"""Slip rates (m/s) between which load and friction must balance; a contact that would be slower starts at rate 0."""
AT_ONCE, ROUNDS = 304, 8
"""Number of slip rates that are tried together, first one in each decade, and how often they close in on the balance."""


class Start(NamedTuple):
    """A contact at the start, with signs: slip rate (m/s), load (Pa or N), and states in the form that the formulas use."""

    rate: float
    load: float
    states: tuple[float, ...]  # those that reverse: in the forward direction


def start_of(problem: ProblemFields) -> Start:
    """Return the start of a problem that `has_initial_rate`. Raises InputError if it lacks something, or if nothing balances."""
    rate = problem.initial_rate
    if problem.initial_load is None and problem.initial_excess is None:
        given = problem.first_pull_rate if rate is None else rate
        return _steady(problem, _steady_rate(problem) if isinstance(given, str) else given)
    if isinstance(rate, str):
        raise InputError(f"Problem: initial_rate '{STEADY}': load and state are those of steady sliding: leave them out")
    load = problem.strength + problem.initial_excess if problem.initial_load is None else problem.initial_load  # type: ignore[operator]
    states = problem.friction.inner_states(problem.given_states)
    if rate is None and problem.friction.reverses:
        rate = 0.0
    if rate is None:
        rate = math.copysign(_balance(_resistance(problem, states), abs(load), problem), load)
    return Start(rate, load, states)


def _steady_rate(problem: ProblemFields) -> float:
    """Return the slip rate (m/s) of steady sliding: the pull rate, unless the driver gives way and its far stress is given.

    It then is the fastest at which friction and a driver of impedance Zd balance, Zd v + S mu(v) = far stress + Zd V.
    """
    pull, driver, far = problem.first_pull_rate, problem.body.driver_impedance, problem.far_stress
    if problem.body.is_driven_rigidly or problem.body.driver_integral_gain > 0.0 or far is None:
        return pull
    drive = (far.first if isinstance(far, LoadingHistory) else far) + driver * pull

    def short(rate: float) -> bool:
        return driver * rate + _steady(problem, rate).load - problem.body.total_damping * rate < abs(drive)

    rates = np.geomspace(SLOWEST, FASTEST, AT_ONCE).tolist()
    high = next((k for k in range(AT_ONCE - 1, 0, -1) if short(rates[k - 1])), 0)
    if high == 0 or short(rates[high]):
        what = "does not keep the contact sliding" if high == 0 else "drives the contact ever faster"
        raise InputError(f"Problem: initial_rate '{STEADY}': the driver {what}: there is no steady sliding")
    low, beyond = rates[high - 1], rates[high]
    while low < 0.5 * (low + beyond) < beyond:
        middle = 0.5 * (low + beyond)
        low, beyond = (middle, beyond) if short(middle) else (low, middle)
    return math.copysign(beyond, drive)


def _steady(problem: ProblemFields, rate: float) -> Start:
    """Return steady sliding at a slip rate (m/s) of either sign."""
    law, states = problem.friction, tuple[float, ...]()
    if rate == 0.0:
        none = "initial_rate is 0" if problem.initial_rate == 0.0 else "the pull rate is 0 at first"
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


def _resistance(problem: ProblemFields, states: tuple[float, ...]) -> Callable[[Any], Floats]:
    """Return the load (Pa or N) that slip rates v >= 0 (m/s) take: damping v + S mu."""
    law, slip, damping, normal = problem.friction, problem.law_slip, problem.body.total_damping, problem.normal
    return lambda rate: np.asarray(damping * rate + normal * law.coefficient(slip, rate, one_argument(states)))


def _balance(resistance: Callable[[Any], Floats], load: float, problem: ProblemFields) -> float:
    """Return the slowest slip rate (m/s, >= 0) with a resistance equal to a load (>= 0), to rounding."""
    rates = np.geomspace(SLOWEST, FASTEST, AT_ONCE)
    beyond = resistance(rates) > load
    if beyond[0]:
        return 0.0
    if not beyond.any():
        why = f"is more than the contact resists at any slip rate up to {FASTEST:g} {problem.unit_of('slip_rate')}"
        raise InputError(f"Problem: a load of {brief(load, problem.load_unit)} {why}: give initial_rate (0 is rest)")
    for _ in range(ROUNDS):
        high = max(int(np.argmax(beyond)), 1)
        rates = np.geomspace(float(rates[high - 1]), float(rates[high]), AT_ONCE)
        beyond = resistance(rates) > load
        beyond[-1] = True  # it was so a round ago, up to rounding
    return float(rates[0])
