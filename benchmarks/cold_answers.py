"""Processor time until the first answer with an empty cache, beside the first answers of five peers; bars that must be kept.

python -m benchmarks.cold_answers                              # three of each; exit status 1 if a bar is missed
python -m benchmarks.cold_answers --only run --repeats 1       # some commands, and no peers but those that match
python -m benchmarks.cold_answers --beside ../other/src        # and another tree, in turn; bars are for this one

Each answer is given by a process of its own. The package is the one that this Python imports, so that what an installation brings
is measured. Its cache of compiled code is empty for the first answer, and the second one has what the first has left. All else is
as it is on a machine in use: bytecode is made as an installation makes it, and the list of fonts of matplotlib is there.
A bar is kept if the least time is within it, because whatever else a machine does only adds; peers have none. What this machine
takes for a kernel of Python and numpy is said, so that tables of two machines can be compared; it moves no bar.
"""

from __future__ import annotations

import argparse
import compileall
import importlib.util
import os
import statistics
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from rich import box
from rich.console import Console
from rich.table import Table

from benchmarks import fresh
from benchmarks.first_answers import PEERS, Peer
from benchmarks.ways_through import kernel


class Command(NamedTuple):
    """A command, and the processor time (s) within which its first answer must be there."""

    typed: str
    bar: float


COMMANDS = (
    Command("check fig6-slab", 2.0),
    Command("run fig6-slab", 2.0),
    Command("run fig6-slab --figure f.png", 2.0),
    Command("run fig5-slab-reconstructed", 2.0),
    Command("run drill-string", 2.0),
    Command("run sliding-block-shaken", 2.0),
    Command("run rate-and-state-block", 3.0),
    Command("sweep fig6-slab --vary friction.alpha=0.05..0.4:50", 2.0),
)
"""What newcomers type first, for each part of the engine that they may meet."""


@dataclass
class Times:
    """Processor times (s) of one command in one tree: with an empty cache, and again."""

    first: list[float] = field(default_factory=list)
    again: list[float] = field(default_factory=list)


def answered(command: Sequence[str], folder: str, **variables: str) -> float:
    """Return the processor time of a Python process that answers. Raises SystemExit with its last line if it fails."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    done = fresh.run([sys.executable, *command], folder, kept | variables)
    if done.code:
        raise SystemExit(f"{' '.join(command)}: {done.last_line}")
    return done.spent


def ask(command: Command, tree: Path, times: Times) -> None:
    """Add the times of a command with an empty cache, and with what it has left there."""
    words = ["-m", "stickslip", *command.typed.split()]
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as cache:
        for found in (times.first, times.again):
            found.append(answered(words, folder, PYTHONPATH=str(tree), STICKSLIP_CACHE_DIR=cache))


def ask_peer(peer: Peer, found: list[float]) -> None:
    """Add the time of a peer."""
    with tempfile.TemporaryDirectory() as folder:
        found.append(answered(["-W", "ignore", "-c", peer.program], folder))


def ready(trees: Sequence[Path]) -> None:
    """Make what an installation has made before anybody asks: bytecode, and matplotlib's list of fonts."""
    for tree in trees:
        compileall.compile_dir(tree / "stickslip", quiet=2)
    with tempfile.TemporaryDirectory() as folder:
        answered(["-c", "import matplotlib.font_manager"], folder)


def installed(peers: Sequence[Peer]) -> tuple[list[Peer], list[Peer]]:
    """Return the peers that are installed beside this Python, and those that are missing."""
    there = [peer for peer in peers if importlib.util.find_spec(peer.module) is not None]
    return there, [peer for peer in peers if peer not in there]


def missed(commands: Sequence[Command], times: Sequence[Times]) -> list[str]:
    """Return a line for each command whose least first time is above its bar."""
    least = [min(one.first) for one in times]
    return [
        f"{command.typed}: {took:.2f} s, {command.bar:g} s allowed"
        for command, took in zip(commands, least, strict=True)
        if took > command.bar
    ]


def cell(found: Sequence[float]) -> str:
    """The least and the median time."""
    return f"{min(found):.2f} {statistics.median(found):.2f}"


def table_of(commands: dict[Command, list[Times]], peers: dict[Peer, list[float]], names: Sequence[str]) -> Table:
    """The table: commands with their bars, then peers."""
    table = Table(box=box.MARKDOWN)
    table.add_column("processor time, s: least and median")
    for heading in (*(f"{name}{when}" for name in names for when in ("empty cache", "again")), "bar"):
        table.add_column(heading, justify="right")
    for command, trees in commands.items():
        table.add_row(command.typed, *(cell(found) for one in trees for found in (one.first, one.again)), f"{command.bar:g}")
    for peer, found in peers.items():
        table.add_row(f"{peer.name}: {peer.question}", cell(found), *[""] * (2 * len(names)))
    return table


def measured(
    commands: Sequence[Command], peers: Sequence[Peer], trees: Sequence[Path], repeats: int
) -> tuple[dict[Command, list[Times]], dict[Peer, list[float]]]:
    """Ask each command in each tree and each peer in turn, so that what else the machine does meets all of them alike."""
    times = {command: [Times() for _ in trees] for command in commands}
    beside: dict[Peer, list[float]] = {peer: [] for peer in peers}
    for turn in range(repeats):
        print(f"turn {turn + 1} of {repeats}", file=sys.stderr, flush=True)  # noqa: T201 - a script
        for command, each in times.items():
            for tree, found in zip(trees, each, strict=True):
                ask(command, tree, found)
        for peer, taken in beside.items():
            ask_peer(peer, taken)
    return times, beside


def tree_of_this() -> Path:
    """The folder from which this Python imports the package."""
    found = importlib.util.find_spec("stickslip")
    if found is None or found.origin is None:
        raise SystemExit("stickslip is not installed beside this Python")
    return Path(found.origin).parents[1]


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table, peers that are missing, and bars that are missed; return 1 if any is."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--beside", type=Path, help="folder with the package of another tree")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", default="", help="only the commands and peers that contain this text")
    options = parser.parse_args(arguments)
    trees = [tree_of_this()] + ([options.beside.resolve()] if options.beside else [])
    commands = [command for command in COMMANDS if options.only in command.typed]
    there, missing = installed([peer for peer in PEERS if options.only in peer.name])
    if options.repeats < 1 or not (commands or there or missing):
        parser.error("--repeats must be 1 or more" if options.repeats < 1 else f"no command and no peer contains '{options.only}'")
    ready(trees)
    speed = kernel()
    times, beside = measured(commands, there, trees, options.repeats)
    over = missed(commands, [each[0] for each in times.values()])
    console = Console(width=None if sys.stdout.isatty() else 160)
    console.print(table_of(times, beside, ["", "other tree: "][: len(trees)]))
    say = [f"measured: {trees[0]}", *(f"other tree: {tree}" for tree in trees[1:])]
    say += [f"not installed: {peer.name} (pip install 'stickslip[bench]')" for peer in missing]
    say.append(f"a kernel of Python and numpy takes {speed:.3f} s here")
    say += [f"bar missed: {line}" for line in over] or ["all bars are kept"]
    console.print("\n".join(say), markup=False, highlight=False)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
