"""What a run says of itself, in lines of a name and a text: the terminal, notebooks, `repr` and the explorer show these lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isnan
from typing import TYPE_CHECKING

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import NamedLine, brief, how_long, with_unit
from stickslip.problem import Problem, Status, creep_tolerance
from stickslip.problem.scenarios import Scenario

if TYPE_CHECKING:
    import pandas as pd

NOTES = {"trapped": "trapped energy", "predictability": "predictability", "proven": "proven", "rounding": "rounding"}
"""What is noted of the whole run, by the words of files, and the name of its line; `short` sums up all but the last."""


@dataclass(frozen=True)
class Account:
    """What is said of a run of a scenario when it is over.

    `reached` is the time (s) at its end. `notes` are by the words of files: reach and, where there is something to say, begun,
    creep, lumping, selection, short and those of NOTES.
    """

    scenario: Scenario
    status: Status
    reached: float
    notes: Mapping[str, str]

    def lines(self) -> Iterator[NamedLine]:
        """Yield how it went: slip, what ended it and when, and what the options of the run came to."""
        scenario, problem, note = self.scenario, self.scenario.problem, self.notes.get
        if begun := note("begun"):
            yield "start", begun
        if reach := note("reach"):
            yield "slip", reach
        yield "status", str(self.status)
        yield "duration", f"{how_long(self.reached, scenario.duration)}, rtol {scenario.rtol:g}"
        if scenario.shortest_event:
            yield "shortest_event", f"{with_unit(scenario.shortest_event, 's')}: shorter events are lumped"
        if lumping := note("lumping"):
            yield "shortest_event", f"automatic: {lumping}"
        if scenario.creep_rtol:
            yield "creep_rtol", f"{scenario.creep_rtol:g}: {note('creep', 'no leaps over creep')}"
        elif creep := note("creep"):
            tolerance = creep_tolerance(problem, None, scenario.rtol)
            yield "creep_rtol", f"{tolerance:g} (automatic; 0 runs every {problem.body.turn}): {creep}"
        yield "selection rule", note("selection", problem.rule)

    def noted(self, *, everything: bool = True) -> Iterator[NamedLine]:
        """Yield what is noted of the whole run; not `everything`: in one short line without a name, and the rounding."""
        short = "" if everything else self.notes.get("short", "")
        if short:
            yield "", short
        for word, name in NOTES.items():
            if (note := self.notes.get(word)) and (everything or word == "rounding"):
                yield name, note


def last_large_event(slips: Floats) -> int:
    """Return the row number of the last event whose slip, in either direction, is at least 99 % of the largest."""
    sizes = np.abs(slips)
    return int(np.flatnonzero(sizes >= 0.99 * sizes.max())[-1])


def events_in_words(events: pd.DataFrame, problem: Problem, digits: int) -> str:
    """Return the number of slip events, and what the largest did: slip, pulses, largest slip rate, and when it was over (s)."""
    count = len(events)
    if not count:
        return "none"
    event = events.iloc[last_large_event(events.slip.to_numpy(float))]
    slip = brief(abs(event.slip), problem.unit_of("slip"), digits)
    rate = brief(event.peak_rate, problem.unit_of("slip_rate"), digits)
    head = f"{_several(count, 'slip event')}{', the largest' if count > 1 else ''} of {slip}{' back' if event.slip < 0.0 else ''}"
    text = f"{head} in {_several(int(event.pulses), 'pulse')}, at up to {rate}"
    if isnan(event.end):
        return f"{text}, which goes on at the end of the run"
    over = f"arrested at {brief(event.end, 's', digits)}" if count == 1 else f"lasting {brief(event.duration, 's', digits)}"
    return f"{text}, {over}"


def _several(count: int, thing: str) -> str:
    """Return a number of things: "no pulse", "one pulse", "3 pulses"."""
    return f"{ {0: 'no', 1: 'one'}.get(count, count) } {thing}{'' if count in (0, 1) else 's'}"
