"""What stands around the kernel: `ss.simulate` itself, imports, and the first compilation."""

from __future__ import annotations

import dataclasses
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import pandas as pd
from rich.console import Console
from rich.table import Table

import stickslip as ss
from benchmarks import ours
from benchmarks.problems import CASES, Case
from benchmarks.runner import interleaved

WRITTEN = {
    "sinusoidal-slip": "mean + amplitude*sin(wavenumber*u)",
    "hyperbolic-rate": "dynamic + (static - dynamic)/(1 + alpha*v)",
}
"""The benchmark's laws as a user would write them."""
TABLE = {
    "start": [0.1, 1.2],
    "end": [0.3, 1.4],
    "slip": [0.5, 0.6],
    "peak_rate": [1.0, 2.0],
    "cause": ["start", "echo"],
}
FIRST_RUN = """
import time
start = time.perf_counter(), time.process_time()
from benchmarks.problems import TRANSIT, EVENT, SHOCKS
from stickslip.run.simulate import simulate
imported = time.perf_counter(), time.process_time()
for case in (TRANSIT, EVENT, SHOCKS):
    simulate(case.problem, case.duration)
    now = time.perf_counter(), time.process_time()
    print(now[0] - imported[0], now[1] - imported[1])
    imported = now
"""


def median(function: Callable[[], object], repeats: int = 300) -> float:
    """Median wall time of a call, s."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def python(code: str, **environment: str) -> str:
    """Run code in a fresh interpreter, and give back what it prints."""
    variables = os.environ | environment
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, env=variables).stdout


def imported(module: str, repeats: int = 7) -> float:
    """Median wall time of an import in a fresh interpreter, s."""
    code = f"import time; a = time.perf_counter(); import {module}; print(time.perf_counter() - a)"
    return statistics.median(float(python(code)) for _ in range(repeats))


def first_compile() -> list[tuple[float, float]]:
    """(wall, CPU) s of the first run of each of three problems with an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        lines = python(FIRST_RUN, STICKSLIP_CACHE_DIR=folder).split("\n")
    return [(float(wall), float(cpu)) for wall, cpu in (line.split() for line in lines if line)]


def as_expression(case: Case) -> Case:
    """The same problem with its law from an expression."""
    law = case.problem.friction
    written = ss.friction.FromExpression(WRITTEN[law.kind], law.numbers())
    return dataclasses.replace(case, problem=dataclasses.replace(case.problem, friction=written))


def show(console: Console, unit: Callable[[float], str]) -> None:
    """Print the second table."""
    table = Table(title="Around the kernel", title_justify="left")
    table.add_column("what")
    table.add_column("time", justify="right")
    for case in CASES:
        whole = median(lambda case=case: ss.simulate(case.problem, case.duration))  # type: ignore[misc]
        kernel = median(ours.runner(case, 1e-10).run)
        table.add_row(f"ss.simulate beyond its kernel: {case.title}", unit(whole - kernel))
    for case in CASES:
        runners = {"own": ours.runner(case, 1e-10), "expression": ours.runner(as_expression(case), 1e-10)}
        times = {name: statistics.median(found) for name, found in interleaved(runners).items()}
        ratio = times["expression"] / times["own"]
        table.add_row(f"law from an expression: {case.title}", f"{unit(times['expression'])}, x {ratio:.2f} of the built-in law")
    table.add_section()
    table.add_row("building one small pandas.DataFrame", unit(median(lambda: pd.DataFrame(TABLE))))
    table.add_section()
    for module in ("numba", "stickslip", "stickslip.run.simulate", "pandas"):
        table.add_row(f"import {module}", unit(imported(module)))
    table.add_section()
    compiled = first_compile()
    for what, (wall, cpu) in zip(("engine and slip law, slab", "slip law, block", "rate law, slab"), compiled, strict=True):
        table.add_row(f"first compilation: {what}", f"{wall:.1f} s wall, {cpu:.1f} s CPU")
    console.print(table)
