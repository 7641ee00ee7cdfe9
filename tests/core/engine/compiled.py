"""Kernels, and functions of tests that call kernels, compiled by numba for whatever Python hands to them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from numba import njit

from stickslip.foundation.kernels.compiler import addresses, records
from stickslip.foundation.kernels.compiler.parts import OPTIONS

OF_PYTHON = {name: value for name, value in OPTIONS.items() if name != "pipeline_class"}
"""Options of kernels, without the compiler that writes parts: what Python calls must be machine code."""


@cache
def compiled(function: Callable[..., Any]) -> Any:
    """Compile a kernel, or a plain function, once for all tests of a process."""
    addresses.register()
    records.register()
    return njit(**OF_PYTHON)(getattr(function, "__wrapped__", function))
