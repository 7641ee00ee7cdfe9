"""A driver that changes in time: it is set free, stops, or takes up another share of the waves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from stickslip.foundation.constants import DEAD_LOAD, RIGID
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run.check.asked import Fact
from stickslip.run.check.far_side import GivesWay, infinite_mass

MOST_DRIVERS = 8
"""Largest number of changes of a driver that are shown one by one (1)."""


class _CheckOfChangingDriver(GivesWay):
    sends_back: ClassVar[str] = "of waves at the driver at first"

    def facts(self, problem: Problem, way: str) -> list[Fact]:
        """Return the reflection at the driver from each change on, and what it then is."""
        facts, unit = [], problem.unit_of("impedance")
        for start, share in problem.driver_steps[1 : MOST_DRIVERS + 1]:
            now = "rigid" if share == RIGID else "set free" if share == DEAD_LOAD else ""
            now = now or f"of impedance {brief(problem.body.last_impedance * (1.0 - share) / (1.0 + share), unit)}"
            facts.append(Fact(f"r from {start:g} s", share, "1", f"the driver is then {now}, as the contact feels {way} later"))
        return facts

    def at_start(self, problem: Problem) -> Iterator[str]:
        """Yield why it is rigid at first, if by its mass, and what the far stress does."""
        yield from infinite_mass(problem)
        yield from super().at_start(problem)


ANSWERS = _CheckOfChangingDriver()
