"""`python -m benchmarks.speed`: one table, from one run - time at equal measured error, for every problem and every method.

For each method the loosest tolerance is taken whose measured error (over the whole time span, against the tightest reference)
meets the target; the runs of all methods are then interleaved, and medians taken. Kernels are warm: compilation, the making of
arrays and of the solvers are not counted.
"""

from __future__ import annotations

import statistics
import sys
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table

from benchmarks import c_peer, heyoka_peer, jitcdde_peer, ours, overhead, scipy_peer
from benchmarks.problems import CASES, Case
from benchmarks.runner import Method, Runner, UnavailableError, interleaved

TARGETS = (1e-7, 1e-9)
LADDER = [10.0 ** (-half / 2) for half in range(6, 31)]
"""Tolerances to try, from loose to tight."""
METHODS: dict[str, Method] = {
    "stickslip": ours.runner,
    "C, same algorithm": c_peer.runner,
    "heyoka": heyoka_peer.runner,
    "scipy DOP853": scipy_peer.runner,
    "JiTCDDE": jitcdde_peer.runner,
}
SLOWER = {"scipy DOP853": LADDER[:-3:2], "JiTCDDE": LADDER[2:15:2]}
"""Coarser ladders for methods whose every run takes long."""


@dataclass(frozen=True)
class Row:
    """A line of the table."""

    method: str
    seconds: float
    steps: int
    error: float
    tolerance: float


def loosest(name: str, case: Case, target: float) -> tuple[Runner, float]:
    """The runner at the loosest tolerance whose measured error meets the target, and that error."""
    for tolerance in SLOWER.get(name, LADDER):
        runner = METHODS[name](case, tolerance)
        error = runner.error()
        if error <= target:
            return runner, error
    raise UnavailableError(f"no tolerance reaches {target:g}")


def measure(case: Case, target: float) -> tuple[list[Row], list[str]]:
    """The rows of one problem, and notes on methods that are missing."""
    chosen: dict[str, tuple[Runner, float]] = {}
    notes = []
    for name in METHODS:
        try:
            chosen[name] = loosest(name, case, target)
        except UnavailableError as reason:
            notes.append(f"{name}: {reason}")
    times = interleaved({name: runner for name, (runner, _) in chosen.items()})
    rows = [
        Row(name, statistics.median(times[name]), runner.steps(), error, runner.tolerance)
        for name, (runner, error) in chosen.items()
    ]
    return rows, notes


def show(seconds: float) -> str:
    """A time with its unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def kernel_table(console: Console) -> None:
    """Time at equal error."""
    table = Table(title="Kernel to kernel, warm, one core: time to reach a measured error", title_justify="left")
    for name, justify in (("problem", "left"), ("method", "left")):
        table.add_column(name, justify=justify)  # type: ignore[arg-type]
    for name in ("median time", "times ours", "steps", "measured error", "its tolerance"):
        table.add_column(name, justify="right")
    notes = []
    for case in CASES:
        for target in TARGETS:
            rows, missing = measure(case, target)
            notes += [f"{case.name} - {note}" for note in missing]
            base = next(row.seconds for row in rows if row.method == "stickslip")
            for n, row in enumerate(rows):
                title = f"{case.title}, to {target:g}" if n == 0 else ""
                ratio = f"{row.seconds / base:,.0f}" if row.seconds > 100.0 * base else f"{row.seconds / base:.2f}"
                table.add_row(
                    title, row.method, show(row.seconds), ratio, str(row.steps), f"{row.error:.1e}", f"{row.tolerance:.0e}"
                )
            table.add_section()
    console.print(table)
    for note in dict.fromkeys(notes):
        console.print(f"  not run: {note}", style="dim", markup=False)


def main() -> None:
    console = Console(width=150 if not sys.stdout.isatty() else None)
    kernel_table(console)
    overhead.show(console, show)


if __name__ == "__main__":
    main()
