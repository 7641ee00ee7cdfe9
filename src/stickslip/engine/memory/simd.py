"""Define lanes, a type of compiled code: four or eight floats side by side, on which the processor works at once.

A function written for floats serves lanes as well. Compiled for lanes, it computes in each lane exactly what it computes for a
float, bit for bit. It must not contain decisions (if, while) that depend on lanes.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import llvmlite.ir as ir
import numpy as np
from llvmlite.binding import get_host_cpu_features
from numba import types
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model

from stickslip.engine.compile.numba_privates import AbstractTemplate, infer_global, signature
from stickslip.engine.compile.uncompiled import UNCOMPILED

WIDTH = 8 if get_host_cpu_features().get("avx512f", False) else 4
"""Number of lanes: as many as fit in a register of this processor, or in two of 128 bits."""

ALIGNED = 1.5 * 2.0**52
"""A float (1) whose last bits are those of the whole number that is added to it."""

Writer = Callable[[Any, Any, list[Any]], Any]
"""Type of a function that writes the code of an operation, from the compiler's context and builder and the arguments."""

VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
WHOLE = ir.IntType(64)
WHOLES = ir.VectorType(WHOLE, WIDTH)
INDEX = ir.IntType(32)


class Lanes(types.Type):  # type: ignore[misc] # numba
    """The type of `WIDTH` floats side by side."""

    def __init__(self) -> None:
        super().__init__("Lanes")


LANES = Lanes()
POINTER = types.CPointer(LANES)


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):  # type: ignore[misc] # numba
    """The representation of lanes in machine code: a vector register."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


def _in_every_lane(builder: Any, number: Any) -> Any:
    """Write the conversion of a float to lanes that all hold it."""
    first = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), number, ir.Constant(INDEX, 0))
    return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(INDEX, WIDTH), [0] * WIDTH))


@lower_cast(types.Float, LANES)
def _cast(context: Any, builder: Any, from_type: Any, to_type: Any, number: Any) -> Any:
    """Write the automatic conversion of a float to lanes."""
    return _in_every_lane(builder, context.cast(builder, number, from_type, types.float64))


def _define(function: Any, arguments: int, write: Writer, result: Any = LANES) -> None:
    """Define a function for lanes, with the given number of arguments; an argument that is a single number holds in every lane."""

    def generic(self: Any, args: tuple[Any, ...], keywords: Any) -> Any:
        known = all(kind == LANES or isinstance(kind, (types.Float, types.Integer)) for kind in args)
        if len(args) != arguments or LANES not in args or not known:
            return None
        return signature(result, *(kind if kind == LANES else types.float64 for kind in args))

    infer_global(function)(type(f"Lanes_{function.__name__}", (AbstractTemplate,), {"generic": generic}))

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        lanes = [x if kind == LANES else _in_every_lane(builder, x) for x, kind in zip(args, sig.args, strict=True)]
        return write(context, builder, lanes)

    for which in range(1, 2**arguments):
        lower_builtin(function, *(LANES if which >> n & 1 else types.float64 for n in range(arguments)))(lower)


def _instruction(name: str) -> Writer:
    """Return the writer of an operation that is one instruction of LLVM."""
    return lambda context, builder, args: getattr(builder, name)(*args)


def _of_the_processor(name: str) -> Writer:
    """Return the writer of a function of one argument that LLVM provides for vectors."""
    kind = ir.FunctionType(VECTOR, [VECTOR])

    def write(context: Any, builder: Any, args: list[Any]) -> Any:
        return builder.call(builder.module.declare_intrinsic(f"llvm.{name}.v{WIDTH}f64", (), kind), args)

    return write


def _smaller(context: Any, builder: Any, args: list[Any]) -> Any:
    """Write min(a, b) as Python has it: a unless b < a."""
    return builder.select(builder.fcmp_ordered("<", args[1], args[0]), args[1], args[0])


def _larger(context: Any, builder: Any, args: list[Any]) -> Any:
    """Write max(a, b) as Python has it: a unless b > a."""
    return builder.select(builder.fcmp_ordered(">", args[1], args[0]), args[1], args[0])


def _comparison(sign: str) -> Writer:
    """Return the writer of a comparison. Its result is a whole number with one bit for each lane, the lowest for lane 0."""

    def write(context: Any, builder: Any, args: list[Any]) -> Any:
        return builder.zext(builder.bitcast(builder.fcmp_ordered(sign, *args), ir.IntType(WIDTH)), WHOLE)

    return write


for _operators, _name in (
    ((operator.add, operator.iadd), "fadd"),
    ((operator.sub, operator.isub), "fsub"),
    ((operator.mul, operator.imul), "fmul"),
    ((operator.truediv, operator.itruediv), "fdiv"),
):
    for _operator in _operators:
        _define(_operator, 2, _instruction(_name))
for _operator, _sign in ((operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "==")):
    _define(_operator, 2, _comparison(_sign), types.int64)
_define(operator.neg, 1, _instruction("fneg"))
_define(abs, 1, _of_the_processor("fabs"))
_define(math.sqrt, 1, _of_the_processor("sqrt"))
_define(np.floor, 1, _of_the_processor("floor"))
_define(min, 2, _smaller)
_define(max, 2, _larger)


@intrinsic
def fused(typingctx: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a b + c, of floats or lanes, in one operation where the processor has it: which product is fused shortens chains."""
    kind = LANES if LANES in (a, b, c) else types.float64

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        numbers = [_in_every_lane(builder, x) if kind == LANES and of != LANES else x for x, of in zip(args, sig.args, strict=True)]
        made = numbers[0].type
        name = f"llvm.fmuladd.v{WIDTH}f64" if kind == LANES else "llvm.fmuladd.f64"
        function = builder.module.declare_intrinsic(name, (), ir.FunctionType(made, [made] * 3))
        return builder.call(function, numbers)

    return kind(*(LANES if x == LANES else types.float64 for x in (a, b, c))), codegen


