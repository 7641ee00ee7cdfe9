"""Where slip events too short to be told apart may be lumped, and what may be asked for.

Under rate weakening every slip steepens the echoes that it sends back, and the events that they make get shorter and shorter. With
a `shortest_event`, pieces of load that are shorter carry their mean, so that they slip as a whole or not at all, and a piece at
rest breaks only where more of it than that is beyond the strength. So the pieces of a round trip are bounded in number.

Without one being given, nothing is lumped until a round trip has more than MOST_PIECES pieces. A contact that creeps below the
critical rate weakening doubles them in each round trip, because it answers each echo with a larger one of the opposite sign:
nobody can follow that for long, and what is lumped then is far beyond what can be resolved.
"""

from __future__ import annotations

from stickslip.bodies import ElasticSlab
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

LARGEST_SHARE = 0.01
"""Of the two-way travel time: more would not be a slab."""
MOST_PIECES = 4096
"""Pieces in a round trip from which on events are lumped automatically: each costs about 0.4 kB and a microsecond."""
AUTOMATIC_SHARE = 1.0 / 1024.0
"""Shortest event of automatic lumping, as a share of the two-way travel time: a few pieces fit into each."""


def check_shortest_event(problem: Problem, shortest: float | None, where: str, name: str = "shortest_event") -> float | None:
    """Check a shortest event (s; None is automatic) that `simulate` takes. Raises InputError beginning with `where`."""
    if shortest is None or shortest == 0.0:
        return shortest
    body = problem.body
    if not isinstance(body, ElasticSlab) or body.reflection != -1.0:
        raise InputError(f"{where}: {name} must be 0 here: only under a slab with a rigid driver do echoes get ever shorter")
    if problem.varies:
        raise InputError(f"{where}: {name} must be 0 here: events are lumped under a constant pull only")
    largest = LARGEST_SHARE * body.two_way_time
    if not 0.0 < shortest <= largest:
        raise InputError(f"{where}: {name} must be 0 or at most {largest:g} s (1 % of the two-way travel time), got {shortest:g} s")
    return shortest


def lumps_by_itself(problem: Problem) -> bool:
    """Return True if events are lumped automatically: echoes come back whole, and friction depends on the slip rate alone."""
    body, law = problem.body, problem.friction
    return (
        isinstance(body, ElasticSlab)
        and body.reflection == -1.0
        and not body.contact_mass > 0.0
        and not problem.varies
        and law.depends_on_rate
        and law.state is None
    )


def automatic_length(body: ElasticSlab) -> float:
    """Return the shortest event (s) of automatic lumping."""
    return AUTOMATIC_SHARE * body.two_way_time
