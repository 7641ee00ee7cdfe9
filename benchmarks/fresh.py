"""A command in a fresh process: what it prints, its exit status, and the time that it takes, with that of its own children."""

from __future__ import annotations

import resource
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple


class Done(NamedTuple):
    """What a command printed, its exit status, and its times on the wall and of the processor (user and system, s)."""

    out: str
    err: str
    code: int
    wall: float
    spent: float

    @property
    def last_line(self) -> str:
        """The last line of what it said is wrong."""
        return (self.err.strip().splitlines() or ["nothing"])[-1]


def run(command: Sequence[str | Path], folder: str | Path, variables: Mapping[str, str]) -> Done:
    """Run a command in a folder, with these variables of the environment and no others."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True, check=False)
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return Done(done.stdout, done.stderr, done.returncode, wall, spent)
