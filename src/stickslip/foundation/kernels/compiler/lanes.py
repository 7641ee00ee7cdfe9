"""How machine code works on lanes, a type of several floats side by side (see `kernels.memory.simd`)."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.extending import lower_builtin, lower_cast, models, register_model

from stickslip.foundation.kernels.compiler.addresses import INTEGER, rule, typed_as
from stickslip.foundation.kernels.memory.simd import (
    ALIGNED,
    SIMD_WIDTH,
    bits_as_number,
    chosen,
    first_of,
    fused,
    power_of_two,
    store_across,
)

Writer = Callable[[Any, Any, list[Any]], Any]
"""Type of a function that writes the code of an operation, from the compiler's context and builder and the arguments."""

VECTOR = ir.VectorType(ir.DoubleType(), SIMD_WIDTH)
WHOLES = ir.VectorType(INTEGER, SIMD_WIDTH)
INDEX = ir.IntType(32)


class Lanes(types.Type):  # type: ignore[misc] # numba
    """The type of `SIMD_WIDTH` floats side by side."""

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
    return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(INDEX, SIMD_WIDTH), [0] * SIMD_WIDTH))


@lower_cast(types.Float, LANES)
def _cast(context: Any, builder: Any, from_type: Any, to_type: Any, number: Any) -> Any:
    """Write the automatic conversion of a float to lanes."""
    return _in_every_lane(builder, context.cast(builder, number, from_type, types.float64))


def _define(function: Any, arguments: int, write: Writer, result: Any = LANES) -> None:
    """Define a function for lanes, with the given number of arguments; an argument that is a single number holds in every lane."""

    def typed(*given: Any) -> Any:
        known = all(kind == LANES or isinstance(kind, (types.Float, types.Integer)) for kind in given)
        if LANES not in given or not known:
            return None
        return result(*(kind if kind == LANES else types.float64 for kind in given))

    typed_as(function, typed, arguments)

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
        return builder.call(builder.module.declare_intrinsic(f"llvm.{name}.v{SIMD_WIDTH}f64", (), kind), args)

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
        return builder.zext(builder.bitcast(builder.fcmp_ordered(sign, *args), ir.IntType(SIMD_WIDTH)), INTEGER)

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


def _fused_typed(a: Any, b: Any, c: Any) -> Any:
    kind = LANES if LANES in (a, b, c) else types.float64
    return kind(*(LANES if x == LANES else types.float64 for x in (a, b, c)))


@rule(fused, _fused_typed, 3)
def _fused(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    wide = LANES in sig.args
    numbers = [_in_every_lane(builder, x) if wide and of != LANES else x for x, of in zip(args, sig.args, strict=True)]
    made = numbers[0].type
    name = f"llvm.fmuladd.v{SIMD_WIDTH}f64" if wide else "llvm.fmuladd.f64"
    return builder.call(builder.module.declare_intrinsic(name, (), ir.FunctionType(made, [made] * 3)), numbers)


@rule(chosen, lambda which, yes, no: LANES(types.int64, yes, no), 3)
def _chosen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    mask = builder.bitcast(builder.trunc(args[0], ir.IntType(SIMD_WIDTH)), ir.VectorType(ir.IntType(1), SIMD_WIDTH))
    lanes = [x if kind == LANES else _in_every_lane(builder, x) for x, kind in zip(args[1:], sig.args[1:], strict=True)]
    return builder.select(mask, *lanes)


@rule(first_of, lambda bits: types.int64(types.int64), 1)
def _first_of(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))


@rule(store_across, lambda rows, targets, first: types.void(POINTER, types.CPointer(types.int64), types.int64), 3)
def _store_across(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    lines = [builder.load(builder.gep(args[0], [builder.add(args[2], _constant(INTEGER, n))])) for n in range(SIMD_WIDTH)]
    for apart in (2**n for n in range(SIMD_WIDTH.bit_length() - 1)):
        lines = [_exchanged(builder, lines[n & ~apart], lines[n | apart], apart, bool(n & apart)) for n in range(SIMD_WIDTH)]
    for n, line in enumerate(lines):
        address = builder.load(builder.gep(args[1], [_constant(INTEGER, n)]))
        target = builder.gep(builder.inttoptr(address, ir.DoubleType().as_pointer()), [args[2]])
        builder.store(line, builder.bitcast(target, VECTOR.as_pointer()), align=8)
    return context.get_dummy_value()


def _exchanged(builder: Any, low: Any, high: Any, apart: int, upper: bool) -> Any:
    """Write one of two vectors whose numbers `apart` places from each other are exchanged: a step of turning rows into columns."""
    places = [n + upper * apart if not n & apart else SIMD_WIDTH + n - apart + upper * apart for n in range(SIMD_WIDTH)]
    return builder.shuffle_vector(low, high, ir.Constant(ir.VectorType(INDEX, SIMD_WIDTH), places))


@rule(bits_as_number, lambda x: x(x), 1)
def _bits_as_number(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Lanes are read as integers without a sign: only these are converted side by side without registers of 512 bits."""
    if sig.args[0] == LANES:
        return builder.uitofp(builder.bitcast(args[0], WHOLES), VECTOR)
    return builder.sitofp(builder.bitcast(args[0], INTEGER), args[0].type)


@rule(power_of_two, lambda n: n(n), 1)
def _power_of_two(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    kind = WHOLES if sig.args[0] == LANES else INTEGER
    moved = builder.fadd(args[0], _number(args[0].type, ALIGNED + 1023.0))
    return builder.bitcast(builder.shl(builder.bitcast(moved, kind), _constant(kind, 52)), args[0].type)


def _number(kind: Any, number: float) -> Any:
    """Return a constant of the type of floats or of lanes, in every lane if the type has lanes."""
    return ir.Constant(kind, [number] * SIMD_WIDTH if kind == VECTOR else number)


def _constant(kind: Any, number: int) -> Any:
    """Return an integer constant of the given type, in every lane if the type has lanes."""
    return ir.Constant(kind, [number] * SIMD_WIDTH if kind == WHOLES else number)
