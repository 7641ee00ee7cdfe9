"""Small random disturbances of a problem's initial load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.problem.start import written_out

LEAST_DISTURBANCE, LARGEST_DISTURBANCE = 1e-15, 1e-2
"""Allowed sizes of a disturbance, as shares of the strength: rounding hides smaller ones, and larger ones make another problem."""
MOST_MEMBERS = 1000
"""Largest number of members of an ensemble; each is a full run."""


def disturbed(problem: Problem, push: float) -> Problem:
    """Return the problem with `push` (Pa; block: N) added to its initial load, and with the same far stress."""
    far = problem.stress if problem.far_stress is None and is_lossy(problem) else problem.far_stress
    if not problem.friction.sticks:
        return replace(written_out(problem), initial_load=problem.load + push, far_stress=far)
    return replace(problem, initial_load=None, initial_excess=problem.excess + push, far_stress=far)


def is_lossy(problem: Problem) -> bool:
    """Return True if the slab has a driver of finite impedance; its far stress follows from the initial load by default."""
    return not problem.body.is_driven_rigidly


def drawn(problem: Problem, members: int, size: float, seed: int) -> Floats:
    """Draw disturbances of the initial load (Pa; block: N), shape (members,). Raises InputError for arguments out of range.

    Their magnitudes lie between size/2 and size times the static strength, or the initial load for a law that never sticks.
    """
    check_whole("ensemble: members", members, 1, MOST_MEMBERS)
    if not LEAST_DISTURBANCE <= size <= LARGEST_DISTURBANCE:
        raise InputError(f"ensemble: size must lie between {LEAST_DISTURBANCE:g} and {LARGEST_DISTURBANCE:g}, got {size!r}")
    check_whole("ensemble: seed", seed, 0)
    scale = abs(problem.strength if problem.friction.sticks else problem.load)
    if scale == 0.0:
        raise InputError("ensemble: there is neither a strength nor an initial load whose share could disturb it")
    shares = 2.0 * np.random.default_rng(seed).random(members) - 1.0
    return _kept_going(problem, 0.5 * size * scale * (shares + np.copysign(1.0, shares)))


def _kept_going(problem: Problem, pushes: Floats) -> Floats:
    """Return the pushes, with their sign changed where they would hold back a contact that starts at its strength or beyond.

    A contact that is held back starts from rest, and its run is the same one a little later.
    """
    # excess of the load over the strength for forward and for backward slip
    ahead, behind = problem.excess, -problem.excess - 2.0 * problem.strength
    held_back = ahead + pushes < 0.0 if ahead >= 0.0 else (behind >= 0.0) & (behind - pushes < 0.0)
    return np.where(held_back, -pushes, pushes)
