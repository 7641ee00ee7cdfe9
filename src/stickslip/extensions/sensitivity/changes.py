"""The changes of a contact in a run, in their order: it slips, turns round, rests, or jumps. A derivative needs one order."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats

MODES = {0: "it comes to rest", 1: "it begins to slip forwards", -1: "it begins to slip backwards"}
"""What a contact does when its mode changes, by the new mode."""
JUMPS = ("", "starts with a jump", "jumps at a fold", "jumps with an echo", "jumps with its loading", "heals", "meets a stop")
"""What happens at a shock, by the code of its cause in a history."""
FOLD, ECHO = 2, 3
"""Codes of jumps at folds and with echoes."""


class Changes(NamedTuple):
    """The changes of a contact: their places in the history, times (s), new modes, and causes (codes; 0 is no shock)."""

    place: Floats
    """The piece that a change begins; that of a rest that was not recorded is half a piece beyond the last."""
    time: Floats
    mode: Floats
    cause: Floats

    def __len__(self) -> int:
        return len(self.place)

    def words(self, n: int) -> str:
        """Say what happens at change n."""
        cause = int(self.cause[n])
        return f"it {JUMPS[cause]}" if cause else MODES[int(self.mode[n])]

    def until(self, place: Floats) -> Floats:
        """Return the number of changes up to places, given as `place_of` does."""
        return np.searchsorted(self.place, place, side="right").astype(float)


def changes_of(history: History) -> Changes:
    """Return the changes of a contact in a run."""
    store, rests = history.store, history.rests
    mode, cause, piece = store.mode.astype(float), store.cause.astype(float), np.arange(len(history), dtype=float)
    before = np.concatenate(([0.0], np.where(rests, 0.0, mode)[:-1]))
    begins = (mode != before) | (cause > 0.0)
    ends = rests & (mode != 0.0)
    place = np.concatenate((piece[begins], piece[ends] + 0.5))
    order = np.argsort(place, kind="stable")
    time = np.concatenate((history.start[begins], history.end[ends]))[order]
    modes = np.concatenate((mode[begins], np.zeros(int(ends.sum()))))[order]
    causes = np.concatenate((cause[begins], np.zeros(int(ends.sum()))))[order]
    return Changes(place[order], time, modes, causes)


def place_of(at: Positions) -> Floats:
    """Return the place of positions in a history, as `Changes` counts them."""
    return at.last + 0.5 * at.at_rest


def alike(one: Changes, other: Changes) -> int:
    """Return how many changes two runs have in common, in one order from the start.

    A jump at a fold is like one with an echo: where both come at once, rounding decides which is told.
    """
    count = min(len(one), len(other))
    causes = (np.where(run.cause[:count] == ECHO, FOLD, run.cause[:count]) for run in (one, other))
    same = (one.mode[:count] == other.mode[:count]) & np.equal(*causes)
    return count if same.all() else int(np.argmin(same))
