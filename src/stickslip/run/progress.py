"""Report the progress of a run to a callback, or in one line on a terminal or in a notebook."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeVar

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import about_time, clean, in_unit, number

News = TypeVar("News")
Show = Callable[[str], object]
"""A function that shows a line of text in place of the one before."""


@contextmanager
def reporting(progress: Callable[[News], object] | bool | None, what: str) -> Iterator[Callable[[News], object] | None]:
    """Provide the function that receives the progress of `what`: the user's function, or a display if `progress` is True.

    It is None if no progress is wanted. Raises InputError for anything else.
    """
    if progress is True:
        with progress_line(f"{what}:") as report:
            yield report
        return
    if not (progress is None or progress is False or callable(progress)):
        raise InputError(f"{what}: progress must be True or a function, got {shown(progress)}")
    yield progress or None


@contextmanager
def progress_line(what: str) -> Iterator[Callable[..., None]]:
    """Show progress on a terminal or in a notebook until the end of the context, which removes the line.

    Yields a function that shows its arguments after `what`. Messages about compilation are shown in the same place.
    """
    notebook = _notebook()
    if notebook is None and not sys.stderr.isatty():
        yield lambda *news: None
        return
    from stickslip.foundation.kernels.code import announce_by
    from stickslip.foundation.sealed_files import tell

    with _in_notebook(notebook) if notebook else _on_terminal(what) as show:

        def report(*news: object) -> None:
            show(" ".join([what, *(clean(str(one)) for one in news)]))

        announce_by(report)
        try:
            yield report
        finally:
            announce_by(tell)


@contextmanager
def _on_terminal(what: str) -> Iterator[Show]:
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(file=sys.stderr, highlight=False, markup=False, emoji=False)
    with Progress(SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), console=console, transient=True) as bar:
        task = bar.add_task(what)
        yield lambda line: bar.update(task, description=line)


def _notebook() -> Callable[..., Any] | None:
    """Return IPython's function `display` in a notebook; None elsewhere, without importing anything."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if getattr(shell, "kernel", None) is None:  # a shell in a terminal has none
        return None
    from IPython.display import display

    return display  # type: ignore[no-any-return]


@contextmanager
def _in_notebook(display: Callable[..., Any]) -> Iterator[Show]:
    """Replace the text of one display; rich would need a library of widgets for that, which many notebooks lack."""
    handle = display({"text/plain": ""}, raw=True, display_id=True)
    try:
        yield lambda line: handle.update({"text/plain": line}, raw=True)
    finally:
        handle.update({"text/plain": ""}, raw=True)


Doing = Literal["stuck", "creeping", "slipping"]


LONG_RUN = 200_000
"""A run is called long from this many pieces of history on: some 0.1 GB in memory, and in a file."""


class Report(NamedTuple):
    """The progress of a run; as a text it is one line for people.

    It holds the simulated time so far and at the end of the run (s); the number of slip events that are over, and the number that
    ends the run, if there is one; the number of pieces of history computed so far, including discarded ones; and the present motion
    of the contact, which creeps while |v| does not exceed the slip rate that defines events. `pace` is the simulated time per
    wall-clock time since the first report, and `left` the wall-clock time left at this pace (s); both are NaN while they are not
    known.
    """

    time: float
    duration: float
    events: int
    max_events: int | None
    pieces: int
    doing: Doing
    pace: float
    left: float

    def __str__(self) -> str:
        wanted = f" of {self.max_events}" if self.max_events else ""
        parts = [
            how_far(self.time, self.duration),
            f"{self.events}{wanted} slip event{'' if self.events == 1 and not wanted else 's'}",
            self.doing,
        ]
        if self.pieces >= LONG_RUN:
            parts.append(f"{number(self.pieces / 1e6, 3)} million pieces")
        return ", ".join(parts + how_fast(self.pace, self.left))


def how_far(time: float, duration: float) -> str:
    """Return in words how far a run has come: both in s."""
    length, unit = in_unit(duration)
    return f"{number(time / length, 6)} of {number(duration / length, 6)} {unit}"


def how_fast(pace: float, left: float) -> list[str]:
    """Return in words the simulated time per wall-clock time, and the wall-clock time left (s), as far as they are known."""
    parts = [f"{about_time(pace)} a second"] if pace > 0.0 else []
    return [*parts, f"{about_time(left)} left"] if 1.0 <= left < math.inf else parts


Progress = Callable[[Report], object]
"""A function that is called with a `Report` between two calls of the engine, some ten times a second."""


@dataclass
class Pace:
    """Measure how fast a run goes since its first report: wall-clock time (s), simulated time (s), and share of the run done."""

    first: tuple[float, float, float] | None = None

    def at(self, now: float, share: float) -> tuple[float, float]:
        """Return the pace and the wall-clock time left (s; see `Report`) at a simulated time (s), with a share of the run done."""
        clock = time.monotonic()
        self.first = from_clock, from_time, from_share = self.first or (clock, now, share)
        took, done = clock - from_clock, share - from_share
        pace = (now - from_time) / took if took > 0 else float("nan")
        return pace, took * (1.0 - share) / done if done > 0 else float("nan")
