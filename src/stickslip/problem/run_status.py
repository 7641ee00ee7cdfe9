"""Reasons for the end of a run, whatever solves it, with cures for failures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from stickslip.foundation.show import brief
from stickslip.problem.run_codes import BAD_PARAMETERS, ENOUGH_EVENTS, FULL_HISTORY, INTERRUPTED, UNDER_WAY, UNSTABLE, Stop


@dataclass(frozen=True)
class Status:
    """The end of a run: the name of the status, a message, and `ok`, which is true if the run got as far as it was meant to."""

    name: str
    message: str
    ok: bool

    def __str__(self) -> str:
        return f"{self.name}: {self.message}"


TOO_MANY = "too many pieces"
"""The name of the status of a run whose history is full, or whose memory is short."""
SHORT_OF_MEMORY = "memory is short"
"""How the message of that status begins where memory is short."""
MOST_WORTH_ASKING = 10_000_000
"""A message proposes to allow at most this many pieces: 4 GB."""
GROWING = 2.0
"""If a history grows faster in its second half than in its first by more than this factor, its size cannot be foretold."""
SHORTER = 0.98
"""A run with as many pieces surely reaches this share of the last time with room left; the time is shown with 3 digits."""

STATUSES = {
    Stop.FINISHED: Status("finished", "the run reached its duration", True),
    ENOUGH_EVENTS: Status("enough events", "the run reached the requested number of slip events", True),
    Stop.LOCKED: Status(
        "locked for ever", "the contact is at rest and no load will ever move it: nothing changes up to the end", True
    ),
    Stop.STORM: Status(
        "event storm",
        "events follow each other without any time between them, or are too short to be resolved: set shortest_event, or try a"
        " mass at the contact or another law",
        False,
    ),
    Stop.FAILED: Status(
        "not finite", "the solution left the range of floating-point numbers: check the units of the scenario", False
    ),
    Stop.NEGATIVE_FRICTION: Status(
        "negative friction",
        "the contact has reached a slip, a slip rate or a state at which the law's friction coefficient is below zero, where it"
        " would drive slip: the law is not meant for what this load does",
        False,
    ),
    Stop.OFF_THE_LAW: Status(
        "off the law",
        "no step from here obeys the contact equation, however short: the law may jump here, or be too steep for double precision",
        False,
    ),
    FULL_HISTORY: Status(
        TOO_MANY,
        "the history reached its limit of pieces (a million takes 0.42 GB)",
        False,
    ),
    INTERRUPTED: Status("interrupted", "stopped by the user: the results are valid up to this time", False),
    UNSTABLE: Status(
        "unstable",
        "slip rates grow beyond all that the loads can drive, so that the nodes or the time steps do not resolve the law: take more"
        " nodes, or a smaller courant",
        False,
    ),
    BAD_PARAMETERS: Status("bad parameters", "the parameters of this batch member make no valid problem", False),
    UNDER_WAY: Status("under way", "a checkpoint of a run that continued: the results are valid up to this time", False),
}
"""Status for each code: see `run_codes`."""


@dataclass(frozen=True)
class Crowd:
    """A history that has reached its limit of pieces, or the share of the memory that it may take."""

    pieces: int
    reached: float  # time, s
    at_half: float  # time when it had half of the pieces, s
    before_last: float  # last time with room for more pieces than an event takes, s
    asked: float  # time that was asked for, s
    turn: str = "round trip"  # what the body calls one: a block has periods
    taken: float | None = None  # memory that it takes, bytes, if that is why it is full

    def status(self, cures: Sequence[str]) -> Status:
        """Return the status of its run; `cures` are further remedies in this case, besides more pieces and a shorter run."""
        later, when = self.reached - self.at_half, f"{brief(self.reached, 's')} of {brief(self.asked, 's')}"
        said = f"the history reached its limit of {self.pieces} pieces at {when}"
        if self.taken is not None:
            said = f"{SHORT_OF_MEMORY}: the history takes {self.taken / 1e9:.2g} GB with {self.pieces} pieces at {when}"
        shorter = f"a duration of up to {brief(SHORTER * self.before_last, 's', 3)}"
        if later * GROWING < self.at_half:
            said += f", and comes to more pieces in each {self.turn}"
            helps = *cures, shorter
        else:
            needed = self.pieces + (self.asked - self.reached) * 0.5 * self.pieces / later
            said += f", and would need {needed:.2g} of them"
            more = [f"max_pieces = {_rounded_up(needed)}"] if needed <= MOST_WORTH_ASKING and self.taken is None else []
            helps = *cures, *more, shorter
        if self.taken is not None:
            helps = *helps, "more memory (STICKSLIP_MEMORY says how much there is)"
        return replace(STATUSES[FULL_HISTORY], message=f"{said}; what helps: {', or '.join(helps)}")


def _rounded_up(pieces: float) -> int:
    """Return a number of pieces with two digits and some room."""
    unit = 10 ** max(int(math.log10(pieces)) - 1, 0)
    return int(math.ceil(1.1 * pieces / unit) * unit)
