"""The parts of a verdict on a claim of the paper, and the table of claims that the functions which measure them fill."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import wraps
from typing import Any

from stickslip.extensions.paper.cases import Runs

Number = tuple[str, Any, str]
"""A measured number: its label, its value and its unit."""


class Outcome(StrEnum):
    """The possible outcomes for a claim."""

    PRINTED = "holds as printed"
    READING = "holds in the reading named"
    QUALIFIED = "holds with a qualification"
    NOT = "does not hold"


@dataclass(frozen=True)
class MeasuredNumber:
    """A number that was measured, with its label and unit."""

    label: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class ClaimVerdict:
    """The outcome for one claim, with the reading that makes it hold, an explanation and the measured numbers."""

    outcome: Outcome
    reading: str
    explanation: str
    measured: tuple[MeasuredNumber, ...]
    number: int = 0
    claim: str = ""

    def value(self, label: str) -> float:
        """Return the measured number with this label."""
        return next(m.value for m in self.measured if m.label == label)


Measurement = Callable[[Runs], ClaimVerdict]
MEASUREMENTS: dict[int, tuple[str, Measurement]] = {}
"""Each claim in our words, and the function that measures it, by the number of the claim."""


def claim(number: int, statement: str) -> Callable[[Measurement], Measurement]:
    """Decorate the function that measures a claim; `statement` is the claim in our words."""

    def register(measure: Measurement) -> Measurement:
        @wraps(measure)
        def judged(runs: Runs) -> ClaimVerdict:
            return replace(measure(runs), number=number, claim=statement)

        MEASUREMENTS[number] = statement, judged
        return judged

    return register


def judge(printed: bool, reading: bool = False) -> Outcome:
    """Return the outcome for a claim, given whether it holds under the printed constants and under another reading."""
    if printed:
        return Outcome.PRINTED
    return Outcome.READING if reading else Outcome.NOT


def each(label: str, values: Mapping[str, Any], unit: str = "") -> list[Number]:
    """Return one measured number for each entry, labelled by `label` and the key."""
    return [(f"{label}, {key}", value, unit) for key, value in values.items()]


def verdict(outcome: Outcome, reading: str, explanation: str, *measured: Number) -> ClaimVerdict:
    """Return a verdict from measured numbers; the decorator `claim` adds the claim and its number."""
    return ClaimVerdict(
        outcome, reading, explanation, tuple(MeasuredNumber(label, float(value), unit) for label, value, unit in measured)
    )
