"""The lean compiler makes what numba's own makes, and leaves numba as it was."""

from __future__ import annotations

import gc
import re
from typing import Any

import pytest
from numba import njit, types
from numba.core.errors import TypingError

from stickslip.engine.codegen.lean_compiler import LeanCompiler


def steps(x: float, n: int) -> float:
    """Every kind of operation that formulas and kernels have: sums, products, powers, comparisons, whole numbers."""
    total = 1.5 * x - 2.0 / (3.0 + x)
    for k in range(n):
        total += x**k if k % 2 == 0 and total > 0.5 else -total * k
    return total


def assembly(**options: Any) -> str:
    compiled = njit((types.float64, types.int64), **options)(steps)
    (text,) = compiled.inspect_asm().values()
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
