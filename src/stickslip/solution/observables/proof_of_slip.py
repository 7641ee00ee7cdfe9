"""Compare the slip of a history with the integral of its slip rate, step by step, and look where steps join.

A step knows the slip, and the slip that the law counts, where it begins. Both must be what the steps before have left, and a
contact with mass keeps its slip rate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import Cause, History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.proof import POINTS_OF_STEP, Places


class SlipJoined(NamedTuple):
    """What is missing where the steps of a history join."""

    slip: float = 0.0
    """Largest error (m) of a slip, of one that the law counts, or of a slip rate against the direction of its step."""
    rate: float = 0.0
    """Largest jump (m/s) of the slip rate of a contact with mass."""


def slip_joined(history: History) -> SlipJoined:
    """Return how far the steps of a history fail to join."""
    store = history.store
    leaps = np.isin(store.trip, history.creep[:, 0])
    n = np.flatnonzero(~(leaps[:-1] | leaps[1:]))
    every = np.flatnonzero(~leaps)
    slip = max(_of_sums(history, n), _against(history, every), _of_times(history, every))
    return SlipJoined(slip, _of_rates(history, n) if history.problem.body.has_inertia else 0.0)


def _of_sums(history: History, n: Places) -> float:
    """Return the largest error of a slip behind one of pieces n."""
    store, law = history.store, history.problem.friction
    grown = history.grown(Positions.inside(n, 1.0)) if len(n) else np.zeros(0)
    sums = np.abs(store.slip[n + 1] - store.slip[n] - grown)
    counted = store.law_slip[n] + (store.mode[n] * grown if law.counts == "path" else grown)
    counts = np.abs(store.law_slip[n + 1] - counted)
    if law.memory == "since-arrest":  # an arrest sets it back
        arrests = (store.mode[n + 1] == 0) | history.rests[n] | (store.mode[n] == 0)
        counts = np.where(arrests, np.minimum(counts, np.abs(store.law_slip[n + 1])), counts)
    first = 0.0
    if len(store.trip) and store.trip[0] == 0 and store.phase_from[0] == 0.0:
        first = float(max(abs(store.slip[0]), abs(store.law_slip[0])))
    return max(first, float(np.max(sums, initial=0.0)), float(np.max(counts, initial=0.0)))


def _against(history: History, n: Places) -> float:
    """Return the longest way that a slip rate goes against the direction of its step, or at rest; to both it is zero."""
    store = history.store
    moves = n[store.rate[n].any(axis=1)] if len(n) else n
    rate = store.rate[moves] @ POINTS_OF_STEP ** np.arange(store.rate.shape[1])[:, None]
    way = store.mode[moves, None]
    against = np.where(way == 0, np.abs(rate), np.maximum(-way * rate, 0.0)).max(axis=1, initial=0.0)
    return float(np.max(against * np.abs(store.speed[moves] + store.bend[moves]), initial=0.0))


def _of_times(history: History, n: Places) -> float:
    """Return the longest way that the slip rate goes in the time that the polynomial of a step misses its end by."""
    store = history.store
    off = np.abs(store.phase_from[n] + store.speed[n] + store.bend[n] - store.phase_to[n])
    return float(np.max(off * np.abs(store.rate[n]).sum(axis=1), initial=0.0))


def _of_rates(history: History, n: Places) -> float:
    """Return the largest jump of the slip rate behind one of pieces n."""
    store = history.store
    n = n[(store.cause[n + 1] != Cause.STOP) & (n >= history.given)]
    ends: Floats = store.rate[n].sum(axis=1)
    return float(np.max(np.abs(store.rate[n + 1, 0] - ends), initial=0.0))
