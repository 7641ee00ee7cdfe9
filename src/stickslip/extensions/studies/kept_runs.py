"""Runs of a study that are kept in a folder: a study that was killed goes on where it was, bit for bit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stickslip.engine import engine_key
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import held
from stickslip.problem import FULL_HISTORY, INTERRUPTED, STATUSES, UNDER_WAY, Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, resume_run
from stickslip.run.simulate import simulate
from stickslip.solution import Solution
from stickslip.solution.files import read_solution

STOPPED = (STATUSES[UNDER_WAY].name, STATUSES[INTERRUPTED].name)
"""Names of the statuses of runs that go on when they are asked for again."""


@dataclass(frozen=True)
class KeptRuns:
    """The runs of a study, each in a file of a folder; without a folder nothing is kept."""

    who: str
    """Name of the study, for messages."""
    folder: Path | None

    @classmethod
    @contextmanager
    def opened(cls, who: str, folder: Path | None) -> Iterator[KeptRuns]:
        """Make the folder if it is missing, and lock it against other studies until the `with` block ends. Raises InputError."""
        if folder is None:
            yield cls(who, None)
            return
        if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
            raise InputError(f"{who}: checkpoint {folder}: is no folder: choose another name")
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise InputError(f"{who}: checkpoint {folder}: cannot be made: {error.strerror or error}") from None
        with held(folder, f"{who}: checkpoint {folder}: another study is writing into it: choose another name"):
            yield cls(who, folder)

    def run(self, name: str, problem: Problem, options: CallOptions) -> Solution:
        """Return a run from its file, from where it stopped in there, or from the start.

        Raises InputError if the file holds another run, or one of another version of the engine.
        """
        if self.folder is None or not (path := self.folder / f"{name}.nc").exists():
            return self._begun(None if self.folder is None else path, problem, options)
        if path.is_symlink():
            raise InputError(f"{path}: is a link: put the file itself there")
        found = read_solution(path)
        if (found.problem, found.options) != (problem, options.options):
            raise InputError(f"{path}: is a run of another {self.who}: choose another folder, or remove this one")
        if found.checkpoint is None or found.checkpoint.engine != engine_key():
            raise InputError(f"{path}: another version of stickslip's engine made it: choose another folder, or remove this one")
        full = found.status == STATUSES[FULL_HISTORY] and len(found.history) < options.most_pieces
        if not full and found.status.name not in STOPPED:
            return found
        others: dict[str, Any] = {"checkpoint": path, "max_pieces": options.max_pieces, "max_events": options.max_events}
        return resume_run(found, path, CallOptions.to_continue(found, options.duration, **others))

    def _begun(self, path: Path | None, problem: Problem, options: CallOptions) -> Solution:
        limits: dict[str, Any] = {"max_pieces": options.max_pieces, "checkpoint": path}
        found: Solution = simulate(Scenario(problem, **vars(options.options)), **limits)
        return found
