"""Let numba do once what it does again and again while the engine is compiled. The machine code is the same.

Our code is thousands of sums and products of floats and reads of fields. For each of them numba searches all definitions of the
operator, those for arrays included, for the one that fits; it asks LLVM for the sizes of the same few types; it prepares to say
where in our code an error occurs; and each call of LLVM tells every compilation that is under way when it began and ended. Here
first answers are remembered, and nobody is told. What numba says about an error is therefore short while these shortcuts are in
place; with STICKSLIP_PLAIN_NUMBA=1 it says all.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import cache
from typing import Any

from stickslip.engine.compile.numba_privates import (
    LLVM_LOCK,
    Assign,
    BaseContext,
    Function,
    Inst,
    Loc,
    Lower,
    NRTContext,
    PostProcessor,
    Type,
    Var,
    VariableLifetime,
    WarningsFixer,
    base,
    canonicalize_cfg,
    llvm,
    lowering,
    typeinfer,
)

_search, _look_up, _value_type = Function.get_call_type, BaseContext.resolve_getattr, BaseContext.resolve_value_type
_measure, _count = Type.get_abi_size, NRTContext._call_incref_decref
_process, _store = PostProcessor.run, Lower.storevar
_found: dict[tuple[Any, tuple[Any, ...]], Any] = {}
"""The definition that fits, by the function or operator and the types of its arguments."""
_attributes: dict[tuple[Any, str], Any] = {}
"""Types of attributes, by the type of the object and the name."""
_values: dict[int, tuple[Any, Any]] = {}
"""Constants of modules with their types, by identity; they are kept here, so that no other object takes the same one."""
_sizes: dict[str, int] = {}
"""Sizes of types (bytes), by their texts."""
_is_counted: dict[Any, bool] = {}
"""True for types whose values hold references that are counted."""


def _search_once(function: Any, context: Any, arguments: Any, keywords: Any) -> Any:
    """Return the definition of a function or operator that fits the types of its arguments."""
    if keywords:
        return _search(function, context, arguments, keywords)
    key = function, tuple(arguments)
    if key not in _found:
        _found[key] = _search(function, context, arguments, keywords)
    return _found[key]


def _look_up_once(context: Any, kind: Any, name: str) -> Any:
    """Return the type of an attribute."""
    key = kind, name
    if key not in _attributes:
        _attributes[key] = _look_up(context, kind, name)
    return _attributes[key]


def _type_value_once(context: Any, value: Any) -> Any:
    """Return the type of a constant of a module."""
    key = id(value)
    if key not in _values:
        _values[key] = value, _value_type(context, value)
    return _values[key][1]


def _measure_once(kind: Any, target: Any, context: Any = None) -> int:
    """Return the size (bytes) of a type of LLVM's."""
    text = str(kind)
    if text not in _sizes:
        _sizes[text] = _measure(kind, target, context)
    return _sizes[text]


def _count_references(run_time: Any, builder: Any, kind: Any, value: Any, way: str) -> None:
    """Write the counting of the references in a value, up or down; most types have none."""
    if is_counted(run_time._context, kind):
        _count(run_time, builder, kind, value, way)


def is_counted(context: Any, kind: Any) -> bool:
    """Return True if values of a type hold references that are counted."""
    if kind not in _is_counted:
        _is_counted[kind] = context.data_model_manager[kind].contains_nrt_meminfo()
    return _is_counted[kind]


def _store_variable(lower: Any, value: Any, name: str, argidx: Any = None) -> None:
    """Write the assignment of a value to a variable; the value before is read only if its references are counted."""
    kind = lower.typeof(name)
    if argidx is not None or name in lower._singly_assigned_vars or is_counted(lower.context, kind):
        _store(lower, value, name, argidx)
        return
    lower._alloca_var(name, kind)
    lower.builder.store(value, lower.getvar(name))


def _put_in_order(processor: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """Put the blocks of a function in order; look for the lives of variables only where their ends are to be written."""
    function = processor.func_ir
    if emit_dels or function.is_generator:
        _process(processor, emit_dels, extend_lifetimes)
        return
    function.blocks = canonicalize_cfg(function.blocks)
    function.variable_lifetime = VariableLifetime(function.blocks)
    function.generator_info = None


def _say_nothing(*_: Any, **__: Any) -> Any:
    """Return a context in which numba prepares no words for an error, and collects no warnings."""
    return _NOTHING


_NOTHING = nullcontext()


def _variables_in(instruction: Any, value: Any) -> list[Any]:
    """Return the variables in a part of an instruction, in order."""
    found: list[Any] = []
    _collect(value, found)
    return found


def _collect(value: Any, found: list[Any]) -> None:
    """Append the variables in a part of an instruction to those that were found."""
    kind = type(value)
    if kind is Var:
        found.append(value)
    elif kind is dict:
        for one in value.values():
            _collect(one, found)
    elif kind is list or kind is tuple:
        for one in value:
            _collect(one, found)
    elif isinstance(value, Inst):
        found += value.list_vars()


SHORTCUTS: tuple[tuple[Any, str, Any], ...] = (
    (Function, "get_call_type", _search_once),
    (BaseContext, "resolve_getattr", _look_up_once),
    (Type, "get_abi_size", _measure_once),
    (BaseContext, "resolve_value_type", _type_value_once),
    (NRTContext, "_call_incref_decref", _count_references),
    (Lower, "storevar", _store_variable),
    (PostProcessor, "run", _put_in_order),
    (base, "_has_loc", cache(base._has_loc)),
    (llvm, "get_process_triple", cache(llvm.get_process_triple)),
    (lowering, "new_error_context", _say_nothing),
    (typeinfer, "new_error_context", _say_nothing),
    (WarningsFixer, "catch_warnings", _say_nothing),
    (Loc, "strformat", lambda place, *_, **__: f"{place.filename}:{place.line}"),
    (Assign, "__str__", lambda _: "an assignment"),  # numba makes this text of every one
    (Inst, "_rec_list_vars", _variables_in),
    (LLVM_LOCK, "_cblist", []),  # whom calls of LLVM tell
)
"""What takes the place of which attribute of which object."""
_under_way: list[None] = []
"""Not empty while something is compiled."""


@contextmanager
def at_speed() -> Iterator[None]:
    """Compile inside this context with shortcuts, while the collector of garbage waits: hardly anything can go.

    Numba's lock is held meanwhile, and everybody else's code is compiled as always. A function that is compiled because another
    one calls it is compiled inside the context of the other one.
    """
    if _under_way:
        yield
        return
    collecting, before = gc.isenabled(), [getattr(owner, name) for owner, name, _ in SHORTCUTS]
    gc.disable()
    _under_way.append(None)
    for owner, name, short in SHORTCUTS:
        setattr(owner, name, short)
    try:
        yield
    finally:
        for (owner, name, _), long in zip(SHORTCUTS, before, strict=True):
            setattr(owner, name, long)
        _under_way.clear()
        _found.clear()
        _attributes.clear()
        _values.clear()
        if collecting:
            _put_off_search()
            gc.enable()


def _put_off_search() -> None:
    """Leave what is new to the next full search for garbage: a search at once takes a tenth of the time of the compilation."""
    if not gc.get_freeze_count():  # else somebody keeps frozen objects
        gc.freeze()
        gc.unfreeze()
