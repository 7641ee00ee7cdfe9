"""Processor time of warm commands, each in a fresh interpreter; trees to compare are run in turn.

python -m benchmarks.startup                          # this tree
python -m benchmarks.startup --beside ../other/src    # and another one, interleaved
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import tempfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks import fresh

HERE = Path(__file__).resolve().parents[1] / "src"
MAP = ("--map", "alpha=0.01..10:40:log", "--map", "normal_stress=10 MPa..500 MPa:30")
COMMANDS = {
    "import stickslip": None,
    "stickslip --version": ["--version"],
    "stickslip --help": ["--help"],
    "stickslip run --help": ["run", "--help"],
    "stickslip new slab": ["new", "slab"],
    "stickslip new --list": ["new", "--list"],
    "stickslip check fig6-slab": ["check", "fig6-slab"],
    "stickslip check cycles-block": ["check", "cycles-block"],
    "stickslip run fig6-slab": ["run", "fig6-slab"],
    "stickslip run fig5-slab-printed": ["run", "fig5-slab-printed"],
    "stickslip run fig6-slab --out": ["run", "fig6-slab", "--out", "{folder}/run.nc"],
    "stickslip run fig6-slab --figure": ["run", "fig6-slab", "--figure", "{folder}/run.png"],
    "stickslip check --map, 40 x 30": ["check", "fig6-slab", *MAP, "--figure", "{folder}/map.png"],
}
"""Commands as a newcomer types them, and their arguments; None is the import alone."""


def processor_time(source: Path, arguments: list[str] | None, folder: str) -> float:
    """Return the processor time (user and system, s) of one command in a fresh interpreter, with the code under `source`.

    Bytecode is kept in `folder`, as every installation keeps it.
    """
    words = [] if arguments is None else [word.format(folder=folder) for word in arguments]
    code = ["-c", "import stickslip"] if arguments is None else ["-m", "stickslip"]
    command = [sys.executable, *code, *words]
    variables = os.environ | {"PYTHONPATH": str(source), "PYTHONPYCACHEPREFIX": f"{folder}/bytecode"}
    variables.pop("PYTHONDONTWRITEBYTECODE", None)
    done = fresh.run(command, folder, variables)
    if done.code:
        raise SystemExit(f"{' '.join(command)}: {done.last_line}")
    return done.spent


def measure(sources: list[Path], arguments: list[str] | None, repeats: int, folder: str) -> list[list[float]]:
    """Return the times of a command in each tree, after one run that fills the caches."""
    times: list[list[float]] = [[] for _ in sources]
    for turn in range(repeats + 1):
        for source, found in zip(sources, times, strict=True):
            took = processor_time(source, arguments, folder)
            if turn:
                found.append(took)
    return times


def main() -> None:
    """Print a table with a row for each command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--beside", type=Path, help="folder with the package of another tree")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--only", default="", help="only the commands that contain this text")
    options = parser.parse_args()
    sources = [HERE] + ([options.beside.resolve()] if options.beside else [])
    table = Table(title="Processor time of warm commands, s: least and median", title_justify="left")
    for heading in ("command", *(str(source.parent.name) for source in sources), *(["ratio"] if options.beside else [])):
        table.add_column(heading, justify="left" if heading == "command" else "right")
    chosen = {name: arguments for name, arguments in COMMANDS.items() if options.only in name}
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in chosen.items():
            times = measure(sources, arguments, options.repeats, folder)
            cells = [f"{min(found):.2f} {statistics.median(found):.2f}" for found in times]
            ratio = [f"{statistics.median(times[0]) / statistics.median(times[1]):.2f}"] if options.beside else []
            table.add_row(name, *cells, *ratio)
    Console().print(table)


if __name__ == "__main__":
    main()
