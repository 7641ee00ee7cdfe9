"""Compile with numba, but without what our code never needs: half of the time of a compilation otherwise.

Our code is thousands of sums and products of floats. For each of them numba twice searches all definitions of the operator,
those for arrays included, for the one that fits: when it infers types, and when it writes the code. Here the first search for an
operator and types of arguments is remembered. The machine code is the same.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from stickslip.engine.codegen.numba_privates import (
    OPERATORS_TO_BUILTINS,
    Compiler,
    InlineClosureLikes,
    InlineInlinables,
    InlineOverloads,
    LiteralUnroll,
    NopythonRewrites,
    WithLifting,
)
from stickslip.engine.codegen.numba_privates import Function as NumbaFunction

NOT_NEEDED = (InlineClosureLikes, InlineInlinables, InlineOverloads, LiteralUnroll, NopythonRewrites, WithLifting)
"""Passes of numba's compiler that find nothing in our code, which has no closures, array expressions or `with` statements."""

Function: Any = NumbaFunction
_search = Function.get_call_type
_found: dict[tuple[Any, tuple[Any, ...]], Any] = {}
"""The definition that fits, by operator and types of its arguments."""


def _remembered(operator: Any, context: Any, arguments: Any, keywords: Any) -> Any:
    """Return the definition of an operator that fits the types of its arguments; search for it only once."""
    if operator.typing_key not in OPERATORS_TO_BUILTINS:
        return _search(operator, context, arguments, keywords)
    key = operator, tuple(arguments)
    if key not in _found:
        _found[key] = _search(operator, context, arguments, keywords)
    return _found[key]


@contextmanager
def _at_speed() -> Iterator[None]:
    """Compile inside this context with remembered definitions, while the collector of garbage waits: hardly anything can go.

    Numba's lock is held meanwhile, and everybody else's code is compiled as always. A function that is compiled because another
    one calls it is compiled inside the context of the other one.
    """
    if Function.get_call_type is _remembered:
        yield
        return
    collecting = gc.isenabled()
    gc.disable()
    Function.get_call_type = _remembered
    try:
        yield
    finally:
        Function.get_call_type = _search
        _found.clear()
        if collecting:
            _put_off_search()
            gc.enable()


def _put_off_search() -> None:
    """Leave what is new to the next full search for garbage: a search at once takes a tenth of the time of the compilation."""
    if not gc.get_freeze_count():  # else somebody keeps frozen objects
        gc.freeze()
        gc.unfreeze()


class LeanCompiler(Compiler):  # type: ignore[misc] # numba is untyped
    """Numba's compiler without what our code does not need."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes but for those that look for closures, array expressions and functions to inline."""
        (passes,) = super().define_pipelines()
        passes.passes = [one for one in passes.passes if one[0] not in NOT_NEEDED]
        passes.finalize()
        return [passes]

    def compile_extra(self, function: Any) -> Any:
        """Compile a function, with all that it calls."""
        with _at_speed():
            return super().compile_extra(function)