@intrinsic
def chosen(typingctx: Any, which: Any, yes: Any, no: Any) -> Any:
    """Return `yes` where a comparison of lanes holds and `no` elsewhere; a single float holds in every lane."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        mask = builder.bitcast(builder.trunc(args[0], ir.IntType(WIDTH)), ir.VectorType(ir.IntType(1), WIDTH))
        lanes = [x if kind == LANES else _in_every_lane(builder, x) for x, kind in zip(args[1:], sig.args[1:], strict=True)]
        return builder.select(mask, *lanes)

    return LANES(types.int64, yes, no), codegen


@intrinsic
def first_of(typingctx: Any, bits: Any) -> Any:
    """Return the place of the lowest bit that is set in a whole number other than 0."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))

    return types.int64(types.int64), codegen


@intrinsic
def store_across(typingctx: Any, rows: Any, targets: Any, first: Any) -> Any:
    """Store the places from `first` to `first` + WIDTH - 1 of rows in lanes: for lane n at the address targets[n] + 8 `first`."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        lines = [builder.load(builder.gep(args[0], [builder.add(args[2], _constant(WHOLE, n))])) for n in range(WIDTH)]
        for apart in (2**n for n in range(WIDTH.bit_length() - 1)):
            lines = [_exchanged(builder, lines[n & ~apart], lines[n | apart], apart, bool(n & apart)) for n in range(WIDTH)]
        for n, line in enumerate(lines):
            address = builder.load(builder.gep(args[1], [_constant(WHOLE, n)]))
            target = builder.gep(builder.inttoptr(address, ir.DoubleType().as_pointer()), [args[2]])
            builder.store(line, builder.bitcast(target, VECTOR.as_pointer()), align=8)
        return context.get_dummy_value()

    return types.void(POINTER, types.CPointer(types.int64), types.int64), codegen


def _exchanged(builder: Any, low: Any, high: Any, apart: int, upper: bool) -> Any:
    """Write one of two vectors whose numbers `apart` places from each other are exchanged: a step of turning rows into columns."""
    places = [n + upper * apart if not n & apart else WIDTH + n - apart + upper * apart for n in range(WIDTH)]
    return builder.shuffle_vector(low, high, ir.Constant(ir.VectorType(INDEX, WIDTH), places))


@intrinsic
def bits_as_number(typingctx: Any, x: Any) -> Any:
    """Return the 64 bits of a float that is not negative, or of each lane, read as an integer and converted to a float.

    Lanes are read as integers without a sign: only these are converted side by side by processors without registers of 512 bits.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if x == LANES:
            return builder.uitofp(builder.bitcast(args[0], WHOLES), VECTOR)
        return builder.sitofp(builder.bitcast(args[0], WHOLE), args[0].type)

    return x(x), codegen


@intrinsic
def power_of_two(typingctx: Any, n: Any) -> Any:
    """Return 2^n for a whole number n that is given as a float, or for lanes of such; the result must be a normal number."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = WHOLES if n == LANES else WHOLE
        moved = builder.fadd(args[0], _number(args[0].type, ALIGNED + 1023.0))
        return builder.bitcast(builder.shl(builder.bitcast(moved, kind), _constant(kind, 52)), args[0].type)

    return n(n), codegen


def _number(kind: Any, number: float) -> Any:
    """Return a constant of the type of floats or of lanes, in every lane if the type has lanes."""
    return ir.Constant(kind, [number] * WIDTH if kind == VECTOR else number)


def _constant(kind: Any, number: int) -> Any:
    """Return an integer constant of the given type, in every lane if the type has lanes."""
    return ir.Constant(kind, [number] * WIDTH if kind == WHOLES else number)


if UNCOMPILED:

    def fused(a: Any, b: Any, c: Any) -> Any:
        """Return a b + c."""
        return a * b + c

    def bits_as_number(x: Any) -> Any:
        """Return the 64 bits of a float, read as an integer and converted to a float."""
        return np.float64(np.float64(x).view(np.int64))

    def power_of_two(n: Any) -> Any:
        """Return 2^n for a whole number n that is given as a float."""
        return np.ldexp(1.0, int(n)) if np.isfinite(n) else np.float64(n)
