"""How machine code calls functions at addresses, and reads bits and addresses (see `kernels.memory.addresses`)."""

from __future__ import annotations

from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.core.cgutils import alloca_once
from numba.extending import lower_builtin, type_callable

from stickslip.foundation.kernels.memory.addresses import CallAt, ahead, bits_of, float_of, floats, integers, room_for

FLOATS, INTEGERS = types.CPointer(types.float64), types.CPointer(types.int64)
INTEGER = ir.IntType(64)
OF_KINDS = {"p": FLOATS, "d": types.float64, "i": types.int64, "": types.void}
"""What numba makes of the letters of a `CallAt`; memory is taken as it comes, and handed on as an address."""

Writer = Callable[[Any, Any, Any, Any], Any]
"""Type of a function that writes the code of a call, from the compiler's context and builder, the signature and the arguments."""


def typed_as(function: Any, typed: Callable[..., Any], arguments: int) -> None:
    """Tell numba what `typed` says of the types of a function's arguments: the signature of the call, or None if it has none."""

    def of_these(*given: Any) -> Any:
        return typed(*given)

    names = (Parameter(f"x{n}", Parameter.POSITIONAL_ONLY) for n in range(arguments))  # numba counts arguments by their names
    of_these.__signature__ = Signature(list(names))  # type: ignore[attr-defined]
    type_callable(function)(lambda context: of_these)


def rule(function: Any, typed: Callable[..., Any], arguments: int) -> Callable[[Writer], Writer]:
    """Return a decorator for what writes the calls of a function that has so many arguments (see `typed_as`)."""
    typed_as(function, typed, arguments)
    return lower_builtin(function, *[types.Any] * arguments)


def register() -> None:
    """Make rules for all functions that call at an address."""
    while CallAt.known:
        _register(CallAt.known.pop())


def _register(one: CallAt) -> None:
    kinds, result = one.kinds, OF_KINDS[one.result]

    def typed(*given: Any) -> Any:
        known = [is_given if kind == "m" else OF_KINDS[kind] for kind, is_given in zip(kinds, given[1:], strict=True)]
        return result(types.int64, *known)

    @rule(one, typed, len(kinds) + 1)
    def write(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = [builder.ptrtoint(x, INTEGER) if kind == "m" else x for kind, x in zip(kinds, arguments[1:], strict=True)]
        returned = context.get_value_type(result) if one.result else ir.VoidType()
        kind = ir.FunctionType(returned, [x.type for x in given])
        found = builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), given)
        return found if one.result else context.get_dummy_value()


@rule(floats, lambda address: FLOATS(types.int64), 1)
@rule(integers, lambda address: INTEGERS(types.int64), 1)
def _pointer(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))


def array_at(address: Any, shape: Any) -> Any:
    """Return, in compiled code, the array of a shape whose numbers lie behind a pointer, without gaps in the order of C."""


@rule(array_at, lambda pointer, shape: types.Array(pointer.dtype, len(shape), "C")(pointer, shape), 2)
def _array_at(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    (pointer, shape), kind = arguments, signature.return_type
    array, lengths = context.make_array(kind)(context, builder), builder.extract_value
    size = ir.Constant(INTEGER, context.get_abi_sizeof(context.get_data_type(kind.dtype)))
    strides, count = [size], ir.Constant(INTEGER, 1)
    for n in reversed(range(kind.ndim)):
        count = builder.mul(count, lengths(shape, n))
        strides.insert(0, builder.mul(strides[0], lengths(shape, n)))
    array.data, array.itemsize, array.nitems = builder.bitcast(pointer, array.data.type), size, count
    array.meminfo, array.parent = (context.get_constant_null(of) for of in (types.voidptr, types.pyobject))
    array.shape = builder.bitcast(shape, array.shape.type) if shape.type != array.shape.type else shape
    for n, stride in enumerate(strides[1:]):
        array.strides = builder.insert_value(array.strides, stride, n)
    return array._getvalue()


@rule(ahead, lambda pointer, n: pointer(pointer, types.int64), 2)
def _ahead(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.gep(arguments[0], [arguments[1]])


@rule(room_for, lambda n: FLOATS(n) if isinstance(n, types.Literal) else None, 1)
def _room_for(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return alloca_once(builder, ir.DoubleType(), size=ir.Constant(INTEGER, signature.args[0].literal_value))


@rule(bits_of, lambda number: types.int64(types.float64), 1)
def _bits_of(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.bitcast(arguments[0], INTEGER)


@rule(float_of, lambda bits: types.float64(types.int64), 1)
def _float_of(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.bitcast(arguments[0], ir.DoubleType())
