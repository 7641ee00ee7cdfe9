"""What leaps need of the run that they are part of."""

from __future__ import annotations

from typing import Protocol

from stickslip.engine.history.status import Checkpoint
from stickslip.engine.state.layout import Counts, Integers, Setup, State, Store
from stickslip.problem import Problem


class LeapingRun(Protocol):
    """A run between two calls of the engine, with its history; its last pieces are those of the round trip just past."""

    problem: Problem
    setup: Setup
    state: State
    count: Counts
    store: Store
    last: tuple[int, float]
    """Round trip and phase (s) of the end of the run."""

    @property
    def length(self) -> int:
        """The number of pieces that the history has."""
        ...

    def reserve(self, pieces: int) -> None:
        """Make sure that there is room for at least so many pieces."""
        ...

    def step(self, budget: int) -> int:
        """Call the engine once, for so many steps at most, and return a code of `Stop`."""
        ...

    def standing(self) -> Integers:
        """Return the pieces whose echoes make up the coming round trip, in order of phase."""
        ...

    def stand(self, pieces: Integers) -> None:
        """Let these pieces, in order of phase, be those whose echoes make up the coming round trip, and meet only what breaks."""
        ...

    def cut_at_end(self) -> None:
        """Let the end of the run cut what comes next."""
        ...

    def snapshot(self) -> Checkpoint:
        """Return a checkpoint of the present state."""
        ...

    def restore(self, checkpoint: Checkpoint) -> None:
        """Go back to a checkpoint."""
        ...
