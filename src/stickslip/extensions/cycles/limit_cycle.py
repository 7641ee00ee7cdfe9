"""A periodic motion: the result of `ss.studies.cycle`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.measures import Measures, measures_of, swing_of
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run import Study
from stickslip.solution import Solution

if TYPE_CHECKING:
    from stickslip.foundation.arrays import Floats

NOT_KNOWN = "not known"
"""What tables say of a cycle whose stability cannot be told."""
NEUTRAL = 1e-9
"""A multiplier this close to the unit circle (1) is on it, as far as can be told."""


NEARLY_ALL = 0.99
"""Where the contact rests for more than this share of a period (1), the time of slip says more."""


def is_stable(multipliers: Floats) -> bool | None:
    """Return True if all multipliers lie inside the unit circle, False if one lies outside; None: it cannot be told."""
    size = float(np.abs(multipliers).max())
    if math.isnan(size):
        return None
    return None if abs(size - 1.0) <= NEUTRAL else size < 1.0


def row_of(measures: Measures, multipliers: Floats) -> dict[str, Any]:
    """Return the numbers of a cycle as a row of a table, in SI."""
    row: dict[str, Any] = measures._asdict() | {"amplitude": measures.amplitude}
    stable = is_stable(multipliers)
    row["stable"] = {True: "yes", False: "no", None: NOT_KNOWN}[stable]
    for n, one in enumerate(multipliers, 1):
        row |= {f"multiplier_{n}": float(one.real), f"multiplier_{n}_imaginary": float(one.imag)}
    return row


@dataclass(frozen=True, eq=False, repr=False)
class LimitCycle(Study):
    """The result of `cycle`: one period of a motion that repeats itself, and what becomes of small disturbances of it.

    `table` has one row: period (s), slip in it, greatest and least slip rate, greatest and least traction, stick_share (1),
    amplitude (half of the difference between the two rates), stable, and the multipliers with their imaginary parts, in SI.
    """

    orbit: FoundCycle = field(compare=False)
    scenario: Scenario = field(compare=False)
    """The scenario whose problem it solves, without its start."""

    @property
    def problem(self) -> Problem:
        """The problem that starts on the cycle, where it meets the section; of a body with waves the problem itself.

        No number of a problem says which waves are in a body at the start.
        """
        return self.orbit.problem_on_it(self.scenario.problem)

    @cached_property
    def run(self) -> Solution:
        """The run of one period, from `begin` on."""
        return self.orbit.run_of_it()

    @property
    def begin(self) -> float:
        """When the period begins in `run` (s): 0, or after a round trip at rest that holds the waves in the body."""
        return float(self.orbit.closed.begin)

    @cached_property
    def measures(self) -> Measures:
        """The numbers of the cycle, in SI."""
        return measures_of(self.orbit)

    @property
    def period(self) -> float:
        """The period (s)."""
        return self.orbit.period

    @property
    def multipliers(self) -> Floats:
        """What one period multiplies small disturbances by (1), the largest first; complex numbers if a disturbance swings.

        A contact that rests forgets: one of them is 0.
        """
        return self.orbit.multipliers

    @property
    def stable(self) -> bool | None:
        """True if all disturbances fade, False if one grows; None: the largest keeps its size, as far as can be told."""
        return is_stable(self.multipliers)

    @property
    def amplitude(self) -> float:
        """Half of the difference between the greatest and the least slip rate (m/s)."""
        return self.measures.amplitude

    @property
    def greatest_rate(self) -> float:
        """The greatest slip rate (m/s)."""
        return self.measures.greatest_rate

    @property
    def least_rate(self) -> float:
        """The least slip rate (m/s)."""
        return self.measures.least_rate

    @property
    def greatest_traction(self) -> float:
        """The greatest traction (N)."""
        return self.measures.greatest_traction

    @property
    def least_traction(self) -> float:
        """The least traction (N)."""
        return self.measures.least_traction

    @property
    def slip(self) -> float:
        """The slip in one period (m)."""
        return self.measures.slip

    @property
    def swing(self) -> float:
        """How far slip goes to and fro in one period (m), which is all of the motion about a set point at rest."""
        return swing_of(self.orbit)

    @property
    def stick_share(self) -> float:
        """The share of rest in the period (1)."""
        return self.measures.stick_share

    @cached_property
    def table(self) -> pd.DataFrame:
        """The numbers of the cycle, in SI, in one row."""
        return pd.DataFrame([row_of(self.measures, self.multipliers)])

    @property
    def text(self) -> str:
        """Say in one sentence how the motion repeats itself."""
        problem, found = self.problem, self.measures
        rates = [brief(one, problem.unit_of("slip_rate")) for one in (found.least_rate, found.greatest_rate)]
        loads = [brief(one, problem.load_unit) for one in (found.least_traction, found.greatest_traction)]
        slips = brief((1.0 - found.stick_share) * self.period, "s")
        rests = (
            f"rests for {100.0 * found.stick_share:.4g} % of it" if found.stick_share < NEARLY_ALL else f"slips for {slips} of it"
        )
        if not self.orbit.sticks:
            rests = "never rests"
        goes = f"slips {brief(found.slip, problem.unit_of('slip'))}"
        if problem.first_pull_rate == 0.0:
            goes = f"goes to and fro over {brief(self.swing, problem.unit_of('slip'), 6)}"
        return (
            f"a cycle of {brief(self.period, 's', 9)}: the contact {rests}, {goes},"
            f" at {rates[0]} to {rates[1]}, under a traction of {loads[0]} to {loads[1]}"
        )

    @property
    def stability_text(self) -> str:
        """Say in one sentence what becomes of a small disturbance."""
        largest = self.multipliers[0]
        if self.orbit.grazes:
            return "neither stable nor unstable: the contact rests for an instant only, and no multiplier holds there"
        if self.orbit.forgets_all:
            return "stable: each rest ends all disturbances, because only the load is left then (multiplier 0, exactly)"
        size = abs(complex(largest))
        how = f"multiplies a small disturbance by up to {brief(size, '')}"
        if abs(largest.imag) > 0.0:
            how += f" and turns it by {math.degrees(math.atan2(abs(largest.imag), largest.real)):.4g} degrees"
        elif largest.real < 0.0:
            how += ", and each period reverses it"
        word = {True: "stable", False: "unstable", None: "neither stable nor unstable, as far as can be told"}[self.stable]
        return f"{word}: a period {how}"

    @property
    def certainty_text(self) -> str:
        """Say in one sentence what is known of the error of the period."""
        return self.orbit.certainty

    def _about(self) -> Iterable[str]:
        return tuple(self._sentences())

    def _sentences(self) -> Iterable[str]:
        return self.text, self.stability_text, self.certainty_text

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.cycles.figures.cycle import draw_cycle

        return draw_cycle
