"""What a sweep will cost, from a timed sample of its members."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.sweeps.execution.chunk import nothing
from stickslip.sweeps.execution.outcome import FIRST_FAILURE
from stickslip.sweeps.execution.plan import Plan
from stickslip.sweeps.results.store import ResultStore
from stickslip.sweeps.sweep import Runner

LONG_ENOUGH = 2.0
"""Wall clock (s) from which on a sample is believed."""
GOLDEN = 0.6180339887498949
REASON_BYTES = 200
BLOCK = 4096
"""Bytes that a file takes at least, and by which it grows."""


@dataclass(frozen=True)
class Estimate:
    """Cost of a sweep of so many `members` in so many `chunks`: wall clock (s), and the size of its store (bytes, at most).

    It rests on `sampled` members, of which `failed` failed, that took `took` s together.
    """

    members: int
    chunks: int
    seconds: float
    bytes: int
    sampled: int
    failed: int
    took: float


def estimate(plan: Plan, run: Runner, at_once: int = 1) -> Estimate:
    """Run a sample spread over the design, in as many chunks as run at a time, twice as large every time until it takes long
    enough, twice, to be believed."""
    size = plan.design.size
    wanted = min(at_once, size)
    while True:
        members = _spread(size, wanted)
        took, failed = _timed(plan, run, members, at_once)
        if took >= LONG_ENOUGH or wanted == size:  # the first time something may have been compiled, or another program busy
            took = min(took, _timed(plan, run, members, at_once)[0])
        if took >= LONG_ENOUGH or wanted == size:
            break
        wanted = min(2 * wanted, size)
    sampled = len(members)
    seconds = took / sampled * size + plan.chunks * _writing(plan)
    return Estimate(size, plan.chunks, seconds, _bytes(plan, failed / sampled), sampled, failed, took)


def _spread(size: int, wanted: int) -> NDArray[np.intp]:
    """Numbers of so many members, or somewhat fewer, spread over the design: multiples of the golden ratio."""
    if wanted == size:
        return np.arange(size)
    return np.unique((np.arange(1, wanted + 1) * GOLDEN % 1.0 * size).astype(np.intp))


def _timed(plan: Plan, run: Runner, members: NDArray[np.intp], at_once: int) -> tuple[float, int]:
    """Wall clock (s) of members in so many chunks, and how many of them failed."""
    chunks = [(n, plan.design.values(own)) for n, own in enumerate(np.array_split(members, at_once)) if len(own)]
    start = time.perf_counter()
    done = [result for _, result in run(plan.work, chunks)]
    return time.perf_counter() - start, sum(int((result.status >= FIRST_FAILURE).sum()) for result in done)


def _writing(plan: Plan) -> float:
    """Wall clock (s) of keeping a chunk, from the second that is kept in memory."""
    store, kept = ResultStore.in_memory(plan), nothing(plan.work, len(plan.members(0)))
    for values in kept.results.values():
        values[...] = np.random.default_rng(0).random(values.shape)
    for _ in range(2):
        start = time.perf_counter()
        store.write(0, kept)
    return time.perf_counter() - start


def _bytes(plan: Plan, failing: float) -> int:
    """At most: numbers are compressed, by how much depends on them."""
    series, chunk = plan.work.series, math.prod(plan.tile)
    reason = 4 + failing * REASON_BYTES
    of_member = [8] * len(plan.work.quantities) + [1, reason] + ([8 * len(series.times)] * len(series.curves) if series else [])
    coordinates = [8 * len(column) for column in plan.design.columns] + ([8 * len(series.times)] if series else [])
    layout = 4 * (len(of_member) + len(coordinates) + 1)  # a folder, its description, and that in the list of all
    blocks = plan.chunks * sum(_blocks(one * chunk) for one in of_member) + sum(map(_blocks, coordinates)) + layout
    return BLOCK * blocks


def _blocks(size: float) -> int:
    return 1 + int(size) // BLOCK
