"""Functions of numbers, arrays and formulas, named as in numpy; and formulas as functions of numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import STATES, VARIABLES, Expression, as_expression, instead, nodes_of
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS, operation_of

sin, cos, exp, log, sqrt, tanh, arcsinh, expm1, log1p = (
    OPERATIONS[name] for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "arcsinh", "expm1", "log1p")
)

COMPOSED: dict[str, Callable[..., Any]] = {
    "square": lambda x: x * x,
    "reciprocal": lambda x: 1.0 / x,
    "log10": lambda x: log(x) / math.log(10.0),
    "log2": lambda x: log(x) / math.log(2.0),
    "exp2": lambda x: exp(x * math.log(2.0)),
    "tan": lambda x: sin(x) / cos(x),
    "cosh": lambda x: 0.5 * (exp(x) + exp(-x)),
    "sinh": lambda x: 0.5 * (expm1(x) - expm1(-x)),
}
"""Further functions that are expressed by those of OPERATIONS."""
OTHER_NAMES = {"ln": "log", "lg": "log10", "asinh": "arcsinh", "arsinh": "arcsinh"}
"""Other names of functions in a formula that is typed."""
_KINKED = ("maximum", "minimum", "fmax", "fmin", "sign", "heaviside", "floor", "ceil", "rint", "trunc", "fabs", "copysign")
"""Functions of numpy with kinks or jumps, which have no Taylor series there."""
_OF_NUMPY: dict[str, Callable[..., Any]] = (
    {one.numpy_name or one.name: one for one in OPERATIONS.values()}
    | COMPOSED
    | {
        "float_power": OPERATIONS["pow"],
        "negative": lambda a: -a,
        "positive": lambda a: a,
        "absolute": abs,
    }
)
"""Rules that turn numpy functions of expressions into expressions, by the name of the numpy function."""


def of_numpy(name: str, method: str, inputs: tuple[Any, ...], options: Mapping[str, Any]) -> Expression:
    """Return the formula for a function of numpy whose arguments have formulas among them. Raises InputError if there is none."""
    if name in _KINKED:
        raise InputError(f"formula: np.{name} has a kink or a jump and cannot be traced; {instead(*inputs)}")
    rule = _OF_NUMPY.get(name)
    if rule is None or method != "__call__" or options:
        allowed = ", ".join(f"np.{one}" for one in (*FUNCTIONS, *COMPOSED))
        raise InputError(f"formula: np.{name} cannot be traced; allowed: {allowed} and + - * / **")
    if any(isinstance(value, np.ndarray) and value.ndim for value in inputs):
        raise InputError("formula: an array cannot be traced: u and v are single numbers")
    return as_expression(rule(*inputs))


def evaluate(tree: Expression, numbers: Mapping[str, Any], u: Any, v: Any, *states: Any) -> Any:
    """Return the formula at slip u (m), slip rate v (m/s) and states, with the parameters' values by name.

    Numbers, arrays and expressions are allowed. States that are left out are 0.
    """
    return evaluate_nodes(tree, numbers, u, v, *states)[tree]


def evaluate_nodes(tree: Expression, numbers: Mapping[str, Any], u: Any, v: Any, *states: Any) -> dict[Expression, Any]:
    """Return the values of all nodes of the formula, with the arguments of `evaluate`."""
    given = dict.fromkeys(STATES, 0.0) | dict(zip(VARIABLES, (u, v, *states), strict=False))
    found: dict[Expression, Any] = {variable: _as_numpy(value) for variable, value in given.items()}
    for node in nodes_of(tree):
        if node.operation == "parameter":
            found[node] = _as_numpy(numbers[node.name])
        elif node.operation == "constant":
            found[node] = np.float64(node.value)
        elif node.arguments:
            found[node] = operation_of(node)(*(found[argument] for argument in node.arguments))
    return found


def _as_numpy(number: Any) -> Any:
    """Return a number of Python as one of numpy, which gives inf or nan on division by zero, where Python's raises an error."""
    return np.float64(number) if isinstance(number, int | float) else number
