"""Write ball arithmetic for the nodes of a formula: how far each value can be from its centre, for complex arguments.

Slip, slip rate and state are complex numbers in discs around real centres. For each node the text computes a radius: every value
that the node takes on these discs lies within this distance of its value at the centres. If an operation has no analytic
continuation over the disc of its argument, as log around 0, or if numbers overflow, the radius is infinite or not a number: nothing
is known. `engine.contact_step.certificate` proves steps with these radii.

In the text, the value of node number i at the centre is n{i}_0 (see `order_zero`), its radius r{i}, a lower bound of its magnitude
on the disc b{i}, and an upper bound of |log(value / centre)| there l{i}. The last two are written only where a denominator, a root,
a power or a logarithm contains an exponential or a power: such a node may vary by orders of magnitude and still stay away from
zero, which a radius alone cannot express.

Sources: Rump 2010, Verification methods, Acta Numerica 19 (balls); Rudin 1987, Real and Complex Analysis, ch. 12 (Schwarz's lemma).
"""

from __future__ import annotations

from stickslip.engine.formula_code.recurrences import Recurrences
from stickslip.friction.formula import RATE, SLIP, STATES, TINIEST, VARIABLES, Expression, nodes_of, operation_of


class Balls:
    """Writes the radii of a formula's nodes; `centres` are the nodes whose values at the centre the text needs."""

    def __init__(self, formula: Recurrences, roots: list[Expression]) -> None:
        self.formula = formula
        wanted = {node for root in roots for node in nodes_of(root)}
        self._done: set[str] = set()
        self.centres: dict[Expression, None] = {}
        self.lines: list[str] = []
        for node in formula.nodes:
            if node in wanted and formula.varies[node] and node not in VARIABLES:
                self._write(f"r{formula.index[node]}", operation_of(node).ball.radius(self, node))

    # ---- names --------------------------------------------------------------------------------------------------------------

    def radius(self, node: Expression) -> str | None:
        """Return the name of a node's radius, or None if the node is constant."""
        if not self.formula.varies[node]:
            return None
        own = {SLIP: "r_slip", RATE: "r_rate"} | {state: f"r_{state.name}" for state in STATES}
        return own.get(node) or f"r{self.formula.index[node]}"

    def centre(self, node: Expression) -> str:
        """Return the name of a node's value at the centre."""
        if self.formula.varies[node]:
            self.centres[node] = None
        return self.formula.coefficient(node, 0) or "0.0"

    def size(self, node: Expression) -> str:
        """Return the text of the magnitude of a node's value at the centre."""
        return f"abs({self.centre(node)})"

    def most(self, node: Expression) -> str:
        """Return the text of an upper bound of a node's magnitude on the disc."""
        radius = self.radius(node)
        return f"({self.size(node)} + {radius})" if radius else self.size(node)

    def _write(self, name: str, rule: str) -> str:
        """Write a statement once, and return the name that it defines."""
        if name not in self._done:
            self._done.add(name)
            self.lines.append(f"{name} = {rule}")
        return name

    def varies_much(self, node: Expression) -> bool:
        """Return True if a node contains an operation whose results vary by orders of magnitude."""
        varying = (part for part in nodes_of(node) if part.arguments and self.formula.varies[part])
        return any(operation_of(part).varies_much for part in varying)

    def least(self, node: Expression) -> str:
        """Write a lower bound of a node's magnitude on the disc, at least TINIEST, and return its name."""
        if not (radius := self.radius(node)):
            return self.size(node)
        plain = f"max({self.size(node)} - {radius}, {TINIEST!r})"
        rule = operation_of(node).ball.least if self.varies_much(node) else None
        return self._write(self._name("b", node), rule(self, node, plain) if rule else plain)

    def logarithm(self, node: Expression) -> str:
        """Write an upper bound of |log(value / centre)| of a node on the disc, and return its name."""
        if not (radius := self.radius(node)):
            return "0.0"
        plain = f"log_radius({self.size(node)}, {radius})"
        rule = operation_of(node).ball.logarithm if self.varies_much(node) else None
        bound = rule(self, node, plain) if rule else plain
        return bound if bound.isidentifier() else self._write(self._name("l", node), bound)

    def _name(self, letter: str, node: Expression) -> str:
        return f"{letter}{self.formula.index[node]}" if node.arguments else f"{letter}_{node.name}"
