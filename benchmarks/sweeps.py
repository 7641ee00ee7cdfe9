"""`python -m benchmarks.sweeps`: members per second, ours and others', on one thread and on two, in one table from one run.

`--members N` sets how many (default 20 000), `--million` runs a thousand and then a million rate-law members and says what memory
they took.
"""

from __future__ import annotations

import argparse
import resource
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numba import njit
from rich.console import Console
from rich.table import Table

from benchmarks.problems import EVENT, ROUND, SHOCKS, TRANSIT
from benchmarks.runner import UnavailableError
from benchmarks.sweep_peers import ADAPTED, FEWER, ONE_THREAD, PEERS, Run, Task, ours
from stickslip.extensions.sweeps.batch import run_members

Rates = dict[tuple[str, int], list[tuple[float, float]]]
ROUNDS = 5
LARGEST_ERROR = 1e-7
"""Of the slip, relative: what ours makes at a tolerance of 1e-6."""
LADDER = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
THREADS = (1, 2)
TASKS = (
    Task(
        "slab, slip law: transit and arrest",
        replace(TRANSIT, duration=1.1 * ROUND),
        1e-6,
        "initial.load",
        (1.5e8 + 3e3, 1.5e8 + 2e4),
    ),
    Task("slab, alpha about 1: two round trips", SHOCKS, 1e-6, "friction.alpha", (0.9, 1.1), more=20),
    Task("slab, slip law: first transit", TRANSIT, 1e-6, "initial.load", (1.5e8 + 3e3, 1.5e8 + 2e4)),
    Task("block, slip law: event and arrest", EVENT, 1e-6, "initial.excess", (2e10, 1e11), more=4),
)


@njit(nogil=True)
def one_after_the_other(steps: int) -> float:
    """Arithmetic of which each result waits for the one before: of a core it needs little."""
    x = 0.5
    for _ in range(steps):
        x = 3.9 * x * (1.0 - x)
    return x


@njit(nogil=True, fastmath=True)
def side_by_side(steps: int) -> float:
    """Arithmetic of numbers that do not wait for each other: it fills a core."""
    x, y = np.ones(1024), np.ones(1024)
    for _ in range(steps // 50):
        for n in range(1024):
            y[n] = 0.999 * y[n] + 1.0001 * x[n]
    return y[0]


def two_cores(work: Callable[[int], float]) -> float:
    """How much more two threads of arithmetic do than one, at the moment: what the machine has to give."""
    steps, spent = 20_000_000, []
    work(100)
    for threads in (1, 2):
        crowd = [threading.Thread(target=work, args=(steps,)) for _ in range(threads)]
        start = time.perf_counter()
        for one in crowd:
            one.start()
        for one in crowd:
            one.join()
        spent.append(time.perf_counter() - start)
    return 2.0 * spent[0] / spent[1]


def timed(run: Callable[[], object]) -> tuple[float, float]:
    """Wall clock and processor time (s) of a run."""
    start, before = time.perf_counter(), time.process_time()
    run()
    return time.perf_counter() - start, time.process_time() - before


def measure(task: Task, members: int) -> tuple[Rates, dict[str, float], list[str]]:
    """Members per second, and µs of processor time for one, of every peer on each number of threads, in turns; largest errors of
    the slip; who is missing."""
    runs: dict[str, tuple[Run, int]] = {}
    errors: dict[str, float] = {}
    notes = []
    for name in PEERS:
        count = max(task.more * members // FEWER.get(name, 1), 2)
        exact = ours(replace(task, rtol=1e-13), count)(1)
        try:
            for tolerance in LADDER if name in ADAPTED else (task.rtol,):
                runs[name] = (PEERS[name](replace(task, rtol=tolerance), count), count)
                errors[name] = float(np.max(np.abs(runs[name][0](1) / exact - 1.0)))
                if errors[name] <= LARGEST_ERROR:
                    break
        except UnavailableError as reason:
            notes.append(f"{task.title} - {name}: {reason}")
    rates: Rates = {}
    for _ in range(ROUNDS):
        for name, (run, count) in runs.items():
            for threads in THREADS[: 1 if name in ONE_THREAD else None]:
                spent = timed(lambda run=run, threads=threads: run(threads))
                rates.setdefault((name, threads), []).append((count / spent[0], 1e6 * spent[1] / count))
    return rates, errors, notes


def show(members: int) -> None:
    """The table."""
    console = Console(width=150 if not sys.stdout.isatty() else None)
    table = Table(
        title=f"{members} members (rate law: 20 times, block: 4 times as many), medians of {ROUNDS}", title_justify="left"
    )
    for name in ("members", "by"):
        table.add_column(name)
    for name in ("1 thread, /s", "2 threads, /s", "2 / 1", "processor, µs a member", "times ours", "error of slip"):
        table.add_column(name, justify="right")
    missing, cores = [], []
    for task in TASKS:
        cores.append((two_cores(one_after_the_other), two_cores(side_by_side)))
        rates, errors, notes = measure(task, members)
        missing += notes
        middle = {key: np.median(found, axis=0) for key, found in rates.items()}
        base = middle["stickslip, slip", 1][1]
        for n, name in enumerate(errors):
            (one, spent), (two, _) = middle[name, 1], middle.get((name, 2), (0.0, 0.0))
            cells = [f"{one:,.0f}", f"{two:,.0f}" if two else "", f"{two / one:.2f}" if two else "", f"{spent:.3g}"]
            table.add_row(task.title if n == 0 else "", name, *cells, f"{spent / base:.3g}", f"{errors[name]:.0e}")
        table.add_section()
    console.print(table)
    for name, found in zip(("waits for itself", "does not"), zip(*cores, strict=True), strict=True):
        gains = ", ".join(f"{gain:.2f}" for gain in found)
        console.print(f"two threads beside one, in between, of arithmetic that {name}: {gains}")
    for note in missing:
        console.print(f"  not run: {note}", style="dim", markup=False)


def million() -> None:
    """A thousand members, then a million: members per second and the process's largest resident memory."""
    task = TASKS[1]
    for members in (1_000, 1_000, 10_000, 100_000, 1_000_000):
        values = {task.key: task.numbers(members)}
        seconds, _ = timed(lambda values=values: run_members(task.scenario, values, ("slip", "events"), 2))
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        print(f"{members:>9,} members: {members / seconds:>9,.0f} /s on 2 threads, {memory:.1f} MB at most")  # noqa: T201


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--members", type=int, default=20_000)
    parser.add_argument("--million", action="store_true")
    chosen = parser.parse_args()
    if chosen.million:
        million()
    else:
        show(chosen.members)


if __name__ == "__main__":
    main()
