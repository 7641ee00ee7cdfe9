"""Write a formula's nodes at a given slip, slip rate and state as text: values, differences from a reference, first derivatives.

The text uses these names for node number i: c[i] is its value at the reference point, e{i} its difference from that value, and
n{i}_{k} its k-th Taylor coefficient (`recurrences` writes the orders from 1 on). The k-th coefficients of slip and slip rate are
x_{k} and s_{k}. The difference of the slip is dx, that of the rate is s_0, and w and w2 are the states, with the coefficients
w_of_{k} and w2_of_{k}. Where an exp of an exp is so large that it counts as constant, o{i} is 0, elsewhere 1.
"""

from __future__ import annotations

from stickslip.friction.formula import (
    LARGEST_EXPONENT,
    OPERATIONS,
    RATE,
    SLIP,
    STATES,
    VARIABLES,
    Expression,
    depends_on,
    harmless_overflows,
    nodes_of,
    operation_of,
)

NO_LIMIT = 1e308
"""Largest exponent of any other exp, in effect no limit: if exp is infinite, the run ends with a status that says so."""


class OrderZero:
    """The nodes of a formula with their dependencies, and the statements that compute them."""

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...] = ()) -> None:
        self.formula, self.parameters, self.state_rates = formula, parameters, state_rates
        self.nodes = self._with_companions(formula)
        self.states = STATES[: len(state_rates)]
        for tree in state_rates:
            self.nodes = list(dict.fromkeys((*self.nodes, *self._with_companions(tree))))
        self.nodes = list(dict.fromkeys((*self.nodes, *self.states)))
        self.index = {node: i for i, node in enumerate(self.nodes)}
        self.varies = {node: any(depends_on(node, one) for one in VARIABLES) for node in self.nodes}
        self.rate_dependent = {node: depends_on(node, RATE) for node in self.nodes}
        self.dynamic = [n for n in self.nodes if self.varies[n] and n not in VARIABLES]
        self._own = {node for tree in (formula, *state_rates) for node in nodes_of(tree)}
        self._only_below = harmless_overflows(self.nodes)
        self.size = len(self.nodes) + 1

    @staticmethod
    def _with_companions(formula: Expression) -> list[Expression]:
        """Return the nodes in order of computation, with the auxiliary nodes that recurrences need, such as cos for sin."""
        found: dict[Expression, None] = {}
        for node in nodes_of(formula):
            found.update(dict.fromkeys(operation_of(node).companions(node) if node.arguments else (node,)))
        found.setdefault(SLIP)
        found.setdefault(RATE)
        return list(found)

    # ---- names --------------------------------------------------------------------------------------------------------------

    def reference(self, node: Expression) -> str:
        """Return the name of a node's value at the reference point."""
        return f"c[{self.index[node]}]"

    def coefficient(self, node: Expression, k: int) -> str | None:
        """Return the name of the k-th Taylor coefficient of a node, or None if it is zero."""
        if not self.varies[node]:
            return self.reference(node) if k == 0 else None
        if node in STATES:
            return f"{node.name}_of_{k}" if k else node.name
        if node == RATE:
            return f"s_{k}"
        return f"x_{k}" if node == SLIP else f"n{self.index[node]}_{k}"

    def difference(self, node: Expression) -> str | None:
        """Return the name of a node's difference from its reference value, or None if the node is constant."""
        if not self.varies[node]:
            return None
        return {SLIP: "dx", RATE: "s_0"}.get(node) or (node.name if node in STATES else f"e{self.index[node]}")

    def slope(self, node: Expression, variable: Expression, tag: str) -> str | None:
        """Return the name of a node's derivative with respect to a variable, or None if it is zero.

        The tag is the letter with which the names of these derivatives begin.
        """
        if not depends_on(node, variable):
            return None
        return "1.0" if node == variable else f"{tag}{self.index[node]}"

    # ---- order zero ---------------------------------------------------------------------------------------------------------

    def reference_value(self, node: Expression) -> str:
        """Write a node's value at the reference point, for `prepare`."""
        if node.arguments:
            operation, given = operation_of(node), [self.reference(argument) for argument in node.arguments]
            if operation.sign:
                return f"{given[0]} {operation.sign} {given[1]}"
            limited = f"min({given[0]}, {self.largest_exponent(node)})" if operation.overflows else given[0]
            return f"{operation.in_math}({limited})"
        if node.operation == "parameter":
            return f"p[{self.parameters.index(node.name)}]"
        return {"slip": "x_ref", "rate": "0.0", "state": "0.0"}.get(node.operation, repr(node.value))

    def largest_exponent(self, node: Expression) -> float:
        """Return the largest exponent of an exp node: beyond it, exp and exp - 1 no longer grow."""
        alike = {Expression(one.name, node.arguments) for one in OPERATIONS.values() if one.overflows} & self._own
        return LARGEST_EXPONENT if alike <= self._only_below else NO_LIMIT

    def vanishes(self, node: Expression) -> bool:
        """Return True if a node is 0 for any parameters at the reference point, where slip rate and state are 0."""
        if not node.arguments:
            return node in (RATE, *STATES)
        return any(self.vanishes(node.arguments[place]) for place in operation_of(node).zeros)

    def saturates(self, node: Expression) -> bool:
        """Return True for an exp whose overflow is harmless and whose argument is no straight line, such as another exp.

        Beyond LARGEST_EXPONENT it is a constant with a series of zeros: the derivatives of its argument may overflow, and those of
        the quotient or exp that contains it are zero to rounding.
        """
        overflows = bool(node.arguments) and operation_of(node).overflows
        return overflows and self.largest_exponent(node) == LARGEST_EXPONENT and not self._is_straight(node.arguments[0])

    def _is_straight(self, node: Expression) -> bool:
        """Return True if a node is linear in the variables."""
        if not self.varies[node] or node in VARIABLES:
            return True
        varying = tuple(place for place, argument in enumerate(node.arguments) if self.varies[argument])
        return varying in operation_of(node).linear and all(self._is_straight(argument) for argument in node.arguments)

    def level(self, node: Expression, difference: str, value: str | None = None) -> dict[str, str]:
        """Return the lines of a node's difference from the reference and of its value, by default the sum of both."""
        e = f"e{self.index[node]}"
        return {e: difference, f"n{self.index[node]}_0": value or f"{self.reference(node)} + {e}"}

    def order_zero(self) -> list[str]:
        """Write the difference from the reference and the value of every varying node, at slip difference dx and rate s_0."""
        lines = {"x_0": f"{self.reference(SLIP)} + dx"}
        for node in self.dynamic:
            lines |= operation_of(node).order_zero(self, node)
        return [f"{name} = {rule}" for name, rule in lines.items()]

    def slopes(self, variable: Expression, tag: str) -> list[str]:
        """Write the first derivatives of the nodes by one of VARIABLES, with names that begin with `tag`."""
        lines = []
        for node in self.dynamic:
            if depends_on(node, variable):
                given = [self.slope(argument, variable, tag) for argument in node.arguments]
                lines.append(f"{tag}{self.index[node]} = {operation_of(node).derivative(self, node, *given)}")
        return lines
