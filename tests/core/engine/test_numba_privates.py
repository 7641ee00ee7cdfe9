"""Where a private name of numba is missing, numba's public compiler takes over, with the same bits."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PRINTED = "from stickslip.foundation.kernels import numba_privates as found; print(repr(found.WHY_PLAIN), hasattr(found, 'JITCodeLibrary'))"

MISSING = {
    "a name": ("import numba.core.caching as m; del m.NullCache", "cannot import name 'NullCache'"),
    "a method": ("import numba.core.compiler as m; del m.CompileResult._rebuild", "CompileResult has no _rebuild"),
    "a parameter": (
        "import numba.core.types as m; m.Function.get_call_type = lambda self, args: None",
        "<lambda> takes self, args",
    ),
    "a pass": ("import numba.core.untyped_passes as m; del m.GenericRewrites", "cannot import name 'GenericRewrites'"),
    "a function that is replaced": (
        "import numba.core.typeinfer as m; del m.new_error_context",
        "numba.core.typeinfer has no new_error_context",
    ),
    "an attribute of an object": ("import numba, llvmlite.binding.ffi as m; del m.lib._lock._cblist", "_LLVMLock has no _cblist"),
}


def python(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    settings = os.environ | environment
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=settings)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("what", MISSING)
def test_what_is_missing_is_named(what: str) -> None:
    spoil, reason = MISSING[what]
    assert reason in python(f"{spoil}\n{PRINTED}").stdout


def test_nothing_is_missing_here() -> None:
    assert python(PRINTED).stdout == "'' True\n"


def test_plain_python_imports_no_private_name() -> None:
    assert python(PRINTED, STICKSLIP_UNCOMPILED="1").stdout == "'' False\n"


SPOILT_TYPES = """
import numba.core.typing.templates as m
del m.AttributeTemplate
from stickslip.cli.main import main
main(["run", "fig6-slab"])
"""


def test_a_numba_that_cannot_serve_gets_one_line() -> None:
    done = subprocess.run([sys.executable, "-c", SPOILT_TYPES], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "cannot compile the engine" in done.stderr
    assert "pip install 'numba>=0.62,<0.69'" in done.stderr


REFUSED = """
from stickslip.foundation.kernels.kernels import kernel
import numba.core.lowering as lowering, numba.core.typeinfer as typeinfer
before = [lowering.new_error_context, typeinfer.new_error_context]

@kernel
def wrong(x):
    return x.nothing

try:
    wrong(1.0)
except Exception as error:
    print("nothing" in str(error), [lowering.new_error_context, typeinfer.new_error_context] == before)
"""


def test_a_kernel_that_cannot_be_compiled_says_why_and_leaves_numba_as_it_was() -> None:
    assert python(REFUSED).stdout == "True True\n"


REFERENCES = """
import gc, sys
import numpy as np
from stickslip.foundation.kernels.kernels import kernel

@kernel
def made(n):
    rows = np.zeros(n)
    for k in range(n):
        rows = rows + np.ones(n)
    return rows

before = made(10_000)
from numba.core.runtime import rtsys
made(10_000)
stats = rtsys.get_allocation_stats()
print(stats.alloc - stats.free)
"""


def test_arrays_inside_kernels_are_given_back() -> None:
    """One is alive, the first result: where a kernel holds counted references, the ends of its variables are written."""
    assert python(REFERENCES, NUMBA_NRT_STATS="1").stdout == "1\n"


FOLDS = """
import stickslip as ss
found = ss.uniqueness(ss.load_scenario("fig6-slab").problem)
print(*(fold.load.hex() for fold in found.folds))
"""
RUNS = """
import hashlib
import stickslip as ss
slab = ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), ss.friction.FromExpression("0.6 - 0.2*v/(v + 1.0) + 0.05*sin(7*u)"),
                  0.0, initial_excess=1e6)
for run in (ss.simulate("fig6-slab"), ss.simulate(slab, 8.0), ss.simulate("rate-and-state-block", duration="30 years")):
    bounds = run.history.store.residual
    print(*(f"{one:.12g}" for one in (bounds.sum(), bounds.max())))
    bounds[:] = 0.0
    print(hashlib.sha256(run.history.store.pieces.tobytes()).hexdigest())
"""


def both_ways(code: str, cache: Path) -> tuple[str, str, str]:
    """Return what code prints by the faster way and by numba's public compiler, and what the second says."""
    plain = python(code, STICKSLIP_PLAIN_NUMBA="1", STICKSLIP_CACHE_DIR=str(cache))
    return python(code).stdout, plain.stdout, plain.stderr


@pytest.mark.slow
def test_folds_are_the_same_bit_for_bit(tmp_path: Path) -> None:
    ours, plain, _ = both_ways(FOLDS, tmp_path)
    assert ours == plain


@pytest.mark.slow
def test_runs_are_the_same_bit_for_bit(tmp_path: Path) -> None:
    """But for the bounds of residuals, to 12 digits: LLVM may join a product and a sum in one of them and not in the other."""
    ours, plain, said = both_ways(RUNS, tmp_path)
    assert ours == plain
    assert ours.count("\n") == 6
    assert "is used plainly (STICKSLIP_PLAIN_NUMBA is set)" in said
    assert list((tmp_path).rglob("plain/**/*.nbc"))
