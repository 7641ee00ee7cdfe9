"""A driver with a mass or an integral gain: it begins at a rate of its own, and may be tuned to a period."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import ClassVar

from stickslip.foundation.show import brief
from stickslip.problem import Problem, driver_of, sent_back, tuned_period
from stickslip.run.check.asked import Fact
from stickslip.run.check.far_side import GivesWay


class _CheckOfMachine(GivesWay):
    sends_back: ClassVar[str] = "of sharp fronts at the driver"

    def facts(self, problem: Problem, way: str) -> list[Fact]:
        """Return the period at which mass and integral gain cancel, and what is sent back of a wave of that period."""
        body = problem.body
        if math.isnan(period := tuned_period(body)):
            return []
        whole, half, twice = (f"{sent_back(body, factor * period):.2g}" for factor in (1.0, 0.5, 2.0))
        share = f"the driver sends back {whole} of a wave with this period, {half} with half of it, {twice} with twice"
        return [Fact("T", period, "s", f"period to which the driver is tuned, where its mass and integral gain cancel: {share}")]

    def at_start(self, problem: Problem) -> Iterator[str]:
        """Yield the rate at which the driver begins, and what the far stress does."""
        body = problem.body
        why = "the pull rate" if body.driver_inertia > 0.0 else "at which the forces on it balance"
        gain = ", and its integral gain has nothing to make up for yet" * (body.driver_integral_gain > 0.0)
        yield f"the driver begins at {brief(driver_of(problem).at_first(problem)[0], problem.unit_of('slip_rate'))}, {why}{gain}"
        yield from super().at_start(problem)


ANSWERS = _CheckOfMachine()
