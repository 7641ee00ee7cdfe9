"""Write a formula tree as text from which `stickslip.friction.formula.parse` reads the same tree."""

from __future__ import annotations

from stickslip.friction.formula.expression import Expression

_SIGNS = {"add": " + ", "sub": " - ", "mul": " * ", "div": " / ", "pow": "**"}
_RANK = {"add": 1, "sub": 1, "mul": 2, "div": 2, "pow": 4}
"""Precedence of the operators: a larger number binds more tightly."""
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
    if node.operation not in _SIGNS:
        if node.arguments:
            return f"{node.operation}({to_text(node.arguments[0])})", _ATOM
        if node.operation == "constant":
            return repr(float(node.value)), _ATOM if str(node.value)[0] != "-" else _MINUS
        return node.name, _ATOM
    left, right = node.arguments
    rank = _RANK[node.operation]
    if node.operation == "sub" and left == Expression("constant", value=0.0) and right.operation != "constant":
        return f"-{_enclosed(right, _MINUS)}", _MINUS
    if node.operation == "pow":
        return f"{_enclosed(left, _ATOM)}**{_enclosed(right, _ATOM)}", rank
    return f"{_enclosed(left, rank)}{_SIGNS[node.operation]}{_enclosed(right, rank + 1)}", rank


def _enclosed(node: Expression, least: int) -> str:
    text, rank = _written(node)
    return text if rank >= least else f"({text})"
