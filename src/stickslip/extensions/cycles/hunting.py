"""The end of hunting about a set point at rest: where cycles of a position loop begin with an amplitude of 0.

Near the set point slips are slow, and friction is S (mu0 + mu' v) there if it does not drop where slip begins. The slip that
begins at a lag e under the load S mu0 obeys m v' = l - (c + S mu') v, l' = ki e - kp v, e' = -v from l = v = 0 on, until v is 0
again. It ends at a lag of -rho e, and rho does not depend on e. Hunting grows from all small lags where the rho of both ways have a
product above 1, and dies out below it. At 1 a cycle vanishes, and its rests have become infinitely long: the load grows by ki e.

Source: Hensen, Van de Molengraft & Steinbuch 2003, Automatica 39, 2131, for hunting that ends.
"""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from stickslip.extensions.cycles.exponent import law_in
from stickslip.extensions.cycles.lag import is_wound
from stickslip.extensions.cycles.path import Path, PlaceOnBranch
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring

STEPS_IN_HALF, MOST_HALVES = 64, 64
"""A swing back is looked for at so many times in each half of a free period, in so many of them (1)."""
FIRST_WIDTH, LAST_WIDTH = 1e-6, 0.1
"""The end is looked for from this far to that far from the last cycle (1, shares of the range, or of the value)."""
ROUNDING_OF_DROP = 1e-12
"""Friction that drops by less than this where slip begins does not drop (1)."""


def growth_of_small_hunting(problem: Problem) -> float | None:
    """Return by what factor (1) small lags grow in a period about the set point; None if hunting never is small.

    It is 0 where a slip ends before the set point. Hunting is not small where friction drops as slip begins, and nothing is said of
    laws with states, or of a reference that moves.
    """
    law = problem.friction
    if not is_wound(problem) or problem.first_pull_rate != 0.0 or law.states or not law.sticks:
        return None
    factors = []
    for direction in (1, -1):
        one = law_in(problem, direction)
        if float(one.static_coefficient(0.0)) - float(one.coefficient(0.0)) > ROUNDING_OF_DROP:
            return None
        factors.append(_overshoot(problem, float(one.slopes(0.0, 0.0)[1])))
    return factors[0] * factors[1] if min(factors) > 0.0 else 0.0


def end_of_hunting(path: Path, last: PlaceOnBranch) -> float | None:
    """Return the value (SI) next to a cycle of small amplitude where small lags neither grow nor die out; None: nowhere near."""
    now = growth_of_small_hunting(path.section(last.value).problem)
    if now is None:
        return None

    def growth(value: float) -> float:
        return (growth_of_small_hunting(path.section(value).problem) or 0.0) - 1.0

    size = max(path.range, abs(last.value))
    width = FIRST_WIDTH * size
    while width <= LAST_WIDTH * size:
        for end in (last.value + width, last.value - width):
            with suppress(InputError):
                if growth(end) * (now - 1.0) < 0.0:
                    return float(brentq(growth, last.value, end, xtol=1e-14 * abs(end), rtol=1e-14))
        width *= 2.0
    return None


def _overshoot(problem: Problem, by_rate: float) -> float:
    """Return the lag behind a small slip over that before it, with its sign turned; `by_rate` (s/m) is the slope of mu."""
    body = as_on_spring(problem.body)
    motion = np.array(
        [
            [-(body.total_damping + problem.normal * by_rate) / body.inertia, 1.0 / body.inertia, 0.0],
            [-body.stiffness, 0.0, body.integral_gain],
            [-1.0, 0.0, 0.0],
        ]
    )
    roots = np.linalg.eigvals(motion)
    swings = float(np.abs(roots.imag).max())
    if swings == 0.0:  # a sum of three exponentials that is 0 twice at the start is so never again
        return 0.0 if roots.real.max() < 0.0 else math.inf
    length = math.pi / (STEPS_IN_HALF * swings)
    step, now, start = expm(length * motion), np.array([0.0, 0.0, 1.0]), 0.0
    for _ in range(STEPS_IN_HALF * MOST_HALVES):
        new = step @ now
        if new[0] <= 0.0 and start > 0.0:
            return _lag_at_rest(motion, now, length)
        now, start = new, start + length
    return 0.0 if roots.real.max() < 0.0 else math.inf


def _lag_at_rest(motion: Floats, now: Floats, length: float) -> float:
    """Return the lag, with its sign turned, where a motion comes to rest within a time (s) from a place on it."""

    def rate(time: float) -> float:
        return float((expm(time * motion) @ now)[0])

    return -float((expm(float(brentq(rate, 0.0, length, xtol=1e-15, rtol=1e-14)) * motion) @ now)[2])
