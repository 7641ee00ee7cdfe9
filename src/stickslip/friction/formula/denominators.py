"""Find the exponentials of a formula that may be replaced by a finite number where they overflow."""

from __future__ import annotations

from collections.abc import Sequence

from stickslip.friction.formula.expression import Expression, nodes_of

LARGEST_EXPONENT = 150.0
"""Largest exponent, dimensionless, of an exp whose overflow is harmless; larger ones are replaced by it. A quotient over e^150 is
negligible, exp(-e^150) is zero, and the square and the series of e^150 are still finite."""
SQUASH = ("exp", "expm1", "tanh")
"""Functions that no longer change when their argument grows beyond e^150, or are infinite there already."""


def harmless_overflows(nodes: Sequence[Expression]) -> set[Expression]:
    """Return the nodes whose every way into the formula leads to a denominator or into one of SQUASH.

    The way may lead through sums, differences, roots and products, but not through a product with a factor that may be as small as
    the node is large, nor over a divisor that may be as large.
    """
    parents: dict[Expression, list[Expression]] = {node: [] for node in nodes}
    for node in nodes:
        for argument in node.arguments:
            parents[argument].append(node)
    below: set[Expression] = set()
    for node in reversed(nodes):
        ways = parents[node]
        if ways and all(
            parent.operation in SQUASH
            or (parent.operation == "div" and parent.arguments[1] == node and (parent.arguments[0] != node))
            or (parent in below and _keeps_large(node, parent))
            for parent in ways
        ):
            below.add(node)
    return below


def _keeps_large(node: Expression, parent: Expression) -> bool:
    """Return True if the parent of a node is large wherever the node is."""
    if parent.operation not in ("mul", "div"):
        return parent.operation in ("add", "sub", "sqrt")
    if parent.operation == "div" and parent.arguments[0] != node:
        return False
    others = [argument for argument in parent.arguments if argument != node]
    return all(part.operation not in ("exp", "expm1", "pow", "div") for other in others for part in nodes_of(other))
