"""Leaps over steady sliding before a driver that lets waves out: deviations fade, and their rates are a geometric series."""

from __future__ import annotations

import math

from typing_extensions import override

from stickslip.engine.creep.drivers.rigid import LeapsInWaves, Multiplied
from stickslip.engine.creep.steady import Tried


class LeapsBeforeLossyDriver(LeapsInWaves):
    """The slip that a deviation adds is the sum of that series; a contact mass, which has no such series, adds none."""

    @override
    def slip_as_it_multiplies(self, tried: Tried, found: Multiplied) -> tuple[float, float] | None:
        if not found.fastest < 0.0:
            return None
        first, gone = found.each.power(1), -math.expm1(found.fastest)
        error = tried.turn * tried.deviation.largest_load / (found.least * gone)
        error *= found.change / gone + 2.0 * found.spread / found.least
        return (first - found.factor) / (1.0 - first) * tried.deviation.slip, error

    @override
    def slip_as_it_fades(self, tried: Tried) -> float:
        return 0.0


ANSWERS = LeapsBeforeLossyDriver()
