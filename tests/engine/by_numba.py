"""Compile the functions of formulas by numba, for floats and for lanes: what `formula_machine` must equal bit for bit."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib.util import find_spec, module_from_spec
from typing import Any

import llvmlite.ir as ir
from numba import cfunc, njit, types
from numba.extending import intrinsic

from stickslip.engine.compile.numba_privates import signature
from stickslip.engine.compile.one_module import LeanCompiler
from stickslip.engine.compiled_formula import NAMES
from stickslip.engine.formula_code.taylor_series import SIDE_BY_SIDE, SIGNATURES, FormulaWriter
from stickslip.engine.memory import simd
from stickslip.engine.memory.simd import INDEX, LANES, VECTOR, WIDTH
from stickslip.friction.formula.operations import OPERATIONS
from tests.engine.formulas import FLOATS

MATHS = {one.in_math: getattr(math, one.in_math) for one in OPERATIONS.values() if not one.sign}
OPTIONS = {"error_model": "numpy", "fastmath": {"contract"}}


def _each_by_itself(function: Any) -> Callable[[Any, Any, list[Any]], Any]:
    """Return the writer of a function that is called for one lane after the other."""

    def write(context: Any, builder: Any, args: list[Any]) -> Any:
        result = ir.Constant(VECTOR, ir.Undefined)
        for n in range(WIDTH):
            one = [builder.extract_element(args[0], ir.Constant(INDEX, n))]
            found = context.compile_internal(builder, lambda x: function(x), signature(types.float64, types.float64), one)
            result = builder.insert_element(result, found, ir.Constant(INDEX, n))
        return result

    return write


for _function in MATHS.values():
    if _function is not math.sqrt:
        simd._define(_function, 1, _each_by_itself(_function))


@intrinsic
def _lane(typingctx: Any, numbers: Any, n: Any) -> Any:
    """Return a tuple of floats: the lane n of each of the given numbers; a single float is returned as it is."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        given = [builder.extract_value(args[0], i) for i in range(len(numbers))]
        own = [builder.extract_element(x, args[1]) if kind == LANES else x for x, kind in zip(given, numbers, strict=True)]
        return context.make_tuple(builder, signature.return_type, own)

    return types.UniTuple(types.float64, len(numbers))(numbers, types.int64), codegen


@intrinsic
def _joined(typingctx: Any, numbers: Any) -> Any:
    """Return WIDTH floats, given as a tuple, as lanes."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        result = ir.Constant(VECTOR, ir.Undefined)
        for n in range(WIDTH):
            result = builder.insert_element(result, builder.extract_value(args[0], n), ir.Constant(INDEX, n))
        return result

    return LANES(numbers), codegen


def _lane_by_lane(function: Any) -> Any:
    """Return a compiled function of lanes that calls a compiled function of floats in each lane."""

    @njit(**OPTIONS)
    def of_lanes(*numbers: Any) -> Any:
        return _joined((
            function(*_lane(numbers, 0)), function(*_lane(numbers, 1)), function(*_lane(numbers, 2)), function(*_lane(numbers, 3)),
            function(*_lane(numbers, 4)), function(*_lane(numbers, 5)), function(*_lane(numbers, 6)), function(*_lane(numbers, 7)),
        ))  # fmt: skip

    return of_lanes


def _copy_of(name: str) -> dict[str, Any]:
    """Return the names of a module that is loaded once more."""
    spec = find_spec(name)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return vars(module)


RADII = _copy_of("stickslip.engine.series.ball_radii")
"""Functions of radii that nothing else has compiled: numba gives them other last bits if they were first called from Python."""
IN_LANES = {name: _lane_by_lane(one) for name, one in FLOATS.items()}


def by_numba(writer: FormulaWriter, part: str) -> Any:
    """A function of a formula, compiled by numba, with its `address`."""
    lanes = part in SIDE_BY_SIDE
    array = simd.POINTER if lanes else types.CPointer(types.float64)
    kinds = [array if name.endswith("[]") else types.float64 for name in SIGNATURES[part]]
    scope = {**NAMES, **RADII, **MATHS, **(IN_LANES if lanes else FLOATS)}
    head = f"def {part}({', '.join(name.strip('[]') for name in SIGNATURES[part])}):\n"
    exec(head + "".join(f"    {line}\n" for line in writer.statements(part)), scope)
    return cfunc(types.void(*kinds), nopython=True, pipeline_class=LeanCompiler, **OPTIONS)(scope[part])
