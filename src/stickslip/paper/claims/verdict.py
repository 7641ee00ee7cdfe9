"""The parts of a verdict on a claim, and the claims of the paper in our words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Outcome(StrEnum):
    """The possible outcomes for a claim."""

    PRINTED = "holds as printed"
    READING = "holds in the reading named"
    QUALIFIED = "holds with a qualification"
    NOT = "does not hold"


@dataclass(frozen=True)
class Measured:
    """A number that was measured, with its label and unit."""

    label: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class Verdict:
    """The outcome for one claim, with the reading in which it holds, the measured numbers and an explanation."""

    number: int
    claim: str
    outcome: Outcome
    reading: str
    measured: tuple[Measured, ...]
    explanation: str

    def value(self, label: str) -> float:
        """Return the measured number with this label."""
        return next(m.value for m in self.measured if m.label == label)


STATEMENTS = {
    1: "Under the slip law the block slips once, releases much of its stress, and stops.",
    2: "Under the slip law the slab shows several pulses of slip.",
    3: "The wave reflected at the driver arrests the slab completely.",
    4: "The number of pulses depends only on the thickness and the wave speed.",
    5: "Under the rate law with α = 1 the block's slip rate is continuous.",
    6: "Under the rate law with α = 1 the slab's slip rate jumps.",
    7: "The critical value is αc = √(ρG)/(S(μS − μD)) = 0.196 s/m.",
    8: "An irregular contact has three solutions between the folds, two at them, one elsewhere.",
    9: "A regular contact has one solution for every load, and no fold.",
    10: "With the slip law the slab's problem is well-posed.",
    11: "Whatever rule selects the solution, shocks occur.",
    12: "The rule of perfect delay is no simple energy criterion: Maxwell's rule gives another answer.",
    13: "In the whole irregular regime shocks dominate the slab's motion, while the block's is smooth.",
    14: "The difference comes from the mass concentrated in the block.",
    15: "After its event the block stays put for a long period.",
    16: "The initial data are close to instability.",
    17: "Accelerating and decelerating paths differ (hysteresis).",
    18: "At αc + 10⁻⁶ there are two shocks, at the beginning and at the end (with the reflected wave), at a very small slip rate.",
    19: "For α > 3 αc the slab behaves as with Coulomb's law.",
    20: "The load is β(t) = G(Vt + D0 − u0)/h up to t = h/c.",
}
"""The claims of the paper in our words, by number."""


def judge(printed: bool, reading: bool = False) -> Outcome:
    """Return the outcome for a claim, given whether it holds under the printed constants and under another reading."""
    if printed:
        return Outcome.PRINTED
    return Outcome.READING if reading else Outcome.NOT


def verdict(number: int, outcome: Outcome, reading: str, explanation: str, *measured: tuple[str, float, str]) -> Verdict:
    """Return a verdict on claim `number`; each measured number is given as label, value and unit."""
    numbers = tuple(Measured(label, float(value), unit) for label, value, unit in measured)
    return Verdict(number, STATEMENTS[number], outcome, reading, numbers, explanation)
