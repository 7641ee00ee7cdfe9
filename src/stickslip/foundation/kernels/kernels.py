"""Kernels: functions that become machine code when the package is built (`engine.build`).

Compiled code calls them by name. Python calls those that are an `entry`, through ctypes, which lets other threads go on meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable
from ctypes import CFUNCTYPE
from functools import cached_property
from typing import Any, ClassVar, TypeVar

from stickslip.foundation.kernels.lock import LOCK
from stickslip.foundation.kernels.signature import Ready, flattened, signature_of
from stickslip.foundation.kernels.uncompiled import UNCOMPILED, as_python

F = TypeVar("F", bound=Callable[..., Any])


class Kernel:
    """A function that compiled code calls.

    One that `is_inlined` is put in place wherever it is called. In one that `is_exact` each operation is rounded by itself, as in
    numpy; in others a product and a sum may be fused into one operation.
    """

    def __init__(self, function: Callable[..., Any], *, is_inlined: bool = False, is_exact: bool = False) -> None:
        self.__doc__, self.__name__, self.__module__ = function.__doc__, function.__name__, function.__module__
        self.__wrapped__, self.is_inlined, self.is_exact = function, is_inlined, is_exact

    @property
    def name(self) -> str:
        """The name of its machine code in the cache."""
        return f"{self.__module__.rsplit('.', 1)[-1]}.{self.__name__}"


class Entry(Kernel):
    """A kernel that Python calls. Its annotations say what it takes: numbers, arrays of stated dimensions, named tuples of such.

    Its machine code is loaded when it is first asked for, once for all threads, and stays until the process ends: addresses of it
    are handed on.
    """

    known: ClassVar[dict[str, Entry]] = {}
    """All entries of the modules that are imported, by name."""

    def __init__(self, function: Callable[..., Any], *, is_exact: bool = False) -> None:
        super().__init__(function, is_exact=is_exact)
        self.known[self.name] = self
        self._called: Any = None

    @cached_property
    def address(self) -> int:
        """The address of the machine code."""
        from stickslip.foundation.kernels.code import address_of_entry  # loads llvmlite: 0.1 s, which a page of help need not wait

        with LOCK:
            return address_of_entry(self)

    def __call__(self, *given: Any) -> Any:
        """Call the machine code."""
        kinds, call = self._called or self._ready()
        return call(*flattened(kinds, given))

    def _ready(self) -> Any:
        """Return the kinds of arguments and the function of C; keep them for later calls."""
        declared = signature_of(self.__wrapped__)
        result, arguments = declared.in_c
        call = CFUNCTYPE(result, *arguments)(self.address)
        self._called = declared.kinds, (lambda *flat: bool(call(*flat))) if declared.result is bool else call
        return self._called


def kernel(function: F) -> F:
    """Return a function that compiled code calls."""
    return as_python(function) if UNCOMPILED else Kernel(function)  # type: ignore[return-value] # called as what it stands for


def inlined(function: F) -> F:
    """Return a function, like `kernel`, that is always inlined: for small functions in the innermost loops."""
    return as_python(function) if UNCOMPILED else Kernel(function, is_inlined=True)  # type: ignore[return-value]


def entry(function: F) -> F:
    """Return a function that compiled code and Python call."""
    return as_python(function) if UNCOMPILED else Entry(function)  # type: ignore[return-value]


def exact(function: F) -> F:
    """Return a function, like `kernel`, whose operations are rounded one by one: for bounds that contain rounding."""
    return as_python(function) if UNCOMPILED else Kernel(function, is_exact=True)  # type: ignore[return-value]


def exact_entry(function: F) -> F:
    """Return a function, like `entry`, whose operations are rounded one by one."""
    return as_python(function) if UNCOMPILED else Entry(function, is_exact=True)  # type: ignore[return-value]


def ready(array: Any) -> Any:
    """Return an array as entries take it fastest, if it is handed on again and again; it must keep its place and its shape."""
    return array if UNCOMPILED else Ready(array)
