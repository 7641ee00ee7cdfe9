"""Formulas as trees: what a friction law is made of.

A law writes its formula once, with ordinary operators and the functions of this module. Called with numbers or arrays the
formula is a number or an array; called with the symbols `SLIP`, `RATE` and `Parameter` it is an `Expression` tree, from which
`stickslip.evolution.generate` writes Taylor recurrences. Nothing here is ever evaluated as Python text.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

FUNCTIONS = ("sin", "cos", "exp", "log", "sqrt", "tanh", "arcsinh")


@dataclass(frozen=True)
class Expression:
    """A node: an operation on other nodes, a parameter, a constant, or one of the two variables."""

    operation: str
    arguments: tuple[Expression, ...] = ()
    name: str = ""
    value: float = 0.0

    def __add__(self, other: Any) -> Expression:
        return Expression("add", (self, as_expression(other)))

    def __radd__(self, other: Any) -> Expression:
        return as_expression(other) + self

    def __sub__(self, other: Any) -> Expression:
        return Expression("sub", (self, as_expression(other)))

    def __rsub__(self, other: Any) -> Expression:
        return as_expression(other) - self

    def __mul__(self, other: Any) -> Expression:
        return Expression("mul", (self, as_expression(other)))

    def __rmul__(self, other: Any) -> Expression:
        return as_expression(other) * self

    def __truediv__(self, other: Any) -> Expression:
        return Expression("div", (self, as_expression(other)))

    def __rtruediv__(self, other: Any) -> Expression:
        return as_expression(other) / self

    def __neg__(self) -> Expression:
        return as_expression(0.0) - self

    def __pow__(self, exponent: Any) -> Expression:
        return Expression("pow", (self, as_expression(exponent)))


SLIP = Expression("slip", name="u")
RATE = Expression("rate", name="v")


def Parameter(name: str) -> Expression:  # noqa: N802 - reads as the node it makes
    """A named number of the law, known when the run starts."""
    return Expression("parameter", name=name)


def as_expression(value: Any) -> Expression:
    """Wrap a plain number as a constant node; a node stays what it is."""
    return value if isinstance(value, Expression) else Expression("constant", value=float(value))


def _function(name: str) -> Callable[[Any], Any]:
    numeric = getattr(np, name)

    def apply(argument: Any) -> Any:
        return Expression(name, (argument,)) if isinstance(argument, Expression) else numeric(argument)

    apply.__name__ = name
    apply.__doc__ = f"{name} of a number, an array or an expression."
    return apply


sin, cos, exp, log, sqrt, tanh, arcsinh = (_function(name) for name in FUNCTIONS)


def depends_on(node: Expression, variable: Expression) -> bool:
    """Whether the formula contains the variable (SLIP or RATE)."""
    return node == variable or any(depends_on(argument, variable) for argument in node.arguments)


def nodes_of(root: Expression) -> list[Expression]:
    """Every distinct node below `root`, arguments before the nodes that use them, `root` last."""
    found: dict[Expression, None] = {}

    def visit(node: Expression) -> None:
        if node not in found:
            for argument in node.arguments:
                visit(argument)
            found[node] = None

    visit(root)
    return list(found)
