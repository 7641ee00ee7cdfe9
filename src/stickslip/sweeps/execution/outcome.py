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
FIRST_FAILURE = 10
"""Smallest code of a failure. Members that failed have a reason in place of results."""

_OUTCOMES = (
    (NOT_RUN, "not_run", None),
    (0, "finished", Stop.FINISHED),
    (1, "enough_events", ENOUGH_EVENTS),
    (2, "locked_for_ever", Stop.LOCKED),
    (BAD_PARAMETERS, "bad_parameters", REFUSED),
    (11, "event_storm", Stop.STORM),
    (12, "not_finite", Stop.FAILED),
    (13, "too_many_pieces", FULL_HISTORY),
    (15, "negative_friction", Stop.NEGATIVE_FRICTION),
    (16, "off_the_law", Stop.OFF_THE_LAW),
    (ERROR, "error", None),
)
MEANINGS = {code: name for code, name, _ in _OUTCOMES}
"""Names of the codes."""
CODES = {stop: code for code, _, stop in _OUTCOMES if stop is not None}
"""The code of a member by the code that ended its run (`engine.state.layout`, `trajectory.status`)."""
