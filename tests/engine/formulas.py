"""A formula for every operation that a law may contain, and the types of the functions compiled from it."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip.engine.codegen.compiler import compile_formula
from stickslip.friction.formula import expression as e

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
