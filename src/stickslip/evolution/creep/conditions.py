"""In which problems there are leaps over creep, and what may be asked of them."""

from __future__ import annotations

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.problem import Problem

LARGEST_RTOL = 1e-2


def check_creep_rtol(problem: Problem, creep_rtol: float, where: str, name: str = "creep_rtol") -> float:
    """A tolerance of leaps over creep that `simulate` takes. Raises InputError beginning with `where`."""
    if not 0.0 <= creep_rtol <= LARGEST_RTOL:
        allowed = f"0 (no leaps over creep, every round trip is run) or at most {LARGEST_RTOL:g}"
        raise InputError(f"{where}: {name} must be {allowed}, got {creep_rtol:g}")
    if creep_rtol > 0.0 and (missing := _missing(problem)):
        raise InputError(f"{where}: {name} must be 0 here: leaps over creep need {missing}")
    return creep_rtol


def _missing(problem: Problem) -> str:
    """What a problem lacks; empty where there are leaps over creep."""
    body, law = problem.body, problem.friction
    if not isinstance(body, ElasticSlab):
        return "a slab, which creeps from round trip to round trip"
    if body.reflection != -1.0:
        return "a rigid driver (no driver_impedance)"
    if body.contact_mass > 0.0:
        return "a contact without mass (no contact_mass)"
    if law.state is not None or law.depends_on_rate:
        return f"a friction law of slip alone, {type(law).__name__} is not"
    if law.memory != "all":
        return "a friction law that remembers all slip (no memory of its own)"
    if problem.varies:
        return "a constant pull rate"
    return "" if problem.pull_rate != 0.0 else "a pull rate that is not 0"
