"""How results are shown: one console, plain tables, numbers with units."""

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

from stickslip import YEAR

if TYPE_CHECKING:
    from stickslip.run.progress import Report

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"))
_SCALED = ("Pa", "Pa/m", "Pa s/m", "N", "N/m", "N s/m")


def console(*, errors: bool = False) -> Console:
    """Where results go; wide where there is no terminal, so that a table in a file keeps its lines."""
    stream = sys.stderr if errors else sys.stdout
    width = None if stream.isatty() else 132
    return Console(file=stream, width=width, highlight=False, markup=False, emoji=False)


def table(*headings: str, numbers: bool = False) -> Table:
    """A table without frame; columns of numbers stand at the right."""
    made = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for heading in headings:
        made.add_column(heading, justify="right" if numbers else "left", overflow="fold")
    return made


def clean(text: str) -> str:
    """Text of a scenario as it can be shown: no control characters."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def number(value: float, digits: int = 8) -> str:
    """A number to so many digits; not-a-number is shown as a dash."""
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def with_unit(value: float, unit: str) -> str:
    """A quantity for people: 34.3 GPa, 15 147 648 000 s (480 years), rates also per year."""
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


def in_unit(seconds: float) -> tuple[float, str]:
    """The largest unit of time that fits into a time: its length in s, and its name."""
    return next(((length, name) for length, name in _UNITS if seconds >= length), _UNITS[-1])


def about_time(seconds: float) -> str:
    """A time as one says it: 3.2 min."""
    length, name = in_unit(seconds)
    value = seconds / length
    return f"{value:.0f} {name}" if value >= 100.0 else f"{number(value, 2)} {name}"


def so_far(report: Report) -> str:
    """How far a run is, in one line."""
    length, unit = in_unit(report.duration)
    wanted = f" of {report.events_wanted}" if report.events_wanted else ""
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
    """A spinner on standard error while something runs; where there is no terminal, nothing until it is done.

    Yields a function to be called with whatever there is to say: it shows its arguments behind `what`.
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
