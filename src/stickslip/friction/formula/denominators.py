"""Find the exponentials of a formula that may be replaced by a finite number where they overflow."""

from __future__ import annotations

from stickslip.friction.formula.expression import Expression

LARGEST_EXPONENT = 150.0
"""Largest exponent, dimensionless, of an exp that occurs in denominators only; larger ones are replaced by it. A quotient over
e^150 is negligible, and the square and the series of e^150 are still finite."""


def in_denominators_only(nodes: list[Expression]) -> set[Expression]:
    """Return the nodes whose every way into the formula leads through sums, differences, products and roots to a denominator."""
    parents: dict[Expression, list[Expression]] = {node: [] for node in nodes}
    for node in nodes:
        for argument in node.arguments:
            parents[argument].append(node)
    below: set[Expression] = set()
    for node in reversed(nodes):
        ways = parents[node]
        if ways and all(
            _divides(node, parent) or (parent in below and parent.operation in ("add", "sub", "mul", "sqrt")) for parent in ways
        ):
            below.add(node)
    return below


def _divides(node: Expression, parent: Expression) -> bool:
    """Return True if a node is the denominator, and not also the numerator, of its parent."""
    return parent.operation == "div" and parent.arguments[1] == node and parent.arguments[0] != node
