"""Backlash between a rigid body and its spring: a play where the spring gives no force."""

from __future__ import annotations

from typing import Any

from stickslip.foundation.arrays import anywhere
from stickslip.foundation.errors import InputError

BACKLASH = "width of the play between spring and body, where the spring gives no force"
"""What the field for it means."""


def check_play(body: Any) -> None:
    """Refuse a play beside no spring."""
    if anywhere(body.backlash) and not anywhere(body.stiffness):
        raise InputError(f"{type(body).__name__}: backlash needs a spring to be beside: give stiffness, or set backlash to 0")
