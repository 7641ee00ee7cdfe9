"""Write ball arithmetic for the nodes of a formula: how far each value can be from its centre, for complex arguments.

Slip, slip rate and state are complex numbers in discs around real centres. For each node the text computes a radius: every value
that the node takes on these discs lies within this distance of its value at the centres. Where an operation has no analytic
continuation over the disc of its argument, as log around 0, or where numbers overflow, the radius is infinite or not a number, and
nothing is known. `engine.contact_step.certificate` proves steps with these radii.

In the text, the value of node number i at the centre is n{i}_0 (see `order_zero`), its radius r{i}, a lower bound of its magnitude
on the disc b{i}, and an upper bound of |log(value / centre)| there l{i}. The last two are written only where a denominator, a root,
a power or a logarithm contains an exponential or a power: such a node may vary by orders of magnitude and still stay away from
zero, which a radius alone cannot express.

Sources: Rump 2010, Verification methods, Acta Numerica 19 (balls); Rudin 1987, Real and Complex Analysis, ch. 12 (Schwarz's lemma).
"""

from __future__ import annotations

from stickslip.engine.codegen.order_zero import OrderZero, exp_of
from stickslip.friction.formula.denominators import LARGEST_EXPONENT
from stickslip.friction.formula.expression import RATE, SLIP, STATES, VARIABLES, Expression, nodes_of

VARIED = ("exp", "expm1", "pow")
"""Operations whose results vary by orders of magnitude without coming near zero."""
STAYS_LARGE = LARGEST_EXPONENT - 10.0
"""Exponent that a harmless overflow must not fall below while it counts as constant: lower than where it begins to count, so that
a step may end there."""
TINIEST = 1e-300
"""Smallest bound of a magnitude from below. In place of zero it makes radii huge instead of infinite, which proves as little, and
no division by zero."""


