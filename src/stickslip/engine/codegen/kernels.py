"""Compile kernels: by `one_module` or, where that cannot be, by `plain_numba`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import types
from numba.extending import typeof_impl

from stickslip.engine.codegen.numba_privates import WHY_PLAIN
from stickslip.engine.codegen.uncompiled import UNCOMPILED

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


@typeof_impl.register(Kernel)
def _type_of_kernel(kernel: Kernel, context: Any) -> Any:
    """Return the type that compiled code sees when it calls a kernel: that of its part."""
    return types.Dispatcher(kernel.part)
