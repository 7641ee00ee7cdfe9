"""Threads that begin at once make what they share once, and the machine code that a run holds outlives it.

Each case runs in a process of its own, with laws that no process has compiled: what is at stake is the life of the process.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from uuid import uuid4

import pytest

SETTING = """
import hashlib, sys, threading
import stickslip as ss

def law(n):
    new = int(hashlib.sha256(f"{sys.argv[1]} {n}".encode()).hexdigest()[:12], 16) / 16**12
    return f"0.6 + {0.1 + 0.01*new!r}/(1 + v) + 0.02*exp(-u/3)"

def problem(n):
    slab = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
    return ss.Problem(slab, law(n), pull_rate=1e-9, initial_excess=0.0)

def slip(one):
    return float(ss.simulate(one, 20.0).slip(20.0))

def at_once(work, count):
    found, gate = [None] * count, threading.Barrier(count)
    def begin(n):
        gate.wait()
        found[n] = work(n)
    threads = [threading.Thread(target=begin, args=(n,)) for n in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return found
"""
CASES = {
    "one problem": """
one = problem(0)
found = at_once(lambda n: [slip(one) for _ in range(3)], 8)
assert len({slip for each in found for slip in each}) == 1 and found[0][0] > 0.0, found
""",
    "one law typed eight times": """
found = at_once(lambda n: slip(problem(0)), 8)
assert len(set(found)) == 1 and found[0] > 0.0, found
""",
    "eight laws": """
found = at_once(lambda n: slip(problem(n)), 8)
assert found == [slip(problem(n)) for n in range(8)] and len(set(found)) == 8, found
""",
    "dask": """
import dask
one = problem(0)
found = dask.compute(*[dask.delayed(slip)(one) for _ in range(16)], scheduler="threads", num_workers=8)
assert len(set(found)) == 1, found
""",
    "runs, sweeps and checks": """
from stickslip.scenarios.examine import examine
scenario = ss.load_scenario("fig6-slab")
kinds = (
    lambda: slip(problem(0)),
    lambda: float(ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]}, quantities=["slip"]).slip[0]),
    lambda: str(examine(scenario)),
    lambda: float(ss.simulate("fig6-slab").events.slip.iloc[0]),
)
found = at_once(lambda n: kinds[n % 4](), 8)
assert found[:4] == found[4:], found
""",
    "eight pages of the explorer": """
from queue import Queue
from stickslip.explorer.model.solve import solve
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.scenarios.scenario import Scenario
calls, found, faults, scenario = Queue(), [], [], Scenario(problem(0), 20.0)
desks = [ThreadDesk(calls.put) for _ in range(8)]
for desk in desks:
    desk.ask(lambda told: solve(scenario, told).sentence, found.append, faults.append)
while len(found) + len(faults) < 8:
    calls.get(timeout=600)()
assert len(set(found)) == 1 and not faults, (found, faults)
""",
}


ANNOUNCED = "stickslip: compiling", "stickslip: numba"
"""How lines begin that say why one has to wait."""


def python(code: str, *arguments: str, **environment: str) -> None:
    """Run a script in another process, which must end well and say nothing of its own accord."""
    settings = os.environ | {"OPENBLAS_NUM_THREADS": "1"} | environment
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False, env=settings)
    said = [line for line in done.stderr.splitlines() if not line.startswith(ANNOUNCED)]
    assert (done.returncode, said) == (0, [])


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("case", CASES)
def test_eight_threads_with_new_laws_at_once(case: str) -> None:
    python(SETTING + CASES[case], uuid4().hex)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_eight_threads_begin_with_an_empty_cache(case: str, tmp_path: Path) -> None:
    python(SETTING + CASES[case], uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path))


@pytest.mark.slow
def test_eight_threads_begin_with_an_empty_cache_and_the_public_compiler(tmp_path: Path) -> None:
    python(SETTING + CASES["one problem"], uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path), STICKSLIP_PLAIN_NUMBA="1")
