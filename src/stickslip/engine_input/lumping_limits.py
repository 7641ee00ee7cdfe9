"""Limits of lumping: where slip events that are too short to be told apart may be, or are, lumped, and of which lengths.

Under rate weakening every slip steepens the echoes that it sends back, and the events that they cause get shorter and shorter.
With a `shortest_event`, shorter pieces of load are replaced by their mean, so that they slip as a whole or not at all, and a
piece at rest begins to slip only where more of it than that length is beyond the strength. This bounds the number of pieces in a
round trip.

The engine counts what automatic leaps and lumping depend on, so that a single run, a run that is resumed and a member of a batch
make the same choice. Until then a run is bit for bit the same as one that never leaps or lumps.

Without a given `shortest_event`, nothing is lumped until a round trip has more than MOST_PIECES pieces. A contact that creeps
below the critical rate weakening doubles them in each round trip, because it answers each echo with a larger one of the opposite
sign. No computation can follow that for long, and the events that are lumped then could not be resolved anyway.
"""

from __future__ import annotations

from stickslip.bodies import BodyOnCharacteristics
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, Params
from stickslip.engine_input.creep_limits import PATIENCE, missing_but_pull
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

LARGEST_SHARE = 0.01
"""Largest shortest_event, as a share of the two-way travel time: a body with a longer one would no longer behave as a slab."""
MOST_PIECES = 4096
"""Number of pieces in a round trip above which events are lumped automatically: each costs about 0.4 kB and a microsecond."""
AUTOMATIC_SHARE = 1.0 / 1024.0
"""Shortest event of automatic lumping, as a share of the two-way travel time: a few pieces fit into each such interval."""


def check_shortest_event(problem: Problem, shortest: float | None, where: str, name: str = "shortest_event") -> float | None:
    """Check a shortest event (s; None is automatic) that `simulate` takes. Raises InputError beginning with `where`."""
    if shortest is None or shortest == 0.0:
        return shortest
    body = problem.body
    if not (body.has_waves and body.is_driven_rigidly):
        raise InputError(f"{where}: {name} must be 0 here: only under a slab with a rigid driver do echoes get ever shorter")
    if problem.varies:
        raise InputError(f"{where}: {name} must be 0 here: events are lumped under a constant pull only")
    largest = LARGEST_SHARE * body.round_trip_time
    if not 0.0 < shortest <= largest:
        raise InputError(f"{where}: {name} must be 0 or at most {largest:g} s (1 % of the two-way travel time), got {shortest:g} s")
    return shortest


def lumps_by_itself(problem: Problem) -> bool:
    """Return True if events are lumped automatically.

    That requires echoes that come back whole, and friction that depends on the slip rate and has no state variable.
    """
    body, law = problem.body, problem.friction
    return (
        body.has_waves
        and body.is_driven_rigidly
        and not body.has_inertia
        and not problem.varies
        and law.depends_on_rate
        and not law.states
    )


def automatic_length(body: BodyOnCharacteristics) -> float:
    """Return the shortest event (s) of automatic lumping."""
    return AUTOMATIC_SHARE * body.round_trip_time


def wait_for_creep(count: Counts, problem: Problem, creep_rtol: float | None) -> None:
    """Have the engine pause when a run that leaps automatically has had PATIENCE round trips with slip."""
    if creep_rtol is None and not missing_but_pull(problem):
        count.creep_in = PATIENCE


def set_lumping(count: Counts, problem: Problem, shortest: float | None) -> None:
    """Set the counts at t = 0 that say when short pieces are lumped: from the start, later, or never."""
    lumps = shortest is not None and shortest > 0.0
    count.lumps, count.lumped_since = lumps, 0 if lumps else at.NEVER
    count.lump_above = MOST_PIECES if shortest is None and lumps_by_itself(problem) else at.NEVER


def set_length(params: Params, shortest: float | None) -> None:
    """Set the length of the pieces that are lumped, in `Setup.params` or in one with a column for each member."""
    params.shortest = AUTOMATIC_SHARE * params.round_trip_time if shortest is None else shortest


def lumping_note(count: Counts, params: Params, shortest: float | None) -> str:
    """Return one line on automatic lumping in a run; empty if it did not begin."""
    if shortest is not None or count.lumps == 0:
        return ""
    since = count.lumped_since * params.round_trip_time
    return (
        f"events shorter than {params.shortest:.3g} s are lumped from {since:.6g} s on, where a round trip had more than"
        f" {MOST_PIECES} pieces: what follows is right only on average (shortest_event = 0 resolves every event)"
    )
