"""Cost of a long run against simulated years and against events: `python -m benchmarks.long_runs`."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import replace

from rich.console import Console
from rich.table import Table

import stickslip as ss

CYCLES = ss.load_scenario("cycles-block")
RECURRENCE = 4.693684 * ss.YEAR


def wall(run: Callable[[], object], repeats: int) -> float:
    """Median wall time of a call, s."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def against_years(console: Console) -> None:
    """Stuck for ever longer: one event, loaded ever more slowly."""
    table = Table(title="One cycle, loaded ever more slowly", title_justify="left")
    for heading in ("years", "events", "pieces", "simulate"):
        table.add_column(heading, justify="right")
    for slower in (1.0, 1e2, 1e4, 1e6, 1e8):
        problem = replace(CYCLES.problem, pull_rate=CYCLES.problem.pull_rate / slower)
        run = ss.simulate(problem, 1.5 * RECURRENCE * slower)
        took = wall(lambda p=problem, s=slower: ss.simulate(p, 1.5 * RECURRENCE * s), 200)  # type: ignore[misc]
        table.add_row(
            f"{1.5 * RECURRENCE * slower / ss.YEAR:.3g}", str(len(run.events)), str(len(run.history)), f"{took * 1e6:.0f} us"
        )
    console.print(table)


def against_events(console: Console) -> None:
    """More and more cycles."""
    table = Table(title="More and more cycles", title_justify="left")
    for heading in ("events", "years", "simulate", "an event", "catalogue", "an event"):
        table.add_column(heading, justify="right")
    for events in (10, 100, 1_000, 10_000):
        duration, repeats = (events + 0.5) * RECURRENCE, max(3, 1000 // events)
        kept = wall(lambda d=duration: ss.simulate(CYCLES.problem, d), repeats)  # type: ignore[misc]
        told = wall(lambda d=duration: ss.catalogue(CYCLES.problem, d), 1 if events > 1_000 else 3)  # type: ignore[misc]
        costs = (f"{kept * 1e3:.3g} ms", f"{kept / events * 1e6:.3g} us", f"{told:.3g} s", f"{told / events * 1e6:.3g} us")
        table.add_row(str(events), f"{duration / ss.YEAR:.3g}", *costs)
    console.print(table)


if __name__ == "__main__":
    console = Console()
    against_years(console)
    against_events(console)
