"""How each member of a sweep ended: codes in the variable `status` of the dataset."""

from __future__ import annotations

from stickslip.engine.state.layout import FAILED, FINISHED, LOCKED, NEGATIVE_FRICTION, OFF_THE_LAW, STORM
from stickslip.trajectory.status import BAD_PARAMETERS as REFUSED
from stickslip.trajectory.status import ENOUGH_EVENTS, FULL_HISTORY

NOT_RUN = -1
BAD_PARAMETERS = 10
"""The scenario with these values is refused, or cannot start."""
ERROR = 14
"""A quantity could not be worked out, or something else went wrong."""
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
"""Names of the codes: below 0 the member has not been run, from 10 on it failed and has no results but a reason."""
FIRST_FAILURE = 10

CODES = {
    FINISHED: 0,
    ENOUGH_EVENTS: 1,
    LOCKED: 2,
    STORM: 11,
    FAILED: 12,
    FULL_HISTORY: 13,
    NEGATIVE_FRICTION: 15,
    OFF_THE_LAW: 16,
    REFUSED: BAD_PARAMETERS,
}
"""Of the codes that end a run (`engine.state.layout`, `trajectory.status`)."""
