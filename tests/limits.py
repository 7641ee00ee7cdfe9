"""Limits of the processor time that something may take: unlike a clock on the wall, they hold on a busy machine too."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager


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
