"""What was found in a run: its slip events and pulses, marks on its curves, key numbers, and the sentence above the panels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from stickslip.contact import Uniqueness
from stickslip.engine import largest_of
from stickslip.extensions.explorer.model.answer import DIGITS, BodyCurves, KeyNumber, Mark, MarkKind, short
from stickslip.extensions.explorer.model.asked import SHOWN_KINDS
from stickslip.foundation.names import si_unit
from stickslip.problem import Problem
from stickslip.solution import Solution, last_large_event
from stickslip.solution.observables import PULSE_COLUMNS, RuleInfluence

MOST_EVENTS = 500
"""Pulses are sought in at most this many slip events: each takes a millisecond, and among more, single ones would not be seen."""


@dataclass(frozen=True)
class Findings:
    """What was found in a run, as the solution gives it: slip events, shocks and, if there are few events, their pulses."""

    solution: Solution
    events: pd.DataFrame
    shocks: pd.DataFrame
    pulses: pd.DataFrame

    @classmethod
    def of(cls, solution: Solution) -> Findings:
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
        """The end time of the largest event, s; NaN if it does not end within the run, or if there is none."""
        return float("nan") if self.largest is None else float(self.largest.end)

    @property
    def units(self) -> tuple[str, str]:
        """The SI units of slip and slip rate."""
        loads = self.solution.problem.load_unit
        return si_unit("slip", loads), si_unit("slip_rate", loads)

    @property
    def total_slip(self) -> float:
        """The slip from the start to the end of the run, m."""
        first, last = self.solution.slip(np.array(self.solution.history.span))
        return float(last - first)


MOST_MARKS = 120
"""Largest number of marks; of more, those of smaller events and shocks are left away."""
KINDS_OF_SHOCK: dict[str, MarkKind] = {"fold": "fold", "echo": "echo"}
"""Kinds of the marks of shocks by their cause, if it is not "jump"."""


def marks_of(found: Findings, motion: BodyCurves) -> tuple[Mark, ...]:
    """Return the marks of a run in order of time."""
    marks = [*_events(found), *_pulses(found, motion), *_jumps(found)]
    return tuple(sorted(marks, key=lambda mark: mark.time))


def largest_first(table: pd.DataFrame) -> pd.DataFrame:
    """Return events or pulses, the one with the largest slip in either direction first."""
    return table.iloc[np.argsort(-table.slip.abs().to_numpy(float), kind="stable")]


def of_slip(slip: float, unit: str) -> str:
    """Return a slip in words, with its direction if it goes back: "10.9 m of slip back"."""
    return f"{short(abs(slip), unit)} of slip{' back' if slip < 0.0 else ''}"


def _events(found: Findings) -> list[Mark]:
    marks, length = [], found.units[0]
    for _, event in largest_first(found.events).head(MOST_MARKS // 4).iterrows():
        marks.append(Mark(float(event.start), "start", f"a slip event begins at {short(event.start, 's')}"))
        if not np.isnan(event.end):
            text = f"arrest at {short(event.end, 's')}, after {of_slip(event.slip, length)}"
            marks.append(Mark(float(event.end), "arrest", text))
    return marks


def _pulses(found: Findings, motion: BodyCurves) -> list[Mark]:
    """Return a mark for each pulse, where its slip rate is largest on the curve."""
    marks, (length, rate) = [], found.units
    for _, pulse in largest_first(found.pulses).head(MOST_MARKS // 4).iterrows():
        inside = np.flatnonzero((motion.time >= pulse.start) & (motion.time <= pulse.start + pulse.duration))
        if len(inside):
            peak = float(motion.time[inside[np.argmax(np.abs(motion.slip_rate[inside]))]])
            text = f"pulse of {of_slip(pulse.slip, length)}, fastest with {short(pulse.peak_rate, rate)} at {short(peak, 's')}"
            marks.append(Mark(peak, "pulse", text))
    return marks


def _jumps(found: Findings) -> list[Mark]:
    shocks = found.shocks.assign(size=(found.shocks.rate_after - found.shocks.rate_before).abs())
    marks, rate = [], found.units[1]
    for _, shock in shocks.nlargest(MOST_MARKS // 4, "size").iterrows():
        step = f"from {short(shock.rate_before, rate)} to {short(shock.rate_after, rate)}"
        text = f"the slip rate jumps {step} at {short(shock.time, 's')} ({shock.cause})"
        marks.append(Mark(float(shock.time), KINDS_OF_SHOCK.get(shock.cause, "jump"), text))
    return marks


def key_numbers(found: Findings, contact: Uniqueness, motion: BodyCurves) -> tuple[KeyNumber, ...]:
    """Return the numbers of a run; NaN for one that it does not have, such as the arrest of a contact that never slips."""
    event, unit = found.largest, motion.load_unit
    length, rate = found.units
    of_event = {} if event is None else event.to_dict()

    def of(name: str) -> float:
        return float(of_event.get(name, np.nan))

    return (
        KeyNumber("slip in all", found.total_slip, length),
        KeyNumber(largest_of(length), found.solution.reach.largest, length),
        KeyNumber("slip events", float(len(found.events)), "1"),
        KeyNumber("slip of the largest event", of("slip"), length),
        KeyNumber("pulses of the largest event", of("pulses"), "1"),
        KeyNumber("largest slip rate", float(np.abs(motion.slip_rate).max()), rate),
        KeyNumber("arrest", found.arrest, "s"),
        KeyNumber("duration of the largest event", of("duration"), "s"),
        KeyNumber("drop of the traction", of("traction_drop"), unit),
        KeyNumber("shocks", float(len(found.shocks)), "1"),
        KeyNumber("critical value", np.nan if contact.critical_value is None else contact.critical_value, contact.critical_unit),
    )


NEAR_ONE = 5e-4
"""If a ratio is closer to 1 than this, its distance from 1 is given instead."""
JUMPS_NAMED = 2
"""Name all jumps if they are at most this many."""
CAUSES = {
    "start": "at the start",
    "fold": "at a fold",
    "echo": "by an echo",
    "loading": "by the loading",
    "healing": "by healing",
}
"""How a jump came about, by the cause that the table of shocks gives."""


def sentence(found: Findings, contact: Uniqueness, influence: RuleInfluence) -> str:
    """Return the sentence on a run; its parts end with full stops."""
    chosen = f"rule {influence.rule}: {influence.decided}" if influence.decided else ""
    parts = (_regime(found.solution.problem, contact, influence), _reach(found), _motion(found), _jumped(found), chosen)
    return " ".join(f"{part[0].upper()}{part[1:]}." for part in parts if part)


def _regime(problem: Problem, contact: Uniqueness, influence: RuleInfluence) -> str:
    if problem.body.has_inertia:
        return f"regular: {SHOWN_KINDS[problem.body.structure].has_the_mass} has a mass, so its slip rate cannot jump"
    if problem.friction.states:
        return "regular: friction has a state, and one slip rate at every load"
    meanings = {
        "regular": "one slip rate at every load",
        "irregular": "several slip rates at some loads",
        "continuum": "all slip rates of an interval at one load",
    }
    return f"{influence.regime}: {meanings[influence.regime]}{_against_critical(problem, contact)}"


def _against_critical(problem: Problem, contact: Uniqueness) -> str:
    """Return how the parameter that has a critical value compares with it, as the end of a sentence."""
    name, critical = contact.critical_parameter, contact.critical_value
    if name is None or critical is None:
        return ""
    one = problem.parameters[name]
    ratio = one.value / critical if critical else math.inf
    own, limit = short(one.value, one.unit), f"its critical value of {short(critical, one.unit)}"
    word = one.name.rpartition(".")[2].replace("_", " ")
    if ratio == 1.0:
        return f"; {word} = {own} is {limit}"
    if abs(ratio - 1.0) > NEAR_ONE:
        return f"; {word} = {own} is {ratio:.4g} times {limit}"
    return f"; {word} is {'above' if ratio > 1.0 else 'below'} {limit} by {abs(ratio - 1.0):.2g} of it"


def _reach(found: Findings) -> str:
    """Return the slip at the end and the largest displacement, if there is any, in few words: the plots need the room."""
    reach = found.solution.reach
    text = reach.text(found.solution.problem, DIGITS).replace(" um", " µm") if reach.largest else ""
    end, which, _ = text.partition(", which is the largest")
    return f"{end}, the largest" if which else text


def _motion(found: Findings) -> str:
    """Return what moved: slip, pulses and arrest of the largest event."""
    if found.largest is not None:
        return found.solution.events_in_words(DIGITS).replace(" um", " µm")
    span = found.solution.history.span
    moved, lasts = found.total_slip, short(span[1] - span[0], "s")
    return (
        f"it slips {short(moved, found.units[0])} in {lasts}, too slowly for a slip event" if moved else f"nothing slips in {lasts}"
    )


def _jumped(found: Findings) -> str:
    """Return how the slip rate jumps: every jump of a few, the largest of many."""
    shocks = found.shocks
    if found.solution.problem.body.has_inertia:  # which has been said
        return ""
    if shocks.empty:
        return "the slip rate never jumps"
    if len(shocks) <= JUMPS_NAMED:
        return f"the slip rate jumps {' and '.join(_jump(shock, found.units[1]) for shock in shocks.itertuples())}"
    largest = int(np.argmax(np.abs(shocks.rate_after - shocks.rate_before)))
    return f"the slip rate jumps {len(shocks)} times, most {_jump(list(shocks.itertuples())[largest], found.units[1])}"


def _jump(shock: Any, unit: str) -> str:
    before, after = (short(rate, unit) if rate else "rest" for rate in (shock.rate_before, shock.rate_after))
    when = "" if shock.cause == "start" else f" at {short(shock.time, 's')}"
    return f"from {before} to {after} {CAUSES[shock.cause]}{when}"
