"""Run the engine as plain Python with every memory access checked, for debugging and for tests.

The environment variable STICKSLIP_UNCOMPILED=1, set before the package is imported, switches this on. Every kernel is then the
Python function from which it is normally compiled, every pointer is an object that knows the array it points into, and every
formula of a law is its generated Python text. Numbers are numpy's, so that a division by zero gives infinity as in compiled code.
Results agree with those of compiled code to the tolerance but not to the last bit, because a processor may fuse a product and a
sum. Batches run member by member, because lanes are registers of a processor and have no counterpart in Python.
"""

from __future__ import annotations

import os
import sys
import weakref
from collections.abc import Callable
from itertools import count
from types import SimpleNamespace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.kernels.lock import LOCK

UNCOMPILED = os.environ.get("STICKSLIP_UNCOMPILED", "") not in ("", "0")
"""True if kernels run as plain Python."""

BYTES = 8
"""Size of a number in memory, in bytes."""

Array = NDArray[Any]


class Pointer:
    """A pointer to a number in an array. Reading or writing outside the array raises IndexError."""

    __slots__ = ("first", "memory")

    def __init__(self, memory: Array, first: int = 0) -> None:
        self.memory, self.first = memory, first

    @property
    def address(self) -> int:
        """The address of the number, in bytes."""
        return self.memory.ctypes.data + BYTES * self.first

    def __getitem__(self, n: int) -> Any:
        return self.memory[self._place(n)]

    def __setitem__(self, n: int, value: Any) -> None:
        self.memory[self._place(n)] = value

    def _place(self, n: int) -> int:
        """Return the index in the array of the number n places after this one."""
        place = self.first + int(n)
        if not 0 <= place < len(self.memory):
            raise IndexError(f"place {place} of an array of {len(self.memory)} numbers")
        return place

    def ahead(self, n: int) -> Self:
        """Return the pointer to the number n places after this one."""
        return type(self)(self.memory, self.first + int(n))

    def as_floats(self) -> Self:
        """Return the pointer to the same place, whose 64 bits are read and written as a float."""
        return type(self)(self.memory.view(np.float64), self.first)


_lent: tuple[weakref.ref[Array], ...] = ()
"""Weak references to the arrays whose addresses have been handed to the engine; another tuple for each change, which other threads
do not see while they search in one."""


def lend_memory(*arrays: Array) -> None:
    """Register arrays whose addresses the engine receives, so that pointers into them can be checked."""
    global _lent
    with LOCK:
        alive = tuple(known for known in _lent if known() is not None)
        _lent = alive + tuple(weakref.ref(array) for array in arrays if not any(known() is array for known in alive))


def pointer_at(address: int, kind: type) -> Pointer:
    """Return the pointer to an address (bytes) inside a registered array, whose numbers have the type `kind`.

    Raises IndexError if the address lies in none of them.
    """
    for known in reversed(_lent):
        array = known()
        if array is not None and 0 <= int(address) - array.ctypes.data < max(array.nbytes, 1):
            return Pointer(array.reshape(-1).view(kind), (int(address) - array.ctypes.data) // BYTES)
    raise IndexError(f"{address} is no address in an array that was lent")


_functions: dict[int, Callable[..., Any]] = {}
"""Functions of formulas and of parts of the engine, by their handles."""
_handles = count(1)


def handle_of(function: Callable[..., Any]) -> int:
    """Register a function and return its handle, which takes the place of the address in compiled code."""
    handle = next(_handles)
    _functions[handle] = function
    return handle


def call(handle: int, *arguments: Any) -> Any:
    """Call the function with the given handle."""
    return _functions[int(handle)](*arguments)


MATHS = SimpleNamespace(
    **{name: getattr(np, name) for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "expm1", "log1p")},
    **{name: getattr(np, name) for name in ("sinh", "cosh", "hypot", "floor", "ceil", "copysign", "fabs")},
    asinh=np.arcsinh,
    pow=np.power,
    **{name: getattr(np, name) for name in ("isnan", "isfinite", "isinf")},
    inf=np.float64(np.inf),
    nan=np.float64(np.nan),
    pi=np.float64(np.pi),
)
"""Replacement of `math` that returns what numpy does where `math` raises an error: the logarithm of zero is minus infinity."""


def as_python(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a kernel as a plain function, after `math` in its module has been replaced by MATHS."""
    names = vars(sys.modules[function.__module__])
    if "math" in names:
        names["math"] = MATHS
    return function


if UNCOMPILED:
    np.seterr(all="ignore")
