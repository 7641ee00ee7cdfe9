"""What a run says of itself, in lines of a name and a text: the terminal, notebooks, `repr` and the explorer show these lines."""

from __future__ import annotations

from collections.abc import Mapping

from stickslip.foundation.show import how_long, with_unit
from stickslip.problem import Status, creep_tolerance
from stickslip.problem.scenarios import Scenario

Line = tuple[str, str]
"""The name of a line, and its text."""
NOTES = {"trapped": "trapped energy", "predictability": "predictability", "proven": "proven", "rounding": "rounding"}
"""What is noted of the whole run, by the words of files, and the name of its line; `short` sums up all but the last."""


def account_of(scenario: Scenario, status: Status, reached: float, notes: Mapping[str, str]) -> list[Line]:
    """Return how a run went: slip, what ended it and when (s), and what the options of the run came to.

    `notes` has, by the words of files, "reach" and, where there is something to say, "creep", "lumping" and "selection".
    """
    problem, shortest = scenario.problem, scenario.shortest_event
    lines = [("slip", notes.get("reach", "")), ("status", str(status))]
    lines.append(("duration", f"{how_long(reached, scenario.duration)}, rtol {scenario.rtol:g}"))
    if shortest:
        lines.append(("shortest_event", f"{with_unit(shortest, 's')}: shorter events are lumped"))
    if lumping := notes.get("lumping"):
        lines.append(("shortest_event", f"automatic: {lumping}"))
    creep = notes.get("creep")
    if scenario.creep_rtol:
        lines.append(("creep_rtol", f"{scenario.creep_rtol:g}: {creep or 'no leaps over creep'}"))
    elif creep:
        tolerance = creep_tolerance(problem, None, scenario.rtol)
        lines.append(("creep_rtol", f"{tolerance:g} (automatic; 0 runs every {problem.body.turn}): {creep}"))
    lines.append(("selection rule", notes.get("selection", problem.rule)))
    return [line for line in lines if line[1]]


def notes_in(notes: Mapping[str, str], *, everything: bool = True) -> list[Line]:
    """Return what is noted of a whole run; not `everything`: in short, if `notes` has that."""
    if not everything and (short := notes.get("short")):
        return [("", short), *notes_in({"rounding": notes.get("rounding", "")})]
    return [(name, notes[word]) for word, name in NOTES.items() if notes.get(word)]
