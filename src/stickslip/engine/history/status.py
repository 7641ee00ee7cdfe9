"""Reasons for the end of a run with cures for failures, and checkpoints of a run or a catalogue."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache

from stickslip.engine.compile.cache import SOURCES
from stickslip.engine.state.layout import Counts, Floats, Integers, Stop
from stickslip.engine.state.workspace import NO_WAVES
from stickslip.foundation.code_key import key_of_folders
from stickslip.foundation.show import brief

DECIDE = ("contact", "engine", "friction", "problem", "run", "solution")
"""Folders of the package whose code decides the result of a run."""


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Copies of everything that changes in a run, except its history (see `layout`)."""

    state: Floats
    count: Integers
    scratch: Floats
    branch: Floats  # Setup.branch, which changes with slip for some laws
    stick_to: Floats  # (1,): Setup.params.stick_to, which changes with it
    engine: str  # hash of the code that made it
    waves: Floats = field(default_factory=NO_WAVES.copy)  # rows of waves of a body of layers, which are of two round trips only

    @property
    def length(self) -> int:
        """The number of pieces in the history at the checkpoint; a run that has ended may hold more, cut at its end."""
        return int(Counts(self.count).length)


ARRAYS = tuple(field.name for field in fields(Checkpoint) if field.name != "engine")
"""Names of the arrays in a checkpoint."""


@cache
def engine(*beside: str) -> str:
    """Return the key of the code that decides the result of a run; a run that continues with other code may differ in its digits.

    `beside` are folders of an extension whose code decides its results, too. Comments, docstrings and the layout of lines leave the
    key as it is (`code_key`).
    """
    return key_of_folders((*DECIDE, *beside), SOURCES)


@dataclass(frozen=True)
class Status:
    """The end of a run: the name of the status, a message, and `ok`, which is true if the run got as far as it was meant to."""

    name: str
    message: str
    ok: bool

    def __str__(self) -> str:
        return f"{self.name}: {self.message}"


def rounding_note(steps: int, share: float) -> str:
    """Return one line on steps that miss the contact equation by more than the tolerance, by rounding; empty if there are none."""
    if steps == 0:
        return ""
    where = "in 1 step" if steps == 1 else f"in {steps} steps"
    return (
        f"{where} the contact equation is missed by more than rtol allows, up to {share:.1g} of the slip rate, which the bound"
        " contains: as a rule the formula loses digits far from where slip began; write it without differences of nearly equal"
        " numbers, or expect no more digits"
    )


def merging_note(change: float, unit: str) -> str:
    """Return one line on the changes of waves in layers by merging, in sum (Pa, N or N m); empty if nothing was merged."""
    if change == 0.0:
        return ""
    return (
        f"pieces of waves in the layers were merged, which changed the waves by {change:.1g} {unit} at most, added up over the run"
    )


def strips_note(shift: float, unit: str) -> str:
    """Return one line on merged strips of creep and how far slip is off within them, in sum (m or rad); empty if there are none."""
    if shift == 0.0:
        return ""
    return (
        f"strips at the borders of creep were merged: within them slip is off by {shift:.1g} {unit} at most, added up over the run"
    )


FULL_HISTORY = -2
"""The history has reached its limit of pieces, or memory is short."""
TOO_MANY = "too many pieces"
"""The name of its status."""
SHORT_OF_MEMORY = "memory is short"
"""How its message begins in the second case."""
MOST_WORTH_ASKING = 10_000_000
"""Largest number of pieces that a message proposes to allow: 4 GB."""
GROWING = 2.0
"""If a history grows faster in its second half than in its first by more than this factor, its size cannot be foretold."""
SHORTER = 0.98
"""A run with as many pieces surely reaches this share of the last time with room left; the time is shown with 3 digits."""
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
"""Status for each code: those of the engine (`layout`) are not negative, the others are defined above."""


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
