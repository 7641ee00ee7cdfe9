"""Do the tests notice? Wrong versions of the source, made in a copy of the tree, and what the tests say to each.

    python -m benchmarks.mutations --named                         # mistakes by name
    python -m benchmarks.mutations --count 40 --seed 1 --only contact --results mutations.jsonl

A mutant that changes no hash of `benchmarks.mutation_check` counts as equivalent. Of the others the tests of the changed file's
package run first, then those that look at results as a whole; the first failure ends it. Results are appended to a file and not
made again; Ctrl-C ends with the table. A mutant of the engine costs its compilation, a minute or two.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from benchmarks.mutants import PACKAGES, SOURCE, Mutant, drawn, named

TREE = Path(__file__).resolve().parent.parent
PARTS = ("src", "tests", "benchmarks", "docs", "pyproject.toml", "README.md", "Makefile")
CHECK_LIMIT, TEST_LIMIT = 420.0, 900.0
"""Seconds for the hashes, and for the tests of one mutant."""
FIRST_TESTS = {
    "contact": ("tests/contact",),
    "observables": ("tests/observables",),
    "evolution": (
        "tests/evolution/test_verified_numbers.py",
        "tests/adversarial/test_known_failures.py",
        "tests/evolution/test_event_sequences.py",
        "tests/evolution/test_solution.py",
    ),
}
THEN = (
    "tests/evolution",
    "tests/adversarial",
    "tests/contact",
    "tests/observables",
    "tests/reference",
    "tests/truth",
    "tests/paper",
)
REST = ("tests/long_runs", "tests/scenarios", "tests/exports", "tests/studies", "tests/test_units.py", "tests/docs")


class Copy:
    """A copy of the tree with a compile cache of its own, in which one mutant at a time is tried."""

    def __init__(self, folder: Path) -> None:
        self.root, self.cache = folder / "tree", folder / "cache"
        shutil.rmtree(self.root, ignore_errors=True)
        self.root.mkdir(parents=True)
        for part in PARTS:
            source = TREE / part
            if source.is_dir():
                shutil.copytree(source, self.root / part, ignore=shutil.ignore_patterns("__pycache__"))
            elif source.exists():
                shutil.copy2(source, self.root / part)

    def run(self, arguments: list[str], limit: float) -> subprocess.CompletedProcess[str]:
        """Run Python in the copy; TimeoutExpired after `limit` seconds."""
        environment = os.environ | {
            "PYTHONPATH": os.pathsep.join((str(self.root / "src"), str(self.root))),
            "STICKSLIP_CACHE_DIR": str(self.cache),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        command = [sys.executable, *arguments]
        return subprocess.run(command, cwd=self.root, env=environment, capture_output=True, text=True, timeout=limit, check=False)

    def hashes(self) -> dict[str, str] | str:
        """Hashes of the fixed suite, or how it failed."""
        try:
            done = self.run(["-m", "benchmarks.mutation_check"], CHECK_LIMIT)
        except subprocess.TimeoutExpired:
            return "hangs"
        if done.returncode != 0:
            return (done.stderr.strip().splitlines() or ["died"])[-1][:100]
        found: dict[str, str] = json.loads(done.stdout)
        return found

    def tested(self, package: str) -> tuple[str, str]:
        """ "caught" and by which test, or "survived"."""
        end = time.monotonic() + TEST_LIMIT
        first = FIRST_TESTS.get(package, ())
        for group in (first, THEN, REST):
            left = end - time.monotonic()
            present = [place for place in group if (self.root / place).exists()]
            if left <= 0.0:
                return "survived", f"so far: the time was up before {group[0]}"
            if not present:
                continue
            try:
                done = self.run(["-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-n", "0", *present, *self.known], left)
            except subprocess.TimeoutExpired:
                return "survived", f"so far: the time was up in {group[0]}"
            if done.returncode < 0:
                raise KeyboardInterrupt  # somebody has ended the tests: that is no verdict
            if done.returncode == 1:
                return "caught", next((line for line in done.stdout.splitlines() if line.startswith("FAILED")), "?")[7:160]
            if done.returncode not in (0, 5):
                return "caught", (done.stdout.strip().splitlines() or ["pytest died"])[-1][:150]
        return "survived", "all tests of the campaign"

    known: tuple[str, ...] = ()
    """Options that leave out tests which fail without any mutant."""


def tried(copy: Copy, mutant: Mutant, before: dict[str, str]) -> dict[str, Any]:
    """What becomes of one mutant; the copy is as before afterwards."""
    path, began = copy.root / SOURCE / mutant.path, time.monotonic()
    original = path.read_bytes()
    try:
        path.write_bytes(mutant.applied(original))
        after = copy.hashes()
        if isinstance(after, str):
            verdict, by = ("caught", after) if after == "hangs" else ("broken", after)
            changed = -1
        else:
            changed = sum(after.get(name) != value for name, value in before.items())
            verdict, by = copy.tested(mutant.package) if changed else ("equivalent", "")
    finally:
        path.write_bytes(original)
    took = round(time.monotonic() - began, 1)
    return {"mutant": mutant.name, "path": mutant.path, "verdict": verdict, "by": by, "changed": changed, "seconds": took}


def campaign(options: argparse.Namespace) -> list[dict[str, Any]]:
    """Try the mutants that have no result yet."""
    results, path = _known(options.results), Path(options.results)
    wanted = named(TREE) if options.named else []
    wanted += drawn(TREE, options.count, options.seed, tuple(options.only or PACKAGES))
    if options.names:
        wanted = [one for one in wanted if one.name in options.names]
    todo = [one for one in wanted if one.name not in {result["mutant"] for result in results}]
    with tempfile.TemporaryDirectory(prefix="mutations-") as temporary:
        folder = options.folder or temporary
        copies: SimpleQueue[Copy] = SimpleQueue()
        made = [Copy(Path(folder) / str(n)) for n in range(options.jobs)]
        for copy in made:
            copy.known = tuple(f"--deselect={test}" for test in options.deselect)
            copies.put(copy)
        before = made[0].hashes()
        if isinstance(before, str):
            raise SystemExit(f"mutations: without any mutant the suite fails: {before}")

        def one(mutant: Mutant) -> None:
            copy = copies.get()
            try:
                result = tried(copy, mutant, before)
            finally:
                copies.put(copy)
            results.append(result)
            with path.open("a") as file:
                file.write(json.dumps(result) + "\n")
            say(f"{len(results)}: {result['verdict']:10} {result['seconds']:6.0f} s  {result['mutant']}  {result['by'][:90]}")

        pool = ThreadPoolExecutor(options.jobs)
        try:
            list(pool.map(one, todo))
        except KeyboardInterrupt:
            say("interrupted")
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
    return results


def _known(path: str) -> list[dict[str, Any]]:
    """Results of earlier campaigns in the file."""
    if not Path(path).exists():
        return []
    return [json.loads(line) for line in Path(path).read_text().splitlines() if line.strip()]


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def table(results: list[dict[str, Any]]) -> None:
    """Counts by package and verdict, then the survivors."""
    verdicts = ("caught", "survived", "equivalent", "broken")
    counts = Counter((result["path"].split("/")[0], result["verdict"]) for result in results)
    say(f"\n{'package':16}" + "".join(f"{verdict:>12}" for verdict in verdicts))
    for package in sorted({package for package, _ in counts}):
        say(f"{package:16}" + "".join(f"{counts[package, verdict]:12}" for verdict in verdicts))
    for result in results:
        if result["verdict"] == "survived":
            say(f"survived: {result['mutant']} ({result['changed']} hashes changed; {result['by']})")


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutations", description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--named", action="store_true", help="the mistakes by name")
    parser.add_argument("--names", nargs="*", help="of the mutants only these")
    parser.add_argument("--count", type=int, default=0, help="random mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=PACKAGES, help="packages of the random mutants")
    parser.add_argument("--results", default="mutations.jsonl")
    parser.add_argument("--deselect", nargs="*", default=[], help="tests that fail without any mutant")
    parser.add_argument("--folder", type=Path, help="where the copies lie, and what is compiled is kept for the next campaign")
    options = parser.parse_args()
    table(campaign(options))
    return 0


if __name__ == "__main__":
    sys.exit(main())
