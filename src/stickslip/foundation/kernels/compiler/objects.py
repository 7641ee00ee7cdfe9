"""Make the object file of an entry: what C calls, and Python by ctypes, around a function of numba's."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import count
from typing import Any

import numpy as np
from numba import types

from stickslip.foundation.kernels.compiler import addresses, records
from stickslip.foundation.kernels.compiler.addresses import array_at
from stickslip.foundation.kernels.compiler.parts import code_of
from stickslip.foundation.kernels.kernels import Entry
from stickslip.foundation.kernels.processor import Processor
from stickslip.foundation.kernels.signature import ArrayOf, Fields, Kind, Signature, signature_of

SCALARS: dict[Any, Any] = {float: types.float64, int: types.int64, bool: types.int64, None: types.void}
"""What numba makes of numbers as C takes them."""
OF_ARRAYS = {np.dtype(float): types.float64, np.dtype(np.int64): types.int64, np.dtype(bool): types.boolean}
OF_C = {
    *("sin", "cos", "tan", "exp", "log", "pow", "expm1", "log1p", "sqrt", "cbrt", "hypot", "floor"),
    *("sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "asin", "acos", "atan", "atan2"),
}
"""Functions of the library of C, which every process has."""


def object_of(entry: Entry, processor: Processor) -> bytes:
    """Return the machine code of an entry as an object file, which needs nothing but functions of the library of C."""
    addresses.register()
    records.register()
    function, signature = in_c(entry, signature_of(entry.__wrapped__))
    module = code_of(function, signature, entry.name)
    code = processor.optimised(module)
    text = str(module)
    declared = {one.name for one in module.functions if one.is_declaration and not one.name.startswith("llvm.")} - OF_C
    needed = sorted(name for name in declared if len(re.findall(rf'@"?{re.escape(name)}\b', text)) > 1)
    if needed:
        raise RuntimeError(f"{entry.name} calls {', '.join(needed)}, which not every process has")
    return code


def in_c(entry: Entry, declared: Signature) -> tuple[Callable[..., Any], Any]:
    """Return a function of numbers and addresses that calls an entry, and its signature for numba."""
    names: dict[str, Any] = {"array_at": array_at, "entry": entry}
    places = (f"x{n}" for n in count())
    arguments: list[tuple[str, Any]] = []
    given = ", ".join(_written(kind, names, places, arguments) for kind in declared.kinds)
    called = f"1 if entry({given}) else 0" if declared.result is bool else f"entry({given})"
    text = f"def in_c({', '.join(name for name, _ in arguments)}):\n    {'' if declared.result is None else 'return '}{called}\n"
    exec(text, names)
    return names["in_c"], SCALARS[declared.result](*(kind for _, kind in arguments))


def _written(kind: Kind, names: dict[str, Any], places: Iterator[str], arguments: list[tuple[str, Any]]) -> str:
    """Return the text of an argument of a kind, and append what C takes for it to `arguments`."""
    if isinstance(kind, Fields):
        inside = ", ".join(_written(one, names, places, arguments) for one in kind.kinds)
        made = next(places)
        names[made] = kind.made
        return f"{made}({inside})"
    first = next(places)
    if not isinstance(kind, ArrayOf):
        arguments.append((first, SCALARS[kind]))
        return f"{first} != 0" if kind is bool else first
    arguments.append((first, types.CPointer(OF_ARRAYS[kind.of])))
    shape = [next(places) for _ in range(kind.dimensions)]
    arguments += [(one, types.int64) for one in shape]
    return f"array_at({first}, ({', '.join(shape)},))"
