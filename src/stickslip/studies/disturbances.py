"""Small disturbances of a problem's initial load."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import Floats

SMALLEST, LARGEST = 1e-15, 1e-2
"""Sizes between which a disturbance is one."""
MOST_MEMBERS = 1000


def disturbed(problem: Problem, push: float) -> Problem:
    """The problem with an initial load that is larger by a push (Pa; block: N)."""
    far = problem.load if problem.far_stress is None and is_lossy(problem) else problem.far_stress
    if not problem.friction.sticks:
        return replace(problem, initial_load=problem.load + push, far_stress=far)
    return replace(problem, initial_load=None, initial_excess=problem.excess + push, far_stress=far)


def is_lossy(problem: Problem) -> bool:
    """Whether the slab has a driver of finite impedance, whose far stress is the initial load by default."""
    return not math.isinf(getattr(problem.body, "driver_impedance", math.inf))


def drawn(problem: Problem, members: int, size: float, seed: int) -> Floats:
    """Disturbances of the initial load (Pa or N). Raises InputError."""
    if not (isinstance(members, int) and 1 <= members <= MOST_MEMBERS):
        raise InputError(f"ensemble: members must be a whole number from 1 to {MOST_MEMBERS}, got {members!r}")
    if not SMALLEST <= size <= LARGEST:
        raise InputError(f"ensemble: size must lie between {SMALLEST:g} and {LARGEST:g}, got {size!r}")
    if not (isinstance(seed, int) and seed >= 0):
        raise InputError(f"ensemble: seed must be a whole number, 0 or more, got {seed!r}")
    scale = abs(problem.strength if problem.friction.sticks else problem.load)
    if scale == 0.0:
        raise InputError("ensemble: there is neither a strength nor an initial load of which a share could disturb it")
    shares = 2.0 * np.random.default_rng(seed).random(members) - 1.0
    return _kept_going(problem, 0.5 * size * scale * (shares + np.copysign(1.0, shares)))


def _kept_going(problem: Problem, pushes: Floats) -> Floats:
    """None may hold back a contact that begins at its strength or beyond: from rest it would do the same a little later."""
    ahead, behind = problem.excess, -problem.excess - 2.0 * problem.strength  # of the strength forwards, and backwards
    held_back = ahead + pushes < 0.0 if ahead >= 0.0 else (behind >= 0.0) & (behind - pushes < 0.0)
    return np.where(held_back, -pushes, pushes)
