"""A formula for every operation that a law may contain, and the types of the functions compiled from it."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.engine.codegen.compiler import compile_formula
from stickslip.engine.enclosure.formula import bound_at_slips, bound_friction, formulas_of
from stickslip.friction.formula import expression as e
from stickslip.friction.formula.expression import Expression


def enclose(
    tree: Expression, parameters: Mapping[str, float], slip: float | tuple[float, float], low: ArrayLike, high: ArrayLike
) -> NDArray[np.float64]:
    """Bounds of mu, dmu/dv and d2mu/dv2, shape (3, 2, cells), at a slip or between two, on cells of slip rates."""
    formulas = formulas_of([tree], tuple(parameters), np.array([list(parameters.values())], float).reshape(1, -1))
    slips = slip if isinstance(slip, tuple) else (slip, slip)
    found = []
    for one, other in zip(np.atleast_1d(low).tolist(), np.atleast_1d(high).tolist(), strict=True):
        bound_at_slips(formulas, 0, *slips)
        found.append(np.array(bound_friction(formulas, 0, one, other)).reshape(3, 2) * [[1.0], [1.0], [2.0]])
    return np.stack(found, axis=-1)


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


def compiled(formula: Formula, reference: float) -> tuple[Any, np.ndarray]:
    functions = compile_formula(e.as_expression(formula(e, e.SLIP, e.RATE)), (), ())
    constants, none = np.zeros(functions.size), np.zeros(1)
    functions.fill(none, reference, constants)
    return functions, constants
