"""Where the engine stands in a run: with the history up to there, all it needs to go on as if it had never stopped."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

from stickslip.engine.codegen.cache import SOURCES
from stickslip.engine.state.layout import Counts, Floats, Integers

DECIDE = (
    "batch",
    "bodies",
    "contact",
    "creep",
    "engine",
    "engine_input",
    "friction",
    "loading",
    "run",
    "solution",
    "trajectory",
)
"""Folders of the package whose code decides what a run gives."""


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Copies of everything that changes in a run but its history (see `layout`)."""

    state: Floats
    count: Integers
    scratch: Floats
    branch: Floats  # Setup.branch, which moves with slip for some laws
    stick_to: Floats  # (1,): Setup.par[STICK_TO], which moves with it
    crossings: Floats  # times (s) of the last crossings of a moving level
    engine: str  # hash of the code that made it

    @property
    def length(self) -> int:
        """Pieces of the history up to here; a run that has ended may have cut some more to its end."""
        return int(Counts(self.count).length)


ARRAYS = tuple(field.name for field in fields(Checkpoint) if field.name != "engine")
"""Names of the arrays in it."""


@cache
def engine() -> str:
    """A hash of the code that decides what a run gives: another one may go on in other digits."""
    package, digest = Path(__file__).parents[1], hashlib.sha256(SOURCES.encode())
    for path in sorted(path for folder in DECIDE for path in (package / folder).rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
