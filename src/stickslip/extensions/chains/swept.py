"""Numbers of the run of a chain that a sweep keeps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from stickslip.extensions.chains.run import ChainRun


def _events(run: ChainRun) -> float:
    return run.count_of_events


def _rate(run: ChainRun) -> float:
    return run.count_of_events / run.duration


def _changes(run: ChainRun) -> float:
    return run.count_of_changes


def _largest_moment(run: ChainRun) -> float:
    return float(run.events["moment"].max(initial=-np.inf)) if len(run.events) else np.nan


def _largest_time(run: ChainRun) -> float:
    return float(run.events["time"][np.argmax(run.events["moment"])]) if len(run.events) else np.nan


def _total_slip(run: ChainRun) -> float:
    return float((run.slip - run.chain.values("initial_slip")).sum())


SUMMARIES: Mapping[str, tuple[str, str, Callable[[ChainRun], float]]] = {
    "events": ("1", "number of finished events", _events),
    "event_rate": ("s-1", "number of finished events per time", _rate),
    "changes": ("1", "number of changes of single blocks", _changes),
    "largest_moment": ("m", "largest sum of the slip of all blocks in an event", _largest_moment),
    "largest_time": ("s", "time of the event with the largest moment", _largest_time),
    "total_slip": ("m", "sum of the slip of all blocks since the start", _total_slip),
}
"""Unit, meaning and function of a run, by name; there is no largest event, NaN, in a run without events."""
