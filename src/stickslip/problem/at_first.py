"""Waves in a body at the start, and the stress behind it, as differences from the reference strength."""

from __future__ import annotations

from typing import Any

from stickslip.problem.problem import Problem


def wave_before(problem: Problem) -> Any:
    """Return the wave beta - 2 Z v, minus the reference strength (Pa), that leaves the contact of a slab just before the start."""
    return problem.excess - 2.0 * problem.body.impedance * problem.rate


def far_excess(problem: Problem) -> Any:
    """Return the default far stress, that in the slab at the start, minus the reference strength (Pa)."""
    return problem.excess - problem.body.impedance * problem.rate


def far_at_first(problem: Problem) -> Any:
    """Return the stress behind the last layer, or behind a slab, at the start, minus the reference strength (Pa)."""
    body = problem.body
    return body.first_share * far_excess(problem) + body.held_at_start(problem.rate, problem.initial_shear)[0]
