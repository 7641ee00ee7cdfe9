"""The operations in formulas: one record each, and nothing else in the package knows them by name."""

from __future__ import annotations

from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.arithmetic import ADD, DIV, MUL, SUB
from stickslip.friction.formula.operations.exponentials import EXP, EXPM1
from stickslip.friction.formula.operations.hyperbolic import ARCSINH, TANH
from stickslip.friction.formula.operations.logarithms import LOG, LOG1P
from stickslip.friction.formula.operations.operation import LARGEST_EXPONENT, Operation
from stickslip.friction.formula.operations.powers import POW, SQRT
from stickslip.friction.formula.operations.waves import COS, SIN

__all__ = ["FUNCTIONS", "LARGEST_EXPONENT", "OPERATIONS", "Operation", "operation_of"]

OPERATIONS = {one.name: one for one in (ADD, SUB, MUL, DIV, POW, SIN, COS, EXP, LOG, SQRT, TANH, ARCSINH, EXPM1, LOG1P)}
"""All operations by their names in the nodes of formulas."""
FUNCTIONS = tuple(name for name, one in OPERATIONS.items() if not one.sign)
"""Elementary functions that a formula may use, as it is typed."""


def operation_of(node: Expression) -> Operation:
    """Return the operation of a node that has arguments."""
    return OPERATIONS[node.operation]
