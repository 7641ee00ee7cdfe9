"""Seven ways into the package, as new users of seven trades type them, from the help to the last number with a file of their own.

python -m benchmarks.ways_through                # with the cache of compiled code as it is
python -m benchmarks.ways_through --empty        # with an empty one: where a newcomer waits
python -m benchmarks.ways_through --only drill

Each command runs in a fresh process. It fails if it takes more processor time than its step allows (as measured against a kernel
of Python and numpy in the same minute, and longer where it says that it compiles), if its exit status is another, or if what it
prints lacks something, or has another number than the truth of the file (`benchmarks.own_files`). There is a line for each failing
step, and the exit status is their number.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks import fresh
from benchmarks.fresh import Done
from benchmarks.own_files import FILES
from benchmarks.ways import WAYS, Number, Step

ROOT = Path(__file__).resolve().parents[1]
KERNEL = 0.20
"""Processor time (s) of `kernel` where the bounds of the steps were measured."""
COMPILING = 90.0
"""Processor time (s) that a command may take in addition if it says that it compiles."""


def say(*lines: str) -> None:
    """Print lines at once."""
    print(*lines, sep="\n", flush=True)  # noqa: T201 - a script


def kernel() -> float:
    """Return the processor time (s) of some work of Python and numpy, the shortest of three."""
    times = []
    for _ in range(3):
        begun, total, values = time.process_time(), 0.0, np.linspace(0.0, 1.0, 200_000)
        for i in range(600_000):
            total += i * 0.5
        for _ in range(60):
            values = np.sqrt(values * values + 1e-3)
        times.append(time.process_time() - begun)
    return min(times)


def run(step: Step, folder: Path) -> Done:
    """Run the command of a step in a folder."""
    typed, _, into = step.typed.partition(" > ")
    python = step.typed.startswith("python: ")
    words = ["-c", step.typed.removeprefix("python: ")] if python else ["-m", "stickslip", *shlex.split(typed)]
    done = fresh.run([sys.executable, *words], folder, os.environ | {"PYTHONPATH": str(ROOT / "src")})
    if into and not python:
        (folder / into).write_text(done.out, encoding="utf-8")
    return done


def faults(step: Step, done: Done, slower: float) -> list[str]:
    """Return what is wrong with what a command did; this machine takes `slower` times as long as that of the bounds."""
    allowed = step.bound * slower + (COMPILING if "compil" in done.err else 0.0)
    found = [f"took {done.spent:.1f} s of the processor, {allowed:.1f} s allowed"] if done.spent > allowed else []
    if done.code != step.code:
        return [*found, f"exit status {done.code}, not {step.code}: {done.last_line}"]
    printed = done.out + done.err
    for wanted in step.wanted:
        pattern = wanted.pattern if isinstance(wanted, Number) else wanted
        match = re.search(pattern, printed, re.DOTALL)
        if match is None:
            found.append(f"does not say {pattern}")
        elif isinstance(wanted, Number) and not abs(float(match[1]) - wanted.value) <= wanted.within * abs(wanted.value):
            found.append(f"says {match[0]!r}, where {wanted.value:.6g} is true within {wanted.within:g} of it")
    return found


def main() -> int:
    """Print each command with its times and what is wrong; return the number of steps that failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--empty", action="store_true", help="begin with an empty cache of compiled code")
    parser.add_argument("--only", default="", help="only the trades that contain this text")
    options = parser.parse_args()
    failed: list[str] = []
    slower = max(kernel() / KERNEL, 1.0)
    with tempfile.TemporaryDirectory() as place:
        if options.empty:
            os.environ["STICKSLIP_CACHE_DIR"] = f"{place}/cache"
        for trade, steps in WAYS.items():
            if options.only not in trade:
                continue
            say(f"\n{trade}\n  wall s  processor s")
            folder = Path(place, trade.replace(" ", "-"))
            folder.mkdir()
            for name, write in FILES.items():
                write(folder / name)
            for step in steps:
                done = run(step, folder)
                wrong = faults(step, done, slower)
                failed += [f"{trade}: {step.typed}: {'; '.join(wrong)}"] * bool(wrong)
                notes = [*(one for one in done.err.splitlines() if "compil" in one), *(f"FAILS: {one}" for one in wrong)]
                say(f"{done.wall:8.1f}{done.spent:13.1f}  {step.typed[:120]}", *(f"{'':23}{one}" for one in notes))
    say("", *failed, f"{len(failed)} steps fail" if failed else "all ways lead through")
    return min(len(failed), 100)


if __name__ == "__main__":
    sys.exit(main())
