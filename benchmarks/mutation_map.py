"""Record which functions of the package each test enters, and how long it takes: a mutant is tried on the tests that reach it.

python -m benchmarks.mutation_map tests/contact tests/observables --map reach.jsonl
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

from benchmarks.mutants import SOURCE

TREE = Path(__file__).resolve().parent.parent


class Recorder:
    """A pytest plugin: one JSON line for each test that passes, with its seconds and the functions entered."""

    def __init__(self, path: Path) -> None:
        self.path, self.prefix = path, str(TREE / SOURCE) + "/"
        self.entered: set[str] = set()

    def trace(self, frame: Any, event: str, argument: Any) -> None:
        """Note the code that is entered; its lines are not traced."""
        file = frame.f_code.co_filename
        if file.startswith(self.prefix):
            self.entered.add(f"{file[len(self.prefix) :]}:{frame.f_code.co_qualname}")

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """Trace one test with its fixtures."""
        self.entered, self.passed, began = set(), True, time.monotonic()
        sys.settrace(self.trace)
        try:
            result = yield
        finally:
            sys.settrace(None)
        seconds = round(time.monotonic() - began, 3)
        if self.passed:
            with self.path.open("a") as file:
                file.write(json.dumps({"test": item.nodeid, "seconds": seconds, "entered": sorted(self.entered)}) + "\n")
        return result

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Leave out tests that do not pass."""
        self.passed &= not report.failed and not report.skipped


class Reach:
    """What was recorded."""

    def __init__(self, path: Path) -> None:
        self.seconds: dict[str, float] = {}
        self.tests: dict[str, set[str]] = {}
        for line in path.read_text().splitlines():
            one = json.loads(line)
            self.seconds[one["test"]] = one["seconds"]
            for function in one["entered"]:
                self.tests.setdefault(function, set()).add(one["test"])

    def of(self, file: str, function: str | None) -> set[str]:
        """Tests that enter a function (or something inside it), or any function of the file."""
        wanted = f"{file}:{function}" if function else f"{file}:"
        return {
            test
            for name, tests in self.tests.items()
            if name == wanted or name.startswith(wanted + "." if function else wanted)
            for test in tests
        }


def main() -> int:
    """Run the tests and record."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutation_map")
    parser.add_argument("places", nargs="+")
    parser.add_argument("--map", type=Path, required=True)
    options = parser.parse_args()
    return int(pytest.main(["-q", "-p", "no:cacheprovider", "-p", "no:xdist", *options.places], plugins=[Recorder(options.map)]))


if __name__ == "__main__":
    sys.exit(main())
