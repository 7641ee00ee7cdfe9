"""Compilation: the engine is compiled once, each friction formula once, both kept on disk (see `cache`).

Formulas are called through their addresses, so that a new law compiles its own few functions and nothing of the engine.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache, cached_property
from typing import Any, TypeVar

import llvmlite.ir as ir
from numba import types
from numba.extending import intrinsic

from stickslip.engine.codegen.cache import load_module
from stickslip.engine.codegen.one_module import Kernel
from stickslip.engine.codegen.records import FLOATS, INTEGERS
from stickslip.engine.codegen.taylor_series import ORDER, FormulaWriter
from stickslip.friction.formula.expression import Expression

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function of the engine, with the cache of this module."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, always put in place where it is called: for small functions in the innermost loops."""
    return _compiled(function, forceinline=True)


def _compiled(function: F, **options: bool) -> F:
    compiled: Any = Kernel(function, **options)
    return compiled


class CompiledFormula:
    """A formula's C functions (see `codegen.taylor_series`): `prepare` to be called, the addresses of the others, and how many
    constants.

    Each is written, compiled and loaded when it is first asked for; what was compiled before comes from the disk.
    """

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rate: Expression | None = None) -> None:
        self._writer = FormulaWriter(formula, parameters, ORDER, state_rate)
        self.size = self._writer.size

    def _function(self, part: str) -> Any:
        text = self._writer.module(part)
        name = f"{part}_{hashlib.sha256(text.encode()).hexdigest()[:20]}"
        return getattr(load_module(name, text), part)

    @property
    def guard_count(self) -> int:
        """How many guards the formula has."""
        return len(self._writer.guards)

    @cached_property
    def guards(self) -> int:
        """Address of guards(c, dx, s, w, out)."""
        return int(self._function("guards").address)

    @cached_property
    def prepare(self) -> Callable[..., None]:
        """prepare(parameters, reference slip, constants) through ctypes."""
        function: Callable[..., None] = self._function("prepare").ctypes
        return function

    @cached_property
    def prepare_at(self) -> int:
        """Address of prepare(parameters, reference slip, constants)."""
        return int(self._function("prepare").address)

    @cached_property
    def value(self) -> int:
        """Address of value(c, dx, s, out)."""
        return int(self._function("value").address)

    @cached_property
    def state_value(self) -> int:
        """Address of state_value(c, dx, s, w, out)."""
        return int(self._function("state_value").address)

    @cached_property
    def rate_jet(self) -> int:
        """Address of rate_jet(c, k, L, s)."""
        return int(self._function("rate_jet").address)

    @cached_property
    def motion_jet(self) -> int:
        """Address of motion_jet(c, k, L, s)."""
        return int(self._function("motion_jet").address)

    @cached_property
    def rate_jets(self) -> int:
        """Address of rate_jet for lanes."""
        return int(self._function("rate_jets").address)

    @cached_property
    def motion_jets(self) -> int:
        """Address of motion_jet for lanes."""
        return int(self._function("motion_jets").address)


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
def floats(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to floats, which is indexed like an array."""
    return FLOATS(types.int64), _cast


@intrinsic
def integers(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to 64-bit integers."""
    return INTEGERS(types.int64), _cast


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
