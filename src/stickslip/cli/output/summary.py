"""Show what happened in a run: what ended it, its slip events, its shocks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.files import announce
from stickslip.cli.output.show import table, titled
from stickslip.engine_input.creep_limits import creep_tolerance
from stickslip.foundation.formatting import number, with_unit

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.run.catalogue import Catalogue
    from stickslip.scenarios.scenario import Scenario
    from stickslip.solution.solution import Solution
    from stickslip.trajectory.status import Status

FIRST = 12
"""Number of table rows that are shown."""
LATE = 1e4
"""Time (s) from which on times have a fixed number of decimals: significant digits alone would hide fractions of a second."""


def show_solution(scenario: Scenario, solution: Solution) -> None:
    """Print the summary of a run on standard output."""
    from stickslip.trajectory.slip_events import SlipEvents
    from stickslip.trajectory.tables import default_event_rate, event_columns, shock_columns

    screen, force, history = titled(scenario), scenario.problem.load_unit, solution.history
    _say_how(screen, scenario, solution.status, solution.creep_note, solution.lumping_note)
    screen.print(f"selection rule {solution.selection_note}\n", soft_wrap=True)
    units = ("s", "s", "s", "m", "m/s", force, force, "")
    shown = ["start", "duration", "peak_after", "slip", "peak_rate", "traction_drop", "static_drop", "pulses"]
    events = event_columns(history, SlipEvents.of(history, default_event_rate(solution.problem)))
    _print(screen, "slip event", {name: events[name] for name in shown}, units)
    _print(screen, "shock", shock_columns(history), ("s", "", "m/s", "m/s", force, force))
    notes = (solution.trapped_note, solution.horizon_note, solution.rounding_note)
    for what, note in zip(("trapped energy", "predictability", "rounding"), notes, strict=True):
        if note:
            screen.print(f"{what}: {note}\n", soft_wrap=True)


def show_catalogue(scenario: Scenario, found: Catalogue) -> None:
    """Print on standard output the summary of a run of which only slip events were kept."""
    screen = titled(scenario)
    _say_how(screen, scenario, found.status, found.notes.get("creep", ""), found.notes.get("lumping", ""))
    screen.print(f"{found.events} slip event{'' if found.events == 1 else 's'}")
    for name, what in (("predictability", "predictability"), ("trapped", "trapped energy"), ("rounding", "rounding")):
        if name in found.notes:
            screen.print(f"{what}: {found.notes[name]}", soft_wrap=True)
    announce(*found.files)


def _say_how(screen: Console, scenario: Scenario, status: Status, creep: str, lumping: str) -> None:
    """Print what ended a run, its duration and tolerances, and requested or automatic leaps over creep and lumping of events."""
    screen.print(f"{status.name}: {status.message}", soft_wrap=True)
    screen.print(f"duration {with_unit(scenario.duration, 's')}, rtol {scenario.rtol:g}")
    if scenario.shortest_event:
        screen.print(f"events shorter than {with_unit(scenario.shortest_event, 's')} are lumped")
    if lumping:
        screen.print(f"shortest_event automatic: {lumping}", soft_wrap=True)
    if scenario.creep_rtol:
        screen.print(f"creep_rtol {scenario.creep_rtol:g}: {creep or 'no leaps over creep'}", soft_wrap=True)
    elif creep:
        tolerance = creep_tolerance(scenario.problem, None, scenario.rtol)
        screen.print(f"creep_rtol {tolerance:g} (automatic; 0 runs every round trip): {creep}", soft_wrap=True)


def _print(screen: Console, what: str, columns: Mapping[str, Sequence[Any]], units: Sequence[str]) -> None:
    rows = len(next(iter(columns.values())))
    if not rows:
        screen.print(f"no {what}\n")
        return
    headings = [f"{name.replace('_', chr(10))}\n{unit}".rstrip() for name, unit in zip(columns, units, strict=True)]
    for digits in (8, 5):  # use fewer digits if the terminal is too narrow
        shown = table(*headings, numbers=True)
        for row in islice(zip(*columns.values(), strict=True), FIRST):
            shown.add_row(*(_cell(value, unit, digits) for value, unit in zip(row, units, strict=True)))
        if screen.measure(shown).maximum < screen.width:
            break
    more = f", the first {FIRST} of them" if rows > FIRST else ""
    screen.print(f"{rows} {what}{'s' if rows > 1 else ''}{more}")
    screen.print(shown)
    screen.print()


def _cell(value: Any, unit: str, digits: int) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.{digits - 2}f}" if unit == "s" and LATE <= abs(value) < math.inf else number(value, digits)
