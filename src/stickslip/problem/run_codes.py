"""Codes that say what ended a run, or made its solver return; `run_status` says what each means, with cures.

The engine's are those of `Stop`, which are not negative but for the one that ends nothing. The others come from around it.
"""

from __future__ import annotations

from enum import IntEnum


class Stop(IntEnum):
    """Say why the engine returned."""

    NONE = -1
    """Nothing: it has made as many passes of the loop as it was asked for."""
    FULL = 0
    """The history has no room for another step."""
    FINISHED = 1
    LOCKED = 2
    """No load to come can move the contact."""
    STORM = 3
    """Events follow each other with no time between them."""
    END_AHEAD = 4
    """The next step or leap depends on where the run ends: the caller sets `to_the_end`."""
    FAILED = 5
    """Slip, slip rate, state, load or strength is not finite."""
    NEED_BRANCHES = 6
    """The caller must put the branches at the present slip into the table."""
    PAUSED = 7
    """The caller wants to look at the run now: the next round trip is `pause_at` or a later one."""
    SLIPS = 8
    """An explicit step of slip is left to the caller, who takes it beside those of other runs."""
    OFF_THE_LAW = 9
    """No step from here obeys the contact equation."""
    NEED_PART = 11
    """The caller must lend the part of the engine that `Run.missing` names (`on_demand.lend_part`)."""
    NEGATIVE_FRICTION = 10
    """Friction is below zero from here on."""


FULL_HISTORY = -2
"""The history has reached its limit of pieces, or memory is short."""
INTERRUPTED = -3
"""The user stopped the run."""
ENOUGH_EVENTS = -4
"""The run has reached the number of slip events that was asked for."""
UNDER_WAY = -5
"""The solution comes from a checkpoint of a run that continued afterwards."""
BAD_PARAMETERS = -6
"""The parameters of a member of a batch make no valid problem."""
UNSTABLE = -7
"""Slip rates of a planar slab have grown beyond what its loads can drive."""
