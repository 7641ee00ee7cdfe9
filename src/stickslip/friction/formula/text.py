"""Write a formula tree as text from which `stickslip.friction.formula.parse` reads the same tree."""

from __future__ import annotations

from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.powers import POW

_MINUS, _ATOM = 3, 5
"""Precedence of a leading minus, between product and power, and of a part that never needs parentheses."""


def to_text(node: Expression) -> str:
    """Return the formula in ordinary notation, with few parentheses."""
    return _written(node)[0]


def quoted(node: Expression) -> str:
    """Return a part of a formula in quotes, cut off after 60 characters, for a message."""
    text = to_text(node)
    return f"'{text}'" if len(text) <= 60 else f"'{text[:57]}...'"


def _written(node: Expression) -> tuple[str, int]:
    if node.operation == "constant":
        number = repr(float(node.value)).removesuffix(".0")
        return number, _ATOM if number[0] != "-" else _MINUS
    if not node.arguments:
        return node.name, _ATOM
    operation = operation_of(node)
    if not operation.sign:
        return f"{node.operation}({to_text(node.arguments[0])})", _ATOM
    base, count = _power_of(node)
    if count > 1:
        return f"{_enclosed(base, _ATOM)}**{count}", POW.rank
    left, right = node.arguments
    if node.operation == "sub" and left == Expression("constant", value=0.0) and right.operation != "constant":
        return f"-{_enclosed(right, _MINUS)}", _MINUS
    if operation is POW:
        return f"{_enclosed(left, _ATOM)}**{_enclosed(right, _ATOM)}", POW.rank
    return f"{_enclosed(left, operation.rank)} {operation.sign} {_enclosed(right, operation.rank + 1)}", operation.rank


def _power_of(node: Expression) -> tuple[Expression, int]:
    """Return base and exponent of a product that was typed as a whole power, and the node itself with 1 for any other.

    A power is parsed into products by repeated squaring, so that the tree of the power is that of the product.
    """
    if node.operation != "mul":
        return node, 1
    left, right = node.arguments
    base, count = _power_of(left)
    if left == right:
        return base, 2 * count
    return (base, count + 1) if count % 2 == 0 and right == base else (node, 1)


def _enclosed(node: Expression, least: int) -> str:
    text, rank = _written(node)
    return text if rank >= least else f"({text})"
