"""What a problem allows of the options of its run: where it may leap over creep, and where short slip events may be lumped.

Options are checked here whatever solves the problem. What the engine then does with them is set in `engine.input.limits`.
"""

from __future__ import annotations

import math
from typing import Literal

from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers, has_dashpot
from stickslip.problem.loading import LoadingHistory
from stickslip.problem.problem import Problem

MOST_ROUND_TRIPS = 2**53
"""Largest number of round trips of a slab, or periods of a block: a float64 counts up to here without gaps."""
LARGEST_RTOL = 1e-2
"""Largest creep_rtol that is accepted."""
PER_ROOT_RTOL = 0.1
"""Automatic creep_rtol divided by the square root of rtol: the time of the first pulse then has a relative error of about rtol."""
TIGHTEST, LOOSEST = 1e-6, 1e-3
"""Bounds of the automatic creep_rtol: tighter ones leave too many round trips to compute, looser ones have not been measured."""

PATIENCE = 200
"""Number of round trips with slip that are all computed before automatic leaps may begin: on the printed slab 40 000 pieces and
0.1 s.
"""
MOST_PIECES = 4096
"""Events are lumped automatically if a round trip has more pieces than this: each costs about 0.4 kB and a microsecond."""

Over = Literal["creep", "swinging creep", "slow sliding", "steady sliding", ""]
"""What a run may leap over: creep under a law of slip (of a slab, or of a block, which swings), slow or only steady sliding, or
nothing."""


def creep_tolerance(problem: Problem, creep_rtol: float | None, rtol: float) -> float:
    """Return the tolerance of leaps over creep in a run: the given or the automatic one, or 0 if there are no leaps."""
    if creep_rtol is not None:
        return creep_rtol
    return min(max(PER_ROOT_RTOL * math.sqrt(rtol), TIGHTEST), LOOSEST) if leaps_over(problem) else 0.0


def leaps_over(problem: Problem) -> Over:
    """Return what a run of a problem may leap over."""
    rigid = problem.body.is_driven_rigidly
    if not problem.body.is_uniform:
        return ""
    return leaps_but_for_pull(problem) if problem.pull_rate != 0.0 or not rigid else ""


def leaps_but_for_pull(problem: Problem) -> Over:
    """Return what `leaps_over` does, whatever the pull rate is, which may differ between the members of a batch."""
    if not missing_for_creep(problem):
        return "creep"
    if swings_as_it_creeps(problem):
        return "swinging creep"
    law = problem.friction
    if not _slides_alike(law) or _what_changes(problem):
        return ""
    body = problem.body
    never_rests = law.creeps and bool(law.states) and len(law.pieces) == 1
    is_averaged = body.has_waves and body.is_driven_rigidly and not has_dashpot(body)
    return "slow sliding" if never_rests and is_averaged else "steady sliding"


def swings_as_it_creeps(problem: Problem) -> bool:
    """Return True if a problem is a block under a law of slip, with all that leaps over its creep need but a pull rate."""
    return not problem.body.has_waves and not missing_for_swings(problem)


def missing_for_swings(problem: Problem) -> str:
    """Return what a block lacks for leaps over creep under a law of slip, besides a pull rate; empty if it lacks nothing."""
    law = problem.friction
    if not law.depends_on_slip or law.depends_on_rate or law.states:
        return f"a friction law of slip alone ({type(law).__name__} is not one)"
    if law.memory != "all":
        return "a friction law that remembers all slip (no memory of its own)"
    if not law.sticks or law.static_excess != 0.0:
        return "a friction law under which slip begins at the friction of rest"
    if problem.ground is not None or problem.one_way:
        return "ground at rest, and slip in both directions"
    if problem.varies or problem.driver_changes:
        return "a constant pull rate and normal load"
    return ""


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


def missing_for_creep(problem: Problem) -> str:
    """Return what a problem lacks for leaps over creep under a law of slip, besides a pull rate; empty if it lacks nothing."""
    body, law = problem.body, problem.friction
    if not body.has_waves:
        return "a slab or a string, which creeps from round trip to round trip"
    if not body.is_uniform:
        return "a body of one layer"
    if not body.is_driven_rigidly:
        return "a rigid driver (no driver_impedance)"
    if body.has_inertia:
        return f"a contact without mass (no {body.mass_field})"
    if has_dashpot(body):
        return f"a contact that waves alone damp (the damping of this {type(body).__name__} is not its impedance)"
    if law.states or law.depends_on_rate:
        return f"a friction law of slip alone, or one without slip ({type(law).__name__} is neither)"
    if law.memory != "all":
        return "a friction law that remembers all slip (no memory of its own)"
    if problem.ground is not None or problem.one_way:
        return "ground at rest, and slip in both directions"
    return _what_changes(problem)


