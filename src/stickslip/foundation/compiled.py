"""Functions of numbers and arrays that are compiled: a stand-in while this branch waits for the builder of machine code."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])


def exact(function: F) -> F:
    """Return a compiled function whose products and sums are never fused, so that it rounds as numpy does."""
    compiled: F = numba.njit(error_model="numpy", cache=function.__code__.co_filename != "<string>", nogil=True)(function)
    return compiled


entry = exact
"""The same for a function that Python calls."""
