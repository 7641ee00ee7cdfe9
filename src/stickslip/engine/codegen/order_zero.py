"""Write a formula's nodes at a given slip, slip rate and state as text: values, differences from a reference, first derivatives.

The text uses these names for node number i: c[i] is its value at the reference point, e{i} its difference from that value, and
n{i}_{k} its k-th Taylor coefficient (`recurrences` writes the orders from 1 on). The k-th coefficients of slip and slip rate are
x_{k} and s_{k}. The difference of the slip is dx, that of the rate is s_0, and w and w2 are the states. Where an exp of an exp is
so large that it counts as constant, o{i} is 0, elsewhere 1.
"""

from __future__ import annotations

from stickslip.friction.formula.denominators import LARGEST_EXPONENT, harmless_overflows
from stickslip.friction.formula.expression import RATE, SLIP, STATES, VARIABLES, Expression, depends_on, nodes_of

NO_LIMIT = 1e308
"""Largest exponent of any other exp, in effect no limit: if exp is infinite, the run ends with a status that says so."""


def _vanishes(node: Expression) -> bool:
    """Return True if a node is 0 for any parameters at the reference point, where slip rate and state are 0."""
    if node in (RATE, *STATES):
        return True
    if node.operation == "mul":
        return any(_vanishes(argument) for argument in node.arguments)
    return node.operation in ("div", "sin", "tanh", "arcsinh", "sqrt", "expm1", "log1p") and _vanishes(node.arguments[0])


