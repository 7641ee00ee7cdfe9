"""The way in which proofs about a contact run: as plain Python while a process asks for few of them, compiled after that.

To compile the search for folds takes ten seconds, once for each machine and version. Plain Python is a thousand times slower than
what is compiled, and still decides about the folds of most laws in some milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip.engine.codegen.kernels import in_python

Way = Callable[[Any], Callable[..., Any]]
"""What makes of a kernel a function that can be called: `in_python` or `compiled`."""


def compiled(kernel: Any) -> Callable[..., Any]:
    """Return a kernel as it is."""
    return kernel  # type: ignore[no-any-return]


class _Patience:
    """How many bounds this process still works out in plain Python.

    It depends on nothing but what was asked before, neither on time nor on what is in the cache: the same calls give the same
    digits. The ends of proven intervals may differ in their last ones from those of compiled code.
    """

    left = 1000


def compile_proofs() -> None:
    """Have all further proofs of this process run in compiled code: for a process that will ask for many."""
    _Patience.left = 0


def run_proof(search: Callable[[Way, int], tuple[int, Any]], budget: int) -> tuple[Any, Way]:
    """Return what a search finds with so many bounds at most, and the way in which it ran.

    The search is given a way and a budget, and returns how much of it was used and what it has found.
    """
    most = min(budget, _Patience.left)
    if most > 0:
        with np.errstate(all="ignore"):
            used, found = search(in_python, most)
        _Patience.left -= used
        if most == budget or used < most:
            return found, in_python
    return search(compiled, budget)[1], compiled


def way_of_next(count: int) -> Way:
    """Return the way of work that is as much as so many bounds."""
    left = _Patience.left
    _Patience.left -= count
    return in_python if left > 0 else compiled
