"""How the engine is compiled: the lean compiler, and the engine as plain Python."""

from __future__ import annotations

import gc
import json
import os
import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from numba import njit, types
from numba.core.compiler import run_frontend
from numba.core.errors import TypingError

from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.numba_privates import LLVM_LOCK
from stickslip.foundation.kernels.one_module import LeanCompiler
from stickslip.foundation.kernels.shortcuts import _variables_in
from stickslip.engine.history.turning_points import search_history
from tests.core.engine.uncompiled_runs import RUNS, results


def steps(x: float, n: int) -> float:
    """Every kind of operation that formulas and kernels have: sums, products, powers, comparisons, whole numbers."""
    total = 1.5 * x - 2.0 / (3.0 + x)
    for k in range(n):
        total += x**k if k % 2 == 0 and total > 0.5 else -total * k
    return total


def assembly(**options: Any) -> str:
    compiled = njit((types.float64, types.int64), **options)(steps)
    (text,) = compiled.inspect_asm().values()
    text = re.sub(r"(\.size\s.*), \d+$", r"\1", text, flags=re.MULTILINE)  # texts that hold such a name grow with its digits
    return re.sub(r"v\d+|B\d+|-w\d+|@[\w.]+|_ZN\w+", "", text)  # names that count what was compiled before


def test_machine_code_is_that_of_numba() -> None:
    lean, numbas = assembly(pipeline_class=LeanCompiler), assembly()
    assert len(numbas) > 1000
    assert lean == numbas


def test_search_for_operators_and_collection_of_garbage_are_as_before_also_after_an_error() -> None:
    def wrong(x: float) -> Any:
        return x + "a"

    with pytest.raises(TypingError):
        njit((types.float64,), pipeline_class=LeanCompiler)(wrong)
    assert gc.isenabled()
    assert types.Function.get_call_type.__module__.startswith("numba.")
    assert LLVM_LOCK._cblist  # calls of LLVM are told again


def test_shortcuts_find_what_numba_finds() -> None:
    """Variables of instructions, which shortcuts list in their own way."""
    compiled: Any = search_history
    lines = [line for block in run_frontend(compiled.__wrapped__).blocks.values() for line in block.body]
    parts = [part for line in lines for part in vars(line).values()]
    assert len(parts) > 50
    assert [_variables_in(lines[0], part) for part in parts] == [lines[0]._rec_list_vars(part) for part in parts]


def test_a_kernel_is_compiled_once_for_all_whole_numbers_that_are_written_in_calls() -> None:
    @kernel
    def times(x: float, n: int) -> float:
        return x * n

    @kernel
    def calls(x: float) -> float:
        return times(x, 2) + times(x, 3)  # type: ignore[no-any-return]

    compiled: Any = times
    assert calls(1.5) == 7.5
    calls.part.compile((types.float64,))  # type: ignore[attr-defined] # which a call leaves out where the cache has its machine code
    assert list(compiled.part.overloads) == [(types.float64, types.int64)]


@pytest.fixture(scope="module")
def uncompiled(request: pytest.FixtureRequest) -> dict[str, dict[str, object]]:
    """Results of the runs that tests of this session ask for, in a process that compiles nothing."""
    cases = (getattr(item, "callspec", None) for item in request.session.items if request.path == item.path)
    names = [case.params["name"] for case in cases if case is not None and "name" in case.params]
    command = [sys.executable, "-m", "tests.core.engine.uncompiled_runs", *names]
    environment = os.environ | {"STICKSLIP_UNCOMPILED": "1"}
    answer = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert answer.returncode == 0, answer.stderr[-2000:]
    found: dict[str, dict[str, object]] = json.loads(answer.stdout)
    return found


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", RUNS)
def test_plain_python_gives_what_compiled_code_gives(uncompiled: dict[str, dict[str, object]], name: str) -> None:
    """To 1e-9: compiled code may fuse a product and a sum, which rounds once instead of twice."""
    plain, compiled = uncompiled[name], results(name)
    assert plain["status"] == compiled["status"]
    for quantity in ("slip", "load", "events"):
        expected = np.array(compiled[quantity], float)
        size = np.abs(expected).max(initial=0.0)
        assert np.array(plain[quantity], float) == pytest.approx(expected, rel=1e-9, abs=1e-9 * size), quantity


def test_a_place_outside_an_array_is_an_error() -> None:
    from stickslip.foundation.kernels.uncompiled import Pointer, lend_memory, pointer_at

    numbers = np.arange(6.0)
    lend_memory(numbers)
    pointer = pointer_at(numbers.ctypes.data + 16, float)
    assert (pointer[0], pointer.ahead(3)[0], pointer.address) == (2.0, 5.0, numbers.ctypes.data + 16)
    pointer[1] = 7.0
    assert numbers[3] == 7.0
    for wrong in (-3, 4):
        with pytest.raises(IndexError, match="of an array of 6 numbers"):
            pointer[wrong]
    with pytest.raises(IndexError, match="no address"):
        pointer_at(numbers.ctypes.data + 48, float)
    assert isinstance(Pointer(numbers).ahead(1), Pointer)
