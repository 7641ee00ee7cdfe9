"""Write the Taylor recurrences of a formula's nodes as text, order by order, for the names of `order_zero`.

Recurrences of elementary functions follow from their differential equations, such as (exp a)' = a' exp a; w{i}_{k} is k times the
k-th coefficient of node number i. A series is a chain: each coefficient waits for those before it. To keep the chain short,
constant factors are multiplied beforehand (`parts`), the weights of an argument that is linear in slip come straight from the slip
rate (`direct`), sums are handed on before they are scaled (v{i}_{k}, see `series_of`), and divisors are inverted once.
"""

from __future__ import annotations

from stickslip.engine.formula_code.order_zero import OrderZero
from stickslip.friction.formula import RATE, SLIP, Expression, Scaled, oldest_first, operation_of, sum_of


class Recurrences(OrderZero):
    """The nodes of a formula with their dependencies, and the statements that compute their series."""

    def __init__(self, formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...] = ()) -> None:
        super().__init__(formula, parameters, state_rates)
        self.pending_rate: int | None = None
        arguments = dict.fromkeys(n.arguments[0] for n in self.dynamic if operation_of(n).recurrence.may_be_direct)
        self.direct = {a: found[SLIP] for a in arguments if set(found := self.parts(a)) == {SLIP}}

    def parts(self, node: Expression) -> dict[Expression, str]:
        """Return a node as a linear combination of others, up to a constant: these nodes with their factors as texts."""
        taken_apart = operation_of(node).parts(self, node) if node.arguments else None
        if taken_apart is not None:
            return taken_apart
        return {node: "1.0"} if self.varies[node] else {}

    def coefficient(self, node: Expression, k: int) -> str | None:
        """Return the name of the k-th Taylor coefficient of a node, or None if it is zero.

        The rate's coefficient of order `pending_rate`, which is not known yet, counts as zero.
        """
        if k and k == self.pending_rate and set(self.parts(node)) == {RATE}:
            return None
        return super().coefficient(node, k)

    def is_direct(self, node: Expression) -> bool:
        """Return True for an argument whose weights come straight from the slip rate."""
        return node in self.direct

    def products(self, a: Expression, b: Expression, k: int, orders: range) -> str:
        """Write the sum of a_j b_(k-j) over some orders j, without products that are zero."""
        names = [(self.coefficient(a, i), self.coefficient(b, j)) for i, j in oldest_first([(j, k - j) for j in orders])]
        return sum_of([f"{x} * {y}" for x, y in names if x is not None and y is not None])

    def order(self, k: int) -> list[str]:
        """Write the k-th Taylor coefficients of all varying nodes, after the weights that come from the slip rate directly."""
        lines = []
        for a in self.direct:
            i = self.index[a]
            lines.append(f"w{i}_{k} = " + (f"fused(p{i}, s_{k - 1}, b{i} * s_{k - 2})" if k > 1 else f"p{i} * s_0"))
        for node in self.dynamic:
            if scaled := self._scaled(node):
                lines.append(f"v{self.index[node]}_{k} = {scaled.total(self, node, k)}")
            lines.append(f"n{self.index[node]}_{k} = {self._recurrence(node, k)}")
        return lines

    def before_orders(self, pace: str, bend: str) -> list[str]:
        """Write the numbers that recurrences use at all orders: factors of weights, and reciprocals of divisors.

        `pace` and `bend` are the texts of A and B, in terms of the law's slip.
        """
        lines = []
        for a, factor in self.direct.items():
            lines += [f"p{self.index[a]} = {factor} * {pace}", f"b{self.index[a]} = {factor} * {bend}"]
        divisors = {node: operation_of(node).recurrence.divisor for node in self.dynamic}
        return lines + [f"i{self.index[node]} = 1.0 / ({below(self, node)})" for node, below in divisors.items() if below]

    def series_of(self, node: Expression, k: int) -> tuple[str, str]:
        """Return a factor and the name of a series whose product is the k-th coefficient of a node."""
        if scaled := self._scaled(node):
            return scaled.factor(self, node, k), f"v{self.index[node]}_{k}"
        return "1.0", self.coefficient(node, k) or "0.0"

    def _scaled(self, node: Expression) -> Scaled | None:
        """Return the rules of a series that is known before a node's own is written, or None if there is none."""
        scaled = operation_of(node).recurrence.scaled if node.arguments and self.varies[node] else None
        return scaled if scaled and scaled.where(self, node) else None

    def directly_weighted(self, a: Expression, b: Expression, k: int) -> str:
        """Write the sum over 0 < j <= k of j a_j b_(k-j), for an argument a whose weights come straight from the slip rate."""
        last = f"w{self.index[a]}_{k}, {self.coefficient(b, 0)}"
        return f"fused({last}, {sum_of(terms)})" if (terms := self._weighted_products(a, b, k)) else last.replace(",", " *")

    def weights(self, k: int) -> list[str]:
        """Write k a_k for every series a if recurrences of higher order need it; several may share it."""
        rules = {node: operation_of(node).recurrence for node in self.dynamic}
        weighted = {node.arguments[0] for node, rule in rules.items() if rule.weights_of_argument} - self.direct.keys()
        weighted |= {node for node, rule in rules.items() if rule.weights_of_result}
        return [f"w{self.index[a]}_{k} = {k}.0 * {self.coefficient(a, k)}" for a in sorted(weighted, key=self.index.__getitem__)]

    def weighted(self, a: Expression, b: Expression, k: int) -> str:
        """Write + (1/k) times the sum over 0 < j < k of j a_j b_(k-j), or nothing if k = 1."""
        return f" + {1.0 / k!r} * ({sum_of(terms)})" if (terms := self._weighted_products(a, b, k)) else ""

    def _weighted_products(self, a: Expression, b: Expression, k: int) -> list[str]:
        pairs = oldest_first([(j, k - j) for j in range(1, k)])
        return [f"w{self.index[a]}_{i} * {self.coefficient(b, j)}" for i, j in pairs]

    def _recurrence(self, node: Expression, k: int) -> str:
        """Write the k-th Taylor coefficient of a node (k > 0) in terms of those already known."""
        if self._scaled(node):
            return " * ".join(self.series_of(node, k))
        return operation_of(node).recurrence.coefficient(self, node, k)
