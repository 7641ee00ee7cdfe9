"""Write the Taylor recurrences of a formula's nodes as text: order zero, first derivatives and higher orders.

The text uses these names for node number i: c[i] is its value at the reference point, e{i} its difference from that value, n{i}_{k}
its k-th Taylor coefficient, and w{i}_{k} is k times that coefficient. The k-th coefficients of slip and slip rate are x_{k} and
s_{k}. The difference of the slip is dx, that of the rate is s_0, and w and w2 are the states. Recurrences of elementary functions
follow from their differential equations, such as (exp a)' = a' exp a, order by order.

A series is a chain in which each coefficient waits for those before it. To keep the chain short, constant factors are multiplied
beforehand (`parts`), the weights of an argument that is linear in slip come straight from the slip rate (`direct`), sums are handed
on before they are scaled (v{i}_{k}, see `series_of`), and divisors are inverted once.
"""

from __future__ import annotations

from stickslip.friction.formula.denominators import LARGEST_EXPONENT, harmless_overflows
from stickslip.friction.formula.expression import RATE, SLIP, STATES, VARIABLES, Expression, depends_on, nodes_of

NO_LIMIT = 1e308
"""Largest exponent of any other exp, in effect no limit: if exp is infinite, the run ends with a status that says so."""
MOST_PARTS = 3
"""Largest number of terms in which a linear combination is taken apart (see `parts`): longer sums are added as a tree."""
FRESH = 4
"""Number of terms of a sum that are added last, because they need the newest coefficients (see `sum_of`)."""


