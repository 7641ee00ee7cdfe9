"""Kernels become parts of one module, by classes of numba that are not public; without these its public compiler takes over."""

from __future__ import annotations

import math
from collections.abc import Callable
from ctypes import CFUNCTYPE, c_double, c_int64
from pathlib import Path

import numba
import numpy as np
import pytest
from numba import types
from numba.core.errors import NumbaError

from stickslip.foundation.arrays import Floats1
from stickslip.foundation.kernels.code import loaded
from stickslip.foundation.kernels.compiler import parts
from stickslip.foundation.kernels.compiler.objects import object_of
from stickslip.foundation.kernels.kernels import Entry, Kernel
from stickslip.foundation.kernels.processor import PROCESSOR
from tests.core.engine.compiled import compiled
from tests.core.foundation.kernels.fresh import printed, python

ROOTS = """
{spoil}
import hashlib
import numpy as np
from stickslip.engine.series.polynomial import crossings, restrict
from stickslip.foundation.kernels.compiler import parts
rng, found, part = np.random.default_rng(3), hashlib.sha256(), np.zeros(27)
for _ in range(500):
    c, out = rng.normal(size=27) * 0.7 ** np.arange(27), np.zeros(27)
    count = crossings(c, out, part)
    restrict(c, 0.3, 0.4, part)
    found.update(out[:count].tobytes() + part.tobytes())
print(repr(parts.WHY_PLAIN), found.hexdigest())
"""
"""Calls two entries after numba has been spoilt; prints why it is used plainly, and a hash of the answers."""
MISSING = {
    "a class": ("import numba.core.codegen as m; del m.JITCodeLibrary", "cannot import name 'JITCodeLibrary'"),
    "a method": ("import numba.core.codegen as m; del m.CodeLibrary._raise_if_finalized", "has no attribute '_raise_if_finalized'"),
    "a pass": ("import numba.core.untyped_passes as m; del m.GenericRewrites", "cannot import name 'GenericRewrites'"),
}
WHY = """
{spoil}
from stickslip.foundation.kernels.compiler import parts
print(parts.WHY_PLAIN, "pipeline_class" in parts.OPTIONS)
"""


def test_nothing_is_missing_here() -> None:
    assert parts.WHY_PLAIN == ""
    assert parts.OPTIONS["pipeline_class"] is parts.PartCompiler


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("what", MISSING)
def test_what_is_missing_is_named_and_numba_is_used_plainly(what: str) -> None:
    spoil, reason = MISSING[what]
    found = printed(python(WHY.format(spoil=spoil), ""))
    assert reason in found
    assert found.endswith(" False\n")


@pytest.mark.slow
def test_without_a_private_class_answers_have_the_same_bits(tmp_path: Path) -> None:
    ours = printed(python(ROOTS.format(spoil=""), tmp_path / "ours"))
    theirs = printed(python(ROOTS.format(spoil=MISSING["a pass"][0]), tmp_path / "theirs", tmp_path / "nothing"))
    assert ours.startswith("'' ")
    assert "GenericRewrites" in theirs
    assert ours.split()[-1] == theirs.split()[-1]
    assert len(list((tmp_path / "theirs").rglob("polynomial.*.o"))) == 2


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


@pytest.mark.slow
def test_runs_are_the_same_bit_for_bit_by_numbas_public_compiler(tmp_path: Path) -> None:
    """But for the bounds of residuals, to 12 digits: LLVM may join a product and a sum in one of them and not in the other."""
    ours = printed(python(RUNS, tmp_path / "ours"))
    plain = python(RUNS, tmp_path / "plain", tmp_path / "nothing", STICKSLIP_PLAIN_NUMBA="1")
    assert printed(plain) == ours
    assert ours.count("\n") == 6
    assert list((tmp_path / "plain").glob("compiled-*/loop.run_until.o"))


# ---- what becomes of a kernel --------------------------------------------------------------------------------------------------


def test_a_kernel_is_compiled_once_for_all_whole_numbers_that_are_written_in_calls() -> None:
    times = Kernel(lambda x, n: x * n)

    @compiled
    def calls(x: float) -> float:
        return times(x, 2) + times(x, 3)  # type: ignore[no-any-return]

    assert calls(1.5) == 7.5
    assert list(numba.typeof(times).dispatcher.overloads) == [(types.float64, types.int64)]


def test_a_kernel_that_cannot_be_compiled_says_why() -> None:
    def wrong(x: float) -> float:
        return x.nothing  # type: ignore[attr-defined,no-any-return]

    with pytest.raises(NumbaError, match="nothing"):
        object_of(Entry(wrong), PROCESSOR)


def raises(x: float) -> float:
    if x < 0.0:
        raise ValueError("negative")
    return x


def prints(x: float) -> float:
    print(x)  # noqa: T201
    return x


def error_function(x: float) -> float:
    return math.erf(x)


def gamma_function(x: float) -> float:
    return math.gamma(x)


@pytest.mark.parametrize(
    ("function", "called"),
    [(raises, "numba_do_raise"), (prints, "PySys_FormatStdout"), (error_function, "erf"), (gamma_function, "numba_gamma")],
)
def test_an_entry_that_calls_what_not_every_process_has_is_refused(function: Callable[[float], float], called: str) -> None:
    with pytest.raises(RuntimeError, match=rf"test_parts\.{function.__name__} calls .*\b{called}\b.*, which not every process has"):
        object_of(Entry(function), PROCESSOR)


def makes_an_array(x: float) -> float:
    return np.zeros(3)[0] + x  # type: ignore[no-any-return]


def test_an_entry_that_makes_arrays_is_refused() -> None:
    """What counts references would need numba when it runs."""
    with pytest.raises(NumbaError, match="zeros"):
        object_of(Entry(makes_an_array), PROCESSOR)


def of_the_library_of_c(c: Floats1, n: int) -> float:
    return math.sin(c[0]) + math.expm1(c[1]) + math.atan2(c[2], c[3]) + c[4] ** 1.5 + c[5] % n


def test_functions_of_the_library_of_c_are_called() -> None:
    entry, c = Entry(of_the_library_of_c), np.linspace(0.3, 1.7, 6)
    made = loaded(object_of(entry, PROCESSOR))
    call = CFUNCTYPE(c_double, c_int64, c_int64, c_int64)(made.get_function_address(entry.name))
    assert call(c.ctypes.data, 6, 3) == pytest.approx(of_the_library_of_c(c, 3), rel=1e-15)