def exp_of(node: Expression) -> Expression:
    """Return the node exp(a) for a node exp(a) - 1: the two have the same derivatives."""
    return Expression("exp", node.arguments)


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
            argument = node.arguments[0] if node.arguments else node
            if node.operation in ("sin", "cos"):
                found.update(dict.fromkeys((Expression("sin", (argument,)), Expression("cos", (argument,)))))
            elif node.operation == "arcsinh":
                found.update(dict.fromkeys(nodes_of(Expression("sqrt", (1.0 + argument * argument,)))))
            elif node.operation == "expm1":
                found[exp_of(node)] = None
            found[node] = None
            if node.operation == "tanh":
                found[node * node] = None
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
            return node.name
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
        arguments = [self.reference(argument) for argument in node.arguments]
        signs = {"add": "+", "sub": "-", "mul": "*", "div": "/", "pow": "**"}
        if node.operation in signs:
            return f"{arguments[0]} {signs[node.operation]} {arguments[1]}"
        if node.operation in ("exp", "expm1"):
            return f"{node.operation}(min({arguments[0]}, {self.largest_exponent(node)}))"
        if node.arguments:
            return f"{'asinh' if node.operation == 'arcsinh' else node.operation}({arguments[0]})"
        if node.operation == "parameter":
            return f"p[{self.parameters.index(node.name)}]"
        return {"slip": "x_ref", "rate": "0.0", "state": "0.0"}.get(node.operation, repr(node.value))

    def largest_exponent(self, node: Expression) -> float:
        """Return the exponent beyond which an exp node, and the node exp - 1 with the same exponent, no longer grow."""
        both = {Expression(name, node.arguments) for name in ("exp", "expm1")} & self._own
        return LARGEST_EXPONENT if both <= self._only_below else NO_LIMIT

    def saturates(self, node: Expression) -> bool:
        """Return True for an exp whose overflow is harmless and whose argument is no straight line, such as another exp.

        Beyond LARGEST_EXPONENT it is a constant with a series of zeros: the derivatives of its argument may be beyond numbers, and
        those of the quotient or exp that it leads to are zero to rounding.
        """
        harmless = node.operation == "exp" and self.largest_exponent(node) == LARGEST_EXPONENT
        return harmless and not self._is_straight(node.arguments[0])

    def _is_straight(self, node: Expression) -> bool:
        """Return True if a node is linear in the variables."""
        if not self.varies[node] or node in VARIABLES:
            return True
        fixed = [not self.varies[argument] for argument in node.arguments]
        straight = node.operation in ("add", "sub") or (node.operation == "mul" and any(fixed))
        straight |= node.operation == "div" and fixed[-1]
        return straight and all(self._is_straight(argument) for argument in node.arguments)

    @staticmethod
    def below(limit: float, argument: str) -> str:
        """Write 1.0 where an argument is below a limit, else 0.0."""
        return f"min(max(1e300 * ({limit!r} - {argument}), 0.0), 1.0)"

    def order_zero(self) -> list[str]:
        """Write the difference from the reference and the value of every varying node, at slip difference dx and rate s_0."""
        lines = [f"x_0 = {self.reference(SLIP)} + dx"]
        turned_by: set[Expression] = set()
        for node in self.dynamic:
            i = self.index[node]
            if node.operation in ("sin", "cos") and node.arguments[0] not in turned_by:
                turned_by.add(node.arguments[0])
                j = self.index[node.arguments[0]]
                turned = self.difference(node.arguments[0])
                lines += [f"g{j} = sine({turned})", f"h{j} = versine({turned})"]
            lines.append(f"e{i} = {self._difference_rule(node)}")
            lines.append(f"n{i}_0 = {self._value_rule(node)}")
            if self.saturates(node):
                lines.append(f"o{i} = {self.below(LARGEST_EXPONENT, self.coefficient(node.arguments[0], 0) or '0.0')}")
        return lines

    def _value_rule(self, node: Expression) -> str:
        """Write a node's value, from its arguments if that is cheap, because reference + difference loses small values."""
        sign = {"add": "+", "sub": "-", "mul": "*", "div": "/"}.get(node.operation)
        if node.operation == "exp":
            a = node.arguments[0]
            near = f"{self.reference(node)}, e{self.index[node]}, {self.difference(a)}"
            return f"exp_value({near}, {self.coefficient(a, 0)}, {self.largest_exponent(node)})"
        if node.operation == "expm1":
            return f"expm1(min({self.coefficient(node.arguments[0], 0)}, {self.largest_exponent(node)}))"
        if node.operation == "log1p":
            return f"log1p({self.coefficient(node.arguments[0], 0)})"
        if node.operation == "sqrt":
            return f"sqrt({self.coefficient(node.arguments[0], 0)})"
        if node.operation == "pow":
            base, exponent = self.coefficient(node.arguments[0], 0), self.reference(node.arguments[1])
            return f"power_value({self.reference(node)}, e{self.index[node]}, {base}, {exponent})"
        if sign is None:
            return f"{self.reference(node)} + e{self.index[node]}"
        left, right = (self.coefficient(argument, 0) for argument in node.arguments)
        return f"{left} {sign} {right}"

    def _difference_rule(self, node: Expression) -> str:
        """Write a node's difference from its reference value, in a form without cancellation."""
        a = node.arguments[0]
        r, ra, ea = self.reference(node), self.reference(a), self.difference(a)
        if node.operation in ("add", "sub", "mul", "div"):
            b = node.arguments[1]
            rb, eb = self.reference(b), self.difference(b)
            if node.operation == "add":
                return " + ".join(e for e in (ea, eb) if e)
            if node.operation == "sub":
                return f"{ea or ''}{f' - {eb}' if eb else ''}"
            if node.operation == "mul" and ea and eb and (_vanishes(a) or _vanishes(b)):
                return f"{self.coefficient(a, 0)} * {self.coefficient(b, 0)}"  # the reference value is 0
            if node.operation == "mul":
                return " + ".join(t for t in (ea and f"{ea} * {rb}", eb and f"{self.coefficient(a, 0)} * {eb}") if t)
            numerator = f"{ea or ''}{f' - {r} * {eb}' if eb else ''}"
            return f"({numerator}) / {self.coefficient(b, 0)}"
        if node.operation in ("sin", "cos"):
            j = self.index[a]
            sine, cosine = (self.reference(Expression(name, (a,))) for name in ("sin", "cos"))
            return f"{cosine} * g{j} - {sine} * h{j}" if node.operation == "sin" else f"-{sine} * g{j} - {cosine} * h{j}"
        now = self.coefficient(a, 0)  # far from the reference this value has digits that reference + difference lacks
        return {
            "exp": f"exp_difference({r}, {now}, {ea}, {self.largest_exponent(node)})",
            "log": f"log_difference({ra}, {now}, {ea})",
            "log1p": f"log_difference(1.0 + {ra}, 1.0 + {now}, {ea})",
            "expm1": f"e{self.index.get(exp_of(node))}",
            "sqrt": f"{ea} / (sqrt({now}) + {r})",
            "tanh": f"tanh_difference({r}, {now}, {ea})",
            "arcsinh": f"arcsinh_difference({ra}, {now}, {ea})",
            "pow": f"power_difference({ra}, {now}, {ea}, {self.reference(node.arguments[-1])})",
        }[node.operation]

    def slopes(self, variable: Expression, tag: str) -> list[str]:
        """Write the first derivatives of the nodes by one of VARIABLES, with names that begin with `tag`."""
        lines = []
        for node in self.dynamic:
            if not depends_on(node, variable):
                continue
            a = node.arguments[0]
            value, a0, da = self.coefficient(node, 0), self.coefficient(a, 0), self.slope(a, variable, tag)
            if node.operation in ("add", "sub", "mul", "div"):
                b = node.arguments[1]
                b0, db = self.coefficient(b, 0), self.slope(b, variable, tag)
                rule = {
                    "add": " + ".join(d for d in (da, db) if d),
                    "sub": f"{da or ''}{f' - {db}' if db else ''}",
                    "mul": " + ".join(t for t in (da and f"{da} * {b0}", db and f"{a0} * {db}") if t),
                    "div": f"({da or ''}{f' - {value} * {db}' if db else ''}) / {b0}",
                }[node.operation]
            else:
                partner = {"sin": "cos", "cos": "sin"}.get(node.operation)
                other = self.coefficient(Expression(partner, (a,)), 0) if partner else ""
                rule = {
                    "sin": f"{other} * {da}",
                    "cos": f"-{other} * {da}",
                    "exp": f"{value} * (o{self.index[node]} * {da})" if self.saturates(node) else f"{value} * {da}",
                    "log": f"{da} / {a0}",
                    "log1p": f"{da} / (1.0 + {a0})",
                    "expm1": f"{self.coefficient(exp_of(node), 0) if node.operation == 'expm1' else ''} * {da}",
                    "sqrt": f"{da} / (2.0 * {value})",
                    "tanh": f"(1.0 - {value} * {value}) * {da}",
                    "arcsinh": f"{da} / (sqrt(1.0 + {a0} * {a0}) if abs({a0}) < 1e150 else abs({a0}))",
                    "pow": f"{self.reference(node.arguments[-1])} * {value} / {a0} * {da}",
                }[node.operation]
            lines.append(f"{tag}{self.index[node]} = {rule}")
        return lines
