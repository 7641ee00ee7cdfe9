"""What a problem allows of the options of its run: where it may leap over creep, and where short slip events may be lumped.

Options are checked here whatever solves the problem. What the engine then does with them is set in `engine.input.limits`.
"""

from __future__ import annotations

import math

from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.leaps.asked import LEAPS, Over
from stickslip.problem.problem import Problem

MOST_ROUND_TRIPS = 2**53
"""Largest number of round trips of a slab, or periods of a block: a float64 counts up to here without gaps."""
LARGEST_RTOL = 1e-2
"""No larger creep_rtol is accepted."""
PER_ROOT_RTOL = 0.1
"""Automatic creep_rtol divided by the square root of rtol: the time of the first pulse then has a relative error of about rtol."""
TIGHTEST, LOOSEST = 1e-6, 1e-3
"""Bounds of the automatic creep_rtol: tighter ones leave too many round trips to compute, looser ones have not been measured."""

EXACT_TRIPS = 200
"""Compute this many round trips with slip before automatic leaps may begin: on the printed slab 40 000 pieces and
0.1 s.
"""
MOST_PIECES = 4096
"""Events are lumped automatically if a round trip has more pieces than this: each costs about 0.4 kB and a microsecond."""


def creep_tolerance(problem: Problem, creep_rtol: float | None, rtol: float) -> float:
    """Return the tolerance of leaps over creep in a run: the given or the automatic one, or 0 if there are no leaps."""
    if creep_rtol is not None:
        return creep_rtol
    return min(max(PER_ROOT_RTOL * math.sqrt(rtol), TIGHTEST), LOOSEST) if leaps_over(problem) else 0.0


def leaps_over(problem: Problem) -> Over:
    """Return what a run of a problem may leap over."""
    is_driven = problem.pull_rate != 0.0 or not problem.body.is_driven_rigidly
    return leaps_but_for_pull(problem) if is_driven else ""


def leaps_but_for_pull(problem: Problem) -> Over:
    """Return what `leaps_over` does, whatever the pull rate is, which may differ between the members of a batch."""
    body, law = LEAPS[problem.body.structure], problem.friction
    if law.backward_from:
        return ""
    if not body.missing_for_creep(problem):
        return body.creep
    if not _slides_alike(law) or body.missing_for_steady(problem):
        return ""
    never_rests = law.creeps and bool(law.states) and len(law.pieces) == 1
    return "slow sliding" if never_rests and body.averages(problem) else "steady sliding"


def check_creep_rtol(problem: Problem, creep_rtol: float | None, where: str, name: str = "creep_rtol") -> float | None:
    """Check a tolerance of leaps over creep that `simulate` takes (None is automatic). Raises InputError beginning with `where`."""
    if creep_rtol is None:
        return None
    if not 0.0 <= creep_rtol <= LARGEST_RTOL:
        allowed = f"0 (no leaps over creep, every round trip is run) or at most {LARGEST_RTOL:g}"
        raise InputError(f"{where}: {name} must be {allowed}, got {creep_rtol:g}")
    if creep_rtol > 0.0 and not leaps_over(problem):
        missing = _missing_for_leaps(problem) or "a pull rate that is not 0"
        raise InputError(f"{where}: {name} must be 0 here: leaps over creep need {missing}")
    return creep_rtol


def _missing_for_leaps(problem: Problem) -> str:
    """Return what a problem lacks for any leaps, besides a pull rate, in words; empty if it lacks nothing.

    Steady sliding may be leapt over on any uniform body, unless something changes. On moving ground a driver that gives way is
    named first.
    """
    if problem.friction.backward_from:
        return "a friction law that is the same in both directions of slip"
    body, gives_way = LEAPS[problem.body.structure], not problem.body.is_driven_rigidly
    if (problem.ground is not None and gives_way) or not _slides_alike(problem.friction):
        return body.missing_for_creep(problem)
    return body.missing_for_steady(problem)


def _slides_alike(law: FrictionLaw) -> bool:
    """Return True if friction may be the same for ever while a contact slides: it depends on slip rate or state, not on slip."""
    return not law.depends_on_slip and (law.depends_on_rate or bool(law.states))


LARGEST_SHARE = 0.01
"""Largest shortest_event, as a share of the two-way travel time: a body with a longer one would no longer behave as a slab."""
AUTOMATIC_SHARE = 1.0 / 1024.0
"""Shortest event of automatic lumping, as a share of the two-way travel time: a few pieces fit into each such interval."""


def check_shortest_event(problem: Problem, shortest: float | None, where: str, name: str = "shortest_event") -> float | None:
    """Check a shortest event (s; None is automatic) that `simulate` takes. Raises InputError beginning with `where`."""
    if shortest is None or shortest == 0.0:
        return shortest
    if why := LEAPS[problem.body.structure].why_not_lumped(problem):
        raise InputError(f"{where}: {name} must be 0 here: {why}")
    largest = LARGEST_SHARE * problem.body.longest_way
    if not 0.0 < shortest <= largest:
        raise InputError(f"{where}: {name} must be 0 or at most {largest:g} s (1 % of the two-way travel time), got {shortest:g} s")
    return shortest


def lumps_by_itself(problem: Problem) -> bool:
    """Return True if events are lumped automatically.

    That requires echoes that come back whole, or through layers, and friction that depends on the slip rate and has no state.
    """
    body, law = problem.body, problem.friction
    if body.has_inertia or not law.depends_on_rate or law.states:
        return False
    return LEAPS[body.structure].lumps_by_itself(problem)


def automatic_length(body: BodyOnCharacteristics) -> float:
    """Return the shortest event (s) of automatic lumping."""
    return AUTOMATIC_SHARE * body.longest_way


def check_round_trips(duration: float, round_trip: float, where: str) -> None:
    """Refuse a run of more than 2^53 round trips of `round_trip` seconds, which cannot be counted exactly. Raises InputError."""
    if not duration <= MOST_ROUND_TRIPS * round_trip:
        raise InputError(
            f"{where}: duration must be at most {MOST_ROUND_TRIPS * round_trip:.3g} s, 2^53 round trips of {round_trip:.3g} s, "
            f"got {duration:g} s"
        )
