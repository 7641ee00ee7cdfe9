"""Compile kernels: by `one_module` or, where that cannot be, by `plain_numba`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any

from numba import types
from numba.extending import typeof_impl

from stickslip.engine.codegen.numba_privates import WHY_PLAIN
from stickslip.engine.codegen.uncompiled import MATHS, UNCOMPILED

if UNCOMPILED:
    pass
elif WHY_PLAIN:
    from stickslip.engine.codegen.plain_numba import dispatchers
else:
    from stickslip.engine.codegen.one_module import dispatchers

OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "fastmath": {"contract"}, "no_cfunc_wrapper": True}
"""Options of all kernels: divisions by zero give infinity or NaN as in numpy, the interpreter's lock is released, and a product and
a sum may be fused into one operation."""


class Kernel:
    """A compiled function of the engine: `entry` is what Python calls, `part` what compiled code calls."""

    def __init__(self, function: Callable[..., Any], **options: bool) -> None:
        self.__doc__, self.__name__, self.__module__ = function.__doc__, function.__name__, function.__module__
        self.__wrapped__ = function
        self.part, self.entry = dispatchers(function, OPTIONS, options)

    def __call__(self, *arguments: Any) -> Any:
        """Call the machine code, which the first call compiles or loads."""
        return self.entry(*arguments)


@cache
def in_python(kernel: Any) -> Callable[..., Any]:
    """Return a kernel as plain Python, with all kernels that it calls: a thousand times slower, but there is nothing to compile.

    It serves kernels whose arguments are numbers, tuples and arrays; addresses need machine code.
    """
    function = kernel.__wrapped__ if isinstance(kernel, Kernel) else kernel
    return FunctionType(function.__code__, _Names(function.__globals__), function.__name__, function.__defaults__)


class _Names(dict[str, Any]):
    """The names of a module, in which kernels are plain Python, and `math` has the functions of numpy."""

    def __init__(self, names: dict[str, Any]) -> None:
        super().__init__({name: _as_python(value) for name, value in names.items()})


def _as_python(value: Any) -> Any:
    """Return what plain Python uses in place of a kernel, of `math`, or of a module of kernels; all else stays as it is."""
    if isinstance(value, Kernel):
        return lambda *arguments: in_python(value)(*arguments)  # made when it is first called, since kernels call each other
    if value is math:
        return MATHS
    if isinstance(value, ModuleType) and any(isinstance(one, Kernel) for one in vars(value).values()):
        return SimpleNamespace(**_Names(vars(value)))
    return value


@typeof_impl.register(Kernel)
def _type_of_kernel(kernel: Kernel, context: Any) -> Any:
    """Return the type that compiled code sees when it calls a kernel: that of its part."""
    return types.Dispatcher(kernel.part)
