"""The slip rate at which a mode of layers crosses the axis: found on the root itself, and checked by counts on both sides."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from stickslip.contact.layer_modes import LayerModes
from stickslip.contact.roots import sign_change

NARROW_STEP = 1.2
"""A root is followed between slip rates whose quotient is no larger than this at first (1)."""
BESIDE_CROSSING = 1e-8
"""Verdicts are compared at slip rates that differ from the crossing by this share (1)."""
ROOTS_FOLLOWED = 10
"""Largest number of roots that are followed."""


def crossing(modes_at: Callable[[float], LayerModes], low: float, high: float, stable_above: bool) -> float:
    """Return the slip rate (m/s) between two others at which sliding gains or loses its stability.

    `modes_at` returns the modes at a slip rate (m/s). Sliding is stable at `high` if `stable_above`, else at `low`.
    """
    return _RateSought(modes_at, stable_above).between(low, high)


@dataclass(frozen=True)
class _RateSought:
    modes_at: Callable[[float], LayerModes]
    stable_above: bool

    def is_beyond(self, rate: float) -> bool | None:
        """Return True if the verdict at a slip rate (m/s) is that above the crossing, None if it is not decided."""
        stable = self.modes_at(rate).verdict
        return None if stable is None else stable == self.stable_above

    def between(self, low: float, high: float) -> float:
        ratio = NARROW_STEP
        for _ in range(ROOTS_FOLLOWED):
            while high > ratio * low:
                middle = math.sqrt(low * high)
                beyond = self.is_beyond(middle)
                if beyond is None:
                    break
                low, high = (low, middle) if beyond else (middle, high)
            found = self.followed(low, high)
            if math.isnan(found):
                ratio = math.sqrt(high / low)
                continue
            before, after = max(found * (1.0 - BESIDE_CROSSING), low), min(found * (1.0 + BESIDE_CROSSING), high)
            if self.is_beyond(before) is True:
                high = before
            elif self.is_beyond(after) is False:
                low = after
            else:
                return found
        return sign_change(self.side, low, high)

    def side(self, rate: float) -> float:
        """Return a number above 0 beyond the crossing, where what is not decided counts as stable: no root is found that grows."""
        return 1.0 if (self.modes_at(rate).verdict is not False) == self.stable_above else -1.0

    def followed(self, low: float, high: float) -> float:
        """Return where the root that grows fastest at one of two slip rates (m/s) crosses the axis; nan if it does not."""
        unstable, stable = (low, high) if self.stable_above else (high, low)
        begin = self.modes_at(unstable).one_that_grows
        if begin is None:
            return math.nan
        last = begin

        def growth(rate: float) -> float:
            nonlocal last
            root = self.modes_at(rate).near(last)
            if root is None:
                return math.nan
            last = root
            return -last.real if self.stable_above else last.real

        at_unstable, at_stable = growth(unstable), growth(stable)
        if (at_unstable < 0.0) != self.stable_above or (at_stable < 0.0) == self.stable_above or at_unstable * at_stable == 0.0:
            return math.nan
        return sign_change(growth, low, high)
