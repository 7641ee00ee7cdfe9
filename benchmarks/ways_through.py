"""Seven ways into the package, as new users of seven fields type them: each command in a fresh process, with its time.

python -m benchmarks.ways_through                # with the cache of compiled code as it is
python -m benchmarks.ways_through --empty        # with an empty one: where a newcomer waits
python -m benchmarks.ways_through --only teaching

A line of standard error that says what is being compiled is printed below its command, and a command that fails with what it said.
"""

from __future__ import annotations

import argparse
import os
import resource
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
WAYS: dict[str, tuple[str, ...]] = {
    "rupture physics": (
        "doctor",
        "check fig6-slab --figure k.png",
        "run fig6-slab --figure run.png",
        'run fig6-slab --duration "480 years" --selection maxwell',
        "sweep fig6-slab -v alpha=0.05..2:20 -v thickness=1km..50km:20 --figure map.png",
        "run planar-patch --figure fault.png",
    ),
    "tribology": (
        "new lab-slab > mine.toml",
        "check mine.toml",
        "run mine.toml --figure mine.png",
        "run reversing-axis --friction-figure loop.png",
        "sweep granite-slab -v pull_rate=1e-6..1e-3:20:log -q events -q peak_rate --figure rates.png",
    ),
    "drilling": (
        "new slab --friction power-stribeck > string.toml",
        "check string.toml",
        "run string.toml --figure string.png",
        "sweep string.toml -v pull_rate=0.1..10:20:log -q events --figure speeds.png",
    ),
    "laboratory geophysics": (
        "run velocity-steps-block --friction-figure steps.png",
        "run rate-and-state-block --figure cycles.png",
        "run direct-shear-block --catalogue events.csv",
        "show events.csv --catalogue-figure events.png",
    ),
    "teaching": ("paper --out paper", "run fig5-slab-reconstructed --space-time waves.png --animation slab.gif"),
    "rupture codes": ("benchmark list", "benchmark get loop", "schemes fig4-loop --figure schemes.png"),
    "acoustics": (
        "run bowed-string-slab --figure string.png",
        "check bowed-string-slab",
        "run kolsky-slab --figure bar.png",
    ),
}
"""Commands by field, in the order in which somebody who reads the pages would try them."""


def run(words: list[str], into: str | None, folder: Path) -> tuple[subprocess.CompletedProcess[str], float, float]:
    """Run one command in a folder; return what it said, and the times on the wall and of the processor (s)."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    source = {"PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(
        [sys.executable, "-m", "stickslip", *words],
        cwd=folder,
        env=os.environ | source,
        capture_output=True,
        text=True,
        check=False,
    )
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    if into is not None:
        (folder / into).write_text(done.stdout, encoding="utf-8")
    return done, wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main() -> int:
    """Print each command with its times; return the number of commands that failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--empty", action="store_true", help="begin with an empty cache of compiled code")
    parser.add_argument("--only", default="", help="only the fields that contain this text")
    options = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as place:
        if options.empty:
            os.environ["STICKSLIP_CACHE_DIR"] = f"{place}/cache"
        for field, commands in WAYS.items():
            if options.only not in field:
                continue
            print(f"\n{field}\n  wall s  processor s", flush=True)  # noqa: T201 - a script
            folder = Path(place, field.replace(" ", "-"))
            folder.mkdir()
            for command in commands:
                typed, _, into = command.partition(" > ")
                done, wall, spent = run(shlex.split(typed), into or None, folder)
                said = done.stderr.splitlines() if done.returncode else [x for x in done.stderr.splitlines() if "compil" in x]
                failed += done.returncode != 0
                print(f"{wall:8.1f}{spent:13.1f}  stickslip {command}", *(f"{'':23}{x}" for x in said), sep="\n", flush=True)  # noqa: T201
    return failed


if __name__ == "__main__":
    sys.exit(main())
