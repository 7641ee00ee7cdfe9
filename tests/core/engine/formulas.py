"""A formula for every operation that a law may contain, and the types of the functions compiled from it."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.engine.compiled_formula import CALLED, compile_formula
from stickslip.engine.formula_code.recurrences import Recurrences
from stickslip.engine.formula_code.taylor_series import ORDER, FormulaWriter
from stickslip.engine.series.sine import sine, versine
from stickslip.foundation.kernels.uncompiled import MATHS
from stickslip.friction.formula import expression as e
from stickslip.friction.formula import functions as elementary
from stickslip.friction.formula.bounds import Enclosure
from stickslip.friction.formula.expression import Expression
from tests.core.engine.compiled import compiled


def enclose(
    tree: Expression, parameters: Mapping[str, float], slip: float | tuple[float, float], low: ArrayLike, high: ArrayLike
) -> NDArray[np.float64]:
    """Bounds of mu, dmu/dv and d2mu/dv2, shape (3, 2, cells), at a slip or between two, on cells of slip rates."""
    ends = np.broadcast_arrays(np.atleast_1d(np.asarray(low, float)), np.asarray(high, float))
    bounds = Enclosure((tree,), parameters, slip).on(*ends, np.arange(len(ends[0])))
    found = np.zeros((3, 2, len(ends[0])))
    found[: bounds.shape[1]] = np.moveaxis(bounds, 0, 1)
    with np.errstate(over="ignore"):
        found[2] *= 2.0
    return found


FLOATS = {name: compiled(function) for name, function in {**CALLED, "sine": sine, "versine": versine}.items()}
"""The functions that operations and formulas call, compiled by numba."""

DOUBLE = ctypes.POINTER(ctypes.c_double)
JET = ctypes.CFUNCTYPE(None, DOUBLE, DOUBLE, DOUBLE, DOUBLE)
VALUE = ctypes.CFUNCTYPE(None, DOUBLE, ctypes.c_double, ctypes.c_double, DOUBLE)

Formula = Callable[[Any, Any, Any], Any]

FORMULAS: dict[str, Formula] = {
    "sin": lambda f, u, v: 1.0 + 0.3 * f.sin(5.0 * u),
    "cos": lambda f, u, v: 1.0 + 0.3 * f.cos(5.0 * u + v),
    "exp": lambda f, u, v: 0.3 + 0.5 * f.exp(-4.0 * u),
    "log": lambda f, u, v: 0.3 + 0.1 * f.log(1.0 + 3.0 * u + v),
    "sqrt": lambda f, u, v: 0.3 + 0.2 * f.sqrt(1.0 + u * u),
    "tanh": lambda f, u, v: 0.6 - 0.2 * f.tanh(3.0 * u - v),
    "arcsinh": lambda f, u, v: 0.5 + 0.05 * f.arcsinh(2.0 * v + u),
    "expm1": lambda f, u, v: 0.4 + 0.2 * f.expm1(-2.0 * v - u),
    "log1p": lambda f, u, v: 0.4 + 0.1 * f.log1p(3.0 * v + 2.0 * u),
    "quotient": lambda f, u, v: 0.3 + 0.5 / (1.0 + 2.0 * v),
    "product": lambda f, u, v: (0.9 - 0.2 * u) * (0.7 + 0.1 * v),
    "power": lambda f, u, v: 0.3 + 0.2 * (1.0 + u) ** -1.7,
}


def pointer(array: np.ndarray) -> Any:
    return array.ctypes.data_as(DOUBLE)


def functions_of(formula: Formula, reference: float) -> tuple[Any, np.ndarray]:
    functions = compile_formula(e.as_expression(formula(elementary, e.SLIP, e.RATE)), (), ())
    constants, none = np.zeros(functions.size), np.zeros(1)
    functions.fill(none, reference, constants)
    return functions, constants


def series(formula: Expression, x_ref: float, slip: list[float], rate: list[float] | None = None) -> tuple[list[float], float]:
    """Return the Taylor coefficients of a formula along given series of slip (difference from x_ref) and slip rate.

    Without a slip rate it is the derivative of the slip. The second result is the difference of the formula from its value at x_ref
    and rate 0. Both come from the generated text.
    """
    writer = Recurrences(formula, ())
    names: dict[str, Any] = {**vars(MATHS), **FLOATS, "x_ref": x_ref, "c": [0.0] * writer.size}
    rate = rate or [k * x for k, x in enumerate([*slip, 0.0])][1:]
    names |= {"dx": slip[0], "p": [], "fused": lambda a, b, c: a * b + c} | {f"s_{k}": rate[k] for k in range(ORDER + 1)}
    lines = [f"c[{writer.index[node]}] = {writer.reference_value(node)}" for node in writer.nodes] + writer.order_zero()
    lines += writer.before_orders("1.0", "0.0")
    for k in range(1, ORDER + 1):
        names[f"x_{k}"] = slip[k]
        lines += [*writer.order(k), *writer.weights(k)]
    exec("\n".join(lines), names)
    coefficients = [names[str(writer.coefficient(formula, k))] for k in range(ORDER + 1)]
    return coefficients, names[str(writer.difference(formula))]


def written_slopes(formula: Expression, x_ref: float, dx: float, rate: float) -> tuple[float, float]:
    """Return the derivatives of a formula by slip rate (s/m) and slip (1/m) from the generated text."""
    writer, out = FormulaWriter(formula, ()), [0.0] * 3
    names: dict[str, Any] = {**vars(MATHS), **FLOATS, "x_ref": x_ref, "c": [0.0] * writer.size}
    exec("\n".join([*writer.prepare(), *writer.value()]), names | {"dx": dx, "s": rate, "p": [], "out": out})
    return out[1], out[2]
