"""Run the engine as plain Python, with every access to memory checked: for a debugger, and for tests.

The environment variable STICKSLIP_UNCOMPILED=1, set before the package is imported, switches it on. Every kernel is then the
Python function that it is written as, every pointer an object that knows the array it points into, and every formula of a law the
generated Python text. Numbers are numpy's, so that a division by zero gives infinity as in compiled code. Results agree with those
of compiled code to the tolerance and not to the last bit, since a processor may fuse a product and a sum. Batches are run member
by member: lanes are registers of a processor and have no counterpart in Python.
"""

from __future__ import annotations

import os
import sys
import weakref
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

UNCOMPILED = os.environ.get("STICKSLIP_UNCOMPILED", "") not in ("", "0")
"""True if kernels are run as plain Python."""

BYTES = 8
"""Size of a number in memory."""

Array = NDArray[Any]


class Pointer:
    """A place in an array of numbers. Reading or writing outside the array raises IndexError."""

    __slots__ = ("first", "memory")

    def __init__(self, memory: Array, first: int = 0) -> None:
        self.memory, self.first = memory, first

    @property
    def address(self) -> int:
        """Address of the place, in bytes."""
        return self.memory.ctypes.data + BYTES * self.first

    def __getitem__(self, n: int) -> Any:
        return self.memory[self._place(n)]

    def __setitem__(self, n: int, value: Any) -> None:
        self.memory[self._place(n)] = value

    def _place(self, n: int) -> int:
        place = self.first + int(n)
        if not 0 <= place < len(self.memory):
            raise IndexError(f"place {place} of an array of {len(self.memory)} numbers")
        return place

    def ahead(self, n: int) -> Self:
        """Return the pointer to the number n places further on."""
        return type(self)(self.memory, self.first + int(n))


_lent: list[weakref.ref[Array]] = []
"""Arrays whose addresses have been handed to the engine, as long as they live."""


def lend_memory(*arrays: Array) -> None:
    """Make the addresses of arrays known, so that pointers to them can be checked."""
    alive = [known for known in _lent if known() is not None]
    _lent[:] = alive + [weakref.ref(array) for array in arrays if not any(known() is array for known in alive)]


def pointer_at(address: int, kind: type) -> Pointer:
    """Return the pointer to an address inside an array that has been lent."""
    for known in reversed(_lent):
        array = known()
        if array is not None and 0 <= int(address) - array.ctypes.data < max(array.nbytes, 1):
            return Pointer(array.reshape(-1).view(kind), (int(address) - array.ctypes.data) // BYTES)
    raise IndexError(f"{address} is no address in an array that was lent")


_formulas: list[Callable[..., None]] = []


def handle_of(function: Callable[..., None]) -> int:
    """Return the number that stands for a formula's function where compiled code has an address."""
    _formulas.append(function)
    return len(_formulas)


def call(handle: int, *arguments: Any) -> None:
    """Call a formula's function."""
    _formulas[int(handle) - 1](*arguments)


MATHS = SimpleNamespace(
    **{name: getattr(np, name) for name in ("sqrt", "log", "exp", "expm1", "log1p", "sin", "cos", "tanh", "sinh", "cosh")},
    **{name: getattr(np, name) for name in ("isnan", "isfinite", "isinf", "floor", "ceil", "copysign", "fabs")},
    asinh=np.arcsinh,
    inf=np.float64(np.inf),
    nan=np.float64(np.nan),
    pi=np.float64(np.pi),
)
"""The functions of `math` with numpy's answers where Python raises an error: the logarithm of zero is minus infinity."""


def as_python(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a kernel as the function that it is, computing as numpy does."""
    names = vars(sys.modules[function.__module__])
    if "math" in names:
        names["math"] = MATHS
    return function


if UNCOMPILED:
    np.seterr(all="ignore")
