"""The waves on both sides of a place where two cells meet: one rule, for the engine, for waves found again, and for arrays."""

from __future__ import annotations

from typing import TypeVar

from stickslip.foundation.kernels.kernels import inlined

Wave = TypeVar("Wave")  # a number in kernels, an array elsewhere


def crossed(share: Wave, beyond: Wave, outward: Wave, inward: Wave) -> tuple[Wave, Wave]:
    """Return what leaves the place towards the contact and away from it (Pa), of waves that come from there.

    `share` of a wave from the contact is sent back, and `beyond` of one towards it; all else is passed on (Goupillaud 1961).
    """
    near = share * outward + (1.0 + share) * inward  # type: ignore[operator] # both are numbers, or arrays
    return near, (1.0 + beyond) * outward + beyond * inward  # type: ignore[operator]


cross = inlined(crossed)
"""The same in kernels."""
