"""Limits of leaps over creep: which problems allow them, which tolerances are valid, and the automatic tolerance."""

from __future__ import annotations

import math

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

LARGEST_RTOL = 1e-2
"""Largest creep_rtol that is accepted."""
PATIENCE = 200
"""Number of round trips with slip that are all computed before automatic leaps may begin: on the printed slab 40 000 pieces and
0.1 s.
"""
PER_ROOT_RTOL = 0.1
"""Automatic creep_rtol divided by the square root of rtol: the time of the first pulse then has a relative error of about rtol."""
TIGHTEST, LOOSEST = 1e-6, 1e-3
"""Bounds of the automatic creep_rtol: tighter ones leave too many round trips to compute, looser ones have not been measured."""


def creep_tolerance(problem: Problem, creep_rtol: float | None, rtol: float) -> float:
    """Return the tolerance of leaps over creep in a run: the given or the automatic one, or 0 if there are no leaps."""
    if creep_rtol is not None:
        return creep_rtol
    return 0.0 if _missing(problem) else min(max(PER_ROOT_RTOL * math.sqrt(rtol), TIGHTEST), LOOSEST)


def check_creep_rtol(problem: Problem, creep_rtol: float | None, where: str, name: str = "creep_rtol") -> float | None:
    """Check a tolerance of leaps over creep that `simulate` takes (None is automatic). Raises InputError beginning with `where`."""
    if creep_rtol is None:
        return None
    if not 0.0 <= creep_rtol <= LARGEST_RTOL:
        allowed = f"0 (no leaps over creep, every round trip is run) or at most {LARGEST_RTOL:g}"
        raise InputError(f"{where}: {name} must be {allowed}, got {creep_rtol:g}")
    if creep_rtol > 0.0 and (missing := _missing(problem)):
        raise InputError(f"{where}: {name} must be 0 here: leaps over creep need {missing}")
    return creep_rtol


def _missing(problem: Problem) -> str:
    """Return what a problem lacks for leaps over creep; empty if it lacks nothing."""
    return missing_but_pull(problem) or ("" if problem.pull_rate != 0.0 else "a pull rate that is not 0")


def missing_but_pull(problem: Problem) -> str:
    """Return what a problem lacks besides a pull rate, which may differ between the members of a batch."""
    body, law = problem.body, problem.friction
    if not body.has_waves:
        return "a slab, which creeps from round trip to round trip"
    if not body.is_driven_rigidly:
        return "a rigid driver (no driver_impedance)"
    if body.has_inertia:
        return "a contact without mass (no contact_mass)"
    if law.states or law.depends_on_rate:
        return f"a friction law of slip alone ({type(law).__name__} is not one)"
    if law.memory != "all":
        return "a friction law that remembers all slip (no memory of its own)"
    if problem.varies:
        return "a constant pull rate"
    return ""
