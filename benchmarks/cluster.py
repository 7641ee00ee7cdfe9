"""What a cluster costs: chunks in which nothing is done, and the same chunks of a sweep in this process and on one worker.

    python -m benchmarks.cluster

One worker with one thread, so that both do the same work one chunk after the other. The fastest of some runs each, in turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from stickslip.sweeps.axis import Values
from stickslip.sweeps.chunk import Work
from stickslip.sweeps.cluster import cluster, on_cluster, stream
from stickslip.sweeps.plan import Plan, make_plan
from stickslip.sweeps.sweep import Runner, carry_out, on_threads

if TYPE_CHECKING:
    from distributed import Client

EMPTY = 200
CHUNKS = 8
LENGTHS = (10, 100)
"""Members of a chunk."""
REPEATS = 4
ALLOWED = 0.05


def plan_of(length: int) -> Plan:
    """Rate-law slabs, two round trips each."""
    return make_plan("fig6-slab", {"friction.alpha": f"0.2..2:{CHUNKS * length}"}, quantities=["slip", "pulses"], chunk=length)


def nothing(work: Work, values: Mapping[str, Values]) -> Mapping[str, Values]:
    """A chunk as it is sent and comes back."""
    return values


def timed(function: Callable[[], object]) -> float:
    """Wall clock (s) of a call."""
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def of_chunk(client: Client) -> float:
    """Wall clock (s) of a chunk in which nothing is done, one behind the other."""
    plan = plan_of(100)
    chunks = [(number, plan.values(0)) for number in range(EMPTY)]
    return min(timed(lambda: list(stream(client, partial(nothing, plan.work), chunks))) for _ in range(REPEATS)) / EMPTY


def compared(length: int, here: Runner, there: Runner) -> tuple[float, float]:
    """Wall clock (s) of a chunk in this process, and on a worker."""
    plan = plan_of(length)
    runs = [[timed(lambda run=run: carry_out(plan, None, run)) for run in (here, there)] for _ in range(REPEATS)]  # type: ignore[misc]
    own, other = (min(run[where] for run in runs) / CHUNKS for where in (0, 1))
    return own, other


def main() -> None:
    """Print what it costs."""
    here = on_threads(1)
    carry_out(plan_of(1), None, here)
    start = time.perf_counter()
    with cluster(workers=1) as client:
        there = on_cluster(client)
        carry_out(plan_of(1), None, there)
        say(f"start of a cluster with one worker, and its first chunks: {time.perf_counter() - start:.1f} s")
        empty = of_chunk(client)
        say(f"an empty chunk: {1e3 * empty:.1f} ms, below {ALLOWED:.0%} for chunks of {empty / ALLOWED:.2f} s and longer")
        for length in LENGTHS:
            own, other = compared(length, here, there)
            say(f"{length} members a chunk: {own:.3f} s here, {other:.3f} s on the worker, {other / own - 1.0:+.1%}")


def say(line: str) -> None:
    """Print at once."""
    print(line, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