def _missing_for_leaps(problem: Problem) -> str:
    """Return what a problem lacks for any leaps, besides a pull rate, in words; empty if it lacks nothing.

    Steady sliding may be leapt over on any uniform body, unless something changes. On moving ground a driver that gives way is
    named first.
    """
    shaken = problem.ground is not None and not problem.body.is_driven_rigidly
    if shaken or not _slides_alike(problem.friction):
        return (missing_for_creep if problem.body.has_waves else missing_for_swings)(problem)
    return _what_changes(problem) if problem.body.is_uniform else "a body of one layer"


def _slides_alike(law: FrictionLaw) -> bool:
    """Return True if friction may be the same for ever while a contact slides: it depends on slip rate or state, not on slip."""
    return not law.depends_on_slip and (law.depends_on_rate or bool(law.states))


def _what_changes(problem: Problem) -> str:
    """Return what would have to be constant for leaps, in words; empty if it is."""
    if problem.driver_changes:
        return "a driver that does not change"
    if problem.ground is not None:
        return "ground at rest"
    varies = isinstance(problem.far_stress, LoadingHistory) or problem.far_stress_rate != 0.0
    if varies and not problem.body.is_driven_rigidly:
        return "a constant far stress"
    if problem.body.has_machine:
        return "a driver without a mass and an integral gain"
    return "a constant pull rate and normal load" if problem.varies else ""


LARGEST_SHARE = 0.01
"""Largest shortest_event, as a share of the two-way travel time: a body with a longer one would no longer behave as a slab."""
AUTOMATIC_SHARE = 1.0 / 1024.0
"""Shortest event of automatic lumping, as a share of the two-way travel time: a few pieces fit into each such interval."""


def check_shortest_event(problem: Problem, shortest: float | None, where: str, name: str = "shortest_event") -> float | None:
    """Check a shortest event (s; None is automatic) that `simulate` takes. Raises InputError beginning with `where`."""
    if shortest is None or shortest == 0.0:
        return shortest
    body = problem.body
    if body.has_waves and not body.is_uniform:
        if body.has_inertia:
            raise InputError(f"{where}: {name} must be 0 here: a contact with mass smooths the waves that come through layers")
    elif not (body.has_waves and body.is_driven_rigidly):
        raise InputError(f"{where}: {name} must be 0 here: only with waves and a rigid driver do echoes get ever shorter")
    elif problem.varies:
        raise InputError(f"{where}: {name} must be 0 here: events are lumped under a constant pull and normal load only")
    largest = LARGEST_SHARE * longest_way(body)
    if not 0.0 < shortest <= largest:
        raise InputError(f"{where}: {name} must be 0 or at most {largest:g} s (1 % of the two-way travel time), got {shortest:g} s")
    return shortest


def lumps_by_itself(problem: Problem) -> bool:
    """Return True if events are lumped automatically.

    That requires echoes that come back whole, or through layers, and friction that depends on the slip rate and has no state.
    """
    body, law = problem.body, problem.friction
    if not body.has_waves or body.has_inertia or not law.depends_on_rate or law.states:
        return False
    if not body.is_uniform and body.has_machine:
        return True
    return not problem.varies and (body.is_driven_rigidly or not body.is_uniform)


def automatic_length(body: BodyOnCharacteristics) -> float:
    """Return the shortest event (s) of automatic lumping."""
    return AUTOMATIC_SHARE * longest_way(body)


def longest_way(body: BodyOnCharacteristics) -> float:
    """Return the time (s) of a wave to the driver and back, through all layers; of a block its period."""
    return body.two_way_time if isinstance(body, OfLayers) else body.round_trip_time


def check_round_trips(duration: float, round_trip: float, where: str) -> None:
    """Refuse a run of more than 2^53 round trips of `round_trip` seconds, which cannot be counted exactly. Raises InputError."""
    if not duration <= MOST_ROUND_TRIPS * round_trip:
        raise InputError(
            f"{where}: duration must be at most {MOST_ROUND_TRIPS * round_trip:.3g} s, 2^53 round trips of {round_trip:.3g} s, "
            f"got {duration:g} s"
        )
