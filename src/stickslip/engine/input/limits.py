"""Where the engine leaps over creep by itself, and where slip events that are too short to be told apart are lumped.

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

import math

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, Params
from stickslip.problem import EXACT_TRIPS, MOST_PIECES, Problem, check_round_trips, leaps_but_for_pull, lumps_by_itself


def wait_for_creep(count: Counts, problem: Problem, creep_rtol: float | None) -> None:
    """Have the engine pause when a run that leaps automatically has had EXACT_TRIPS round trips with slip."""
    if creep_rtol is None and leaps_but_for_pull(problem):
        count.creep_in = EXACT_TRIPS


def set_lumping(count: Counts, problem: Problem, shortest: float | None) -> None:
    """Set the counts at t = 0 that say when short pieces are lumped: from the start, later, or never."""
    lumps = shortest is not None and shortest > 0.0
    count.lumps, count.lumped_since = lumps, 0 if lumps else at.NEVER
    count.lump_above = MOST_PIECES if shortest is None and lumps_by_itself(problem) else at.NEVER


def set_length(params: Params, shortest: float | None) -> None:
    """Set the length of the pieces that are lumped, in `Setup.params` or in one with a column for each member, if it is given."""
    if shortest is not None:
        params.shortest = shortest


def lumping_note(count: Counts, params: Params, shortest: float | None) -> str:
    """Return one line on automatic lumping in a run; empty if it did not begin."""
    if shortest is not None or count.lumps == 0:
        return ""
    since = count.lumped_since * params.round_trip_time
    return (
        f"events shorter than {params.shortest:.3g} s are lumped from {since:.6g} s on, where a round trip had more than"
        f" {MOST_PIECES} pieces: what follows is right only on average (shortest_event = 0 resolves every event)"
    )


def split_time(time: float, round_trip: float) -> tuple[int, float]:
    """Return a positive time (s) as (whole round trips, offset in (0, round trip]). Raises InputError for too many round trips.

    A block's round trip is a period; `round_trip` is its length, s.
    """
    check_round_trips(time, round_trip, "run")
    trips = math.floor(time / round_trip)
    offset = time - trips * round_trip
    if offset <= 0.0 and trips > 0:
        return trips - 1, round_trip
    return trips, min(offset, round_trip)
