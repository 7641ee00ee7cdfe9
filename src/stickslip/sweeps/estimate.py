"""Estimates of the cost of a sweep, from a timed sample of its members."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.sweeps.execution.chunk import FIRST_FAILURE, ChunkResult, Runner
from stickslip.sweeps.execution.plan import Plan
from stickslip.sweeps.results.store import ResultStore

LONG_ENOUGH = 2.0
"""Shortest wall-clock time (s) of a sample that is reliable: a shorter one is doubled."""
GOLDEN = 0.6180339887498949
"""The golden ratio, less 1. The fractional parts of its multiples cover the interval from 0 to 1 evenly, whatever their number."""
REASON_BYTES = 200
"""Size (bytes) that is assumed for the text that says why a member failed."""
BLOCK = 4096
"""Unit (bytes) in which a file system allocates space for a file."""


@dataclass(frozen=True)
class Estimate:
    """The expected cost of a sweep of `members` members in `chunks` chunks.

    `seconds` is the wall-clock time (s), and `bytes` an upper estimate of the size of the store. They are extrapolated from
    `sampled` members, of which `failed` failed, and which took `took` s of wall clock together.
    """

    members: int
    chunks: int
    seconds: float
    bytes: int
    sampled: int
    failed: int
    took: float


def estimate(plan: Plan, run: Runner, at_once: int = 1) -> Estimate:
    """Estimate the cost of a sweep by running a sample of its members, spread over the design.

    The sample is divided into `at_once` chunks, the number that run at the same time. Its size is doubled until two runs of it in
    succession take at least LONG_ENOUGH each, or until it contains every member.
    """
    size = plan.design.size
    wanted = min(at_once, size)
    while True:
        members = _spread(size, wanted)
        took, failed = _timed(plan, run, members, at_once)
        if took >= LONG_ENOUGH or wanted == size:
            # Time the sample again: the first time may include compilation, or the work of another program.
            took = min(took, _timed(plan, run, members, at_once)[0])
            if took >= LONG_ENOUGH or wanted == size:
                break
        wanted = min(2 * wanted, size)
    sampled = len(members)
    seconds = took / sampled * size + plan.chunks * _writing(plan)
    return Estimate(size, plan.chunks, seconds, _bytes(plan, failed / sampled), sampled, failed, took)


def _spread(size: int, wanted: int) -> NDArray[np.intp]:
    """Return the indices of `wanted` members, or of slightly fewer, spread evenly over the design by the golden ratio."""
    if wanted == size:
        return np.arange(size)
    return np.unique((np.arange(1, wanted + 1) * GOLDEN % 1.0 * size).astype(np.intp))


def _timed(plan: Plan, run: Runner, members: NDArray[np.intp], at_once: int) -> tuple[float, int]:
    """Run members in `at_once` chunks. Returns the wall-clock time (s) and the number of members that failed."""
    chunks = [(n, plan.design.values(own)) for n, own in enumerate(np.array_split(members, at_once)) if len(own)]
    start = time.perf_counter()
    done = [result for _, result in run(plan.work, chunks)]
    return time.perf_counter() - start, sum(int((result.status >= FIRST_FAILURE).sum()) for result in done)


def _writing(plan: Plan) -> float:
    """Return the wall-clock time (s) of storing a chunk, measured in memory; the second time, as the first may do extra work."""
    store, kept = ResultStore.in_memory(plan), ChunkResult.empty(plan.work, len(plan.members(0)))
    for values in kept.results.values():
        values[...] = np.random.default_rng(0).random(values.shape)
    for _ in range(2):
        start = time.perf_counter()
        store.write(0, kept)
    return time.perf_counter() - start


def _bytes(plan: Plan, failing: float) -> int:
    """Return an upper estimate of the size (bytes) of the store: it is compressed, by an amount that depends on the numbers."""
    series, chunk = plan.work.series, math.prod(plan.tile)
    reason = 4 + failing * REASON_BYTES
    of_member = [8] * len(plan.work.quantities) + [1, reason] + ([8 * len(series.times)] * len(series.curves) if series else [])
    coordinates = [8 * len(column) for column in plan.design.columns] + ([8 * len(series.times)] if series else [])
    # Each array, and the group, takes a folder, a description, and a copy of the description in the list of all.
    layout = 4 * (len(of_member) + len(coordinates) + 1)
    blocks = plan.chunks * sum(_blocks(one * chunk) for one in of_member) + sum(map(_blocks, coordinates)) + layout
    return BLOCK * blocks


def _blocks(size: float) -> int:
    return 1 + int(size) // BLOCK
