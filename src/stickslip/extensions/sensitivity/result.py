"""The derivatives of an output of a run with respect to numbers of its problem: the result of `ss.studies.sensitivity`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from stickslip.extensions.sensitivity.differences import OfNumber
from stickslip.extensions.sensitivity.outputs import CurveAtTimes, Output
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief, number
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run import Study

MOST_DIGITS = 6
"""Digits of derivatives in sentences, if all of them are known."""


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(Study):
    """The result of `sensitivity`: derivatives of one output with respect to several numbers, with their errors.

    `table` has a row for each number and time, in SI: number, its value, time (or event), output, derivative, error, and scaled,
    which is the value of the number times the derivative: what a change by 100 % would make of the output, if all were linear.
    """

    scenario: Scenario = field(compare=False)
    output: Output
    values: Floats
    """The output (SI) at each time, or of the event."""
    found: tuple[OfNumber, ...]

    @property
    def problem(self) -> Problem:
        """The problem."""
        return self.scenario.problem

    @property
    def numbers(self) -> tuple[str, ...]:
        """The names of the numbers."""
        return tuple(one.parameter.name for one in self.found)

    @property
    def times(self) -> Floats:
        """The times (s) of the output; empty for a number of an event."""
        return self.output.times if isinstance(self.output, CurveAtTimes) else np.empty(0)

    @property
    def derivatives(self) -> Floats:
        """The derivatives (SI), a row for each number and a column for each time; NaN where there is none."""
        return np.array([one.slope for one in self.found])

    @property
    def errors(self) -> Floats:
        """Estimates of the errors of the derivatives, in their unit."""
        return np.array([one.error for one in self.found])

    @property
    def scaled(self) -> Floats:
        """The derivatives times the values of their numbers, in the unit of the output."""
        return np.array([one.parameter.value * one.slope for one in self.found])

    @property
    def runs(self) -> int:
        """The number of runs beside the problem's own."""
        return sum(one.runs for one in self.found)

    def by(self, number: str) -> Floats:
        """Return the derivatives with respect to one number (SI), at each time. Raises InputError if it is not among them."""
        name = self.problem.parameters[number].name
        if name not in self.numbers:
            raise InputError(f"sensitivity: {name} is none of its numbers, which are {', '.join(self.numbers)}")
        return self.found[self.numbers.index(name)].slope

    @cached_property
    def table(self) -> pd.DataFrame:
        """The derivatives, in SI, with a row for each number and time."""
        place = {"time": self.output.times} if isinstance(self.output, CurveAtTimes) else {"event": [self.output.event]}
        parts = [
            pd.DataFrame(
                {"number": one.parameter.name, "value": one.parameter.value}
                | place
                | {self.output.name: self.values, "derivative": one.slope, "error": one.error, "scaled": scaled}
            )
            for one, scaled in zip(self.found, self.scaled, strict=True)
        ]
        return pd.concat(parts, ignore_index=True)

    @property
    def texts(self) -> tuple[str, ...]:
        """Say of each number in one sentence how much it matters, the most important first."""
        return tuple(self._text(n) for n in self.order if np.isfinite(self.found[n].slope).any())

    @property
    def notes(self) -> tuple[str, ...]:
        """Say in one sentence each where there is no derivative and why, and which are derivatives to one side."""
        alike: dict[tuple[str, str], list[OfNumber]] = {}
        for one in self.found:
            if one.missing:
                alike.setdefault((one.missing.where, one.missing.why), []).append(one)
        sides = tuple(
            f"the derivative with respect to {one.parameter.name} is that from {one.side}: it has no values on the other side"
            for one in self.found
            if one.side != "both"
        )
        return tuple(self._why_none(where, why, those) for (where, why), those in alike.items()) + sides

    def _why_none(self, where: str, why: str, those: list[OfNumber]) -> str:
        names = ", ".join(one.parameter.name for one in those)
        between = next((one.missing.between for one in those if one.missing), "")
        return f"no derivative with respect to {names}{where}: {between}{' ' if between else ''}{why}"

    @property
    def unit(self) -> str:
        """The SI unit of the output."""
        return self.output.unit(self.problem)

    @property
    def order(self) -> list[int]:
        """The places of the numbers, those that matter most first: with the largest scaled derivative."""
        sizes = np.nan_to_num(np.abs(self.scaled)).max(axis=1)
        return [int(n) for n in np.argsort(-sizes, kind="stable")]

    def _text(self, n: int) -> str:
        one, scaled = self.found[n], self.scaled[n]
        at = int(np.nanargmax(np.abs(one.slope)))
        when = f" at {brief(float(self.times[at]), 's')}" if len(self.times) else ""
        by = f"{one.parameter.name} = {brief(one.parameter.value, one.parameter.unit)}"
        of, by_unit = (f" {name}" if name not in ("", "1") else "" for name in (self.unit, one.parameter.unit))
        per = f" per{by_unit}" if by_unit else ""
        size = f"{_as_known(float(one.slope[at]), float(one.error[at]))}{of}{per}"
        if one.parameter.value == 0.0:
            return f"{by}: the derivative is {size}{when}"
        change = 0.01 * float(scaled[at]) if abs(one.slope[at]) > one.error[at] else 0.0
        makes = f"{brief(abs(change), self.unit)} {'less' if change < 0.0 else 'more'}" if change else "no difference"
        most = ", at most" if len(self.times) > 1 else ""
        return f"{by}: 1 % more makes {makes}{when}{most} (derivative {size})"

    def _about(self) -> Iterable[str]:
        return tuple(self._sentences())

    def _sentences(self) -> Iterable[str]:
        count = "a number" if len(self.found) == 1 else f"{len(self.found)} numbers"
        yield f"derivatives of the {self.output.words} with respect to {count}, by {self.runs} runs"
        yield from self.texts
        yield from self.notes

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.sensitivity.figures.sensitivity import draw_sensitivity

        return draw_sensitivity


def _as_known(value: float, error: float) -> str:
    """Return a number with the digits that are known, at most MOST_DIGITS; one below its error is 0 within that."""
    if abs(value) <= error:
        return f"0 within {number(error, 1)}" if error else "0"
    known = math.floor(math.log10(abs(value) / error)) if error else 1
    return number(value, min(max(known, 1), MOST_DIGITS))
