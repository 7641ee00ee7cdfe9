"""Say in time that the history of a run, and the file that takes it, become large."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from stickslip.cli.output.files import file_size
from stickslip.foundation.formatting import number
from stickslip.run.progress import MANY

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem
    from stickslip.run.progress import Report

CURE = "--catalogue FILE instead keeps slip events only, in bounded memory"


@dataclass
class Growth:
    """The growth of a history, told on standard error in one line when the history has become long, and whenever it has doubled.

    `most` is the largest number of pieces that the run may have, and `is_given` is True if it was given as --max-pieces.
    """

    problem: Problem
    file: Path | None
    most: int
    is_given: bool
    next_at: int = MANY

    def tell_limit(self) -> None:
        """Say how large the file can become, if the given limit allows a long history."""
        if self.file is not None and self.is_given and self.most > MANY:
            typer.echo(f"{self.file}: up to {self._size(self.most)}, {_many(self.most)}; {CURE}", err=True)

    def look(self, report: Report) -> None:
        """Say, if it is time to, how long the history is and how long it will be at this rate."""
        if report.pieces < self.next_at:
            return
        self.next_at = 2 * report.pieces
        share = max(report.time / report.duration, report.events / report.max_events if report.max_events else 0.0)
        wanted = report.pieces / share if share > 0.0 else float("inf")
        where = "the history" if self.file is None else str(self.file)
        so_far = f"{where} grows large: {self._size(report.pieces)} so far, {_many(report.pieces)}"
        typer.echo(f"{so_far}; {self._expected(wanted)}; {CURE}", err=True)

    def _expected(self, wanted: float) -> str:
        if wanted <= self.most:
            return f"at this rate {self._size(wanted)} at the end of the run"
        lost = "" if self.is_given or self.file is None else " and is not written"
        return f"at this rate the run ends too early, at {_many(self.most)}{lost}, unless --max-pieces allows more"

    def _size(self, pieces: float) -> str:
        from stickslip.io.netcdf import piece_size

        return file_size(pieces * piece_size(self.problem))


def _many(pieces: float) -> str:
    return f"{number(pieces / 1e6, 2)} million pieces"
