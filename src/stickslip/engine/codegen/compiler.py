"""Compilation: the engine is compiled once, each friction formula once, both kept on disk (see `cache`).

Formulas are called through their addresses, so that a new law compiles its own few functions and nothing of the engine.
"""

from __future__ import annotations

import ctypes
import hashlib
from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.extending import intrinsic

from stickslip.engine.codegen.cache import load_module
from stickslip.engine.codegen.one_module import Kernel
from stickslip.engine.codegen.records import FLOATS, INTEGERS, Floats
from stickslip.engine.codegen.taylor_series import ORDER, FormulaWriter
from stickslip.engine.codegen.uncompiled import MATHS, UNCOMPILED, Pointer, as_python, call, handle_of, pointer_at
from stickslip.friction.formula.expression import Expression

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function of the engine, with the cache of this module."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, always put in place where it is called: for small functions in the innermost loops."""
    return _compiled(function, forceinline=True)


def _compiled(function: F, **options: bool) -> F:
    compiled: Any = as_python(function) if UNCOMPILED else Kernel(function, **options)
    return compiled


class CompiledFormula:
    """The functions of a friction formula (see `codegen.taylor_series`), and how many constants they need.

    Each is written, compiled and loaded when it is first asked for; what was compiled before comes from the disk.
    """

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rate: Expression | None = None) -> None:
        self._writer = FormulaWriter(formula, parameters, ORDER, state_rate)
        self._functions: dict[str, Any] = {}
        self.size = self._writer.size

    @property
    def guard_count(self) -> int:
        """The number of guards of the formula."""
        return len(self._writer.guards)

    def address(self, part: str) -> int:
        """Return the address of one of the functions, by its name: see `taylor_series.SIGNATURES`."""
        function = self._function(part)
        return int(function.handle if UNCOMPILED else function.address)

    def fill(self, values: Floats, reference: float, constants: Floats) -> None:
        """Fill the formula's constants from the values of its parameters and the reference slip (m)."""
        prepare = self._function("prepare")
        if UNCOMPILED:
            prepare(values, reference, constants)
        else:
            prepare.ctypes(values.ctypes.data_as(_DOUBLE), reference, constants.ctypes.data_as(_DOUBLE))

    def fill_guards(self, constants: Floats, slip: float, out: Floats) -> None:
        """Put arguments and pulls of the guards at a slip (m, minus the reference), at rest, into out."""
        guards = self._function("guards")
        if UNCOMPILED:
            guards(constants, slip, 0.0, 0.0, out)
        else:
            guards.ctypes(constants.ctypes.data_as(_DOUBLE), slip, 0.0, 0.0, out.ctypes.data_as(_DOUBLE))

    def _function(self, part: str) -> Any:
        if part not in self._functions:
            text = self._writer.module(part)
            name = f"{part}_{hashlib.sha256(text.encode()).hexdigest()[:20]}"
            function = getattr(load_module(name, text), part)
            if UNCOMPILED:
                function.__globals__.update(vars(MATHS))
                function.handle = handle_of(function)
            self._functions[part] = function
        return self._functions[part]


_DOUBLE = ctypes.POINTER(ctypes.c_double)


@cache
def compile_formula(formula: Expression, parameters: tuple[str, ...], state_rate: Expression | None = None) -> CompiledFormula:
    """The compiled functions of a formula (and of how its state changes), the same ones for every problem."""
    return CompiledFormula(formula, parameters, state_rate)


@intrinsic
def call_prepare(typingctx: Any, address: Any, parameters: Any, reference: Any, c: Any) -> Any:
    """prepare(parameters, reference, c) of the formula at `address`."""
    return types.void(types.int64, FLOATS, types.float64, FLOATS), _call


@intrinsic
def call_value(typingctx: Any, address: Any, c: Any, dx: Any, s: Any, out: Any) -> Any:
    """value(c, dx, s, out) of the formula at `address`."""
    return types.void(types.int64, FLOATS, types.float64, types.float64, FLOATS), _call


@intrinsic
def call_state_value(typingctx: Any, address: Any, c: Any, dx: Any, s: Any, w: Any, out: Any) -> Any:
    """state_value(c, dx, s, w, out) of the formula at `address`."""
    return types.void(types.int64, FLOATS, types.float64, types.float64, types.float64, FLOATS), _call


@intrinsic
def call_guards(typingctx: Any, address: Any, c: Any, dx: Any, s: Any, w: Any, out: Any) -> Any:
    """guards(c, dx, s, w, out) of the formula at `address`."""
    return types.void(types.int64, FLOATS, types.float64, types.float64, types.float64, FLOATS), _call


@intrinsic
def call_jet(typingctx: Any, address: Any, c: Any, k: Any, load: Any, s: Any) -> Any:
    """rate_jet or motion_jet(c, k, L, s) of the formula at `address`."""
    return types.void(types.int64, FLOATS, FLOATS, FLOATS, FLOATS), _call


def _call(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    kind = ir.FunctionType(ir.VoidType(), [argument.type for argument in args[1:]])
    builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
    return context.get_dummy_value()


@intrinsic
def call_step(typingctx: Any, address: Any, run: Any, xi_to: Any) -> Any:
    """Call a step of the engine that is compiled apart: step(memory of the run, xi_to)."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        whole = ir.IntType(64)
        kind = ir.FunctionType(ir.VoidType(), [whole, ir.DoubleType()])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), [builder.ptrtoint(args[1], whole), args[2]])
        return context.get_dummy_value()

    return types.void(types.int64, run, types.float64), codegen


@intrinsic
def floats(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to floats, which is indexed like an array."""
    return FLOATS(types.int64), _cast


@intrinsic
def integers(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to 64-bit integers."""
    return INTEGERS(types.int64), _cast


@intrinsic
def floats_in(typingctx: Any, array: Any) -> Any:
    """An array of floats as a pointer to the first of them; the caller keeps the array alive."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return context.make_array(signature.args[0])(context, builder, args[0]).data

    return FLOATS(array), codegen


def _cast(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return builder.inttoptr(args[0], context.get_value_type(signature.return_type))


@intrinsic
def ahead(typingctx: Any, pointer: Any, n: Any) -> Any:
    """The pointer to the number n places further on."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.gep(args[0], [args[1]])

    return pointer(pointer, types.int64), codegen


@intrinsic
def bits_of(typingctx: Any, number: Any) -> Any:
    """The 64 bits of a float as an integer."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@intrinsic
def float_of(typingctx: Any, bits: Any) -> Any:
    """The float with these 64 bits."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), codegen


if UNCOMPILED:
    call_prepare = call_value = call_state_value = call_guards = call_jet = call_step = call

    def floats(address: int) -> Pointer:
        """Return the pointer to floats at an address."""
        return pointer_at(address, np.float64)

    def integers(address: int) -> Pointer:
        """Return the pointer to whole numbers at an address."""
        return pointer_at(address, np.int64)

    def bits_of(number: float) -> np.int64:
        """Return the 64 bits of a float as an integer."""
        return np.float64(number).view(np.int64)

    def float_of(bits: int) -> np.float64:
        """Return the float with these 64 bits."""
        return np.int64(bits).view(np.float64)

    def floats_in(array: Floats) -> Pointer:
        """Return the pointer to the first number of an array."""
        return Pointer(array)

    def ahead(pointer: Pointer, n: int) -> Pointer:
        """Return the pointer to the number n places further on."""
        return pointer.ahead(n)
