"""Checkpoints: with the history up to there, a checkpoint lets a run continue as if it had never stopped."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

from stickslip.engine.codegen.cache import SOURCES
from stickslip.engine.state.layout import Counts, Floats, Integers

DECIDE = (
    *("batch", "bodies", "contact", "creep", "engine", "engine_input"),
    *("friction", "loading", "observables", "run", "solution", "trajectory"),
)
"""Folders of the package whose code decides the result of a run."""


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Copies of everything that changes in a run, except its history (see `layout`)."""

    state: Floats
    count: Integers
    scratch: Floats
    branch: Floats  # Setup.branch, which changes with slip for some laws
    stick_to: Floats  # (1,): Setup.params.stick_to, which changes with it
    crossings: Floats  # times (s) of the last crossings of a level of the selection rule that moves with slip
    engine: str  # hash of the code that made it

    @property
    def length(self) -> int:
        """The number of pieces in the history at the checkpoint; a run that has ended may hold more, cut at its end."""
        return int(Counts(self.count).length)


ARRAYS = tuple(field.name for field in fields(Checkpoint) if field.name != "engine")
"""Names of the arrays in a checkpoint."""


@cache
def engine(folders: tuple[str, ...] = DECIDE) -> str:
    """Return a hash of the code that decides the result of a run; a run that continues with other code may differ in its digits."""
    package, digest = Path(__file__).parents[1], hashlib.sha256(SOURCES.encode())
    for path in sorted(path for folder in folders for path in (package / folder).rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
