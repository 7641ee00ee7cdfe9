"""What a cluster costs: the same chunks of a sweep in this process and on one worker, for chunks of different lengths.

    python -m benchmarks.cluster

One worker with one thread, so that both do the same work one chunk after the other; the start of the cluster and the first chunk,
with which the worker loads the engine, are told apart from the rest. The fastest of some runs each, in turns.
"""

from __future__ import annotations

import time

from stickslip.sweeps.cluster import cluster, on_cluster
from stickslip.sweeps.plan import Plan, make_plan
from stickslip.sweeps.sweep import Runner, carry_out, on_threads

CHUNKS = 8
LENGTHS = (1, 10, 40, 160)
"""Members of a chunk."""
REPEATS = 5


def plan_of(length: int) -> Plan:
    """Rate-law slabs, two round trips each."""
    return make_plan("fig6-slab", {"friction.alpha": f"0.2..2:{CHUNKS * length}"}, quantities=["slip", "pulses"], chunk=length)


def timed(plan: Plan, run: Runner) -> float:
    """Wall clock (s) of the sweep, store in memory."""
    start = time.perf_counter()
    carry_out(plan, None, run)
    return time.perf_counter() - start


def main() -> None:
    """Print the table."""
    here = on_threads(1)
    timed(plan_of(1), here)
    start = time.perf_counter()
    with cluster(workers=1) as client:
        started = time.perf_counter() - start
        there = on_cluster(client)
        first = timed(plan_of(1), there)
        print(f"start of the cluster {started:.2f} s, first chunks (engine loaded) {first:.2f} s")  # noqa: T201
        print("members a chunk   s a chunk here   on a worker   ms more a chunk   overhead")  # noqa: T201
        for length in LENGTHS:
            pairs = [(timed(plan_of(length), here), timed(plan_of(length), there)) for _ in range(REPEATS)]
            own, other = (min(pair[k] for pair in pairs) / CHUNKS for k in (0, 1))
            line = f"{length:15d} {own:16.4f} {other:13.4f} {1e3 * (other - own):17.2f} {other / own - 1.0:10.1%}"
            print(line)  # noqa: T201


if __name__ == "__main__":
    main()
