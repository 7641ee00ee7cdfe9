"""Find the exponentials of a formula that may be replaced by a finite number where they overflow."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from stickslip.friction.formula.expression import Expression, nodes_of
from stickslip.friction.formula.operations import operation_of


@lru_cache(maxsize=256)
def limited(tree: Expression) -> frozenset[Expression]:
    """Return the exponentials of a formula whose exponents are limited to LARGEST_EXPONENT."""
    return frozenset(node for node in harmless_overflows(nodes_of(tree)) if node.arguments and operation_of(node).overflows)


def harmless_overflows(nodes: Sequence[Expression]) -> set[Expression]:
    """Return the nodes whose every way into the formula leads to a denominator, or to an argument such as that of exp.

    The way may lead through sums, differences, roots and products, but not through a product with a factor that may be as small as
    the node is large, nor over a divisor that may be as large.
    """
    parents: dict[Expression, list[Expression]] = {node: [] for node in nodes}
    for node in nodes:
        for argument in node.arguments:
            parents[argument].append(node)
    found: set[Expression] = set()
    for node in reversed(nodes):
        ways = parents[node]
        if ways and all(_settles(node, parent) or (parent in found and _keeps_large(node, parent)) for parent in ways):
            found.add(node)
    return found


def _places(node: Expression, parent: Expression) -> set[int]:
    return {place for place, argument in enumerate(parent.arguments) if argument == node}


def _settles(node: Expression, parent: Expression) -> bool:
    """Return True if the parent of a node no longer changes where the node is large."""
    return _places(node, parent) <= set(operation_of(parent).settles)


def _keeps_large(node: Expression, parent: Expression) -> bool:
    """Return True if the parent of a node is large wherever the node is."""
    operation = operation_of(parent)
    others = [part for argument in parent.arguments if argument != node for part in nodes_of(argument) if part.arguments]
    small = operation.scales and any(operation_of(part).shrinks for part in others)
    return bool(_places(node, parent) & set(operation.carries)) and not small
