"""What was found in a run: its slip events and pulses, marks on its curves, and the numbers by which runs are compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from stickslip.contact.uniqueness import Uniqueness
from stickslip.explorer.model.answer import KeyNumber, Mark, MarkKind, Motion
from stickslip.explorer.model.words import short
from stickslip.observables.energy.pulses import PULSE_COLUMNS
from stickslip.solution.interval import last_large_event
from stickslip.solution.solution import Solution

MOST_EVENTS = 500
"""Number of slip events up to which pulses are looked for: each takes a millisecond, and single ones of more would not be seen."""


@dataclass(frozen=True)
class Found:
    """What was found in a run, as the solution gives it: slip events, shocks and, if there are few events, their pulses."""

    solution: Solution
    events: pd.DataFrame
    shocks: pd.DataFrame
    pulses: pd.DataFrame

    @classmethod
    def of(cls, solution: Solution) -> Found:
        """Look for events, shocks and pulses."""
        few = len(solution.events) <= MOST_EVENTS
        pulses = solution.pulses() if few else pd.DataFrame(columns=list(PULSE_COLUMNS), dtype=float)
        return cls(solution, solution.events, solution.shocks, pulses)

    @property
    def largest(self) -> pd.Series | None:
        """The row of the last event whose slip is at least 99 % of the largest; None if there is none."""
        return self.events.iloc[last_large_event(self.events.slip.to_numpy(float))] if len(self.events) else None

    @property
    def arrest(self) -> float:
        """The time at which the largest event ends, s; NaN if it does not end within the run, or if there is none."""
        return float("nan") if self.largest is None else float(self.largest.end)

    @property
    def total_slip(self) -> float:
        """The slip from the start to the end of the run, m."""
        first, last = self.solution.slip(np.array(self.solution.history.span))
        return float(last - first)


MOST_MARKS = 120
"""Largest number of marks; of more, those of smaller events and shocks are left away."""
KINDS: dict[str, MarkKind] = {"fold": "fold", "echo": "echo"}
"""Kinds of the marks of shocks by their cause, if it is not "jump"."""


def marks_of(found: Found, motion: Motion) -> tuple[Mark, ...]:
    """Return the marks of a run in order of time."""
    marks = [*_events(found), *_pulses(found, motion), *_jumps(found)]
    return tuple(sorted(marks, key=lambda mark: mark.time))


def _events(found: Found) -> list[Mark]:
    marks = []
    for _, event in found.events.nlargest(MOST_MARKS // 4, "slip").iterrows():
        marks.append(Mark(float(event.start), "start", f"a slip event begins at {short(event.start, 's')}"))
        if not np.isnan(event.end):
            text = f"arrest at {short(event.end, 's')}, after {short(event.slip, 'm')} of slip"
            marks.append(Mark(float(event.end), "arrest", text))
    return marks


def _pulses(found: Found, motion: Motion) -> list[Mark]:
    """Return a mark for each pulse, where its slip rate is largest on the curve."""
    marks = []
    for _, pulse in found.pulses.nlargest(MOST_MARKS // 4, "slip").iterrows():
        inside = np.flatnonzero((motion.time >= pulse.start) & (motion.time <= pulse.start + pulse.duration))
        if len(inside):
            peak = float(motion.time[inside[np.argmax(np.abs(motion.slip_rate[inside]))]])
            text = f"pulse of {short(pulse.slip, 'm')}, fastest with {short(pulse.peak_rate, 'm/s')} at {short(peak, 's')}"
            marks.append(Mark(peak, "pulse", text))
    return marks


def _jumps(found: Found) -> list[Mark]:
    shocks = found.shocks.assign(size=(found.shocks.rate_after - found.shocks.rate_before).abs())
    marks = []
    for _, shock in shocks.nlargest(MOST_MARKS // 4, "size").iterrows():
        step = f"from {short(shock.rate_before, 'm/s')} to {short(shock.rate_after, 'm/s')}"
        text = f"the slip rate jumps {step} at {short(shock.time, 's')} ({shock.cause})"
        marks.append(Mark(float(shock.time), KINDS.get(shock.cause, "jump"), text))
    return marks


def key_numbers(found: Found, contact: Uniqueness, motion: Motion) -> tuple[KeyNumber, ...]:
    """Return the numbers of a run; NaN for one that it does not have, such as the arrest of a contact that never slips."""
    event, unit = found.largest, motion.load_unit
    of_event = {} if event is None else event.to_dict()

    def of(name: str) -> float:
        return float(of_event.get(name, np.nan))

    return (
        KeyNumber("slip in all", found.total_slip, "m"),
        KeyNumber("slip events", float(len(found.events)), "1"),
        KeyNumber("slip of the largest event", of("slip"), "m"),
        KeyNumber("pulses of the largest event", of("pulses"), "1"),
        KeyNumber("largest slip rate", float(np.abs(motion.slip_rate).max()), "m/s"),
        KeyNumber("arrest", found.arrest, "s"),
        KeyNumber("duration of the largest event", of("duration"), "s"),
        KeyNumber("drop of the traction", of("traction_drop"), unit),
        KeyNumber("shocks", float(len(found.shocks)), "1"),
        KeyNumber("critical value", np.nan if contact.critical_value is None else contact.critical_value, contact.critical_unit),
    )
