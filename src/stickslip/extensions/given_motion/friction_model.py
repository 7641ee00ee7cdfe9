"""Friction along measured motion as a function of the free numbers of a law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from stickslip.extensions.given_motion.along import FrictionAlongMotion, in_intervals
from stickslip.extensions.given_motion.intervals import MotionInIntervals
from stickslip.extensions.given_motion.law_numbers import LawNumber, with_numbers
from stickslip.extensions.given_motion.measured import MeasuredMotion
from stickslip.extensions.given_motion.moved import MovedContact
from stickslip.foundation.arrays import Floats
from stickslip.friction import FrictionLaw
from stickslip.problem import PiecewiseLinear

RTOL_OF_FITS = 1e-8
"""Relative tolerance (1) of friction's states in a fit."""


@dataclass(frozen=True, eq=False)
class FrictionModel:
    """Friction along measured motion, as a function of the free numbers in their own scales."""

    law: FrictionLaw
    record: MeasuredMotion
    rate: Floats
    normal: Any
    free: Sequence[LawNumber]
    start: Mapping[str, Any]
    scales: Floats
    """A change of each number that changes friction noticeably; 1 for numbers that are searched by their logarithm."""

    def values(self, x: Floats) -> dict[str, float]:
        """Return the free numbers by name from what is searched."""
        return {
            one.name: float(np.exp(y) if self.by_log(one) else y * size)
            for one, y, size in zip(self.free, x, self.scales, strict=True)
        }

    def by_log(self, one: LawNumber) -> bool:
        """Return True for a number that is searched by its logarithm."""
        return one.positive and one.value > 0.0

    def begin(self) -> Floats:
        """Return where the search begins."""
        pairs = zip(self.free, self.scales, strict=True)
        return np.array([np.log(one.value) if self.by_log(one) else one.value / size for one, size in pairs])

    def moved(self, values: Mapping[str, float], rate: Floats | None = None) -> MovedContact:
        """Return the contact with some values of the free numbers, along another slip rate if one is given."""
        of_law = {name: value for name, value in values.items() if name.startswith("friction.")}
        law = with_numbers(self.law, of_law) if of_law else self.law
        history = self._history if rate is None else PiecewiseLinear(self.record.time, rate)
        return MovedContact(law, history, self.normal, **self.start)

    @cached_property
    def _history(self) -> PiecewiseLinear:
        return PiecewiseLinear(self.record.time, self.rate)

    @cached_property
    def _motion(self) -> MotionInIntervals:
        """The measured motion in intervals, which is the same for all values of the free numbers."""
        return in_intervals(self.moved({}), float(self.record.time[-1]))

    def friction(self, x: Floats, rate: Floats | None = None) -> Floats:
        """Return friction at the samples in the unit of the record; NaN at rest under a law that sticks. Raises InputError."""
        values, time = self.values(x), self.record.time
        moved, end = self.moved(values, rate), float(time[-1])
        motion = self._motion if rate is None else in_intervals(moved, end)
        run = FrictionAlongMotion.along(moved, motion, end, RTOL_OF_FITS)
        found = run.coefficient(time) if self.record.unit == "" else run.traction(time)
        speed = self.rate if rate is None else rate
        return np.asarray(found + values.get("record.offset", 0.0) + values.get("record.viscous", 0.0) * speed)
