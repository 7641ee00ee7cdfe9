"""The progress of a search: trials so far, misfit of the best one and what it looks like, and an end after some processor time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from stickslip.extensions.inference.fit.looks import looks_of
from stickslip.extensions.inference.fit.model import FAILED, Model
from stickslip.extensions.inference.fit.what_is_left import words
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import about_time

Tell = Callable[[str], Any]

LOOKED = 5.0
"""Processor time (s) between two looks at the residuals of the best run so far."""
BETTER = 0.99
"""A trial is better if its residuals are smaller than this share of the best ones so far."""
NOISE = 1.05
"""Residuals below this multiple of the noise of neighbouring samples need no words."""


class OutOfTime(KeyboardInterrupt):
    """The processor time is over. A search then ends as after Ctrl-C, with the best numbers so far."""


@dataclass
class SearchProgress:
    """The progress of a search as a line of text after each run: its phase, what the best run leaves, the number of runs.

    After `limit` (s of processor time, by `clock`) it raises OutOfTime, once, and not before a first trial has succeeded.
    """

    tell: Tell
    limit: float = math.inf
    clock: Callable[[], float] = time.process_time
    phase: str = ""
    runs: int = 0
    least: float = math.inf
    """Root mean square of the residuals of the best run so far, in standard deviations of the noise of neighbouring samples."""
    looks: str = ""
    succeeded: bool = False
    begun: float = field(default=math.nan)
    _looked: float = -math.inf
    _better: tuple[Model, Floats] | None = None

    def __post_init__(self) -> None:
        self.begun = self.clock()

    def __call__(self, phase: str) -> None:
        """Report that a new phase begins."""
        self.phase = phase
        self.tell(f"{phase}, {self.runs} runs so far" if self.runs else phase)

    def run(self) -> None:
        """Report that a run is done. Raises OutOfTime if the time is over."""
        self.runs += 1
        left = f", {self.left}" if self.left else ""
        self.tell(f"{self.phase}{left}, {self.runs} runs so far")
        if self.succeeded and self.clock() - self.begun > self.limit:
            over, self.limit = self.limit, math.inf
            left = f"; {self.left}" if self.left else ""
            more = f"bounds and a nearer start make it shorter, max_time={2.0 * over:.6g} gives it twice the time"
            raise OutOfTime(f"stopped after {about_time(over)} of processor time and {self.runs} runs{left}; {more}")

    @property
    def left(self) -> str:
        """What the best run so far leaves, as text; empty before the first one."""
        if not math.isfinite(self.least):
            return ""
        looks = f" ({self.looks})" if self.looks else ""
        return f"{self.least:.3g} times the noise is left{looks}"

    def tried(self, model: Model, searched: Floats, residual: Floats) -> None:
        """Take notice of the residuals of a trial, and look at those of the best one from time to time."""
        if not len(residual) or np.all(np.abs(residual) >= FAILED):
            return
        self.succeeded = True
        if model.smooth or model.of_means:
            return
        size = math.sqrt(float(np.mean(np.square(residual))))
        if size < BETTER * self.least:
            self.least, self._better = size, (model, searched.copy())
        if self._better is not None and self.clock() - max(self._looked, self.begun) > LOOKED:
            better, at = self._better
            self._looked, self._better = self.clock(), None
            self.looks = "" if self.least < NOISE else words_of(better, at)


def words_of(model: Model, searched: Floats) -> str:
    """Return what the residuals of the first quantity of a model look like, as text."""
    name = next(iter(model.sizes))
    return words(looks_of(model, searched, name), model.problem.unit_of(name))
