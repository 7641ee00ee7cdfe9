"""Limits of the processor time that something may take, numbers of examples, and what mypy says of code."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def all_tests() -> bool:
    """Say whether these are the tests of `make test-all`."""
    return os.environ.get("STICKSLIP_TESTS") == "all"


def examples(many: int) -> int:
    """Return how many examples are drawn: so many in `make test-all`, and an eighth of them in `make test`."""
    return many if all_tests() else max(many // 8, 2)


def mypy_on(file: Path, code: str) -> str:
    """Write code into a file, and return what mypy prints about it.

    Its options are the project's, so that it finds the types of the package in the cache that `make lint` has left: half a second
    instead of twenty. Files of different tests have different names, because that cache knows them by name.
    """
    pytest.importorskip("mypy")
    file.write_text(code)
    command = [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), str(file)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False).stdout


@contextmanager
def processor_time(seconds: float) -> Iterator[None]:
    """Fail if what is done here takes more than so many seconds of this process (not on Windows, which has no such limit)."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def fail(*_: object) -> None:
        raise AssertionError(f"took more than {seconds} s of processor time")

    before = signal.signal(signal.SIGPROF, fail)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def limit_of_process(seconds: int) -> str:
    """Return a line of code: the process that runs it is killed after so many seconds of processor time (nothing on Windows)."""
    return "" if sys.platform == "win32" else f"import resource; resource.setrlimit(resource.RLIMIT_CPU, ({seconds}, {seconds}))\n"
