"""Do the tests notice? Wrong versions of the source, one at a time, and what the tests say to each.

    python -m benchmarks.mutations tests/core/contact tests/core/solution/observables --named
    python -m benchmarks.mutations tests/core/contact --count 40 --seed 1 --only contact --results mutations.jsonl
    python -m benchmarks.mutations --reach reach.jsonl --count 30 --seed 1 --only sweeps

Each mutant is a copy of the package in a temporary folder, on which the tests run up to the first failure: the given ones or, with
`--reach`, those that reach the changed line (`benchmarks.reach` finds them). Where all pass, hashes of a fixed suite
(`benchmarks.mutation_check`) decide between "survived" and "equivalent" for a mutant of the core. Results are appended to a file
and not made again; Ctrl-C ends with the table. A mutant of the engine is compiled anew.
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
from pathlib import Path
from typing import Any

from benchmarks.mutants import CORE, PACKAGES, SOURCE, Mutant, drawn, named
from benchmarks.reached import Reached

TREE = Path(__file__).resolve().parent.parent
VERDICTS = ("caught", "survived", "not reached", "equivalent")


class Campaign:
    """A copy of the package, the tests that are run on each mutant, and the hashes without any."""

    def __init__(self, copy: Path, tests: list[str], reached: Reached | None, most: int, limit: float) -> None:
        shutil.copytree(TREE / SOURCE, copy / "stickslip", ignore=shutil.ignore_patterns("__pycache__"))
        self.copy, self.tests, self.reached, self.most, self.limit = copy, tests, reached, most, limit
        self.before = ""

    def called(self, command: list[str]) -> subprocess.CompletedProcess[str]:
        """Run a command on the copy, for `limit` seconds at most."""
        paths = os.pathsep.join([str(self.copy), str(TREE)])
        environment = os.environ | {"PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(command, cwd=TREE, env=environment, capture_output=True, text=True, timeout=self.limit, check=False)

    def hashes(self) -> str:
        """The hashes of the fixed suite, as text."""
        return self.called([sys.executable, "-m", "benchmarks.mutation_check"]).stdout

    def tried(self, mutant: Mutant) -> dict[str, Any]:
        """What becomes of one mutant."""
        path, began = self.copy / "stickslip" / mutant.path, time.monotonic()
        if mutant.package in CORE and not self.before:
            self.before = self.hashes()
        original = path.read_bytes()
        path.write_bytes(mutant.applied(original))
        try:
            verdict, by = self.judged(mutant)
        except subprocess.TimeoutExpired:
            verdict, by = "caught", "the time was up"
        finally:
            path.write_bytes(original)
        seconds = round(time.monotonic() - began, 1)
        return {"mutant": mutant.name, "path": mutant.path, "verdict": verdict, "by": by, "seconds": seconds}

    def judged(self, mutant: Mutant) -> tuple[str, str]:
        """The verdict, and the test that failed or how many passed."""
        tests, every = self.tests, []
        if self.reached is not None:
            tests, every = tests + self.reached.of(mutant, self.most), ["-m", ""]  # all chosen cases of a test that is sampled
        if not tests:
            return "not reached", "no test"
        done = self.called([sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *every, *tests])
        lines = done.stdout.splitlines()
        if done.returncode:
            return "caught", next((line for line in lines if line.startswith(("FAILED", "ERROR"))), f"exit code {done.returncode}")
        return ("equivalent" if mutant.package in CORE and self.hashes() == self.before else "survived"), lines[-1]


def known(path: Path) -> list[dict[str, Any]]:
    """Results of earlier campaigns in the file."""
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def table(results: list[dict[str, Any]]) -> None:
    """Counts by package and verdict, then the survivors."""
    packages = {result["mutant"]: Mutant("", result["path"], 0, 0, "").package for result in results}
    counts = Counter((packages[result["mutant"]], result["verdict"]) for result in results)
    say(f"\n{'package':16}" + "".join(f"{verdict:>12}" for verdict in VERDICTS))
    for package in sorted({package for package, _ in counts}):
        say(f"{package:16}" + "".join(f"{counts[package, verdict]:12}" for verdict in VERDICTS))
    for result in results:
        if result["verdict"] in {"survived", "not reached"}:
            say(f"{result['verdict']}: {result['mutant']} ({result['by']})")


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutations", description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("tests", nargs="*", help="the tests that are to notice: files or folders, the quick ones first")
    parser.add_argument("--reach", type=Path, help="the file of benchmarks.reach: run those tests that reach each mutant")
    parser.add_argument("--most", type=int, default=30, help="largest number of tests from --reach for a mutant")
    parser.add_argument("--named", action="store_true", help="the mistakes by name")
    parser.add_argument("--count", type=int, default=0, help="random mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=PACKAGES, help="packages of the random mutants")
    parser.add_argument("--limit", type=float, default=1200.0, help="seconds for the tests of one mutant")
    parser.add_argument("--results", type=Path, default=Path("mutations.jsonl"))
    options = parser.parse_args()
    if not options.tests and options.reach is None:
        parser.error("name tests, or a file with --reach")
    reached = None if options.reach is None else Reached(TREE, options.reach)
    wanted = named(TREE) if options.named else []
    wanted += drawn(TREE, options.count, options.seed, tuple(options.only or PACKAGES))
    results = known(options.results)
    with tempfile.TemporaryDirectory() as folder:
        try:
            campaign = Campaign(Path(folder), options.tests, reached, options.most, options.limit)
            for mutant in [one for one in wanted if one.name not in {result["mutant"] for result in results}]:
                results.append(campaign.tried(mutant))
                with options.results.open("a") as file:
                    file.write(json.dumps(results[-1]) + "\n")
                found = results[-1]
                say(f"{len(results)}: {found['verdict']:11} {found['seconds']:6.1f} s  {mutant.name}  {found['by'][:90]}")
        except KeyboardInterrupt:
            say("interrupted")
    table(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