class Balls:
    """Writes the radii of a formula's nodes; `centres` are the nodes whose values at the centre the text needs."""

    def __init__(self, formula: OrderZero, roots: list[Expression]) -> None:
        self._formula = formula
        wanted = {node for root in roots for node in nodes_of(root)}
        self._done: set[str] = set()
        self.centres: dict[Expression, None] = {}
        self.lines: list[str] = []
        for node in formula.nodes:
            if node in wanted and formula.varies[node] and node not in VARIABLES:
                self._write(f"r{formula.index[node]}", self._radius_rule(node))

    # ---- names --------------------------------------------------------------------------------------------------------------

    def radius(self, node: Expression) -> str | None:
        """Return the name of a node's radius, or None if the node is constant."""
        if not self._formula.varies[node]:
            return None
        own = {SLIP: "r_slip", RATE: "r_rate"} | {state: f"r_{state.name}" for state in STATES}
        return own.get(node) or f"r{self._formula.index[node]}"

    def _centre(self, node: Expression) -> str:
        """Return the name of a node's value at the centre."""
        if self._formula.varies[node]:
            self.centres[node] = None
        return self._formula.coefficient(node, 0) or "0.0"

    def _size(self, node: Expression) -> str:
        """Return the text of the magnitude of a node's value at the centre."""
        return f"abs({self._centre(node)})"

    def _most(self, node: Expression) -> str:
        """Return the text of an upper bound of a node's magnitude on the disc."""
        radius = self.radius(node)
        return f"({self._size(node)} + {radius})" if radius else self._size(node)

    def _write(self, name: str, rule: str) -> str:
        """Write a statement once, and return the name that it defines."""
        if name not in self._done:
            self._done.add(name)
            self.lines.append(f"{name} = {rule}")
        return name

    # ---- rules --------------------------------------------------------------------------------------------------------------

    def _radius_rule(self, node: Expression) -> str:
        """Write the radius of a node from those of its arguments."""
        a = node.arguments[0]
        ra = self.radius(a)
        if node.operation in ("add", "sub"):
            return " + ".join(r for r in (ra, self.radius(node.arguments[1])) if r)
        if node.operation == "mul":
            return self._product(a, node.arguments[1])
        if node.operation == "div":
            return self._quotient(node)
        if node.operation in ("sin", "cos"):
            sine, cosine = (self._size(Expression(name, (a,))) for name in ("sin", "cos"))
            first, second = (sine, cosine) if node.operation == "sin" else (cosine, sine)
            return f"sine_radius({first}, {second}, {ra})"
        if node.operation == "exp":
            return self._exponential(node, f"exp_radius({self._centre(a)}, {self._centre(node)}, {ra})")
        if node.operation == "expm1":
            return self._exponential(exp_of(node), f"exp_radius({self._centre(a)}, {self._centre(exp_of(node))}, {ra})")
        if node.operation == "log1p":
            return f"log_radius(abs(1.0 + {self._centre(a)}), {ra})"
        if node.operation == "tanh":
            return f"tanh_radius({self._size(a)}, {ra})"
        if node.operation == "arcsinh":
            return f"arcsinh_radius({self._size(a)}, {ra})"
        if node.operation == "log":
            return self._logarithm(a)
        exponent = "0.5" if node.operation == "sqrt" else f"abs({self._centre(node.arguments[1])})"
        return f"power_radius({self._size(node)}, {exponent}, {self._logarithm(a)})"

    def _exponential(self, node: Expression, radius: str) -> str:
        """Write the radius of an exp; 0 for one that is a constant, if its argument stays large along the step."""
        if not self._formula.saturates(node):
            return radius
        a = node.arguments[0]
        small = self._formula.below(LARGEST_EXPONENT, self._centre(a)), self._formula.below(STAYS_LARGE, self._least(a))
        return f"min({radius}, 1e308 * max({small[0]}, {small[1]}))"

    def _product(self, a: Expression, b: Expression) -> str:
        ra, rb = self.radius(a), self.radius(b)
        if a == b:
            return f"{ra} * ({ra} + 2.0 * {self._size(a)})"
        if ra and rb:
            return f"{self._size(a)} * {rb} + {self._most(b)} * {ra}"
        return f"{self._size(a)} * {rb}" if rb else f"{self._size(b)} * {ra}"

    def _quotient(self, node: Expression) -> str:
        a, b = node.arguments
        ra, rb = self.radius(a), self.radius(b)
        if not rb:
            return f"{ra} / {self._size(b)}"
        moved = f"{ra} + {self._size(node)} * {rb}" if ra else f"{self._size(node)} * {rb}"
        if not self._varies_much(b):
            return f"({moved}) / max({self._size(b)} - {rb}, {TINIEST!r})"
        least = self._least(b)
        return f"min({self._most(a)} / {least} + {self._size(node)}, ({moved}) / {least})"

    def _varies_much(self, node: Expression) -> bool:
        """Return True if a node contains an operation whose results vary by orders of magnitude."""
        return any(part.operation in VARIED and self._formula.varies[part] for part in nodes_of(node))

    def _least(self, node: Expression) -> str:
        """Write a lower bound of a node's magnitude on the disc, at least TINIEST, and return its name."""
        ra = self.radius(node)
        if not ra:
            return self._size(node)
        name = f"b{self._formula.index[node]}" if node.arguments else f"b_{node.name}"
        plain = f"max({self._size(node)} - {ra}, {TINIEST!r})"
        if not self._varies_much(node):
            return self._write(name, plain)
        a = node.arguments[0]
        if node.operation == "exp":
            return self._write(name, f"max(1.0 / exp_above({self.radius(a)} - {self._centre(a)}), {TINIEST!r})")
        if node.operation == "sqrt":
            return self._write(name, f"sqrt({self._least(a)})")
        if node.operation == "mul":
            return self._write(name, f"{self._least(a)} * {self._least(node.arguments[1])}")
        if node.operation == "div":
            return self._write(name, f"{self._least(a)} / {self._most(node.arguments[1])}")
        if node.operation in ("add", "sub"):
            b = node.arguments[1]
            apart = f"max({self._least(a)} - {self._most(b)}, {self._least(b)} - {self._most(a)})"
            return self._write(name, f"max({plain}, {apart})")
        return self._write(name, plain)

    def _logarithm(self, node: Expression) -> str:
        """Write an upper bound of |log(value / centre)| of a node on the disc, and return its name."""
        if not self.radius(node):
            return "0.0"
        name = f"l{self._formula.index[node]}" if node.arguments else f"l_{node.name}"
        plain = f"log_radius({self._size(node)}, {self.radius(node)})"
        if not self._varies_much(node):
            return self._write(name, plain)
        a = node.arguments[0]
        if node.operation == "exp":
            return self.radius(a) or "0.0"
        if node.operation in ("mul", "div"):
            return self._write(name, f"{self._logarithm(a)} + {self._logarithm(node.arguments[1])}")
        if node.operation == "sqrt":
            return self._write(name, f"0.5 * {self._logarithm(a)}")
        if node.operation == "pow":
            return self._write(name, f"abs({self._centre(node.arguments[1])}) * {self._logarithm(a)}")
        if node.operation in ("add", "sub"):
            b = node.arguments[1]
            sides = (self._beside(one, other) for one, other in ((a, b), (b, a)))
            return self._write(name, f"min({plain}, min({', '.join(sides)}))")
        return self._write(name, plain)

    def _beside(self, large: Expression, small: Expression) -> str:
        """Write the bound of |log(value / centre)| of a sum whose one term is larger than the other on the whole disc."""
        return f"{self._logarithm(large)} + 2.0 * log_radius({self._least(large)}, {self._most(small)})"