def oldest_first(pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Sort the pairs of orders in a product's recurrence so that those which need the newest coefficients come last.

    Of two factors of one order the first is known before the second: it is often the weight of the other's argument.
    """
    return sorted(pairs, key=lambda pair: max(2 * pair[0], 2 * pair[1] + 1))


def sum_of(terms: list[str]) -> str:
    """Write the sum of terms, which are given oldest first: the older ones as a balanced tree, then the newest one by one.

    The tree is short and has little rounding error. The processor has finished it before the newest terms are known, and then needs
    only one addition for each of these.
    """
    if not terms:
        return "0.0"
    old = terms[: max(len(terms) - FRESH, 1)]
    return " + ".join([_balanced(old), *terms[len(old) :]])


def _balanced(terms: list[str]) -> str:
    """Write the sum of terms as a balanced binary tree."""
    if len(terms) == 1:
        return terms[0]
    half = len(terms) // 2
    return f"({_balanced(terms[:half])} + {_balanced(terms[half:])})"


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


def root_of(node: Expression) -> Expression:
    """Return the node sqrt(1 + a^2) for a node arcsinh(a)."""
    return Expression("sqrt", (1.0 + node.arguments[0] * node.arguments[0],))


class Recurrences:
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
        self.pending_rate: int | None = None
        self.size = len(self.nodes) + 1
        arguments = dict.fromkeys(n.arguments[0] for n in self.dynamic if n.operation in ("sin", "cos", "exp"))
        self.direct = {a: found[SLIP] for a in arguments if set(found := self.parts(a)) == {SLIP}}

    def parts(self, node: Expression) -> dict[Expression, str]:
        """Return the nodes of which a node is a linear combination, but for a constant, with their factors as texts."""
        a, b = (*node.arguments, node, node)[:2]
        found = {node: "1.0"} if self.varies[node] else {}
        if node.operation in ("add", "sub"):
            left, right = self.parts(a), self.parts(b)
            minus = {part: f"-1.0 * {factor}" for part, factor in right.items()}
            if not left.keys() & right.keys() and len(left) + len(right) <= MOST_PARTS:
                return left | (right if node.operation == "add" else minus)
        elif node.operation == "mul" and not (self.varies[a] and self.varies[b]):
            varying, constant = (a, b) if self.varies[a] else (b, a)
            return {part: f"{factor} * {self.reference(constant)}" for part, factor in self.parts(varying).items()}
        elif node.operation == "div" and not self.varies[b]:
            return {part: f"{factor} / {self.reference(b)}" for part, factor in self.parts(a).items()}
        return found

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
        """Return the name of the k-th Taylor coefficient of a node, or None if it is zero.

        The rate's coefficient of order `pending_rate`, which is not known yet, counts as zero.
        """
        if not self.varies[node]:
            return self.reference(node) if k == 0 else None
        if node in STATES:
            return node.name
        if node == RATE:
            return None if k == self.pending_rate else f"s_{k}"
        if k and k == self.pending_rate and set(self.parts(node)) == {RATE}:
            return None
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

    def products(self, a: Expression, b: Expression, pairs: list[tuple[int, int]]) -> list[str]:
        """Write the products a_i b_j for the given pairs (i, j), without those that are zero."""
        names = [(self.coefficient(a, i), self.coefficient(b, j)) for i, j in oldest_first(pairs)]
        return [f"{x} * {y}" for x, y in names if x is not None and y is not None]

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
                    "exp": f"{value} * {da}",
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

    # ---- higher orders ------------------------------------------------------------------------------------------------------

    def order(self, k: int) -> list[str]:
        """Write the k-th Taylor coefficients of all varying nodes, after the weights that come from the slip rate directly."""
        lines = []
        for a in self.direct:
            i = self.index[a]
            lines.append(f"w{i}_{k} = " + (f"fused(p{i}, s_{k - 1}, b{i} * s_{k - 2})" if k > 1 else f"p{i} * s_0"))
        for node in self.dynamic:
            if self._is_scaled(node):
                lines.append(f"v{self.index[node]}_{k} = {self._scaled_sum(node, k)}")
            lines.append(f"n{self.index[node]}_{k} = {self._recurrence(node, k)}")
        return lines

    def before_orders(self, pace: str, bend: str) -> list[str]:
        """Write what recurrences use at all orders: factors of weights, and reciprocals of what they would divide by.

        `pace` and `bend` are the texts of A and B, in terms of the law's slip.
        """
        lines = []
        for a, factor in self.direct.items():
            lines += [f"p{self.index[a]} = {factor} * {pace}", f"b{self.index[a]} = {factor} * {bend}"]
        lines += [f"i{self.index[node]} = 1.0 / ({below})" for node in self.dynamic if (below := self._divisor(node))]
        return lines

    def _divisor(self, node: Expression) -> str | None:
        """Write what the recurrence of a node would divide by, or return None if it does not divide."""
        if node.operation in ("div", "sqrt", "arcsinh"):
            by = {"div": node.arguments[-1], "sqrt": node, "arcsinh": root_of(node)}[node.operation]
            return f"{'2.0 * ' if by == node else ''}{self.coefficient(by, 0)}"
        shift = {"pow": "", "log": "", "log1p": "1.0 + "}.get(node.operation)
        return None if shift is None else f"{shift}{self.coefficient(node.arguments[0], 0)}"

    def series_of(self, node: Expression, k: int) -> tuple[str, str]:
        """Return a factor and the name of a series whose product is the k-th coefficient of a node."""
        if not self._is_scaled(node):
            return "1.0", self.coefficient(node, k) or "0.0"
        factor = {"div": f"-i{self.index.get(node)}", "cos": f"{-1.0 / k!r}"}.get(node.operation, f"{1.0 / k!r}")
        return factor, f"v{self.index[node]}_{k}"

    def _is_scaled(self, node: Expression) -> bool:
        """Return True if a series that is known before a node's own is written, from which it differs by a factor (`series_of`)."""
        if node.operation == "div":
            return self.varies[node] and not self.varies[node.arguments[0]]
        return node.operation in ("sin", "cos", "exp") and node.arguments[0] in self.direct

    def _scaled_sum(self, node: Expression, k: int) -> str:
        """Write the sum that differs from the k-th coefficient of a node by a factor."""
        a = node.arguments[0]
        if node.operation == "div":
            return sum_of(self.products(node.arguments[1], node, [(j, k - j) for j in range(1, k + 1)]))
        partner = {"sin": "cos", "cos": "sin"}.get(node.operation)
        other = Expression(partner, (a,)) if partner else node
        pairs = oldest_first([(j, k - j) for j in range(1, k)])
        terms = [f"w{self.index[a]}_{i} * {self.coefficient(other, j)}" for i, j in pairs]
        last = f"w{self.index[a]}_{k}, {self.coefficient(other, 0)}"
        return f"fused({last}, {sum_of(terms)})" if terms else last.replace(",", " *")

    def weights(self, k: int) -> list[str]:
        """Write k a_k for every series a for which recurrences of higher order need it; several may share it."""
        arguments = {n.arguments[0] for n in self.dynamic if n.operation in ("sin", "cos", "exp", "tanh")} - self.direct.keys()
        arguments |= {n for n in self.dynamic if n.operation in ("log", "log1p", "arcsinh")}
        return [f"w{self.index[a]}_{k} = {k}.0 * {self.coefficient(a, k)}" for a in sorted(arguments, key=self.index.__getitem__)]

    def _weighted(self, a: Expression, b: Expression, k: int) -> str:
        """Write + (1/k) times the sum over 0 < j < k of j a_j b_(k-j), or nothing if k = 1."""
        pairs = oldest_first([(j, k - j) for j in range(1, k)])
        terms = [f"w{self.index[a]}_{i} * {self.coefficient(b, j)}" for i, j in pairs]
        return f" + {1.0 / k!r} * ({sum_of(terms)})" if terms else ""

    def _recurrence(self, node: Expression, k: int) -> str:
        """Write the k-th Taylor coefficient of a node (k > 0) in terms of those already known."""
        a = node.arguments[0]
        ak = self.coefficient(a, k) or "0.0"
        if self._is_scaled(node):
            return " * ".join(self.series_of(node, k))
        if node.operation in ("add", "sub"):
            bk = self.coefficient(node.arguments[1], k)
            if bk is None:
                return ak
            if node.operation == "add":
                return f"{ak} + {bk}" if self.coefficient(a, k) else bk
            return f"{ak} - {bk}"
        if node.operation == "mul":
            return sum_of(self.products(a, node.arguments[1], [(j, k - j) for j in range(k + 1)]))
        if node.operation == "div":
            b = node.arguments[1]
            terms = self.products(b, node, [(j, k - j) for j in range(1, k + 1)])
            return f"({ak} - ({sum_of(terms)})) * i{self.index[node]}"
        if node.operation == "sqrt":
            terms = self.products(node, node, [(j, k - j) for j in range(1, k)])
            return f"({ak} - ({sum_of(terms)})) * i{self.index[node]}"
        if node.operation == "pow":
            exponent = self.reference(node.arguments[1])
            factors = [
                (i, self.coefficient(a, j), self.coefficient(node, i)) for i, j in oldest_first([(j, k - j) for j in range(k)])
            ]
            terms = [f"({k - j}.0 * {exponent} - {j}.0) * {x} * {y}" for j, x, y in factors if x is not None]
            return f"({sum_of(terms)}) * ({1.0 / k!r} * i{self.index[node]})"
        sine, cosine = Expression("sin", (a,)), Expression("cos", (a,))
        if node.operation == "sin":
            return f"{ak} * {self.coefficient(cosine, 0)}" + self._weighted(a, cosine, k)
        if node.operation == "cos":
            return f"-({ak} * {self.coefficient(sine, 0)}" + self._weighted(a, sine, k) + ")"
        if node.operation == "exp":
            return f"{ak} * {self.coefficient(node, 0)}" + self._weighted(a, node, k)
        if node.operation == "expm1":
            return f"{self.coefficient(exp_of(node), k)}"
        if node.operation in ("log", "log1p"):
            return f"({ak} - (0.0{self._weighted(node, a, k)})) * i{self.index[node]}"
        if node.operation == "tanh":
            square = node * node
            return f"{ak} * (1.0 - {self.coefficient(square, 0)}) - (0.0{self._weighted(a, square, k)})"
        return f"({ak} - (0.0{self._weighted(node, root_of(node), k)})) * i{self.index[node]}"  # arcsinh
