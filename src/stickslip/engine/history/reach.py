"""How far a contact has gone: its displacement at the end of a history, and the largest one on the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.engine.history.history import History, Positions
from stickslip.foundation.names import name_of
from stickslip.foundation.show import brief, in_turns
from stickslip.problem import Problem

DIGITS_OF_SLIP = 8
"""Number of significant digits of a slip in a summary, as in its tables."""
SAME_REACH = 1e-9
"""Relative difference of two displacements that is rounding."""


@dataclass(frozen=True)
class Reach:
    """The displacement from the start of a run (m, or rad) at its end, and the largest one in size with its sign and time (s)."""

    end: float
    largest: float
    time: float

    def beyond(self, other: Reach | None) -> Reach:
        """Return this reach, with the largest displacement of an earlier part of the run if that is larger."""
        if other is None or abs(other.largest) <= abs(self.largest):
            return self
        return Reach(self.end, other.largest, other.time)

    def text(self, problem: Problem, digits: int = DIGITS_OF_SLIP) -> str:
        """Return the slip at the end and the largest displacement, in one line."""
        unit, name = problem.unit_of("slip"), name_of("slip", problem.load_unit)
        largest = largest_of(unit)
        now = f"{name} at the end {shown_slip(problem.initial_slip + self.end, unit, digits)}"
        if not self.largest:
            return f"{now}, {largest} {shown_slip(0.0, unit)}: nothing slips"
        if problem.initial_slip:
            now += f", {shown_slip(self.end, unit, digits)} from the start"
        if abs(self.largest - self.end) <= SAME_REACH * abs(self.largest):
            return f"{now}, which is the {largest}"
        return f"{now}; {largest} {shown_slip(self.largest, unit, digits)}, at {brief(self.time, 's')}"


def largest_of(unit: str) -> str:
    """Return what the largest displacement is called where slip has this unit."""
    return f"largest {'rotation' if unit == 'rad' else 'displacement'}"


def shown_slip(value: float, unit: str, digits: int = DIGITS_OF_SLIP) -> str:
    """Return a slip for readers; an angle also in turns if it has one or more."""
    return brief(value, unit, digits) + (in_turns(value) if unit == "rad" else "")


def reach_of(history: History) -> Reach:
    """Return how far the contact has gone in a history.

    Slip has one direction within a piece, so that the largest displacement is at the start of one, or at the end.
    """
    end = float(history.slipped(Positions.inside(len(history) - 1, 1.0))[0])
    slips = np.append(history.store.slip, end)
    n = int(np.abs(slips).argmax())
    return Reach(end, float(slips[n]), float(history.end[-1] if n == len(history) else history.start[n]))
