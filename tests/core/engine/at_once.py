"""Scripts whose threads begin at once, run in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys

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


ANNOUNCED = "stickslip: compiling"
"""How a line begins that says why one has to wait."""


def python(code: str, *arguments: str, **environment: str) -> None:
    """Run a script in another process, which must end well and say nothing of its own accord."""
    settings = os.environ | {"OPENBLAS_NUM_THREADS": "1"} | environment
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False, env=settings)
    said = [line for line in done.stderr.splitlines() if not line.startswith(ANNOUNCED)]
    assert (done.returncode, said) == (0, [])
