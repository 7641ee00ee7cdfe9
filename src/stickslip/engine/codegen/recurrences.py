"""Write the Taylor recurrences of a formula's nodes as text, order by order, for the names of `order_zero`.

Recurrences of elementary functions follow from their differential equations, such as (exp a)' = a' exp a; w{i}_{k} is k times the
k-th coefficient of node number i. A series is a chain in which each coefficient waits for those before it. To keep the chain short,
constant factors are multiplied beforehand (`parts`), the weights of an argument that is linear in slip come straight from the slip
rate (`direct`), sums are handed on before they are scaled (v{i}_{k}, see `series_of`), and divisors are inverted once.
"""

from __future__ import annotations

from stickslip.engine.codegen.order_zero import OrderZero, exp_of
from stickslip.friction.formula.expression import RATE, SLIP, Expression

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


def root_of(node: Expression) -> Expression:
    """Return the node sqrt(1 + a^2) for a node arcsinh(a)."""
    return Expression("sqrt", (1.0 + node.arguments[0] * node.arguments[0],))


class Recurrences(OrderZero):
    """The nodes of a formula with their dependencies, and the statements that compute their series."""

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...] = ()) -> None:
        super().__init__(formula, parameters, state_rates)
        self.pending_rate: int | None = None
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

    def coefficient(self, node: Expression, k: int) -> str | None:
        """Return the name of the k-th Taylor coefficient of a node, or None if it is zero.

        The rate's coefficient of order `pending_rate`, which is not known yet, counts as zero.
        """
        if k and k == self.pending_rate and set(self.parts(node)) == {RATE}:
            return None
        return super().coefficient(node, k)

    def products(self, a: Expression, b: Expression, pairs: list[tuple[int, int]]) -> list[str]:
        """Write the products a_i b_j for the given pairs (i, j), without those that are zero."""
        names = [(self.coefficient(a, i), self.coefficient(b, j)) for i, j in oldest_first(pairs)]
        return [f"{x} * {y}" for x, y in names if x is not None and y is not None]

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
            grows = f"o{self.index[node]} * " if self.saturates(node) else ""
            return f"{grows}{ak} * {self.coefficient(node, 0)}" + self._weighted(a, node, k)
        if node.operation == "expm1":
            return f"{self.coefficient(exp_of(node), k)}"
        if node.operation in ("log", "log1p"):
            return f"({ak} - (0.0{self._weighted(node, a, k)})) * i{self.index[node]}"
        if node.operation == "tanh":
            square = node * node
            return f"{ak} * (1.0 - {self.coefficient(square, 0)}) - (0.0{self._weighted(a, square, k)})"
        return f"({ak} - (0.0{self._weighted(node, root_of(node), k)})) * i{self.index[node]}"  # arcsinh
