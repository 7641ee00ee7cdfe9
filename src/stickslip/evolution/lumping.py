"""Where slip events too short to be told apart may be lumped, and what may be asked for.

Under rate weakening every slip steepens the echoes that it sends back, and the events that they make get shorter and shorter. With
a `shortest_event`, pieces of load that are shorter carry their mean, so that they slip as a whole or not at all, and a piece at
rest breaks only where more of it than that is beyond the strength. So the pieces of a round trip are bounded in number.
"""

from __future__ import annotations

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.problem import Problem

LARGEST_SHARE = 0.01
"""Of the two-way travel time: more would not be a slab."""


def check_shortest_event(problem: Problem, shortest: float, where: str, name: str = "shortest_event") -> float:
    """A shortest event (s) that `simulate` takes. Raises InputError beginning with `where`."""
    if shortest == 0.0:
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
