"""Addresses and bits, which compiled code reads, writes and calls; plain Python versions serve where the compiler is switched off.

The engine calls formulas and parts of itself through their addresses, so that a new law compiles nothing of the engine.
"""

from __future__ import annotations

from inspect import Parameter, Signature
from typing import Any

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.core.cgutils import alloca_once
from numba.extending import intrinsic

from stickslip.engine.compile.uncompiled import UNCOMPILED, Pointer, call, pointer_at
from stickslip.engine.memory.pointers import numbers_of, whole_numbers_of
from stickslip.engine.memory.records import FLOATS


def calls(kinds: str) -> Any:
    """Return a function for compiled code that calls a C function without result at an address, its first argument.

    `kinds` are those of the other arguments: p for a pointer to floats, d for a float.
    """
    if UNCOMPILED:
        return call
    types_of = types.void(types.int64, *(FLOATS if kind == "p" else types.float64 for kind in kinds))

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [argument.type for argument in args[1:]])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value()

    def calling(typingctx: Any, *arguments: Any) -> Any:
        return types_of, codegen

    names = ("typingctx", "address", *(f"{kind}{n}" for n, kind in enumerate(kinds)))  # numba counts arguments by their names
    calling.__signature__ = Signature([Parameter(name, Parameter.POSITIONAL_ONLY) for name in names])  # type: ignore[attr-defined]
    return intrinsic(calling)


call_prepare = calls("pdp")
"""Call `prepare(parameters, reference, c)` of a formula."""
call_value, call_state_value = calls("pddp"), calls("pddpp")
"""Call `value(c, dx, s, out)` or `state_value(c, dx, s, states, out)` of a formula."""
call_values = call_radii = calls("ppp")
"""Call `values_in_lanes(c, at, out)`, or `radii(c, s, k)` or `balls(c, s, k)`; `at` holds slip (m) and slip rate (m/s)."""
call_jet = calls("pppp")
"""Call `rate_jet(c, k, L, s)` or `motion_jet(c, k, L, s)`."""


PART = (types.int64, types.int64, types.float64)
"""Arguments of a part of the engine that is compiled apart: the address of the run's memory, a code of `Task`, and a number."""


@intrinsic
def call_part(typingctx: Any, address: Any, run: Any, task: Any, number: Any) -> Any:
    """Call the part of the engine at an address, which is compiled apart: part(memory of the run, task, number) -> float."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        convention = context.call_conv
        function = builder.inttoptr(args[0], convention.get_function_type(types.float64, PART).as_pointer())
        memory = builder.ptrtoint(args[1], ir.IntType(64))
        _, result = convention.call_function(builder, function, types.float64, PART, [memory, args[2], args[3]])
        return result

    return types.float64(types.int64, run, types.int64, types.float64), codegen


floats, integers = numbers_of, whole_numbers_of
"""An address as a pointer to floats, or to 64-bit integers, which is indexed like an array."""


@intrinsic
def ahead(typingctx: Any, pointer: Any, n: Any) -> Any:
    """Return the pointer to the number n places after the one that `pointer` points to."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.gep(args[0], [args[1]])

    return pointer(pointer, types.int64), codegen


@intrinsic(prefer_literal=True)
def room_for(typingctx: Any, n: Any) -> Any:
    """Return a pointer to room for n floats that lasts as long as the function that asks for it; n is a constant."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return alloca_once(builder, ir.DoubleType(), size=ir.Constant(ir.IntType(64), n.literal_value))

    return FLOATS(n), codegen


@intrinsic
def bits_of(typingctx: Any, number: Any) -> Any:
    """Return the 64 bits of a float as an integer."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@intrinsic
def float_of(typingctx: Any, bits: Any) -> Any:
    """Return the float with the given 64 bits."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), codegen


if UNCOMPILED:
    call_part = call

    def floats(address: int) -> Pointer:
        """Return the pointer to floats at an address."""
        return pointer_at(address, np.float64)

    def integers(address: int) -> Pointer:
        """Return the pointer to 64-bit integers at an address."""
        return pointer_at(address, np.int64)

    def room_for(n: int) -> Pointer:
        """Return a pointer to room for n floats."""
        return Pointer(np.full(n, np.nan))

    def bits_of(number: float) -> np.int64:
        """Return the 64 bits of a float as an integer."""
        return np.float64(number).view(np.int64)

    def float_of(bits: int) -> np.float64:
        """Return the float with the given 64 bits."""
        return np.int64(bits).view(np.float64)

    def ahead(pointer: Pointer, n: int) -> Pointer:
        """Return the pointer to the number n places after the one that `pointer` points to."""
        return pointer.ahead(n)
