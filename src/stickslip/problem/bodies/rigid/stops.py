"""Hard stops that bar the way of a rigid body, ahead and behind, and how it bounces off them."""

from __future__ import annotations

import math
from typing import Any

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.problem.bodies.contract import check_body

RESTITUTION = Quantity("1", "share of the slip rate with which it bounces off a stop", at_least=0, at_most=1)
"""The number of a body that bounces off stops; at 0 it rests at them."""
STOP_AHEAD, STOP_BEHIND = (f"way from the start to a hard stop {side}; none: there is no stop" for side in ("ahead", "behind"))
"""What the fields for ways to stops mean."""


def check_with_stops(body: Any) -> None:
    """Check the fields of a body that may have stops."""
    check_body(body)
    if getattr(body, "off_belt", "") and body.has_stops:
        name, way = type(body).__name__, "stop_ahead" if body.stop_ahead < math.inf else "stop_behind"
        raise InputError(f"{name}: {way}: stops are not followed over a belt: leave them out, or pull the spring instead")
    if anywhere(body.restitution) and not body.has_stops:
        raise InputError(f"{type(body).__name__}: restitution needs a stop to bounce off: give stop_ahead or stop_behind")
