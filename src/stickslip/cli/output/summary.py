"""Show what happened in a run: what ended it, its slip events, its shocks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.show import fits, print_numbers, say, titled
from stickslip.foundation.names import readable_unit, si_unit
from stickslip.foundation.show import clean, number, with_unit
from stickslip.problem.scenarios import doubts

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Scenario
    from stickslip.solution import Account, Solution

ROWS_SHOWN = 12
"""Number of table rows that are shown."""
TABLE_DIGITS = 8, 5
"""Numbers of significant digits that are tried until a table fits the terminal; if none does, the table is divided."""
REST = " (--all has the rest)"
"""Says where the rest of the notes is that one line sums up."""
SENTENCES = "slip", "status"
"""Lines of a run that say what they are without their names."""
LATE = 1e4
"""Times from this one (s) on have a fixed number of decimals: significant digits alone would hide fractions of a second."""


def show_solution(scenario: Scenario, solution: Solution, *, everything: bool = False) -> None:
    """Print the summary of a run on standard output, with `everything` that is known of its proof, waves and predictability."""
    from stickslip.engine import SlipEvents, shock_columns
    from stickslip.problem import default_event_rate
    from stickslip.solution.observables import event_columns

    history, account = solution.history, solution.account
    events = event_columns(history, SlipEvents.of(history, default_event_rate(solution.problem)))
    show_run(titled(scenario), account, events, solution.problem, shocks=shock_columns(history), everything=everything)


def show_run(
    screen: Console,
    account: Account | None,
    events: Mapping[Any, Any] | str,
    problem: Problem | None,
    *,
    shocks: Mapping[str, Any] | None = None,
    everything: bool = False,
) -> None:
    """Print what is said of a run, its slip events or a text on them, and its shocks if they are kept.

    Account and problem may not be known.
    """
    from stickslip.engine import SHOCK_COLUMNS

    if account is not None:
        say(screen, *(clean(text if name in SENTENCES else f"{name} {text}") for name, text in account.lines()))
        say(screen, *(f"warning: {one}" for one in doubts(account.scenario.problem)))
    screen.print()
    if isinstance(events, str):
        say(screen, f"{events}\n")
    else:
        _print_events(screen, events, problem)
    if shocks is not None:
        _print(screen, "shock", shocks, [_unit(SHOCK_COLUMNS[name], problem) for name in shocks])
    for name, text in () if account is None else account.noted(everything=everything):
        say(screen, clean(f"{name}: {text}" if name else f"{text}{REST}"), "")


def _print_events(screen: Console, events: Mapping[Any, Any], problem: Problem | None) -> None:
    """Print the slip events of a problem, or of one that is not known.

    Stiffness times slip is left out where the driver has a finite impedance: the load does not fall by that much.
    """
    from stickslip.solution.observables import EVENT_COLUMNS, shown_columns

    if problem is not None and _slides_throughout(events, problem):
        say(screen, "the contact slides throughout: there are no separate slip events\n")
        return
    rigid = problem is None or problem.is_driven_rigidly
    names = [name for name in shown_columns() if name in events and (rigid or name != "static_drop")]
    units = [_unit(EVENT_COLUMNS[name].unit, problem) for name in names]
    _print(screen, "slip event", {name: events[name] for name in names}, units)
    say(screen, *statistics(events, _unit("slip", problem)))


def _unit(unit: str, problem: Problem | None) -> str:
    """Return the unit of a column as readers expect to see it, for a problem or for one that is not known."""
    found = si_unit(unit) if problem is None else problem.unit_of(unit)
    return "" if found == "1" else found


def _slides_throughout(events: Mapping[Any, Any], problem: Problem) -> bool:
    """Return True if the only event of a contact that never rests begins with the run and has no end."""
    starts, ends = events["start"], events["end"]
    return not problem.friction.sticks and len(starts) == 1 and float(starts[0]) == 0.0 and math.isnan(float(ends[0]))


def statistics(events: Mapping[Any, Any], slip: str = "m") -> list[str]:
    """Return a line with mean and scatter of slips (unit `slip`) and recurrence times, if there are three of these or more."""
    import numpy as np

    from stickslip.solution.observables import that_count

    lines = []
    for name, unit in (("recurrence", "s"), ("slip", slip)):
        values = that_count(events, name)
        if len(values) > 2:
            mean, scatter = float(values.mean()), float(values.std(ddof=1))
            of = "size of slip" if name == "slip" and (np.asarray(events["slip"], float) < 0.0).any() else name
            lines.append(f"{of}: mean {with_unit(mean, unit)}, standard deviation {100.0 * scatter / mean:.2g} % of it")
    if lines and np.isnan(np.asarray(events["end"], float)).any():
        lines[-1] += ", without the event that the end of the run cuts off"
    return [f"{'; '.join(lines)}\n"] if lines else []


def _print(screen: Console, what: str, columns: Mapping[str, Sequence[Any]], units: Sequence[str]) -> None:
    count = len(next(iter(columns.values())))
    if not count:
        say(screen, f"no {what}\n")
        return
    first = list(islice(zip(*columns.values(), strict=True), ROWS_SHOWN))
    scaled = [_readable(column, unit) for column, unit in zip(zip(*first, strict=True), units, strict=True)]
    headings = [f"{name.replace('_', chr(10))}\n{unit}".rstrip() for name, (unit, _) in zip(columns, scaled, strict=True)]
    rows = list(zip(*(column for _, column in scaled), strict=True))
    forms = [[[_cell(value, unit, n) for value, unit in zip(row, units, strict=True)] for row in rows] for n in TABLE_DIGITS]
    shown = next((form for form in forms if fits(screen, headings, form)), forms[0])
    more = f", the first {ROWS_SHOWN} of them" if count > ROWS_SHOWN else ""
    say(screen, f"{count} {what}{'s' if count > 1 else ''}{more}")
    print_numbers(screen, headings, shown)
    screen.print()


def _readable(column: Sequence[Any], unit: str) -> tuple[str, Sequence[Any]]:
    """Return the unit that makes a column of numbers short, and the column in that unit."""
    sizes = [abs(value) for value in column if isinstance(value, float) and math.isfinite(value)]
    name, factor = readable_unit(unit, *sizes, plain=True)
    return (name, column) if factor == 1.0 else (name, [value / factor for value in column])


def _cell(value: Any, unit: str, digits: int) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.{digits - 2}f}" if unit == "s" and LATE <= abs(value) < math.inf else number(value, digits)
