"""Do the tests notice? Wrong versions of the source, one at a time, and what the tests say to each.

    python -m benchmarks.mutations tests/contact tests/observables --named
    python -m benchmarks.mutations tests/contact --count 40 --seed 1 --only contact --results mutations.jsonl

Each mutant is a copy of the package in a temporary folder, on which the tests run up to the first failure. Where all pass, hashes
of a fixed suite (`benchmarks.mutation_check`) decide between "survived" and "equivalent". Results are appended to a file and not
made again; Ctrl-C ends with the table. A mutant of the engine is compiled anew.
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

from benchmarks.mutants import PACKAGES, SOURCE, Mutant, drawn, named

TREE = Path(__file__).resolve().parent.parent
VERDICTS = ("caught", "survived", "equivalent")


class Campaign:
    """A copy of the package, the tests that are run on it, and the hashes without any mutant."""

    def __init__(self, copy: Path, tests: list[str], limit: float) -> None:
        shutil.copytree(TREE / SOURCE, copy / "stickslip", ignore=shutil.ignore_patterns("__pycache__"))
        self.copy, self.limit = copy, limit
        self.tests = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
        self.before = self.hashes()

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
        original = path.read_bytes()
        path.write_bytes(mutant.applied(original))
        try:
            verdict, by = self.judged()
        except subprocess.TimeoutExpired:
            verdict, by = "caught", "the time was up"
        finally:
            path.write_bytes(original)
        seconds = round(time.monotonic() - began, 1)
        return {"mutant": mutant.name, "path": mutant.path, "verdict": verdict, "by": by, "seconds": seconds}

    def judged(self) -> tuple[str, str]:
        """The verdict, and the test that failed or how many passed."""
        done = self.called(self.tests)
        lines = done.stdout.splitlines()
        if done.returncode:
            return "caught", next((line for line in lines if line.startswith(("FAILED", "ERROR"))), f"exit code {done.returncode}")
        return ("equivalent" if self.hashes() == self.before else "survived"), lines[-1]


def known(path: Path) -> list[dict[str, Any]]:
    """Results of earlier campaigns in the file."""
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def table(results: list[dict[str, Any]]) -> None:
    """Counts by package and verdict, then the survivors."""
    counts = Counter((result["path"].split("/")[0], result["verdict"]) for result in results)
    say(f"\n{'package':16}" + "".join(f"{verdict:>12}" for verdict in VERDICTS))
    for package in sorted({package for package, _ in counts}):
        say(f"{package:16}" + "".join(f"{counts[package, verdict]:12}" for verdict in VERDICTS))
    for result in results:
        if result["verdict"] == "survived":
            say(f"survived: {result['mutant']} ({result['by']})")


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutations", description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("tests", nargs="+", help="the tests that are to notice: files or folders, the quick ones first")
    parser.add_argument("--named", action="store_true", help="the mistakes by name")
    parser.add_argument("--count", type=int, default=0, help="random mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=PACKAGES, help="packages of the random mutants")
    parser.add_argument("--limit", type=float, default=1200.0, help="seconds for the tests of one mutant")
    parser.add_argument("--results", type=Path, default=Path("mutations.jsonl"))
    options = parser.parse_args()
    wanted = named(TREE) if options.named else []
    wanted += drawn(TREE, options.count, options.seed, tuple(options.only or PACKAGES))
    results = known(options.results)
    with tempfile.TemporaryDirectory() as folder:
        try:
            campaign = Campaign(Path(folder), options.tests, options.limit)
            for mutant in [one for one in wanted if one.name not in {result["mutant"] for result in results}]:
                results.append(campaign.tried(mutant))
                with options.results.open("a") as file:
                    file.write(json.dumps(results[-1]) + "\n")
                found = results[-1]
                say(f"{len(results)}: {found['verdict']:10} {found['seconds']:6.1f} s  {mutant.name}  {found['by'][:90]}")
        except KeyboardInterrupt:
            say("interrupted")
    table(results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
