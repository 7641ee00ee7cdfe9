"""Declare the numbers that say how long and how accurately to run a problem, for scenario files and for Python alike."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem

DURATION = Quantity("s", "how long to simulate", above=0)
RUN_RTOL = Quantity("1", "relative tolerance of the run", at_least=1e-15)
CREEP_RTOL = Quantity("1", "leap over creep with this error of slip (slab, law of slip); 0: never; else automatic", at_least=0)
SHORTEST_EVENT = Quantity(
    "s", "lump slip events that are shorter (slab, rigid driver; layers); 0: none; else automatic", at_least=0
)
CHECKPOINT_INTERVAL = Quantity("s", "wall-clock time between two checkpoints", at_least=0, infinite=True)
EVENT_RATE = Quantity("m/s", "slip rate above which the contact is in a slip event", at_least=0)
EVENT_SHARE = 1e-6
"""Slip at this rate or above is an event by default: a share of S (range of mu) / Z; for a block sqrt(K m) replaces Z."""
LARGEST_RTOL = 1e-2
"""Largest relative tolerance of a run."""


class RunNumbers(NamedTuple):
    """The numbers of a run, which its solver takes: how long and how accurately, and how much it may keep."""

    duration: float
    """Latest end of the run, s."""
    rtol: float
    creep_rtol: float | None
    """Tolerance of leaps over creep; None is automatic."""
    shortest_event: float | None
    """Slip events shorter than this (s) are lumped; None is automatic."""
    most_pieces: int
    """Largest number of pieces that the history may have."""


def check_rtol(value: Any, where: str, name: str = "rtol") -> float:
    """Return a relative tolerance as a float. Raises InputError, beginning with `where`, if it is out of range."""
    found = RUN_RTOL.check(where, name, value)
    if found > LARGEST_RTOL:
        raise InputError(f"{where}: {name} must be at most {LARGEST_RTOL:g}, got {found:g}")
    return found


def check_event_rate(value: Any, where: str) -> float | None:
    """Return the slip rate (m/s) that defines slip events, or None, which stands for the default of the problem.

    Raises InputError, beginning with `where`, if it is out of range.
    """
    return None if value is None else EVENT_RATE.check(where, "event_rate", value)


def default_event_rate(problem: Problem) -> float:
    """Return the default slip rate (m/s) that defines an event: 1e-6 S (range of mu) / Z; for the block sqrt(K m) replaces Z.

    If a contact that can stick is thrown at a smaller rate than S (range of mu) / Z, it is 1e-6 times its initial rate: a block on
    a soft spring is never faster than that.
    """
    fast = problem.normal * problem.friction.variation / problem.body.impedance
    thrown = problem.friction.sticks and problem.has_initial_rate and not problem.starts_steadily
    return EVENT_SHARE * (min(fast, abs(problem.rate)) if thrown else fast)
