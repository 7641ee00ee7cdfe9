"""The codes that say how each member of a sweep ended, in the variable `status` of the dataset."""

from __future__ import annotations

from stickslip.engine.state.layout import Stop
from stickslip.trajectory.status import BAD_PARAMETERS as REFUSED
from stickslip.trajectory.status import ENOUGH_EVENTS, FULL_HISTORY

NOT_RUN = -1
"""Code of a member that has not been run; a new store is filled with it."""
BAD_PARAMETERS = 10
"""Code of a member whose scenario is refused, or cannot start."""
ERROR = 14
"""Code of a member for which a quantity could not be calculated, or something else went wrong."""
MEANINGS = {
    NOT_RUN: "not_run",
    0: "finished",
    1: "enough_events",
    2: "locked_for_ever",
    BAD_PARAMETERS: "bad_parameters",
    11: "event_storm",
    12: "not_finite",
    13: "too_many_pieces",
    15: "negative_friction",
    16: "off_the_law",
    ERROR: "error",
}
"""Names of the codes. Codes below 0 are of members that have not been run; members with codes from 10 on failed, and have a reason
in place of results."""
FIRST_FAILURE = 10
"""Smallest code of a failure."""

CODES = {
    Stop.FINISHED: 0,
    ENOUGH_EVENTS: 1,
    Stop.LOCKED: 2,
    Stop.STORM: 11,
    Stop.FAILED: 12,
    FULL_HISTORY: 13,
    Stop.NEGATIVE_FRICTION: 15,
    Stop.OFF_THE_LAW: 16,
    REFUSED: BAD_PARAMETERS,
}
"""The code of a member by the code that ended its run (`engine.state.layout`, `trajectory.status`)."""
