"""Cost of a long run against simulated years and against events: `python -m benchmarks.long_runs`."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from rich.console import Console
from rich.table import Table

import stickslip as ss

CYCLES = ss.load_scenario("cycles-block")
RECURRENCE = 4.693684 * ss.YEAR

FASTER = 1e6
FIRST = 6.0
"""Seconds in which the first event of either slab is over: from there on it is loaded faster, if it is."""
ALPHA_ONE = ss.load_scenario("second-event-perfect-delay")
MICRO_EVENTS = ss.load_scenario("fig7-slab-critical")


def medians(runs: Sequence[Callable[[], object]], repeats: int) -> list[float]:
    """Median wall times of calls that take turns, s."""
    times: list[list[float]] = [[] for _ in runs]
    for _ in range(repeats):
        for run, took in zip(runs, times, strict=True):
            start = time.perf_counter()
            run()
            took.append(time.perf_counter() - start)
    return [statistics.median(took) for took in times]


def wall(run: Callable[[], object], repeats: int) -> float:
    """Median wall time of a call, s."""
    return medians([run], repeats)[0]


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


def against_loading(console: Console) -> None:
    """Slabs at the real plate rate, and a million times faster: for as much load beyond the first event, or for other times."""
    table = Table(title="Slabs, pulled by 5 cm a year and a million times faster", title_justify="left")
    for heading in ("slab", "loaded", "until", "events", "pieces", "simulate", "an event", "a piece"):
        table.add_column(heading, justify="right")
    one = [n * ss.YEAR for n in (480.0, 1000.0, 5000.0, 20_000.0)]
    real, fast = slabs(table, "alpha = 1", ALPHA_ONE.problem, one, [FIRST + until / FASTER for until in one[:3]], 200)
    micro, rush = slabs(table, "alpha_c + 1e-6", MICRO_EVENTS.problem, (1.0e5, 1.1e5, 1.2e5, 1.4e5), (FIRST + 0.1, 12.0, 30.0), 9)
    console.print(table)
    ratios = [a / b for a, b in zip(real, fast, strict=False)]
    console.print(f"alpha = 1, an event, real to fast: median {statistics.median(ratios):.2f}, largest {max(ratios):.2f}")
    ratio = statistics.median(micro) / statistics.median(rush)
    console.print(f"alpha_c + 1e-6, an event, real to fast: {ratio:.2f} (of medians), at most {max(micro) / min(rush):.2f}")


def slabs(
    table: Table, name: str, problem: ss.Problem, real: Sequence[float], fast: Sequence[float], repeats: int
) -> tuple[list[float], list[float]]:
    """Add a row a run, up to times (s) under real and under fast loading; median costs of an event under either, s."""
    faster = replace(problem, pull_rate=problem.pull_rate * FASTER)
    asked = [*((problem, 1.0, until) for until in real), *((faster, FASTER, until) for until in fast)]
    times = medians([lambda p=p, t=t: ss.simulate(p, t) for p, _, t in asked], repeats)  # type: ignore[misc]
    costs = []
    for (pulled, times_faster, until), took in zip(asked, times, strict=True):
        run = ss.simulate(pulled, until)
        events, pieces = len(run.catalogue(0.0)), len(run.history)
        costs.append(took / events)
        shown = f"{until / ss.YEAR:.0f} years" if until > ss.YEAR else f"{until:.7g} s"
        numbers = (f"{took * 1e3:.3g} ms", f"{took / events * 1e6:.3g} us", f"{took / pieces * 1e6:.3g} us")
        table.add_row(name, f"x {times_faster:g}", shown, str(events), str(pieces), *numbers)
    return costs[: len(real)], costs[len(real) :]


if __name__ == "__main__":
    console = Console()
    against_years(console)
    against_events(console)
    against_loading(console)
