"""Derive a formula by one of its variables: the result is a formula, too."""

from __future__ import annotations

from functools import lru_cache

from stickslip.friction.formula.expression import Expression, as_expression, depends_on, nodes_of
from stickslip.friction.formula.operations import operation_of

ZERO, ONE = as_expression(0.0), as_expression(1.0)


@lru_cache(maxsize=256)
def slope_formula(tree: Expression, variable: Expression) -> Expression:
    """Return the derivative of a formula by a variable, one of VARIABLES."""
    found = {variable: ONE}
    for node in nodes_of(tree):
        if node not in found:
            varies = bool(node.arguments) and depends_on(node, variable)
            slopes = [found[argument] for argument in node.arguments]
            found[node] = operation_of(node).slope_formula(node, *slopes) if varies else ZERO
    return found[tree]
