"""What a cluster costs: chunks in which nothing is done, and the same chunks of a sweep in this process and on one worker.

    python -m benchmarks.cluster

One worker with one thread. For chunks that do something the processor time of the thread that runs them is compared, in turns: it
depends little on what else the machine does.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import partial
from statistics import median
from typing import TYPE_CHECKING

import numpy as np

from stickslip.extensions.sweeps.design.axis import Values
from stickslip.extensions.sweeps.execution.chunk import Work, run_chunk
from stickslip.extensions.sweeps.execution.cluster import cluster, stream
from stickslip.extensions.sweeps.execution.plan import make_plan

if TYPE_CHECKING:
    from distributed import Client

EMPTY = 200
CHUNKS, LENGTH = 4, 200_000
"""Chunks that are compared, and their members: rate-law slabs, two round trips each."""
REPEATS = 5
PLAN = make_plan(
    "fig6-slab", {"friction.alpha": np.linspace(0.5, 2.0, CHUNKS * LENGTH)}, quantities=["slip", "pulses"], chunk=LENGTH
)


def nothing(work: Work, values: Mapping[str, Values]) -> Mapping[str, Values]:
    """A chunk as it is sent and comes back."""
    return values


def processor_time(work: Work, values: Mapping[str, Values]) -> float:
    """Of a chunk, s."""
    start = time.thread_time()
    run_chunk(work, values, threads=1)
    return time.thread_time() - start


def timed(function: Callable[[], object]) -> float:
    """Wall clock (s) of a call."""
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def of_empty_chunk(client: Client) -> float:
    """Wall clock (s) of a chunk in which nothing is done, one behind the other."""
    chunks = [(number, PLAN.values(0)) for number in range(EMPTY)]
    return min(timed(lambda: list(stream(client, partial(nothing, PLAN.work), chunks))) for _ in range(REPEATS)) / EMPTY


def compared(client: Client) -> tuple[float, float]:
    """Processor time (s) of a chunk in this process, and on a worker."""
    here, there = [], []
    for chunk in [*range(CHUNKS)] * (1 + REPEATS):
        values = PLAN.values(chunk)
        here.append(processor_time(PLAN.work, values))
        there += [took for _, took in stream(client, partial(processor_time, PLAN.work), [(chunk, values)])]
    return median(here[CHUNKS:]), median(there[CHUNKS:])  # the first time something is compiled


def main() -> None:
    """Print what it costs."""
    start = time.perf_counter()
    with cluster(workers=1) as client:
        list(stream(client, partial(processor_time, PLAN.work), [(0, PLAN.values(0))]))
        say(f"start of a cluster with one worker, and its first chunk: {time.perf_counter() - start:.1f} s")
        empty, (here, there) = of_empty_chunk(client), compared(client)
        say(f"an empty chunk: {1e3 * empty:.1f} ms")
        say(f"{LENGTH} members: {here:.3f} s here, {there:.3f} s on the worker, {there / here - 1.0:+.1%}")
        say(f"chunks of a second: {there / here - 1.0 + empty:+.1%}")


def say(line: str) -> None:
    """Print at once."""
    print(line, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
