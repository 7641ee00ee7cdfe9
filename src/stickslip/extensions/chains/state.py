"""The state of a chain: all arrays that decide how it goes on, in one flat set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.memory import Now

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ChainState:
    """The state of a chain at a time: with the chain, all that a run needs to go on bit for bit as if it had never stopped.

    `now` has the time, energies, counts and the event in progress; `blocks` and `whole` have a row for each number of blocks. Their
    places are named in `compiled/memory.py`.
    """

    now: Floats
    blocks: Floats
    whole: NDArray[np.int64]

    @classmethod
    def empty(cls, count: int) -> ChainState:
        """Return a state of so many blocks, filled with zeros."""
        return cls(
            np.zeros(at.NUMBERS_NOW), np.zeros((at.ROWS_OF_BLOCKS, count)), np.zeros((at.WHOLE_ROWS_OF_BLOCKS, count), np.int64)
        )

    def copy(self) -> ChainState:
        """Return a copy of its own."""
        return ChainState(self.now.copy(), self.blocks.copy(), self.whole.copy())

    @property
    def time(self) -> float:
        """The time (s)."""
        return float(self.now[at.ORIGIN] + self.now[at.SINCE])

    @property
    def arrays(self) -> Mapping[str, NDArray[np.generic]]:
        """The arrays by name, as files keep them: `ChainState(**arrays)` is the state again."""
        return {"now": self.now, "blocks": self.blocks, "whole": self.whole}

    @property
    def memory(self) -> Now:
        """The state as compiled code takes it."""
        return Now(self.now, self.blocks, self.whole)
