"""Which tests reach which line: a plugin of pytest, which needs the package `coverage`.

    python -m pytest -p benchmarks.reach tests/extensions/sweeps

It appends one JSON line for each test to the file that REACH names (reach.jsonl): its name, its seconds and, by file of the
package, the lines that it runs. What a fixture runs for a whole module or session counts for each test that uses it.
"""

from __future__ import annotations

import json
import os
import time
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path
from typing import Any

import coverage
import pytest

from benchmarks.mutants import SOURCE

FILE = "REACH"
"""Environment variable with the name of the file."""
TREE = Path(__file__).resolve().parent.parent

_traced = coverage.Coverage(data_file=None, include=[f"{TREE / SOURCE}/*"], config_file=False, messages=False)
_seconds: dict[str, float] = {}
_fixtures: dict[str, list[str]] = {}
"""The contexts of wider fixtures that each test uses."""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Trace a test under its name."""
    _traced.start()
    _traced.switch_context(item.nodeid)
    began = time.perf_counter()
    try:
        return (yield)
    finally:
        _seconds[item.nodeid] = time.perf_counter() - began
        info = getattr(item, "_fixtureinfo", None)
        wide = [one for name in getattr(info, "names_closure", ()) for one in info.name2fixturedefs.get(name, ())]  # type: ignore[union-attr]
        _fixtures[item.nodeid] = [f"fixture {one.baseid} {one.argname}" for one in wide if one.scope != "function"]
        _traced.stop()


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: Any, request: Any) -> Generator[None, object, object]:
    """Trace a fixture of a module or session under its own name."""
    if fixturedef.scope == "function":
        return (yield)
    _traced.switch_context(f"fixture {fixturedef.baseid} {fixturedef.argname}")
    try:
        return (yield)
    finally:
        _traced.switch_context(request._pyfuncitem.nodeid)


def pytest_sessionfinish() -> None:
    """Write what was traced."""
    data = _traced.get_data()
    lines: dict[str, dict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    for file in data.measured_files():
        name = str(Path(file).relative_to(TREE / SOURCE))
        for line, contexts in data.contexts_by_lineno(file).items():
            for context in contexts:
                lines[context][name].append(line)
    with Path(os.environ.get(FILE, "reach.jsonl")).open("a") as out:
        for test, seconds in _seconds.items():
            reached: dict[str, set[int]] = defaultdict(set)
            for context in [test, *_fixtures[test]]:
                for name, numbers in lines[context].items():
                    reached[name] |= set(numbers)
            out.write(
                json.dumps({"test": test, "seconds": round(seconds, 3), "lines": {k: sorted(v) for k, v in reached.items()}}) + "\n"
            )
