"""Rows of events and changes of a run in memory, and states during it that motion is calculated again from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.state import ChainState
from stickslip.foundation.arrays import Floats

if TYPE_CHECKING:
    from stickslip.extensions.chains.solver import ChainSolver
    from stickslip.problem import Status

MOST_SNAPSHOTS = 256
"""Number of states that are kept during a run, at most."""
ROOM_FOR_SNAPSHOTS = 2**24
"""Memory (bytes) that they take at most; two are kept whatever they take."""


@dataclass
class Snapshots:
    """States during a run, thinned as it goes: at most MOST_SNAPSHOTS, in ROOM_FOR_SNAPSHOTS."""

    states: list[ChainState] = field(default_factory=list)
    every: int = 1
    """Only each so many-th state is kept."""
    calls: int = 0

    def add(self, state: ChainState) -> None:
        """Take a state, to be copied, if it is one that is kept."""
        if self.calls % self.every == 0:
            self.states.append(state.copy())
            if len(self.states) > self.most(state):
                self.states, self.every = self.states[::2], 2 * self.every
        self.calls += 1

    @staticmethod
    def most(state: ChainState) -> int:
        """Return how many states like this one are kept at most."""
        size = sum(one.nbytes for one in state.arrays.values())
        return max(2, min(MOST_SNAPSHOTS, ROOM_FOR_SNAPSHOTS // size))


@dataclass(eq=False)
class ChainRows:
    """Rows of a run in memory. `keeps_changes` says whether those of changes are kept, too."""

    chain: Chain
    title: str
    keeps_changes: bool
    snapshots: Snapshots = field(default_factory=Snapshots)
    count_of_events: int = 0
    count_of_changes: int = 0
    """The number of changes whose rows were taken; 0 if none are kept."""
    events: list[Floats] = field(default_factory=lambda: [np.empty((0, at.EVENT_COLUMNS))])
    changes: list[Floats] = field(default_factory=lambda: [np.empty((0, at.CHANGE_COLUMNS))])

    def take(self, events: Floats, changes: Floats) -> None:
        """Take rows of events and changes."""
        self.count_of_events += len(events)
        self.events.append(events)
        if self.keeps_changes:
            self.count_of_changes += len(changes)
            self.changes.append(changes)

    def save(self, state: ChainState) -> None:
        """Do nothing: there is no folder."""

    def run(self, solver: ChainSolver, reached: float, status: Status) -> ChainRun:
        """Return the run up to a time (s), with what ended it."""
        changes = np.concatenate(self.changes) if self.keeps_changes else None
        end = solver.state, solver.at(reached)
        rows = np.concatenate(self.events), changes
        return ChainRun(self.chain, reached, *rows, self.snapshots.states, *end, status=status, title=self.title)
