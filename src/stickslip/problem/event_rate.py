"""The slip rate above which slip is a slip event."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stickslip.foundation.quantities import Quantity

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem

EVENT_RATE = Quantity("m/s", "slip rate above which the contact is in a slip event", at_least=0)
EVENT_SHARE = 1e-6
"""Slip rate from which slip is an event by default, as a share of S (range of mu) / Z; for a block sqrt(K m) replaces Z."""


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
