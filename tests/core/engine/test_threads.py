"""Threads that begin at once make what they share once, and the machine code that a run holds outlives it.

Each case runs in a process of its own, with laws that no process has compiled: what is at stake is the life of the process.
"""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path
from uuid import uuid4

import pytest

from stickslip.foundation.kernels.lock import LOCK, made_once
from tests.core.engine.at_once import SETTING, python

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
    "runs and checks": """
from stickslip.run.check.examine import examine
scenario = ss.load_scenario("fig6-slab")
kinds = (
    lambda: slip(problem(0)),
    lambda: str(examine(scenario)),
    lambda: float(ss.simulate("fig6-slab").events.slip.iloc[0]),
)
found = at_once(lambda n: kinds[n % 3](), 9)
assert found[:3] == found[3:6] == found[6:], found
""",
}


@pytest.mark.slow
@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("case", CASES)
def test_eight_threads_with_new_laws_at_once(case: str) -> None:
    python(SETTING + CASES[case], uuid4().hex)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_eight_threads_begin_with_an_empty_cache(case: str, tmp_path: Path) -> None:
    python(SETTING + CASES[case], uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path))


COMPILED = """
from pathlib import Path
from stickslip.foundation import code_key
code_key.SHIPPED = Path("nowhere")
"""
"""First lines of a script for which no machine code came with the package."""


@pytest.mark.slow
def test_eight_threads_begin_without_machine_code(tmp_path: Path) -> None:
    python(COMPILED + SETTING + CASES["one problem"], uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path))
    assert list(tmp_path.glob("compiled-*/loop.run_until.o"))


FORKED = """
import os, signal, time
from stickslip.foundation.kernels.lock import LOCK
slip(problem(0))
held = threading.Event()

def compile_for_long():
    with LOCK:
        held.set()
        time.sleep(0.5)

threading.Thread(target=compile_for_long).start()
held.wait()
child = os.fork()
if child == 0:
    signal.alarm(60)
    slid = slip(problem(1)) > 0.0 and len(ss.simulate("rate-and-state-block", max_events=1).history) > 1
    os._exit(0 if slid else 1)
assert os.waitpid(child, 0)[1] == 0
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes do not fork here")
def test_a_process_that_is_forked_while_another_thread_compiles_can_compile() -> None:
    python(SETTING + FORKED, uuid4().hex, PYTHONWARNINGS="ignore")


WARNED = """
import warnings
from stickslip.friction.formula.text import parse
sys.setswitchinterval(1e-6)
for m in range(12):
    warnings.simplefilter("error")
    at_once(lambda n: [parse(f"{m} + {n} + {k}*v", ()) for k in range(1, 60)], 8)
    try:
        warnings.warn("this is said")
    except UserWarning:
        pass
    else:
        raise AssertionError("a warning is lost")
"""


@pytest.mark.slow
def test_formulas_that_are_read_at_once_do_not_silence_warnings() -> None:
    python(SETTING + WARNED, uuid4().hex)


def test_what_eight_threads_want_at_once_is_made_once() -> None:
    made, gate, found = [], threading.Barrier(8), []

    @made_once()
    def slowly(n: int) -> object:
        made.append(n)
        time.sleep(0.05)
        return object()

    def ask() -> None:
        gate.wait()
        found.append(slowly(3))

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == [3]
    assert len(found) == 8
    assert len(set(map(id, found))) == 1


def test_what_was_asked_for_last_is_kept() -> None:
    made = []

    @made_once(2)
    def double(n: int) -> int:
        made.append(n)
        return 2 * n

    for n in (1, 2, 1, 3, 1, 2):
        assert double(n) == 2 * n
    assert made == [1, 2, 3, 2]
    double.cache_clear()
    assert double(1) == 2
    assert made == [1, 2, 3, 2, 1]


def test_what_is_known_waits_for_no_thread_that_compiles() -> None:
    @made_once()
    def same(n: int) -> int:
        return n

    same(5)
    held, done = threading.Event(), threading.Event()

    def compile_until_done() -> None:
        with LOCK:
            held.set()
            done.wait(60)

    other = threading.Thread(target=compile_until_done)
    other.start()
    held.wait()
    try:
        asked = threading.Thread(target=same, args=(5,), daemon=True)
        asked.start()
        asked.join(30)
        assert not asked.is_alive()
    finally:
        done.set()
        other.join()
