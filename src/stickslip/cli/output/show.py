"""Show results on the terminal: one console, plain tables, numbers with units."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from stickslip.foundation.constants import YEAR

if TYPE_CHECKING:
    from stickslip.run.progress import Report
    from stickslip.scenarios.scenario import Scenario

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"))
"""SI prefixes with their factors, largest first."""
_SCALED = ("Pa", "Pa/m", "Pa s/m", "N", "N/m", "N s/m")
"""Units that are shown with a prefix."""


def console(*, errors: bool = False) -> Console:
    """Return the console for results; without a terminal it is 132 columns wide, so that a table in a file keeps its lines."""
    stream = sys.stderr if errors else sys.stdout
    width = None if stream.isatty() else 132
    return Console(file=stream, width=width, highlight=False, markup=False, emoji=False)


def table(*headings: str, numbers: bool = False) -> Table:
    """Return a table without a frame; columns of numbers are aligned to the right."""
    made = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for heading in headings:
        made.add_column(heading, justify="right" if numbers else "left", overflow="fold")
    return made


def clean(text: str) -> str:
    """Return a text of a scenario with spaces in place of control characters, which could change the terminal."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def titled(scenario: Scenario) -> Console:
    """Print the title of a scenario, or its name, on the console for results, and return the console."""
    screen = console()
    screen.print(clean(scenario.title or scenario.name), style="bold")
    return screen


def print_sentences(screen: Console, *texts: str) -> None:
    """Print texts as sentences, each on a line of its own; empty ones are left out."""
    for text in filter(None, texts):
        screen.print(f"{text[0].upper()}{text[1:]}.", soft_wrap=True)


def number(value: float, digits: int = 8) -> str:
    """Format a number with the given number of significant digits; NaN is shown as a dash."""
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def with_unit(value: float, unit: str) -> str:
    """Format a quantity for users: 34.3 GPa, 1.5147648e+10 s (480 years); slow rates are also given per year."""
    if unit == "1":
        return number(value)
    if unit in _SCALED and math.isfinite(value):
        factor, prefix = next(((f, p) for f, p in _PREFIXES if abs(value) >= f), (1.0, ""))
        return f"{number(value / factor)} {prefix}{unit}"
    plain = f"{number(value)} {unit}"
    if unit == "s" and 1e5 <= abs(value) < math.inf:
        return f"{plain} ({number(value / YEAR, 6)} years)"
    if unit.endswith("/s") and 0 < abs(value) < 1e-4:
        return f"{plain} ({number(value * YEAR, 6)} {unit.removesuffix('/s')}/year)"
    return plain


_UNITS = ((YEAR, "years"), (86_400.0, "days"), (3_600.0, "hours"), (60.0, "min"), (1.0, "s"))
"""Units of time with their lengths in s, longest first."""


def in_unit(seconds: float) -> tuple[float, str]:
    """Return the length (s) and the name of the largest unit that is not longer than a time; seconds for times below 1 s."""
    return next(((length, name) for length, name in _UNITS if seconds >= length), _UNITS[-1])


def about_time(seconds: float) -> str:
    """Format a time (s) briefly in its largest unit, such as 3.2 min."""
    length, name = in_unit(seconds)
    value = seconds / length
    return f"{value:.0f} {name}" if value >= 100.0 else f"{number(value, 2)} {name}"


def so_far(report: Report) -> str:
    """Format the progress of a run in one line."""
    length, unit = in_unit(report.duration)
    wanted = f" of {report.max_events}" if report.max_events else ""
    parts = [
        f"{number(report.time / length, 6)} of {number(report.duration / length, 6)} {unit}",
        f"{report.events}{wanted} slip event{'' if report.events == 1 and not wanted else 's'}",
        report.doing,
    ]
    if report.pace > 0.0:
        parts.append(f"{about_time(report.pace)} a second")
    if math.isfinite(report.left):
        parts.append(f"{about_time(report.left)} left")
    return ", ".join(parts)


@contextmanager
def progress_to(what: str) -> Iterator[Callable[..., Any]]:
    """Show a spinner on standard error while something runs, or nothing without a terminal.

    Yields a function that shows its arguments after `what`.
    """
    shown = console(errors=True)
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=shown, transient=True, disable=not shown.is_terminal) as bar:
        task = bar.add_task(what)

        def report(*news: Any) -> None:
            bar.update(task, description=" ".join([what, *(clean(str(one)) for one in news)]))

        if not shown.is_terminal:
            yield report
            return
        from stickslip.engine.codegen.cache import announce_by, tell  # with the compiler behind it, which is needed now anyway

        announce_by(report)
        try:
            yield report
        finally:
            announce_by(tell)
